// Fail-safe on the page: what is chosen is in force, and the rehearsal writes a report of every cell.
// In: the program. Out: pictures under build/browser.
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { becomes, examine, launch, open, shot, until } from './lib/browser.mjs';
import { Program } from './lib/program.mjs';

let program, browser, page;
const section = () => page.getByRole('region', { name: 'When who commands is lost' });

before(async () => {
  program = await Program.start();
  browser = await launch();
  page = await open(browser, `${program.url}/site`, { bypassCSP: true });
  await section().waitFor();
});
after(async () => {
  await browser?.close();
  await program?.end();
});

test('an action is chosen for a cause, in plain words, and the gateway has it', async () => {
  const card = section().locator('[data-fail-safe="feeder"]');
  await until('the default is said', async () => /all as by default/.test(await card.innerText()) || (await card.innerText()));
  await card.locator('summary').click();
  await card.getByLabel('Modbus connection closed').selectOption({ label: 'Quick stop' });
  await becomes('it is in force', async () => (await program.call('GET', '/fail_safe/feeder')).body.fail_safe.modbus_closed, 'quick_stop');
  await until('the card says it', async () => /Modbus connection closed: quick stop/.test(await card.locator('summary').innerText()) || (await card.innerText()));
  await card.getByLabel('Modbus connection closed').selectOption('');
  await becomes('the default is back', async () => (await program.call('GET', '/fail_safe/feeder')).body.fail_safe.modbus_closed, null);
});

test('the rehearsal plays on models, and its report has a figure in every cell', async () => {
  const before = (await program.call('GET', '/axes/feeder')).body.position;
  await section().getByRole('button', { name: 'Rehearse on models' }).click();
  await until('it has ended', async () => (await page.locator('[data-field="rehearsal-report"]').count()) === 1, 60_000);
  const rows = section().getByRole('region', { name: 'Report of the rehearsal' }).locator('tbody tr');
  const { body } = await program.call('GET', '/fail_safe/rehearsal');
  await becomes('each cell is a row', () => rows.count(), body.report.cells.length);
  assert.ok(body.report.cells.length >= 9 && body.report.without_figures === 0);
  assert.match(await page.locator('[data-field="rehearsal-report"]').innerText(), /^Rehearsed \d\d:\d\d:\d\d by .*\d+ cells\./);
  assert.equal((await program.call('GET', '/axes/feeder')).body.position, before, 'nothing has moved');
  await section().getByRole('button', { name: 'Rehearse on models' }).scrollIntoViewIfNeeded();
  await shot(page, 'fail-safe');
  assert.deepEqual(await examine(page), []);
  assert.deepEqual(page.faults(), []);
});
