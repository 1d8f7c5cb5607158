// Profiles on the page: a unit speaks another device's language, its registers are listed, and it is taken away after a question.
// In: the program. Out: pictures under build/browser.
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { becomes, examine, launch, open, shot, until } from './lib/browser.mjs';
import { Program } from './lib/program.mjs';

let program, browser, page;
const section = () => page.getByRole('region', { name: "Profiles: another device's registers" });
const told = () => page.locator('[data-field="profile-told"]').innerText();

before(async () => {
  program = await Program.start();
  browser = await launch();
  page = await open(browser, `${program.url}/mappings`, { bypassCSP: true });
  await section().waitFor();
});
after(async () => {
  await browser?.close();
  await program?.end();
});

test('a profile is added by its form, and a Modbus client sees the language', async () => {
  const form = section().getByRole('form', { name: 'Add a profile' });
  await form.getByLabel('Unit ID').fill('1');
  await form.getByRole('button', { name: 'Add the profile' }).click();
  await until('faults stand at their fields', async () => /whole number from 2 to 254[\s\S]*Choose an axis/.test(await form.innerText()) || (await form.innerText()));
  await form.getByLabel('Unit ID').fill('30');
  await form.getByLabel('Speaks').selectOption({ label: 'Lexium MCode' });
  await form.getByLabel('Axis', { exact: true }).selectOption('feeder');
  await form.getByLabel('Full speed').fill('20');
  await form.getByRole('button', { name: 'Add the profile' }).click();
  await becomes('it is told', told, 'Unit 30 speaks Lexium MCode now.');
  const { body } = await program.call('GET', '/registers?unit=30&table=holding_registers&address=28&count=1');
  assert.deepEqual(body.words, [0], 'DE: the axis has no power');
});

test('its registers are listed as the manual names them, in the addresses of the page', async () => {
  await section().getByText('Unit 30:').click();
  const row = section().getByRole('row', { name: /MA/ }).first();
  await until('MA stands at 67, 68', async () => /67, 68[\s\S]*moves to this position/.test(await row.innerText()) || (await row.innerText()));
  await shot(page, 'profiles');
  assert.deepEqual(await examine(page), []);
});

test('eight axes stand behind one PA-CONTROL: a further field for each that is chosen', async () => {
  const form = section().getByRole('form', { name: 'Add a profile' });
  await form.getByLabel('Speaks').selectOption({ label: 'PA-CONTROL' });
  await form.getByLabel('Axis 1').selectOption('feeder');
  await form.getByLabel('Axis 2').selectOption('slide.x');
  await form.getByLabel('Axis 3').waitFor();
  await form.getByLabel('Unit ID').fill('30');
  await form.getByRole('button', { name: 'Add the profile' }).click();
  await until('the unit is taken', async () => /Unit 30 has the profile Lexium MCode/.test(await form.innerText()) || (await form.innerText()));
  await form.getByLabel('Unit ID').fill('31');
  await form.getByRole('button', { name: 'Add the profile' }).click();
  await becomes('it is told', told, 'Unit 31 speaks PA-CONTROL now.');
});

test('a profile goes after a question', async () => {
  const card = section().locator('[data-profile="30"]');
  await card.getByRole('button', { name: 'Take it away' }).click();
  await page.locator('[data-field="profile-ask"]').getByRole('button', { name: 'Take it away' }).click();
  await becomes('it is told', told, 'Unit 30 has no profile now.');
  await card.waitFor({ state: 'detached' });
  assert.deepEqual(page.faults(), []);
});
