// Every part, walked through by the Tab key alone: the focus is always seen and never caught; Escape stops from anywhere, Enter follows a link.
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { becomes, launch, open, until } from './lib/browser.mjs';
import { arrive, furnish, parts } from './lib/parts.mjs';
import { Program } from './lib/program.mjs';

let program, browser;
before(async () => {
  program = await Program.start();
  await furnish(program);
  browser = await launch();
});
after(async () => {
  await browser?.close();
  await program?.end();
});
const ready = (page, part) => arrive(page, program, part);

/** What has the keyboard: its name, a mark that is the element's own, and whether a person can see that it has it. */
const focused = (page) =>
  page.evaluate(() => {
    const e = document.activeElement;
    if (!e || e === document.body || e === document.documentElement) return null;
    const marks = (globalThis.marks ??= new Map());
    if (!marks.has(e)) marks.set(e, marks.size);
    const drawn = (x) => {
      if (!x) return false;
      const s = getComputedStyle(x);
      return s.outlineStyle !== 'none' && parseFloat(s.outlineWidth) >= 2 && s.outlineColor !== 'rgba(0, 0, 0, 0)';
    };
    // A field in a box, and a file input that is a button to the eye, show it on what is around them.
    const shown = drawn(e) || drawn(e.closest('.field-box')) || drawn(e.closest('label.button'));
    const visible = e.closest('label.button') ?? e;
    const r = visible.getBoundingClientRect();
    const head = document.querySelector('.top').getBoundingClientRect().bottom;
    const foot = innerWidth < 880 ? document.querySelector('.nav').getBoundingClientRect().top : innerHeight;
    const inFrame = e.closest('.top, .nav, .skip') !== null;
    const inSight = r.width > 0 && r.height > 0 && r.right > 0 && r.left < innerWidth && (inFrame || (r.bottom > head + 1 && r.top < foot - 1));
    return { mark: marks.get(e), name: (e.getAttribute('aria-label') ?? e.labels?.[0]?.textContent ?? e.textContent ?? '').trim().slice(0, 60), tag: e.tagName, shown, inSight };
  });
/** What the Tab key should come to: everything that can be used, as the browser itself counts it; of radio buttons of one group one. */
const usable = (page) =>
  page.evaluate(() => {
    const all = [...document.querySelectorAll('a[href], button, input, select, textarea, summary, [tabindex="0"]')].filter((e) => !e.matches(':disabled') && e.checkVisibility({ visibilityProperty: true }) && e.tabIndex >= 0);
    return all.length;
  });

for (const part of parts) {
  test(`${part.name}: the Tab key reaches all, is always seen, and comes out again, forward and backward`, async () => {
    const page = await open(browser, program.url);
    await ready(page, part);
    // Live parts grow while one walks; those are held still.
    if (part.name === 'line') await page.getByRole('button', { name: 'Pause' }).click();
    const count = await usable(page);
    await page.evaluate(() => { document.activeElement.blur(); getSelection().removeAllRanges(); scrollTo(0, 0); });
    await page.locator('body').evaluate((b) => { b.tabIndex = -1; b.focus(); b.removeAttribute('tabindex'); });
    const seen = new Map();
    const most = count + 40;
    let turns = 0;
    for (; turns < most; turns += 1) {
      await page.keyboard.press('Tab');
      const f = await focused(page);
      if (f === null) break; // out of the page, into the browser
      if (seen.has(f.mark)) break; // round again
      assert.ok(f.shown, `the focus on "${f.name}" (${f.tag}) cannot be seen`);
      assert.ok(f.inSight, `"${f.name}" (${f.tag}) has the keyboard out of sight`);
      seen.set(f.mark, f.name);
    }
    assert.ok(turns < most, `no way out after ${turns} turns; last: ${[...seen.values()].slice(-3).join(' | ')}`);
    assert.ok(seen.size >= count - 4, `the Tab key came to ${seen.size} of ${count}`);
    const names = [...seen.values()];
    assert.equal(names[0], 'To the content');
    assert.ok(names.findIndex((n) => /^Stop all/.test(n)) < 20, 'the stop of all is near the beginning');
    await page.keyboard.press('Shift+Tab');
    await page.keyboard.press('Shift+Tab');
    assert.ok(await focused(page), 'backward there is something too');
    assert.deepEqual(page.faults(), []);
    await page.context().close();
  });
}

test('from any part: Escape empties the field that is being typed in, the next one stops all axes, and the button says so', async () => {
  const page = await open(browser, program.url);
  let stops = 0;
  page.on('request', (r) => /\/axes\/feeder\/commands$/.test(r.url()) && /quick_stop/.test(r.postData() ?? '') && (stops += 1));
  let fields = 0;
  for (const part of parts) {
    await ready(page, part);
    const field = page.locator('main input[type=text]:enabled:visible, main input[type=search]:enabled:visible, main textarea:enabled:visible').first();
    if ((await field.count()) > 0) {
      await field.focus();
      await field.fill('12');
      await becomes('it is said', () => page.locator('.stop-all kbd').innerText(), 'Esc Esc');
      await page.keyboard.press('Escape');
      await becomes('it is empty', () => field.inputValue(), '');
      assert.equal(stops, 0, part.path);
      fields += 1;
    }
    await becomes('the next one stops', () => page.locator('.stop-all kbd').innerText(), 'Esc');
    const answers = page.waitForResponse((r) => /\/axes\/feeder\/commands$/.test(r.url()) && /quick_stop/.test(r.request().postData() ?? ''));
    await page.keyboard.press('Escape');
    assert.equal((await answers).status() < 300, true, part.path);
    stops = 0;
  }
  assert.ok(fields > 5, `${fields} parts have a field`);
  await page.context().close();
});

test('by keyboard alone from the first part to every other, by Enter on its link', async () => {
  const page = await open(browser, program.url);
  await ready(page, parts[0]);
  for (const [link, title] of [['Lines', 'Lines and drives'], ['Mappings', 'Mappings'], ['Site', 'Site'], ['Recipes', 'Recipes'], ['Events', 'Events and alarms'], ['Gateway', 'Gateway'], ['Axes', 'Overview']]) {
    await page.evaluate(() => scrollTo(0, 0));
    await page.locator('a.skip').focus();
    for (let i = 0; i < 14; i += 1) {
      await page.keyboard.press('Tab');
      if (await page.evaluate((l) => document.activeElement.closest('.nav') !== null && document.activeElement.querySelector('span')?.textContent === l, link)) break;
    }
    await page.keyboard.press('Enter');
    await page.locator('main h1', { hasText: title }).first().waitFor();
    await until(`the keyboard is at the beginning of ${title}`, () => page.evaluate(() => document.activeElement.matches('main h1')));
  }
  await page.context().close();
});
