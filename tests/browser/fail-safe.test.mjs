// Fail-safe on the page: what is chosen is in force, and the rehearsal writes a report of every cell.
// In: the program. Out: pictures under build/browser.
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { becomes, examine, launch, look, open, pictures, shot, until } from './lib/browser.mjs';
import { Program } from './lib/program.mjs';

let program, browser, page;
const section = () => page.getByRole('region', { name: 'Loss of command' });

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
  assert.match(await card.locator('[data-field="drive-watchdog"]').innerText(), /no watchdog of its own\. The manual names none/);
  await card.getByLabel('Modbus connection closed').selectOption({ label: 'Quick stop' });
  await becomes('it is in force', async () => (await program.call('GET', '/fail_safe/feeder')).body.fail_safe.modbus_closed, 'quick_stop');
  await until('the card says it', async () => /Modbus connection closed: quick stop/.test(await card.locator('summary').innerText()) || (await card.innerText()));
  await card.getByLabel('Modbus connection closed').selectOption('');
  await becomes('the default is back', async () => (await program.call('GET', '/fail_safe/feeder')).body.fail_safe.modbus_closed, null);
});

test('how long a Modbus client may be silent is set, refused in words, and given back to the default', async () => {
  const card = section().locator('[data-fail-safe="feeder"]');
  if (!(await card.getByLabel('Silent after, ms').isVisible())) await card.locator('summary').click();
  const field = card.getByLabel('Silent after, ms');
  const kept = async () => (await program.call('GET', '/fail_safe/feeder')).body.fail_safe.watchdog_ms ?? null;
  await field.fill('soon');
  await card.getByText('A whole number of ms').waitFor();
  assert.equal(await card.getByRole('button', { name: 'Set' }).isDisabled(), true);
  await field.fill('800');
  await field.press('Enter');
  await becomes('it is in force', kept, 800);
  await card.getByText('In force: 800 ms').waitFor();
  await field.fill('');
  await card.getByRole('button', { name: 'Set' }).click();
  await becomes('the default is back', kept, null);
});

test('the rehearsal plays on models, and its report has a figure in every cell', async () => {
  const before = (await program.call('GET', '/axes/feeder')).body.position;
  await section().getByRole('button', { name: 'Rehearse on models' }).click();
  await until('it has ended', async () => (await page.locator('[data-field="rehearsal-report"]').count()) === 1, 60_000);
  const rows = section().getByRole('region', { name: 'Report of the rehearsal' }).locator('tbody tr');
  const { body } = await program.call('GET', '/fail_safe/rehearsal');
  await becomes('each cell is a row', () => rows.count(), body.report.cells.length);
  assert.ok(body.report.cells.length >= 9 && body.report.without_figures === 0);
  assert.match(await page.locator('[data-field="rehearsal-report"]').innerText(), /^Rehearsed \d{4}-\d\d-\d\d \d\d:\d\d:\d\d by .*\d+ cells\./);
  assert.equal((await program.call('GET', '/axes/feeder')).body.position, before, 'nothing has moved');
  await section().getByRole('button', { name: 'Rehearse on models' }).scrollIntoViewIfNeeded();
  await shot(page, 'fail-safe');
  await page.evaluate(() => scrollTo(0, 0)); // what the head lies over while one scrolls is not too small
  assert.deepEqual(await examine(page), []);
  assert.deepEqual(page.faults(), []);
});

test('the report is printed alone, with its date, and the page is whole again afterwards', async () => {
  await page.evaluate(() => (globalThis.print = () => (globalThis.printed = document.documentElement.dataset.print)));
  await section().getByRole('button', { name: 'Print the report' }).click();
  assert.equal(await page.evaluate(() => globalThis.printed), 'rehearsal');
  await page.emulateMedia({ media: 'print' });
  await section().getByRole('heading', { name: 'Fail-safe rehearsal' }).waitFor();
  assert.equal(await section().getByRole('region', { name: 'Report of the rehearsal' }).isVisible(), true);
  for (const other of ['.site-tree', '.site-history', '[data-fail-safe]', '.rehearsal > .form-foot']) {
    assert.ok((await page.locator(other).count()) > 0, `${other} is there`);
    assert.equal(await page.locator(other).first().isVisible(), false, other);
  }
  await shot(page, 'fail-safe-printed', { fullPage: true });
  await page.emulateMedia({ media: 'screen' });
  await page.evaluate(() => dispatchEvent(new Event('afterprint')));
  assert.equal(await page.evaluate(() => document.documentElement.dataset.print), undefined);
  assert.equal(await page.locator('.site-tree').isVisible(), true);
});

test('on a phone and at a desk, in light and dark, with a card open and the report below', async () => {
  await pictures(browser, program.url, '/site', 'fail-safe', async (p) => {
    await p.locator('[data-fail-safe="feeder"] summary').click();
    await p.locator('[data-field="rehearsal-report"]').waitFor();
  });
  const small = await open(browser, `${program.url}/site`, { viewport: { width: 320, height: 640 }, hasTouch: true, isMobile: true, bypassCSP: true });
  await small.locator('[data-fail-safe="feeder"] summary').click();
  await small.locator('[data-field="rehearsal-report"]').waitFor();
  assert.deepEqual(await look(small, 'fail-safe'), []);
  await small.context().close();
});
