// The page loads from the program alone: no console error, no other host, no inline code; every route answers; marks are in words.
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { becomes, launch, open, tileOf, until } from './lib/browser.mjs';
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

test('the overview shows each axis live, without a fault', async () => {
  const page = await open(browser, program.url);
  for (const name of ['feeder', 'slide.x']) {
    const axis = tileOf(page, name);
    await axis.tile.waitFor();
    await until(`${name} is live`, async () => (await axis.field('position').getAttribute('data-live')) === 'true');
    await becomes('it is said to be simulated', () => axis.text('mark'), 'SIMULATED');
    assert.match(await axis.text('position'), /^Position: [\u2212\d.\u202f]+ ?(mm|deg)$/);
  }
  await becomes('the connection is live', () => page.locator('[data-field=connection]').innerText(), 'Live');
  await becomes('the line is there', () => page.locator('[data-line=can0]').count(), 1);
  const says = (selector, words) => until(`${selector} says ${words}`, async () => words.test(await page.locator(selector).innerText()) || (await page.locator(selector).innerText()));
  await says('[data-line=can0]', /Up[\s\S]*Exchanges/);
  await says('[data-drive=feeder]', /Simulated/);
  assert.deepEqual(page.faults(), []);
  await page.context().close();
});

test('the content security policy is strict and the page keeps it', async () => {
  const response = await fetch(program.url);
  const policy = response.headers.get('content-security-policy') ?? '';
  assert.match(policy, /default-src 'self'/);
  assert.doesNotMatch(policy, /unsafe/);
  assert.doesNotMatch(await response.text(), /<style|\sstyle=|<script(?![^>]*\bsrc=)/i);
});

test('every page has an address of its own, with a heading and a title', async () => {
  const page = await open(browser, program.url);
  const routes = { '/lines': 'Lines and drives', '/lines/can0': 'can0', '/events': 'Events', '/gateway': 'Gateway', '/mappings': 'Mappings', '/site': 'Site', '/axes/feeder/parameters': 'Parameters of feeder', '/axes/feeder': 'feeder', '/axes/slide.x/': 'slide.x', '/nonsense': 'There is no such page' };
  for (const [path, heading] of Object.entries(routes)) {
    await page.goto(program.url + path);
    await page.getByRole('heading', { level: 1, name: heading }).waitFor();
    await until('it has a title', async () => /axisgate$/.test(await page.title()) || (await page.title()));
  }
  assert.deepEqual(page.faults(), []);
  await page.context().close();
});

test('links change the page without loading it anew, and the back button goes back', async () => {
  const page = await open(browser, program.url);
  await page.evaluate(() => (globalThis.sameDocument = true));
  await page.locator('[data-axis="slide.x"] h3 a').click();
  await page.getByRole('heading', { level: 1, name: 'slide.x' }).waitFor();
  assert.equal(new URL(page.url()).pathname, '/axes/slide.x/');
  await page.goBack();
  await page.locator('[data-axis=feeder]').waitFor();
  assert.equal(await page.evaluate(() => globalThis.sameDocument), true);
  assert.deepEqual(page.faults(), []);
  await page.context().close();
});

test('the frames of a line are shown as they cross it', async () => {
  const page = await open(browser, `${program.url}/lines/can0`);
  await page.locator('.frame-list li').first().waitFor();
  await until('there are several', async () => (await page.locator('.frame-list li').count()) > 1);
  await page.context().close();
});
