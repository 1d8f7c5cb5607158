// The page of an axis' parameters: marks, history, comparison, export and import, snapshots with compare and restore.
// What the program does not offer yet must be said in words; the tests ask the program itself what that is.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { after, before, test } from 'node:test';
import { launch, open, pictures, shot, until } from './lib/browser.mjs';
import { Program } from './lib/program.mjs';

let program, browser, page, list, a, b, c, offersSnapshots;
const path = '/axes/feeder/parameters';
const get = async (id) => (await program.call('GET', `/axes/feeder/parameters/${encodeURIComponent(id)}`)).body.value;
const put = (id, value) => program.call('PUT', `/axes/feeder/parameters/${encodeURIComponent(id)}`, { value });
const told = (field) => page.locator(`[data-field="${field}"]`).innerText();
const row = (id) => page.locator(`tr[data-parameter="${id}"]`);

before(async () => {
  program = await Program.start();
  browser = await launch();
  offersSnapshots = (await program.call('GET', '/axes/feeder/snapshots')).status === 200;
  list = (await program.call('GET', '/axes/feeder/parameters')).body;
  [a, b] = list.filter((p) => p.access === 'RW' && p.max !== null && p.min >= 0 && p.max > 2000 && !p.allowed && !p.count && /accel|decel/i.test(p.name));
  assert.ok(a && b, 'two parameters that may be written without harm');
  c = list.find((p) => p.access === 'RW' && p.default === 0 && /stall_action|backlash/.test(p.name));
  assert.ok(c, 'a parameter with a default');
  await put(c.id, 1);
  await put(a.id, 1111);
  await put(a.id, 1234);
  await get(b.id);
  page = await open(browser, program.url + path);
  await row(a.id).waitFor();
});
after(async () => {
  await browser?.close();
  await program?.end();
});

test('the axis page leads here, and the heading names the axis', async () => {
  const other = await open(browser, `${program.url}/axes/feeder`);
  await other.getByRole('link', { name: /Snapshots, comparison/ }).click();
  await other.getByRole('heading', { level: 1, name: 'Parameters of feeder' }).waitFor();
  assert.equal(new URL(other.url()).pathname, path);
  await other.context().close();
});

test('a value that is not the default is marked in words, and can be shown alone', async () => {
  await page.getByRole('searchbox', { name: 'Search parameters' }).fill(c.id);
  await until('it is marked', async () => /changed/.test(await row(c.id).locator('[data-field=live]').innerText()) || (await row(c.id).innerText()));
  await page.getByRole('searchbox', { name: 'Search parameters' }).fill('');
  await page.getByLabel('Show').selectOption('written');
  await until('both that were written stand alone', async () => (await page.locator('tr[data-parameter]').count()) === 2);
  await page.getByLabel('Show').selectOption('all');
});

test('the history says when, who, from where, from what to what', async () => {
  await row(a.id).getByRole('button', { name: `History of ${a.id}` }).click();
  const history = row(a.id).locator('.history');
  await until('it is there', async () => /1\s?234/.test(await history.innerText()) || (await history.innerText()));
  assert.match(await history.innerText(), /127\.0\.0\.1/);
});

test('now is compared with the defaults: what differs is listed', async () => {
  const form = page.getByRole('form', { name: 'Compare' });
  await form.getByRole('button', { name: 'Compare' }).click();
  await form.locator(`[data-compared="${c.id}"]`).waitFor();
  assert.match(await told('compare-told'), /^\d+ of \d+ values differ/);
  assert.match(await form.locator(`[data-compared="${c.id}"]`).innerText(), /differs/);
  await put(c.id, 0);
});

test('now is compared with another axis', async () => {
  await program.call('GET', `/axes/slide.x/parameters/${encodeURIComponent(a.id)}`);
  const form = page.getByRole('form', { name: 'Compare' });
  await form.getByLabel('with').selectOption('axis:slide.x');
  await form.getByRole('button', { name: 'Compare' }).click();
  await form.locator(`[data-compared="${a.id}"]`).waitFor();
});

for (const [kind, name] of [['CSV', 'feeder-parameters.csv'], ['JSON', 'feeder-parameters.json']]) {
  test(`${kind} goes out and comes in again: checked first, then only what differs is written`, async () => {
    const [download] = await Promise.all([page.waitForEvent('download'), page.getByRole('button', { name: `Export ${kind}` }).click()]);
    assert.equal(download.suggestedFilename(), name);
    const text = readFileSync(await download.path(), 'utf8');
    assert.match(text, /1234/);
    const box = page.locator('#transfer-text');
    await box.fill(text.replace('1234', String(a.max + 1)));
    await until('the fault is told', async () => /must be mended/.test(await told('transfer-count')) || (await told('transfer-count')));
    assert.equal(await page.getByRole('button', { name: /^Write \d+ values? to the drive$/ }).last().isDisabled(), true);
    assert.equal(await get(a.id), 1234);
    // Read only values of the export would be refused; what is written is a file of one's own.
    await box.fill(kind === 'CSV' ? `parameter,value\n${a.id},1500\n${b.id},${await get(b.id)}` : JSON.stringify({ [a.id]: 1600 }));
    await page.getByRole('button', { name: 'Write 1 value to the drive' }).click();
    await until('it is written', async () => /1 parameters written/.test(await told('transfer-told')) || (await told('transfer-told')));
    assert.equal(await get(a.id), kind === 'CSV' ? 1500 : 1600);
    assert.equal(await box.inputValue(), '');
    await put(a.id, 1234);
  });
}

test('snapshots: saved, compared, restored after a look; or it is said that there are none', async () => {
  if (!offersSnapshots) {
    assert.match(await told('snapshots'), /does not offer snapshots/);
    return;
  }
  await page.getByRole('button', { name: 'Save snapshot' }).click();
  await page.getByText('Give it a name.').waitFor();
  const form = page.getByRole('form', { name: 'Save a snapshot' });
  await form.getByLabel('Name').fill('as delivered');
  await form.getByRole('button', { name: 'Save snapshot' }).click();
  const entry = page.locator('[data-snapshot]').filter({ hasText: 'as delivered' });
  await entry.waitFor({ timeout: 60_000 });
  await put(a.id, 1700);
  const compare = page.getByRole('form', { name: 'Compare' });
  await compare.getByLabel('Compare', { exact: true }).selectOption({ label: 'snapshot as delivered' });
  await compare.getByLabel('with').selectOption('device');
  await compare.getByRole('button', { name: 'Compare' }).click();
  await compare.locator(`[data-compared="${a.id}"]`).waitFor({ timeout: 60_000 });
  await entry.getByRole('button', { name: 'Restore as delivered' }).click();
  const changes = page.locator('.changes');
  await changes.waitFor({ timeout: 60_000 });
  assert.match(await changes.innerText(), new RegExp(`${a.id.replace(/[[\]]/g, '\\$&')}[\\s\\S]*1\\s?700 → 1\\s?234`));
  assert.equal(await get(a.id), 1700);
  await shot(page, 'parameters-restore', { fullPage: true });
  await changes.getByRole('button', { name: /^Write \d+ values? to the drive$/ }).click();
  await until('it is restored', async () => (await get(a.id)) === 1234, 60_000);
  await entry.getByRole('button', { name: 'Remove as delivered', exact: true }).click();
  await entry.getByRole('button', { name: 'Remove for good: as delivered' }).click();
  await until('it is gone', async () => (await entry.count()) === 0);
});

test('axe-core finds nothing serious, nothing scrolls sideways, pictures', async () => {
  assert.deepEqual(page.faults(), []);
  await pictures(browser, program.url, path, 'parameters', (p) => p.locator('[data-parameter]').first().waitFor());
});
