// Assemblies on the page: a range of a unit gets an EtherNet/IP instance, its bytes are listed, it is changed, and taken away after a question.
// In: the program. Out: pictures under build/browser.
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { becomes, examine, launch, open, shot, until } from './lib/browser.mjs';
import { Program } from './lib/program.mjs';

let program, browser, page;
const section = () => page.getByRole('region', { name: 'EtherNet/IP assemblies' });
const told = () => page.locator('[data-field="assembly-told"]').innerText();
const form = (name) => section().getByRole('form', { name });

before(async () => {
  program = await Program.start();
  for (const [point, address, type] of [['controlword', 0, 'u16'], ['target_position', 1, 'i32'], ['position', 10, 'i32'], ['statusword', 12, 'u16']])
    assert.equal((await program.call('POST', '/mappings', { unit: 40, address, axis: 'feeder', point, type })).status, 201);
  browser = await launch();
  page = await open(browser, `${program.url}/mappings`, { bypassCSP: true });
  await section().waitFor();
});
after(async () => {
  await browser?.close();
  await program?.end();
});

test('an assembly is added by its form, and its bytes are listed', async () => {
  const add = form('Add an assembly');
  await add.getByLabel('Instance').fill('0');
  await add.getByRole('button', { name: 'Add the assembly' }).click();
  await until('faults stand at their fields', async () => /whole number from 1 to 65535[\s\S]*unit with mappings[\s\S]*from 1 to 250/.test(await add.innerText()) || (await add.innerText()));
  await add.getByLabel('Instance').fill('101');
  await add.getByLabel('Of unit').fill('40');
  await add.getByLabel('First register').fill('10');
  await add.getByLabel('Number of registers').fill('3');
  await add.getByRole('button', { name: 'Add the assembly' }).click();
  await until('the gateway says what holds it', async () => /taken by axis number 1/.test(await told()) || (await told()));
  await add.getByLabel('Instance').fill('300');
  await add.getByLabel('Name').fill('press');
  await add.getByRole('button', { name: 'Add the assembly' }).click();
  await becomes('it is told', told, 'Instance 300 is served now.');
  await section().getByText('Instance 300:').click();
  const row = section().getByRole('row', { name: /position/ }).first();
  await until('offsets are bytes', async () => /0 to 3[\s\S]*i32/.test(await row.innerText()) || (await row.innerText()));
  assert.match(await section().getByRole('row', { name: /statusword/ }).first().innerText(), /4 to 5/);
  await shot(page, 'assemblies');
  assert.deepEqual(await examine(page), []);
});

test('it is changed in the same form', async () => {
  await section().locator('[data-assembly="300"]').getByRole('button', { name: 'Change' }).click();
  const change = form('Change instance 300');
  await change.getByLabel('Direction').selectOption('output');
  await change.getByLabel('First register').fill('0');
  await change.getByRole('button', { name: 'Save the change' }).click();
  await becomes('it is told', told, 'Instance 300 is changed.');
  const { body } = await program.call('GET', '/assemblies/300');
  assert.deepEqual(body, { instance: 300, direction: 'output', unit: 40, table: 'holding_registers', address: 0, registers: 3, comment: 'press' });
  await form('Add an assembly').waitFor();
});

test('the instances of a profile stand among them and are changed there', async () => {
  const profile = page.getByRole('region', { name: "Profiles: another device's registers" }).getByRole('form', { name: 'Add a profile' });
  await profile.getByLabel('Unit ID').fill('50');
  await profile.getByLabel('Speaks').selectOption({ label: 'Lexium MCode' });
  await profile.getByLabel('Axis', { exact: true }).selectOption('feeder');
  await profile.getByLabel('Input assembly').fill('210');
  await profile.getByLabel('Instance of its objects').fill('1');
  await profile.getByRole('button', { name: 'Add the profile' }).click();
  await page.getByText('EtherNet/IP: input assembly 210, objects with instance 1').waitFor();
  const card = section().locator('[data-assembly="210"]');
  await card.waitFor();
  await card.locator('summary').click();
  await until('it says whose it is', async () => /comes with the profile of unit 50/.test(await card.innerText()) || (await card.innerText()));
  assert.equal(await card.getByRole('button', { name: 'Change' }).count(), 0);
});

test('a table is tried, refused with its line, taken as one, and comes out as it went in', async () => {
  const box = section().locator('[data-field="assembly-table"]');
  const said = () => page.locator('[data-field="assembly-table-told"]').innerText();
  await box.locator('summary').click();
  const field = box.getByLabel('Table of assemblies');
  await field.fill('instance;direction;unit;address;registers\n400;input;40;10;3\n401;input;40;11;2');
  assert.equal(await box.getByRole('button', { name: 'Take the table' }).isDisabled(), true, 'it is tried first');
  await box.getByRole('button', { name: 'Check with the gateway' }).click();
  await until('the line is named', async () => /cuts mapping/.test(await box.locator('[data-line="3"]').innerText().catch(() => '')) || (await said()));
  assert.match(await box.locator('[data-line="3"]').innerText(), /^Line 3: /);
  assert.equal(await box.getByRole('button', { name: 'Take the table' }).isDisabled(), true);
  await shot(page, 'assembly-table');
  await field.fill('instance;direction;unit;address;registers\n400;input;40;10;3\n401;input;40;12;1');
  await box.getByRole('button', { name: 'Check with the gateway' }).click();
  await until('the gateway would take it', async () => /would take the table: 3 of its assemblies/.test(await said()) || (await said()));
  assert.match(await box.getByRole('list', { name: 'What would change' }).innerText(), /assembly 400: not set ->/);
  assert.equal((await program.call('GET', '/assemblies/400')).status, 404, 'nothing is done yet');
  await box.getByRole('button', { name: 'Take the table' }).click();
  await until('it is taken', async () => /is taken: 3/.test(await said()) || (await said()));
  await section().locator('[data-assembly="401"]').waitFor();
  assert.equal(await field.inputValue(), '');
  const [file] = await Promise.all([page.waitForEvent('download'), box.getByRole('link', { name: 'Export CSV' }).click()]);
  assert.equal(file.suggestedFilename(), 'assemblies.csv');
  await box.locator('input[type=file]').setInputFiles(await file.path());
  await until('it is in the field', async () => /401,input,40,holding_registers,12,1/.test(await field.inputValue()) || (await field.inputValue()));
  await box.getByLabel('in place of all of its own').check();
  await box.getByRole('button', { name: 'Check with the gateway' }).click();
  await until('it is what is there', async () => /would take the table: 3/.test(await said()) || (await said()));
  assert.equal(await box.getByRole('list', { name: 'What would change' }).count(), 0);
  for (const instance of [400, 401]) await program.call('DELETE', `/assemblies/${instance}`);
});

test('an assembly goes after a question', async () => {
  const card = section().locator('[data-assembly="300"]');
  await card.getByRole('button', { name: 'Take it away' }).click();
  await page.locator('[data-field="assembly-ask"]').getByRole('button', { name: 'Take it away' }).click();
  await becomes('it is told', told, 'Instance 300 is gone.');
  await card.waitFor({ state: 'detached' });
  assert.deepEqual(page.faults(), []);
});
