// A phone in the hand: the stop of all lies across the foot, whole and uncovered, nothing hides behind it, nothing is too small for a finger, and
// nobody is told of keys that are not there.
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { launch, open, shot, tooWide, until } from './lib/browser.mjs';
import { Program } from './lib/program.mjs';

let program, browser;
before(async () => {
  program = await Program.start();
  browser = await launch();
});
after(async () => {
  await browser?.close();
  await program?.end();
});
const phone = (path, width, height) => open(browser, program.url + path, { viewport: { width, height }, hasTouch: true, isMobile: true });
const box = (page, selector) => page.locator(selector).first().evaluate((e) => { const r = e.getBoundingClientRect(); return { x: r.x, y: r.y, w: r.width, h: r.height, bottom: r.bottom, right: r.right }; });

for (const [width, height] of [[390, 844], [320, 640]]) {
  test(`${width} px: the stop bar is whole, above the navigation, and the end of the page is above it`, async () => {
    const page = await phone('/', width, height);
    await page.locator('[data-axis] [data-live=true]').first().waitFor();
    const stop = await box(page, '.stop-all');
    const nav = await box(page, '.nav');
    assert.deepEqual([stop.x, Math.round(stop.w)], [0, width]);
    assert.ok(stop.h >= 48 && stop.bottom <= nav.y + 1 && nav.bottom <= height + 1, JSON.stringify({ stop, nav }));
    const hit = await page.evaluate(([x, y]) => document.elementFromPoint(x, y).closest('button')?.className, [width / 2, stop.y + stop.h / 2]);
    assert.match(hit, /stop-all/);
    await page.evaluate(() => scrollTo(0, document.documentElement.scrollHeight));
    const last = await page.evaluate(() => Math.max(...[...document.querySelectorAll('main section')].map((e) => e.getBoundingClientRect().bottom)));
    assert.ok(last <= stop.y, `the page ends at ${last}, the bar begins at ${stop.y}`);
    await page.locator('.stop-all').tap();
    await until('the answer stands above the bar', async () => (await box(page, '.strip-stop')).bottom <= stop.y + 1 && /accepted/.test(await page.locator('.strip-stop').innerText()));
    await shot(page, `phone-stop-${width}`);
    assert.equal(await tooWide(page), 0);
    await page.context().close();
  });
}

test('the badge of the alarms stays in the navigation in landscape', async () => {
  const page = await phone('/', 844, 390);
  await program.command('feeder', { command: 'enable' });
  await program.call('POST', '/axes/feeder/commands', { command: 'move_velocity', velocity: 1, acceleration: 20 });
  await program.call('PATCH', '/drives/feeder/hand', { stall: true });
  await page.locator('[data-field=alarm-badge]').waitFor();
  const badge = await box(page, '[data-field=alarm-badge]');
  const nav = await box(page, '.nav');
  assert.ok(badge.y >= nav.y && badge.bottom <= nav.bottom, JSON.stringify({ badge, nav }));
  await program.call('PATCH', '/drives/feeder/hand', { stall: false });
  await page.context().close();
});

test('320 px, page of an axis: every control is whole, and large enough for a finger', async () => {
  const page = await phone('/axes/feeder', 320, 640);
  await page.locator('[data-live=true]').first().waitFor();
  const wrong = await page.evaluate(() => [...document.querySelectorAll('.head a, .head button, .axis-head button, .axis-state button')].filter((e) => e.checkVisibility() && !e.matches('.brand')).flatMap((e) => {
    const r = e.getBoundingClientRect();
    const name = e.getAttribute('aria-label') ?? e.textContent;
    return [...(r.height < 40 || r.width < 40 ? [`${name} is ${r.width} x ${r.height}`] : []), ...(r.left < 0 || r.right > innerWidth || e.scrollWidth > e.clientWidth + 1 ? [`${name} is cut`] : [])];
  }));
  assert.deepEqual(wrong, []);
  const [connection, brand] = [await box(page, '.connection'), await box(page, '.brand')];
  assert.ok(brand.right <= connection.x, 'the state of the connection beside the name');
  await page.context().close();
});

test('nobody without keys is told of the Escape key', async () => {
  const page = await phone('/gateway', 820, 1180);
  await page.locator('.facts').first().waitFor();
  assert.doesNotMatch(await page.locator('body').innerText(), /\bEsc\b/i);
  await page.context().close();
  const desk = await open(browser, `${program.url}/gateway`);
  await desk.getByText('stops all axes').waitFor();
  await desk.context().close();
});

test('a line of 3000 characters leaves the console as high as it was', async () => {
  const page = await open(browser, `${program.url}/axes/feeder/drive`);
  const line = page.getByLabel(/^Line to send to/);
  await line.fill('X'.repeat(3000));
  const before = (await box(page, '.console')).h;
  await line.press('Enter');
  await page.locator('.console-log .sent').waitFor();
  assert.ok((await box(page, '.console')).h <= before + 1);
  await page.context().close();
});

for (const width of [390, 320]) {
  test(`${width} px: what the cursors of the scope read stands below each other, nothing is to be scrolled for`, async () => {
    const page = await phone('/axes/feeder', width, 844);
    await page.locator('.scope canvas').waitFor();
    await page.locator('[data-live=true]').first().waitFor();
    for (const name of ['Following error', 'Demand']) {
      const b = page.getByRole('group', { name: 'Channels' }).getByRole('button', { name, exact: true });
      if ((await b.getAttribute('aria-pressed')) !== 'true') await b.click();
    }
    await page.locator('.scope-plot').evaluate((e) => e.scrollIntoView({ block: 'center' }));
    /** Into the plot between its scales, which is made anew when its channels change: from the left edge so far to the right. */
    const into = async (share) => {
      const plot = await page.locator('.scope .u-over').boundingBox();
      if (plot) await page.mouse.click(plot.x + plot.width * share, plot.y + plot.height / 2);
    };
    await until('cursor A is there', async () => {
      await into(0.5);
      return (await page.locator('.cursor-table').count()) === 1;
    });
    await page.getByRole('group', { name: /^Cursor/ }).getByRole('button', { name: 'B', exact: true }).click();
    await page.locator('.scope-plot').evaluate((e) => e.scrollIntoView({ block: 'center' }));
    const table = page.locator('.cursor-table');
    await until('both cursors and their difference are there', async () => {
      await into(0.7);
      return (await table.locator('tbody tr').count()) === 3 || (await table.innerText());
    });
    const wide = await table.evaluate((t) => [...t.querySelectorAll('td, th'), t, t.parentElement].filter((e) => e.scrollWidth > e.clientWidth + 1 || e.getBoundingClientRect().right > innerWidth).map((e) => e.outerHTML.slice(0, 80)));
    assert.deepEqual(wide, []);
    const titles = await table.locator('tbody tr').first().locator('td').evaluateAll((l) => l.map((e) => getComputedStyle(e, '::before').content));
    assert.ok(titles.length >= 5 && titles.every((t) => /[A-Z][a-z]/.test(t)), `each value has its name: ${titles}`);
    await table.scrollIntoViewIfNeeded();
    await shot(page, `phone-cursors-${width}`);
    await page.context().close();
  });
}
