// Reach: by keyboard alone, by screen reader (axe-core), on a phone; nothing jumps while values change.
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { becomes, examine, launch, look, open, quiet, tileOf, until } from './lib/browser.mjs';
import { Program } from './lib/program.mjs';

let program, browser, bare;
before(async () => {
  program = await Program.start();
  browser = await launch();
  bare = await open(browser, program.url, { bypassCSP: true });
});
after(async () => {
  await browser?.close();
  await program?.end();
});
const settled = (page) => page.locator('[data-live=true], main h1').first().waitFor();

for (const path of ['/', '/axes/feeder', '/lines', '/lines/can0', '/events', '/gateway', '/recorder/trends/', '/recorder/captures/', '/recorder/recordings/', '/report']) {
  test(`axe-core finds nothing serious on ${path}, in light and in dark, where nothing is furnished`, async () => {
    await bare.goto(program.url + path);
    await settled(bare);
    await quiet(bare);
    assert.deepEqual(await look(bare, `bare-${path.replaceAll('/', '-')}`), []);
  });
}

test('axe-core finds nothing serious while the connection is lost', async () => {
  const page = await open(browser, program.url, { bypassCSP: true });
  await page.locator('[data-axis=feeder] [data-live=true]').waitFor(); // a page that has heard nothing yet has nothing to lose
  page.expectLoss(true);
  await program.stop('SIGKILL');
  try {
    await page.locator('[data-condition=disconnected]').first().waitFor();
    assert.deepEqual(await examine(page), []);
    await page.context().close();
  } finally {
    await program.run();
  }
});

test('by keyboard alone: an axis is enabled, moved and stopped', async () => {
  const page = await open(browser, program.url);
  await page.locator('[data-axis=feeder] [data-live=true]').waitFor();
  const focused = () =>
    page.evaluate(() => {
      const e = document.activeElement;
      const label = e.getAttribute('aria-label') ?? (e.labels && e.labels[0]?.textContent) ?? e.textContent;
      const o = getComputedStyle(e);
      const box = e.closest('.field-box');
      const visible = o.outlineStyle !== 'none' && parseFloat(o.outlineWidth) >= 2;
      const boxVisible = box ? getComputedStyle(box).outlineStyle !== 'none' : false;
      return { label: label?.trim().replace(/Esc$/, ''), visible: visible || boxVisible };
    });
  const reach = async (label) => {
    for (let i = 0; i < 60; i += 1) {
      await page.keyboard.press('Tab');
      const f = await focused();
      assert.ok(f.visible, `the focus on "${f.label}" cannot be seen`);
      if (f.label === label) return;
    }
    assert.fail(`"${label}" cannot be reached with the Tab key`);
  };
  await reach('Stop all');
  await reach('Stop feeder');
  await reach('Target of feeder');
  await page.keyboard.type('4');
  await reach('Speed of feeder');
  await page.keyboard.press('Control+A');
  await page.keyboard.type('20');
  await reach('Jog feeder forward while held');
  await reach('Enable feeder');
  await page.keyboard.press('Enter');
  const feeder = tileOf(page, 'feeder');
  await until('it is enabled', async () => /Enabled/.test(await feeder.text('state')));
  await page.getByRole('textbox', { name: 'Target of feeder' }).focus();
  await page.keyboard.press('Enter');
  await until('it has moved', async () => Math.abs((await feeder.position()) - 4) < 0.01 || (await feeder.position()));
  await page.keyboard.press('Escape');
  await until('it was stopped', async () => (await program.axis('feeder')).state === 'quick_stop_active' || (await program.axis('feeder')).state, 3_000);
  await page.context().close();
});

test('the first Tab offers the way past the head', async () => {
  const page = await open(browser, program.url);
  await settled(page);
  await page.keyboard.press('Tab');
  assert.equal(await page.evaluate(() => document.activeElement.textContent.trim()), 'To the content');
  await page.context().close();
});

test('fingers find controls that are large enough', async () => {
  const page = await open(browser, program.url, { viewport: { width: 390, height: 844 }, hasTouch: true, isMobile: true });
  await page.locator('[data-axis=feeder] [data-live=true]').waitFor();
  const small = await page.evaluate(() => [...document.querySelectorAll('.tile button')].map((b) => [b.getAttribute('aria-label'), b.getBoundingClientRect().height]).filter(([, h]) => h < 40));
  assert.deepEqual(small, []);
  await page.context().close();
});

test('a refusal is shown to its end, on a tile and on the page of the axis', async () => {
  const page = await open(browser, program.url);
  const detail = `held by http olga 127.0.0.1 page-abc123 ${'for a reason that takes some words to tell '.repeat(4)}to its end`;
  await page.route('**/axes/feeder/commands', (r) => r.fulfill({ status: 409, contentType: 'application/problem+json', body: JSON.stringify({ type: 'about:blank', title: 'x', status: 409, detail, reason: 'held' }) }));
  for (const [path, button] of [['/', 'Enable feeder'], ['/axes/feeder', 'Enable']]) {
    await page.goto(program.url + path);
    await page.locator('[data-live=true]').first().waitFor();
    await page.getByRole('button', { name: button, exact: true }).click();
    const words = page.locator('.result-refused span').first();
    await words.waitFor();
    // Nothing grows, so that no button moves: the beginning is seen, and the rest is scrolled to, by keyboard, too.
    const box = path === '/' ? '.tile-foot' : '.axis-state .result';
    const begins = await words.evaluate((e, b) => e.getBoundingClientRect().top >= e.closest(b).getBoundingClientRect().top - 1, box);
    assert.ok(begins, `${path}: its first line is not seen`);
    await page.locator(box).first().focus();
    await page.keyboard.press('End');
    await becomes(`${path}: its last line is seen`, () => words.evaluate((e, b) => {
      const r = e.getBoundingClientRect();
      return e.scrollHeight <= e.clientHeight + 1 && r.bottom <= e.closest(b).getBoundingClientRect().bottom + 1;
    }, box), true);
  }
  await page.context().close();
});

test('nothing jumps while values, states and the connection change', async () => {
  const page = await open(browser, program.url);
  for (const axis of ['feeder', 'slide.x']) await page.locator(`[data-axis="${axis}"] [data-live=true]`).waitFor();
  const places = () => page.evaluate(() => [...document.querySelectorAll('.tile button, .tile input, .head button')].map((e) => {
    const r = e.getBoundingClientRect();
    return [e.getAttribute('aria-label') ?? e.textContent, Math.round(r.x), Math.round(r.y), Math.round(r.width), Math.round(r.height)].join(' ');
  }).filter((t) => !/theme/.test(t)));
  const before = await places();
  await program.command('feeder', { command: 'enable' });
  await program.command('feeder', { command: 'move_relative', position: -120, velocity: 80 });
  const feeder = tileOf(page, 'feeder');
  await until('it moves', async () => /Moving/.test(await feeder.text('motion')));
  assert.deepEqual(await places(), before);
  await page.getByRole('button', { name: 'Stop feeder' }).click();
  await until('the answer is there', async () => /accepted/.test(await feeder.result()));
  await page.getByRole('button', { name: 'Move to target of feeder' }).click();
  await until('the refusal is there', async () => (await feeder.result()).length > 10);
  assert.deepEqual(await places(), before);
  page.expectLoss(true);
  await program.stop('SIGKILL');
  try {
    await page.locator('[data-condition=disconnected]').first().waitFor();
    assert.deepEqual(await places(), before);
    await page.context().close();
  } finally {
    await program.run();
  }
});

test('the theme can be chosen and is kept', async () => {
  const page = await open(browser, program.url, { colorScheme: 'light' });
  await settled(page);
  const ground = () => page.evaluate(() => getComputedStyle(document.body).backgroundColor);
  const light = await ground();
  await page.getByRole('button', { name: 'Dark theme' }).click();
  await until('it is another', async () => (await ground()) !== light);
  const dark = await ground();
  await page.reload();
  await settled(page);
  await becomes('it is kept', ground, dark);
  await page.getByRole('button', { name: 'Light theme' }).click();
  await becomes('it is the first one again', ground, light);
  await page.context().close();
});
