// How high and how wide the page is: no page is higher than three screens of a small phone, what is folded is there on paper, one width of content, room
// for strips and choices, one octagon. In: the program. Out: counts; pictures under build/browser.
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { readFileSync } from 'node:fs';
import { becomes, examine, open, quiet, shot, until } from './lib/browser.mjs';
import { start } from './lib/machine.mjs';
import { furnish, parts } from './lib/parts.mjs';
import { Program } from './lib/program.mjs';

let program, browser, page;
before(async () => void ({ program, browser, page } = await start()));
after(async () => {
  await browser?.close();
  await program?.end();
});

test('no tab of an axis is higher than three screens of a small phone', async () => {
  await furnish(program).catch(() => undefined); // events, snapshots, an alarm
  const phone = await open(browser, program.url, { viewport: { width: 360, height: 740 }, hasTouch: true, isMobile: true });
  const wrong = [];
  for (const [path, ready] of [['/axes/feeder', '.machine'], ['/axes/feeder/scope', '.scope canvas'], ['/axes/feeder/parameters', 'tr[data-parameter]'], ['/axes/feeder/drive', '[data-part=actions]'], ['/axes/feeder/simulation', '[data-hand]'], ['/axes/feeder/events', '.event']]) {
    await phone.goto(program.url + path);
    await phone.locator(ready).first().waitFor();
    const height = await phone.evaluate(() => globalThis.document.querySelector('main').getBoundingClientRect().height);
    if (height > 3 * 740) wrong.push(`${path} is ${Math.round(height)} px high`);
  }
  assert.deepEqual(wrong, []);
  await phone.context().close();
});

test('no page is higher than three screens of a small phone; what is folded is there when it is asked for, and whole on paper', async () => {
  const furnished = await Program.start();
  try {
    await furnish(furnished);
    const phone = await open(browser, furnished.url, { viewport: { width: 360, height: 740 }, hasTouch: true, isMobile: true, bypassCSP: true });
    const pages = [...parts, { path: '/report', ready: '[data-field=report]' }, { path: '/fleet', ready: 'main h1' }, ...['trends', 'captures', 'recordings'].map((tab) => ({ path: `/recorder/${tab}`, ready: 'main h1' }))];
    const wrong = [];
    for (const { path, ready } of pages) {
      await phone.goto(furnished.url + path);
      await phone.locator(ready).first().waitFor();
      await quiet(phone);
      const height = await phone.evaluate(() => globalThis.document.querySelector('main').getBoundingClientRect().height);
      if (height > 3 * 740) wrong.push(`${path} is ${Math.round(height)} px high`);
    }
    const linked = await phone.locator('.nav a').evaluateAll((l) => l.map((a) => new URL(a.href).pathname));
    assert.ok(linked.length > 5, `${linked}`);
    wrong.push(...linked.filter((path) => !pages.some((p) => p.path === path || p.path.startsWith(`${path}/`))).map((path) => `${path} is not looked at`));
    assert.deepEqual(wrong, []);
    for (const path of ['/lines/can0', '/mappings', '/recipes/there-and-back', '/events', '/report']) {
      await phone.goto(furnished.url + path);
      await phone.locator(pages.find((p) => p.path === path).ready).first().waitFor();
      await quiet(phone);
      wrong.push(...(await examine(phone)).map((v) => `${path}: ${JSON.stringify(v)}`));
      const folds = phone.locator('main .fold');
      if (/events|report/.test(path)) assert.ok(await phone.locator('.window[role=region][tabindex="0"]').count() > 0, path);
      else assert.match((await folds.allInnerTexts()).join('; '), /\w \(\d+\)/, path);
      for (const fold of await folds.all()) {
        assert.equal(await fold.getAttribute('aria-expanded'), 'false');
        await fold.press('Enter');
        await becomes('it is open', () => fold.getAttribute('aria-expanded'), 'true');
        assert.ok(await fold.evaluate((e) => [...e.closest('.section').children].every((c) => c.checkVisibility())), path);
        await fold.press('Enter');
        await becomes('it is folded', () => fold.getAttribute('aria-expanded'), 'false');
      }
      assert.equal(await phone.locator('.is-folded > :not(.section-head):visible').count(), 0, path);
      await phone.emulateMedia({ media: 'print' });
      const cut = await phone.evaluate(() => [...globalThis.document.querySelectorAll('main .window, main .is-folded, main .report .scroll')].filter((e) => e.matches('.is-folded') ? [...e.children].some((c) => getComputedStyle(c).display === 'none' && !c.matches('.section-head')) : getComputedStyle(e).maxHeight !== 'none').map((e) => e.className));
      wrong.push(...cut.map((c) => `${path} on paper: ${c}`));
      await phone.emulateMedia({ media: null });
    }
    await phone.goto(`${furnished.url}/mappings`);
    // Not the fold of the form itself, which is called so, too.
    await phone.getByRole('button', { name: 'Add a mapping', exact: true }).and(phone.locator('.button')).tap();
    await becomes('the form is open, and the keyboard in it', () => phone.evaluate(() => globalThis.document.activeElement.closest('form')?.id), 'mapping-form');
    assert.deepEqual(wrong, []);
    assert.deepEqual(phone.faults(), []);
    await phone.context().close();
  } finally {
    await furnished.end();
  }
});

test('one width of content: head, strip and every part begin and end at the same two lines', async () => {
  const wide = await open(browser, program.url, { viewport: { width: 1920, height: 900 } });
  const wrong = [];
  for (const part of parts) {
    await wide.goto(program.url + part.path);
    await wide.locator('main h1').first().waitFor();
    const edges = await wide.evaluate(() => ['.head', '.strip', 'main'].map((s) => {
      const e = globalThis.document.querySelector(s);
      const [r, c] = [e.getBoundingClientRect(), getComputedStyle(e)];
      return [Math.round(r.left + parseFloat(c.paddingLeft)), Math.round(r.right - parseFloat(c.paddingRight))].join('-');
    }));
    if (new Set(edges).size !== 1) wrong.push(`${part.path}: ${edges}`);
  }
  assert.deepEqual(wrong, []);
  await wide.context().close();
});

test('a strip never cuts a message, at any width', async () => {
  for (const width of [1440, 900, 390]) {
    const p = await open(browser, program.url, { viewport: { width, height: 844 }, ...(width < 500 ? { hasTouch: true, isMobile: true } : {}) });
    await p.locator('[data-axis=lift] [data-live=true]').waitFor();
    const detail = `axis lift is held by modbus 192.0.2.17 for 57 s more, and so are all others of this machine part; ask there, or take it over as an engineer, which is told there. ${'This sentence goes on. '.repeat(4)}`;
    await p.route('**/commands', (r) => r.fulfill({ status: 409, contentType: 'application/problem+json', body: JSON.stringify({ type: 'about:blank', title: 'x', status: 409, detail, reason: 'held' }) }));
    await p.locator('.stop-all').click();
    const said = p.locator('.strip-stop');
    await until('it is told', async () => /NOT confirmed/.test(await said.innerText()));
    const whole = await said.evaluate((e) => {
      const r = e.getBoundingClientRect();
      return { cut: e.scrollWidth > e.clientWidth + 1 || (e.scrollHeight > e.clientHeight + 1 && getComputedStyle(e).overflowY !== 'auto'), out: r.left < 0 || r.right > innerWidth + 1 };
    });
    assert.deepEqual(whole, { cut: false, out: false }, `${width} px`);
    await shot(p, `shape-strip-${width}`);
    await p.context().close();
  }
});

test('choices have room for their longest text', async () => {
  const p = await open(browser, program.url);
  const wrong = [];
  const cut = () => p.evaluate(() => {
    const pen = globalThis.document.createElement('canvas').getContext('2d');
    return [...globalThis.document.querySelectorAll('select')].filter((e) => e.checkVisibility()).flatMap((e) => {
      const c = getComputedStyle(e);
      pen.font = `${c.fontWeight} ${c.fontSize} ${c.fontFamily}`;
      const room = e.clientWidth - parseFloat(c.paddingLeft) - parseFloat(c.paddingRight) - 16; // the arrow
      return [...e.options].filter((o) => pen.measureText(o.text).width > room + 1).map((o) => `${e.getAttribute('aria-label') ?? e.labels?.[0]?.textContent}: ${o.text}`).slice(0, 2);
    });
  });
  for (const part of parts.filter((x) => ['overview', 'site', 'axis', 'parameters', 'axis-drive', 'axis-simulation', 'line'].includes(x.name))) {
    await p.goto(program.url + part.path);
    await p.locator('main h1').first().waitFor();
    if (part.name === 'parameters') await p.locator('tr[data-parameter]').first().waitFor();
    if (part.name === 'site') {
      for (const b of ['Change line can0', 'Change drive d5', 'Change axis lift']) await p.getByRole('button', { name: b }).click();
      await p.locator('form details').evaluateAll((l) => l.forEach((d) => (d.open = true)));
    }
    wrong.push(...(await cut()).map((w) => `${part.name}: ${w}`));
  }
  assert.deepEqual(wrong, []);
  await p.context().close();
});

test('the stop is an octagon and nothing else is', async () => {
  await page.goto(program.url);
  await page.locator('[data-axis=lift] [data-live=true]').waitFor();
  const octagon = /octagon: <path d="([^"]+)"/.exec(readFileSync(new URL('../../web/src/components/icon.tsx', import.meta.url), 'utf8'))[1];
  const others = () => page.evaluate((d) => [...globalThis.document.querySelectorAll(`svg.icon path[d="${d}"]`)].filter((e) => !e.closest('.stop')).map((e) => e.closest('[class]:not(svg)')?.className), octagon);
  for (const path of ['/', '/events']) {
    await page.goto(program.url + path);
    await page.locator('main h1').first().waitFor();
    await page.locator('.event').first().waitFor();
    assert.deepEqual(await others(), [], path);
  }
});

test('nothing on the way was a fault of the page', () => assert.deepEqual(page.faults(), []));
