// The page of mappings: entries by form, conflicts while typing, a spreadsheet's table, changes undone, what an HMI sees, the list for paper. What is done on
// the map by mouse and keys is in register-map.test.mjs.
// In: the program. Out: counts; pictures under build/browser.
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { becomes, launch, open, shot, until } from './lib/browser.mjs';
import { Program } from './lib/program.mjs';

let program, browser, page;
before(async () => {
  program = await Program.start();
  browser = await launch();
  page = await open(browser, `${program.url}/mappings`);
  await page.getByText('Nothing is mapped yet').waitFor();
});
after(async () => {
  await browser?.close();
  await program?.end();
});
const all = async () => (await program.call('GET', '/mappings')).body;
const form = () => page.getByRole('form', { name: 'Add a mapping' });
const told = (field) => page.locator(`[data-field="${field}"]`).innerText();
const place = (m) => `${m.address} ${m.point} ${m.type}`;

test('an entry is added by keyboard, and its value is live', async () => {
  await form().getByLabel('Axis').selectOption('feeder');
  await form().getByLabel('Point or parameter').fill('position_units');
  await becomes('the type is the point’s own', () => form().getByLabel('Type').inputValue(), 'f32');
  await form().getByLabel('Address').fill('0');
  await page.keyboard.press('Enter');
  await until('it is told', async () => /^Added position_units of feeder/.test(await told('mapping-told')) || (await told('mapping-told')));
  assert.deepEqual((await all()).map(place), ['0 position_units f32']);
  const cell = page.locator('[data-mapping] [data-field=value]').first();
  await until('it is live', async () => (await cell.getAttribute('data-live')) === 'true');
  await program.command('feeder', { command: 'enable' });
  await program.command('feeder', { command: 'move_absolute', position: 2, velocity: 50 });
  await until('it follows', async () => Math.abs(Number((await cell.locator('.mono').innerText()).replace('\u2212', '-')) - 2) < 0.01 || (await cell.innerText()));
});

test('a conflict is named while typing, nothing is sent, and the next free place is offered', async () => {
  await form().getByLabel('Point or parameter').fill('velocity');
  await form().getByLabel('Address').fill('1');
  await form().getByText(/^Taken by .*position_units of feeder, 0–1/).waitFor();
  assert.equal(await form().getByLabel('Address').getAttribute('aria-invalid'), 'true');
  await form().getByLabel('Address').press('Enter');
  assert.equal((await all()).length, 1);
  await form().getByRole('button', { name: 'Next free place: 2' }).click();
  await becomes('it is taken', () => form().getByLabel('Address').inputValue(), '2');
  await form().getByLabel('Address').fill('6');
  await form().getByText('4 places free after').waitFor();
  await becomes('the type follows the point', () => form().getByLabel('Type').inputValue(), 'i32');
  await form().getByLabel('Type').selectOption('u32');
  await form().getByLabel('Point or parameter').fill('statusword');
  await form().getByText('the point’s own type is u16').waitFor();
  assert.equal(await form().getByLabel('Type').inputValue(), 'u32', 'what was set by hand stays');
  await form().getByLabel('Point or parameter').fill('velocity');
  await form().getByLabel('Type').selectOption('i32');
  await form().getByRole('button', { name: 'Add', exact: true }).click();
  await until('it is there', async () => (await all()).length === 2);
  await page.locator('[data-place="2"]').getByText('free').waitFor({ state: 'attached' });
  await page.locator('[data-place="2"]').click();
  await becomes('a free place is in the form by a press', () => form().getByLabel('Address').inputValue(), '2');
});

test('a wrong field says so, and what was typed stays', async () => {
  await form().getByLabel('Unit').fill('1');
  await form().getByText('The modbus unit is a whole number from 2 to 254.', { exact: false }).or(form().getByText('from 2 to 254')).first().waitFor();
  await form().getByRole('button', { name: 'Add', exact: true }).click();
  assert.equal(await form().getByLabel('Unit').inputValue(), '1');
  await form().getByLabel('Unit').fill('2');
});

test('an entry is changed; a change of somebody else is shown first, and what was typed stays', async () => {
  const [m] = await all();
  await page.locator(`[data-mapping="${m.id}"]`).click();
  const edit = page.getByRole('form', { name: `Change mapping ${m.id}` });
  await edit.getByLabel('Scale').fill('0.5');
  const { id, ...rest } = m;
  await program.call('PUT', `/mappings/${id}`, { ...rest, offset: 3 });
  await edit.getByRole('button', { name: 'Save', exact: true }).click();
  await until('the difference is shown', async () => /offset 0 → 3/.test(await told('mapping-told')) || (await told('mapping-told')));
  assert.equal(await edit.getByLabel('Scale').inputValue(), '0.5');
  assert.equal((await all())[0].scale, 1);
  await edit.getByRole('button', { name: 'Save mine all the same' }).click();
  await until('it is changed', async () => (await all())[0].scale === 0.5);
});

test('a removal is undone, by the keyboard too', async () => {
  const before = await all();
  await page.locator(`[data-mapping="${before[1].id}"]`).click();
  await page.getByRole('button', { name: `Remove ${before[1].id}` }).click();
  await until('it is gone', async () => (await all()).length === 1);
  await page.getByRole('button', { name: `Undo: removed ${before[1].id}`, exact: true }).waitFor(); // the page has heard of it, too
  await page.locator('main h1').focus();
  await page.keyboard.press('Control+z');
  await until('it is back', async () => (await all()).length === 2);
  assert.deepEqual((await all()).map(place).sort(), before.map(place).sort());
});

test('a table from a spreadsheet is checked row by row, tried, taken as one, and undone as one', async () => {
  await page.getByRole('button', { name: 'Paste or import' }).click();
  const box = page.getByLabel('Table of mappings');
  await box.fill('unit\taddress\taxis\tpoint\ttype\n2\t20\tfeeder\tposition\ti32\n2\t21\tfeeder\tvelocity\ti32\n2\t0\tslide.x\tnonsense_type\tq');
  await until('both faults are counted', async () => /2 of 3 rows/.test(await told('table-count')) || (await told('table-count')));
  assert.match(await page.locator('[data-line="3"]').innerText(), /taken by line 2/);
  assert.match(await page.locator('[data-line="4"]').innerText(), /no type/);
  assert.equal(await page.getByRole('button', { name: 'Check with the gateway' }).isDisabled(), true);
  await box.fill('unit\taddress\taxis\tpoint\ttype\n2\t20\tfeeder\tposition\ti32\n2\t22\tslide.x\tvelocity\ti32');
  const count = (await all()).length;
  await page.getByRole('button', { name: 'Check with the gateway' }).click();
  await until('the gateway would take it', async () => /would take 2 rows/.test(await told('table-told')) || (await told('table-told')));
  assert.equal((await all()).length, count);
  await page.getByRole('button', { name: 'Add 2 rows' }).click();
  await until('they are there', async () => (await all()).length === count + 2);
  await until('the field is empty again', async () => (await box.inputValue()) === '');
  await page.getByRole('button', { name: 'Close', exact: true }).click();
  await page.getByRole('button', { name: /^Undo/ }).first().click();
  await until('both are gone', async () => (await all()).length === count);
});

test('a template is looked at first, added as a block at the next free place, and undone as one', async () => {
  await page.getByRole('button', { name: 'Add a template' }).click();
  const f = page.getByRole('form', { name: 'Template' });
  const before = await all();
  await becomes('the page has heard of what was undone', () => page.locator('[data-mapping]').count(), before.length);
  await f.getByRole('button', { name: 'Add the block' }).click();
  await until('an axis is asked for', async () => /Choose an axis/.test(await told('template-told')) || (await told('template-told')));
  await f.getByLabel('Axis').selectOption('slide.x');
  await f.getByLabel('Unit').fill('1');
  await f.getByText('A whole number from 2 to 254.').waitFor();
  assert.equal(await f.getByLabel('Unit').getAttribute('aria-invalid'), 'true');
  await f.getByLabel('Unit').fill('2');
  const free = Number(/(\d+)/.exec(await f.getByLabel('Address').getAttribute('placeholder'))[1]);
  assert.ok(before.every((m) => m.unit !== 2 || m.address < free), 'the block begins behind what is there');
  await f.getByRole('button', { name: 'Show what it adds' }).click();
  await until('it is shown', async () => /mappings at .* of unit 2\. Nothing has been changed/.test(await told('template-told')) || (await told('template-told')));
  const list = f.getByRole('list', { name: 'What would be added' });
  const shown = await list.locator('li').count();
  assert.match(await list.locator('li').first().innerText(), new RegExp(`^${free}: statusword of slide.x, u16, read`));
  assert.ok(shown > 10, `${shown} are shown`);
  assert.equal((await all()).length, before.length);
  // What is typed while the answer is on its way is meant for the next block, and stays.
  let answer;
  const late = new Promise((resolve) => (answer = resolve));
  await page.route('**/mappings/template', async (r) => {
    const response = await r.fetch();
    await late;
    await r.fulfill({ response });
  });
  await f.getByLabel('Axis').focus();
  await f.getByLabel('Address').press('Enter');
  await until('it is there', async () => (await all()).length === before.length + shown || [(await all()).length, shown, await told('template-told')]);
  const block = (await all()).filter((m) => !before.some((b) => b.id === m.id));
  assert.ok(block.every((m) => m.axis === 'slide.x' && m.address >= free && m.address < free + 64));
  assert.equal(Math.min(...block.map((m) => m.address)), free, JSON.stringify(block.slice(0, 3)));
  await f.getByLabel('Address').fill(String(free));
  await f.getByLabel('Axis').selectOption('feeder');
  answer();
  await until('the answer is told', async () => /^Added the standard map of slide\.x/.test(await told('template-told')) || (await told('template-told')));
  await page.unroute('**/mappings/template');
  assert.equal(await f.getByLabel('Address').inputValue(), String(free));
  await f.getByRole('button', { name: 'Add the block' }).click();
  await until('a taken place is refused', async () => /taken|conflict|overlap|mapping/i.test(await told('template-told')) || (await told('template-told')));
  assert.equal((await all()).length, before.length + shown);
  await f.getByLabel('Address').fill('');
  await page.getByRole('button', { name: 'Close', exact: true }).click();
  await page.getByRole('button', { name: /^Undo: added the standard map/ }).click();
  await until('it is gone as one', async () => (await all()).length === before.length || (await all()).length);
});

test('a row with a parameter that the axis does not have is marked in its line', async () => {
  await page.getByRole('button', { name: 'Paste or import' }).click();
  await page.getByLabel('Table of mappings').fill('unit\taddress\taxis\tpoint\ttype\n2\t40\tslide.x\tno_such_parameter\ti32');
  const verdict = page.locator('[data-line="2"]');
  await until('it is judged', async () => /slide\.x has neither a point nor a parameter no_such_parameter/.test(await verdict.innerText()) || (await verdict.innerText()));
  await becomes('it is not sent', () => page.getByRole('button', { name: 'Check with the gateway' }).isDisabled(), true);
  await page.getByLabel('Table of mappings').fill('');
  await page.getByRole('button', { name: 'Close', exact: true }).click();
});

test('the export is what the gateway has', async () => {
  const [download] = await Promise.all([page.waitForEvent('download'), page.getByRole('link', { name: 'Export CSV' }).click()]);
  assert.equal(download.suggestedFilename(), 'mappings.csv');
});

test('what an HMI sees: words, meaning, and an exception where nothing is', async () => {
  await page.getByRole('button', { name: 'What the HMI sees' }).click();
  const hmi = page.getByRole('form', { name: 'Read registers' });
  await hmi.getByLabel('Unit').fill('2');
  await hmi.getByLabel('Address').fill('0');
  await hmi.getByLabel('Count').fill('2');
  await hmi.getByRole('button', { name: 'Look' }).click();
  await page.locator('.hmi-map [data-block="hmi/1"]').waitFor();
  assert.match(await page.locator('.hmi-map [data-block="hmi/0"]').innerText(), /^0:\s+0 [0-9A-F]{4}[\s\S]* · /);
  await hmi.getByLabel('Address').fill('5000');
  await hmi.getByRole('button', { name: 'Look' }).click();
  await until('the exception is told', async () => /exception 2/.test(await told('hmi-told')) || (await told('hmi-told')));
  await hmi.getByLabel('Count').fill('126');
  await hmi.getByText('from 1 to 125').waitFor();
  await page.getByRole('button', { name: 'Map', exact: true }).click();
});

test('lists of the gateway are linked, and each comes', async () => {
  const lists = page.locator('[data-field=lists]');
  for (const name of ['Register list, CSV', 'PLC structure']) {
    const link = lists.getByRole('link', { name });
    await link.waitFor();
    const answer = await fetch(new URL(await link.getAttribute('href'), program.url));
    assert.equal(answer.status, 200, name);
    assert.match(await answer.text(), /feeder/, name);
  }
  assert.match(await told('hash'), /[0-9A-Fa-f]{4,}/);
});

test('paper gets the list and nothing else', async () => {
  await page.emulateMedia({ media: 'print' });
  await page.locator('[data-field=printed]').waitFor();
  assert.equal(await form().isVisible(), false);
  assert.equal(await page.locator('.head').isVisible(), false);
  assert.match(await page.locator('[data-field=printed]').innerText(), /Unit 2, holding registers/);
  const units = page.locator('.printed tr').filter({ hasText: 'position_units' }).first().locator('td').nth(6);
  await becomes('each value has its unit', () => units.innerText(), 'mm');
  await shot(page, 'mappings-paper', { fullPage: true });
  await page.emulateMedia({ media: 'screen' });
  assert.deepEqual(page.faults(), []);
});
