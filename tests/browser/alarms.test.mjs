// Alarms on the page: a fault made by the hand shows everywhere, is acknowledged, shelved, taken back; events are filtered and saved.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { after, before, test } from 'node:test';
import { becomes, launch, look, open, until, visits } from './lib/browser.mjs';
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

const alarms = async () => (await program.call('GET', '/alarms')).body;
const driveOf = (axis) => axis.split('.')[0];
async function breakAxis(axis) {
  await program.command(axis, { command: 'enable' });
  await program.call('POST', `/axes/${axis}/commands`, { command: 'move_velocity', velocity: 1, acceleration: 20 });
  await program.call('PATCH', `/drives/${driveOf(axis)}/hand`, { stall: true });
  await until('fault', async () => (await program.axis(axis)).fault);
}
async function mendAxis(axis) {
  await program.call('PATCH', `/drives/${driveOf(axis)}/hand`, { stall: false });
  await program.command(axis, { command: 'reset_fault' });
  await until('no fault', async () => !(await program.axis(axis)).fault);
}

test('a fault shows at the top of the overview with the way to it; all is well: nothing is shown', async () => {
  const page = await open(browser, `${program.url}/`);
  await page.locator('[data-axis]').first().waitFor();
  await becomes('nothing is wrong', () => page.locator('[data-field=wrong]').count(), 0);
  await becomes('no alarm is counted', () => page.locator('[data-field=alarm-badge]').count(), 0);
  await breakAxis('feeder');
  await page.locator('[data-wrong="axis feeder"]').waitFor();
  const says = (selector, words) => until(`${selector} says ${words}`, async () => words.test(await page.locator(selector).innerText()) || (await page.locator(selector).innerText()));
  await says('[data-wrong="axis feeder"]', /Fault/);
  await page.locator('[data-wrong=alarms]').waitFor();
  await says('[data-field=alarm-badge]', /^[12]\s/);
  await page.locator('[data-wrong="axis feeder"]').click();
  await page.getByRole('heading', { level: 1, name: 'feeder' }).waitFor();
  assert.deepEqual(page.faults(), []);
  await page.context().close();
});

test('light and dark, two widths: pictures for people, nothing serious for axe-core, nothing wider than the screen', async () => {
  for (const { device } of visits) {
    const page = await open(browser, `${program.url}/events`, { ...device, bypassCSP: true });
    await page.locator('[data-alarm]').first().waitFor();
    await page.getByRole('button', { name: /^Shelve feeder/ }).first().click();
    await page.getByLabel('Reason').waitFor();
    assert.deepEqual(await look(page, 'alarms', {}), []);
    await page.goto(`${program.url}/`);
    await page.locator('[data-field=wrong]').waitFor();
    assert.deepEqual(await look(page, 'wrong', {}), []);
    assert.deepEqual(page.faults(), []);
    await page.context().close();
  }
});

test('an alarm says what to do, and leads to its axis, its frames, its trends and its recording', async () => {
  const page = await open(browser, `${program.url}/events`);
  const row = page.locator('[data-alarm]').filter({ has: page.locator('[data-field=error-help]') }).first();
  await row.waitFor();
  assert.match(await row.locator('[data-field=error-help]').innerText(), /What to do: \w+[\s\S]*Cause: \w+/);
  const recording = row.getByRole('link', { name: /^Recording of it/ });
  await recording.waitFor(); // two seconds after the fault
  await recording.click();
  await page.locator('[data-field=playback]').getByRole('slider').waitFor();
  await page.goBack();
  await row.getByRole('link', { name: /^Trends then/ }).click();
  await page.getByRole('heading', { level: 1, name: /^Recorder/ }).waitFor();
  await page.goBack();
  await row.getByRole('link', { name: /^Frames then/ }).click();
  await page.locator('[data-field=frames-then]').waitFor(); // the line may have forgotten them by now
  await page.goto(`${program.url}/lines/can0/${Date.now() - 1000}`);
  await page.locator('[data-field=frames-then]').getByText(/^Held: the frames/).waitFor();
  assert.ok((await page.locator('.frame-row').count()) > 0);
  await page.goto(`${program.url}/axes/feeder`);
  await page.locator('[data-field=error-help]').first().waitFor();
  await page.goto(`${program.url}/lines/can0/1000`);
  await page.locator('[data-field=frames-then]').getByText(/remembers no frames/).waitFor();
  assert.deepEqual(page.faults(), []);
  await page.context().close();
});

test('an alarm is shelved with a reason, taken back, acknowledged, and leaves when it is cleared', async () => {
  const page = await open(browser, `${program.url}/events`);
  const row = page.locator('[data-alarm][data-state=unacknowledged_active]').first();
  await row.waitFor();
  const id = await row.getAttribute('data-alarm');
  const same = page.locator(`[data-alarm="${id}"]`);
  await same.getByRole('button', { name: /^Shelve/ }).click();
  await page.getByRole('button', { name: 'Put on the shelf' }).click();
  await page.getByText('Say why it may be silent').waitFor();
  await page.getByLabel('Reason').fill('sensor is being replaced');
  await page.getByLabel('For', { exact: true }).selectOption('600');
  await page.getByRole('button', { name: 'Put on the shelf' }).click();
  await page.locator(`[data-alarm="${id}"][data-state=shelved]`).waitFor();
  assert.match(await same.innerText(), /Shelved[\s\S]*sensor is being replaced/);
  await same.getByRole('button', { name: /^Unshelve/ }).click();
  await page.locator(`[data-alarm="${id}"][data-state=unacknowledged_active]`).waitFor();
  await page.getByLabel('Comment for the acknowledgement').fill('guard was open');
  await same.getByRole('button', { name: /^Acknowledge/ }).click();
  await page.locator(`[data-alarm="${id}"][data-state=acknowledged_active]`).waitFor();
  assert.match(await same.innerText(), /Active, acknowledged[\s\S]*guard was open/);
  await mendAxis('feeder');
  await same.waitFor({ state: 'detached' });
  await breakAxis('slide.x');
  await page.locator('[data-alarm][data-state=unacknowledged_active]', { hasText: 'slide.x' }).first().waitFor(); // the page has heard of it
  await page.getByRole('button', { name: 'Acknowledge all shown' }).click();
  await page.locator('[data-field=alarm-badge]').waitFor({ state: 'detached' });
  await becomes('none waits', async () => (await alarms()).unacknowledged, 0);
  await mendAxis('slide.x');
  await page.getByText('No alarm. Everything that was is acknowledged.').waitFor();
  assert.deepEqual(page.faults(), []);
  await page.context().close();
});

test('events are filtered by kind, axis and text, and saved as shown', async () => {
  const page = await open(browser, `${program.url}/events`);
  await page.locator('[data-severity]').first().waitFor();
  await page.getByRole('combobox', { name: 'Kind' }).selectOption('fault');
  await page.getByRole('combobox', { name: 'Axis' }).selectOption('slide.x');
  await page.getByRole('heading', { name: /Events: 1 shown/ }).waitFor();
  await page.getByLabel('Text in the event').fill('no such text');
  await page.getByRole('heading', { name: /Events: 0 shown/ }).waitFor();
  await page.getByLabel('Text in the event').fill('');
  for (const [name, first] of [['Save 1 as CSV', /^id,at,severity/], ['Save 1 as text', /alarm +fault +slide\.x/]]) {
    const [file] = await Promise.all([page.waitForEvent('download'), page.getByRole('button', { name }).click()]);
    const text = readFileSync(await file.path(), 'utf8');
    assert.match(text, first);
    assert.ok(!text.includes('feeder'), 'only what was asked for');
    assert.equal(text.trim().split('\n').length - (/CSV/.test(name) ? 1 : 0), 1, 'as many as are shown');
  }
  assert.deepEqual(page.faults(), []);
  await page.context().close();
});

test('an order of a move stands in the list in the unit of its axis, beside its increments', async () => {
  await program.command('feeder', { command: 'enable' });
  await until('it is enabled', async () => (await program.axis('feeder')).state === 'operation_enabled');
  assert.equal((await program.command('feeder', { command: 'move_relative', position: 5, velocity: 50 })).status, 200);
  const page = await open(browser, `${program.url}/events`);
  await page.locator('.event', { hasText: /move by 5\.000 mm \(16\s000 increments\)/ }).first().waitFor();
  await page.context().close();
});
