// Descriptions of drives: files dropped and chosen, their warnings, objects and differences, a removal that is refused; the form of a drive, the wizard,
// and the values of a DCF. In: the program with CiA 402 twins, files of the family's tests. Out: counts; pictures under build/browser.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { after, before, test } from 'node:test';
import { becomes, examine, launch, open, pictures, quiet, until } from './lib/browser.mjs';
import { Program } from './lib/program.mjs';

const eds = (name) => readFileSync(new URL(`../../adapters/cia402/tests/eds/${name}`, import.meta.url), 'latin1');
const plain = eds('plain.eds');
const dcf = eds('by_tool.dcf');
/** The same with an entry that no reader can take as it stands. */
const odd = plain.replace(/DataType=0x0007/, 'DataType=0x0999');
/** More objects than a table can show at once. */
const large = `${plain}\n[ManufacturerObjects]\nSupportedObjects=2000\n${Array.from({ length: 2000 }, (_, i) => `${i + 1}=0x${(0x3000 + i).toString(16)}`).join('\n')}\n${Array.from({ length: 2000 }, (_, i) => `[${(0x3000 + i).toString(16)}]\nParameterName=Word ${i}\nObjectType=0x7\nDataType=0x0006\nAccessType=rw\nDefaultValue=${i}\nPDOMapping=0`).join('\n')}\n`;

let program, browser;
before(async () => {
  const site = {
    lines: [{ name: 'can0', uri: 'twin', family: 'cia402', bitrate: 1000000 }, { name: 'old', uri: 'twin', family: 'uim342', bitrate: 1000000 }],
    drives: [{ name: 'lift', line: 'can0', address: 20, presence: 'twin' }],
    axes: [{ name: 'lift', drive: 'lift', channel: 1, number: 1 }],
    mappings: [],
  };
  program = await Program.start({ site });
  browser = await launch();
  await store('used.dcf', dcf);
  const r = await program.call('PATCH', '/drives/lift', { description: 'used.dcf' });
  assert.equal(r.status, 200, JSON.stringify(r.body));
  await until('the drive answers', async () => (await program.axis('lift')).online === true);
});
after(async () => {
  await browser?.close();
  await program?.end();
});

async function store(name, text) {
  const r = await program.call('POST', '/descriptions', { name, text });
  assert.ok([200, 201].includes(r.status), JSON.stringify(r.body));
}
const names = async () => (await program.call('GET', '/descriptions')).body.map((d) => d.name);
/** Files that are let go over an element, as a browser tells it. */
const drop = (locator, files) =>
  locator.evaluate((e, all) => {
    const dataTransfer = new DataTransfer();
    for (const [name, text] of all) dataTransfer.items.add(new File([Uint8Array.from(text, (c) => c.charCodeAt(0))], name));
    for (const kind of ['dragover', 'drop']) e.dispatchEvent(new DragEvent(kind, { bubbles: true, cancelable: true, dataTransfer }));
  }, files);
const picked = (name, text) => ({ name, mimeType: 'application/octet-stream', buffer: Buffer.from(text, 'latin1') });
const sent = (page, file) => page.locator(`[data-sent="${file}"]`);

test('several files are dropped at once; each says how it went, and the list has those that were stored', async () => {
  const page = await open(browser, `${program.url}/descriptions`);
  await page.locator('[data-description="used.dcf"]').waitFor();
  await drop(page.locator('[data-field=drop]'), [['Maker Model.EDS', plain], ['odd.eds', odd], ['broken.eds', '[DeviceInfo]\nVendorName=x\n'], ['notes.txt', 'x']]);
  await becomes('all are judged', () => page.locator('[data-sent]').evaluateAll((l) => l.map((e) => e.dataset.tone)), ['good', 'good', 'refused', 'refused']);
  assert.match(await sent(page, 'Maker Model.EDS').innerText(), /^Maker-Model\.eds is stored/);
  assert.match(await sent(page, 'odd.eds').innerText(), /with \d+ warnings?\./);
  assert.match(await sent(page, 'broken.eds').innerText(), /is not stored: .*\S/);
  assert.match(await sent(page, 'notes.txt').innerText(), /ends with \.eds or \.dcf/);
  assert.deepEqual(await names(), ['Maker-Model.eds', 'odd.eds', 'used.dcf']);
  await becomes('the list shows them', () => page.locator('main li[data-description]').evaluateAll((l) => l.map((e) => e.dataset.description)), ['Maker-Model.eds', 'odd.eds', 'used.dcf']);
  assert.match(await page.locator('li[data-description="used.dcf"]').innerText(), /Used by drive lift\..*node 12, called lift, 500 kbit\/s/s);
  // Beside the place a file does not take the page away.
  const away = await page.evaluate(() => !document.body.dispatchEvent(new DragEvent('drop', { bubbles: true, cancelable: true, dataTransfer: new DataTransfer() })));
  assert.equal(away, true, 'the browser would open the file');
  assert.deepEqual(page.faults(), []);
  await page.context().close();
});

test('files are chosen by the keyboard; another text under a taken name is refused in words', async () => {
  const page = await open(browser, `${program.url}/descriptions`);
  const input = page.getByLabel('Choose files');
  await input.focus();
  assert.equal(await page.evaluate(() => document.activeElement.type), 'file');
  await input.setInputFiles([picked('large.eds', large), picked('odd.eds', plain)]);
  await becomes('both are judged', () => page.locator('[data-sent]').evaluateAll((l) => l.map((e) => e.dataset.tone)), ['good', 'refused']);
  assert.match(await sent(page, 'odd.eds').innerText(), /there is another description odd\.eds/);
  assert.deepEqual(page.faults(), []);
  await page.context().close();
});

test('a file shows its warnings with their lines, its users, and its objects, which are sought and filtered', async () => {
  const page = await open(browser, `${program.url}/descriptions/odd.eds/`);
  await page.getByRole('heading', { level: 1, name: 'odd.eds' }).waitFor();
  assert.match(await page.locator('[data-field=warnings]').innerText(), /line \d+: .*\S/);
  await page.locator('tr[data-object="6040h"]').waitFor();
  await page.getByLabel('Search objects by number, name or type').fill('controlword');
  await becomes('only that is shown', () => page.locator('tr[data-object]').evaluateAll((l) => l.map((e) => e.dataset.object)), ['6040h']);
  assert.match(await page.locator('[data-field=paged]').innerText(), /^1 to 1 of 1 that fit, of \d+$/);
  await page.goto(`${program.url}/descriptions/used.dcf/`);
  await becomes('its user is named', async () => /Used by drive lift\./.test(await page.locator('[data-field=description-facts]').innerText()), true);
  await page.locator('.description-objects select').selectOption('configured');
  await page.locator('tr[data-object="6083h"]', { hasText: '7000' }).waitFor();
  assert.deepEqual(page.faults(), []);
  await page.context().close();
});

test('2,000 objects are shown a hundred at a time', async () => {
  const page = await open(browser, `${program.url}/descriptions/large.eds/`);
  const rows = page.locator('tr[data-object]');
  await rows.first().waitFor();
  assert.equal(await rows.count(), 100);
  await page.getByLabel('Search objects by number, name or type').fill('word');
  const at = page.locator('[data-field=paged]');
  await until('it is searched', async () => /^1 to 100 of 2,?0\d\d/.test(await at.innerText()) || (await at.innerText()));
  await page.getByRole('button', { name: 'Next 100' }).press('Enter');
  await until('the next ones are shown', async () => /^101 to 200/.test(await at.innerText()));
  assert.equal(await rows.count(), 100);
  await page.getByRole('button', { name: 'Previous 100' }).click();
  await until('the first ones are shown', async () => /^1 to 100/.test(await at.innerText()));
  assert.deepEqual(page.faults(), []);
  await page.context().close();
});

test('two files are compared: what only one of them has, and what differs', async () => {
  const page = await open(browser, `${program.url}/descriptions/Maker-Model.eds/`);
  await page.locator('tr[data-object]').first().waitFor();
  await page.getByLabel('Compare Maker-Model.eds with').selectOption('used.dcf');
  await page.locator('[data-field=difference-count]').waitFor();
  assert.equal(new URL(page.url()).pathname, '/descriptions/Maker-Model.eds/used.dcf/');
  const table = page.getByRole('region', { name: 'Differences of Maker-Model.eds and used.dcf' });
  await table.locator('tr[data-side=both]').first().waitFor();
  assert.match(await page.locator('[data-field=difference-count]').innerText(), /\d+ objects of both files differ/);
  await page.locator('.description-difference').getByLabel('Show', { exact: true }).selectOption('both');
  await becomes('only those of both', () => table.locator('tr[data-object]:not([data-side=both])').count(), 0);
  await page.reload();
  await page.locator('[data-field=difference-count]').waitFor();
  assert.deepEqual(page.faults(), []);
  await page.context().close();
});

test('a file that a drive uses is not removed, and the drive is named; another one is, after a question', async () => {
  const page = await open(browser, `${program.url}/descriptions`);
  const remove = async (name) => {
    await page.getByRole('button', { name: `Delete ${name}` }).click();
    await page.locator('[data-field=delete]').getByRole('button', { name: 'Delete' }).click();
  };
  await remove('used.dcf');
  const told = page.locator('[data-field=description-told]');
  await until('it is refused', async () => /is named by lift/.test(await told.innerText()) || (await told.innerText()));
  await remove('odd.eds');
  await until('it is gone', async () => /odd\.eds is deleted/i.test(await told.innerText()) || (await told.innerText()));
  assert.deepEqual((await names()).includes('odd.eds'), false);
  assert.deepEqual(page.faults(), []);
  await page.context().close();
});

test('the form of a drive offers the stored files, leads to the chosen one, and says the start of the drive in words', async () => {
  const page = await open(browser, `${program.url}/site`, { bypassCSP: true });
  await page.getByRole('button', { name: 'Change drive lift' }).click();
  const form = page.getByRole('form', { name: 'Change drive lift' });
  const choice = form.getByLabel('Description', { exact: true });
  assert.equal(await choice.inputValue(), 'used.dcf');
  await becomes('all files are offered', () => choice.locator('option').evaluateAll((l) => l.map((o) => o.value)), ['', 'Maker-Model.eds', 'large.eds', 'used.dcf']);
  assert.equal(await form.getByRole('link', { name: 'Look at used.dcf' }).getAttribute('href'), '/descriptions/used.dcf/');
  await form.locator('[data-field=boot] summary').click();
  await form.locator('[data-field=options] summary').click();
  await form.getByLabel('Heartbeat ms', { exact: true }).fill('250');
  assert.match(await form.locator('[data-field=boot]').innerText(), /heartbeat each 250 ms/);
  assert.deepEqual(await examine(page), []);
  await choice.selectOption('Maker-Model.eds');
  await form.getByRole('button', { name: 'Save to draft' }).click();
  await page.locator('main', { hasText: 'drive lift: description used.dcf → Maker-Model.eds' }).waitFor();
  assert.deepEqual(page.faults(), []);
  await page.context().close();
});

test('the wizard makes a drive of a file: the line by choice, family, description and node number from the file', async () => {
  const page = await open(browser, `${program.url}/descriptions`);
  await page.getByRole('link', { name: 'Make a drive of used.dcf' }).click();
  const wizard = page.locator('.wizard');
  await wizard.getByRole('radio', { name: 'old' }).check();
  await wizard.getByRole('button', { name: 'Next' }).click();
  await wizard.locator('[data-field=of-file]', { hasText: 'node number 12' }).waitFor();
  assert.match(await wizard.locator('[data-field=of-file]').innerText(), /made for 500 kbit\/s; line old has 1000/);
  const value = (label) => wizard.getByLabel(label, { exact: true }).inputValue();
  assert.deepEqual([await value('Address'), await value('Description'), await value('Family')], ['12', 'used.dcf', 'cia402']);
  // Another file that is dropped here takes its place; it names no node.
  await drop(wizard.locator('[data-field=drop]'), [['dropped.eds', plain]]);
  await becomes('the other file is chosen', () => value('Description'), 'dropped.eds');
  await wizard.getByLabel('Name', { exact: true }).fill('press');
  await wizard.getByRole('button', { name: 'Next' }).click();
  await wizard.getByRole('heading', { name: /Step 3 of 5/ }).waitFor();
  const draft = await page.evaluate(() => JSON.parse(sessionStorage.getItem('axisgate.site.draft')).draft.drives.find((d) => d.name === 'press'));
  assert.deepEqual(draft, { name: 'press', line: 'old', family: 'cia402', address: 12, description: 'dropped.eds', presence: 'auto' });
  assert.deepEqual(page.faults(), []);
  await page.context().close();
});

test('the values of a DCF that differ are listed, chosen, and written when it is asked for', async () => {
  const native = async (send) => assert.equal((await program.call('POST', '/drives/lift/native', { send })).status, 200);
  const value = async (id) => (await program.call('GET', `/axes/lift/parameters/${id}`)).body.value;
  await native('6083:00=9999');
  const page = await open(browser, `${program.url}/axes/lift/parameters`, { bypassCSP: true });
  const part = page.locator('[data-field=configured]');
  await part.getByRole('button', { name: 'Compare with the drive' }).click();
  const row = part.locator('[data-configured="6083h"]');
  await row.waitFor();
  await quiet(page);
  assert.match(await row.innerText(), /9999 → 7000/);
  assert.equal(await value('6083h'), 9999, 'nothing is written before it is asked for');
  assert.deepEqual(await examine(page), []);
  for (const other of await part.locator('[data-configured]:not([data-configured="6083h"]) input:checked').all()) await other.uncheck();
  await part.getByRole('button', { name: 'Write 1 value to the drive' }).click();
  await until('it is told', async () => /1 parameter written/.test(await part.locator('[data-field=configured-told]').innerText()) || (await part.innerText()));
  assert.equal(await value('6083h'), 7000);
  assert.equal(await row.count(), 0);
  assert.deepEqual(page.faults(), []);
  await page.context().close();
});

for (const [path, name, ready] of [['/descriptions', 'descriptions', 'li[data-description]'], ['/descriptions/Maker-Model.eds/used.dcf/', 'description', '[data-field=difference-count]']])
  test(`${name}: pictures at three widths in light and dark, nothing serious for axe-core`, () => pictures(browser, program.url, path, name, async (page) => {
    await page.locator(ready).first().waitFor();
    await quiet(page);
  }));
