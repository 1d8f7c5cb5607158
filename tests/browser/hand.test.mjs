// The hand of a drive with two axes, on the page of each: what is taken in hand there is that axis and no other. And the mark of what is simulated,
// wherever an axis is named. In: the program with a control of two axes. Out: counts; pictures under build/browser.
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { becomes, launch, open, pictures, shot, until } from './lib/browser.mjs';
import { isMock, Program } from './lib/program.mjs';

const site = {
  lines: [{ name: 'can0', uri: 'twin', family: 'uim342', bitrate: 1000000 }, { name: 'bench', uri: 'twin', family: 'pacontrol' }],
  drives: [{ name: 'feeder', line: 'can0', address: 5, presence: 'auto' }, { name: 'gantry', line: 'bench', presence: 'twin', options: { axes: '2' } }],
  axes: [
    { name: 'feeder', drive: 'feeder', number: 1, unit: 'mm', increments_per_unit: 3200 },
    { name: 'gantry-x', drive: 'gantry', channel: 1, number: 2, unit: 'mm', increments_per_unit: 1000 },
    { name: 'gantry-y', drive: 'gantry', channel: 2, number: 3, unit: 'mm', increments_per_unit: 1000 },
  ],
  mappings: [{ id: 'place', unit: 2, table: 'holding_registers', address: 0, axis: 'feeder', point: 'position', type: 'i32', word_order: 'high_first', scale: 1, offset: 0, access: 'R' }],
};
let program, browser, page;
const hand = async () => (await program.call('GET', '/drives/gantry/hand')).body;
const group = (name) => page.locator(`[data-hand-group="${name}"]`);

before(async () => {
  program = await Program.start({ site });
  browser = await launch();
  page = await open(browser, `${program.url}/axes/gantry-y/simulation`);
  await group('gantry-y').waitFor();
});
after(async () => {
  await browser?.close();
  await program?.end();
});

test('what is taken in hand on the page of the second axis is the second axis', async () => {
  await group('gantry-y').getByRole('switch', { name: 'Limit positive' }).click();
  await becomes('the second axis has it, the first has not', async () => [(await hand())['axis2.limit_positive'], (await hand()).limit_positive], [true, false]);
  await page.getByText('gantry-y: Limit positive: set to on').waitFor();
  await group('gantry-y').getByRole('switch', { name: 'Limit positive' }).click();
  await becomes('it is taken back', async () => (await hand())['axis2.limit_positive'], false);
  assert.equal(await page.getByRole('switch', { name: 'Stall', exact: true }).count(), 1, 'no second one of the same name is in sight');
  await group('The whole drive').getByRole('switch', { name: 'Power', exact: true }).waitFor();
});

test('the other axis is folded under its name; its position is told in its unit as well', async () => {
  const other = group('gantry-x');
  const stall = other.getByRole('switch', { name: 'Stall, gantry-x' });
  assert.equal(await stall.isVisible(), false);
  await other.locator('summary').first().focus();
  await page.keyboard.press('Enter');
  await stall.click();
  await becomes('the first axis has it', async () => [(await hand()).stall, (await hand())['axis2.stall']], [true, false]);
  await stall.click();
  const position = group('gantry-y').getByRole('textbox', { name: 'Position', exact: true });
  await position.fill('12500');
  await group('gantry-y').locator('[data-field=hand-unit]').getByText('= 12.500 mm').waitFor();
  await position.fill('0');
  await shot(page, 'hand-of-two-axes', { fullPage: true });
});

test('the page of the line has each axis under its own name', async () => {
  await page.goto(`${program.url}/lines/bench`);
  for (const name of ['gantry-x', 'gantry-y', 'The whole drive']) await group(name).waitFor();
  await group('gantry-x').getByRole('switch', { name: 'Stall, gantry-x' }).waitFor();
});

test('wherever a simulated axis is named, that it is simulated stands beside it', async () => {
  const sim = (where) => page.locator(`${where} [data-field=sim]`).first();
  for (const [path, where] of [
    ['/site', '[data-entry="axes/feeder"]'],
    ['/site', '[data-entry="drives/gantry"]'],
    ['/mappings', '[data-mapping=place]'],
    ['/lines', '[data-drive=gantry]'],
  ]) {
    await page.goto(program.url + path);
    await sim(where).waitFor();
    assert.equal(await sim(where).getAttribute('aria-label'), 'simulated');
  }
  await program.command('feeder', { command: 'enable' });
  await page.goto(`${program.url}/axes/feeder`);
  if (!isMock) await page.locator('[data-field=last-commander]').getByText('last commanded by 127.0.0.1 (http)').waitFor();
  await page.goto(`${program.url}/events`);
  await sim('.event').waitFor();
  await page.goto(`${program.url}/mappings`);
  await page.getByRole('button', { name: 'What the HMI sees' }).click();
  await page.getByRole('button', { name: 'Look', exact: true }).click();
  await sim('.hmi-map [data-block="hmi/2"]').waitFor();
  if (!isMock) assert.match(await page.locator('.hmi-map [data-block="hmi/2"]').innerText(), /increments/);
  await page.getByLabel('Count', { exact: true }).fill('0');
  await page.locator('[data-field=hmi-former]').waitFor();
  await page.getByRole('button', { name: 'Look', exact: true }).click();
  await becomes('no answer stands below fields that it does not belong to', () => page.locator('.hmi-map').count(), 0);
  await page.getByLabel('Count', { exact: true }).fill('16');
  await page.emulateMedia({ media: 'print' });
  await until('it is printed', async () => /feeder \(simulated\)/.test(await page.locator('[data-field=printed]').innerText()));
  await page.emulateMedia({ media: 'screen' });
  await program.call('PUT', '/recipes/go', { steps: [{ enable: { axis: 'feeder' } }] });
  await page.goto(`${program.url}/recipes/go`);
  await sim('[data-step="/steps/0"]').waitFor();
  await page.getByRole('button', { name: 'Run', exact: true }).click();
  await sim('[data-report="/steps/0"]').waitFor();
  assert.deepEqual(page.faults(), []);
});

test('axe-core finds nothing serious, nothing scrolls sideways, pictures', async () => {
  await pictures(browser, program.url, '/axes/gantry-y/simulation', 'hand', async (p) => {
    await p.locator('[data-hand-group="gantry-y"]').waitFor();
    await p.locator('[data-hand-group="gantry-x"] summary').first().click();
    await p.evaluate(() => scrollTo(0, 0)); // nothing behind the head that stays
  });
});
