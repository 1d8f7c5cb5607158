// The page of an axis' parameters: marks, history, comparison, export and import, snapshots with compare and restore.
// In: the program. Out: counts; pictures under build/browser.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { after, before, test } from 'node:test';
import { becomes, launch, open, shot, until } from './lib/browser.mjs';
import { Program } from './lib/program.mjs';

let program, browser, page, list, a, b, c;
const path = '/axes/feeder/parameters';
const get = async (id) => (await program.call('GET', `/axes/feeder/parameters/${encodeURIComponent(id)}`)).body.value;
const put = (id, value) => program.call('PUT', `/axes/feeder/parameters/${encodeURIComponent(id)}`, { value });
const told = (field) => page.locator(`[data-field="${field}"]`).innerText();
const row = (id) => page.locator(`tr[data-parameter="${id}"]`);

before(async () => {
  program = await Program.start();
  browser = await launch();
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
  await other.getByRole('navigation', { name: 'Parts of feeder' }).getByRole('link', { name: 'Parameters' }).click();
  await other.getByRole('heading', { level: 1, name: 'Parameters of feeder' }).waitFor();
  assert.equal(new URL(other.url()).pathname, path);
  await other.context().close();
});

test('what is on the screen is read by itself: no row moves or changes its height, and what has the keyboard is left alone', async () => {
  const other = await open(browser, `${program.url}/axes/slide.x/parameters`);
  const rows = other.locator('tr[data-parameter]');
  await rows.first().waitFor();
  const places = () => rows.evaluateAll((all) => all.slice(0, 14).map((r) => [r.dataset.parameter, r.offsetTop, r.offsetHeight]));
  const before = await places();
  // While the first values come, somebody is typing in the fourth field that can be written.
  const field = other.locator('tr[data-parameter] input[type=text]').nth(3);
  await field.pressSequentially('12');
  await field.evaluate((e) => {
    globalThis.touched = 0;
    new MutationObserver((all) => (globalThis.touched += all.length)).observe(e.closest('.edit-row'), { attributes: true, childList: true, subtree: true });
  });
  const id = await field.evaluate((e) => e.closest('tr').dataset.parameter);
  const heard = (p) => other.locator(`tr[data-parameter="${p}"] [data-field=age]`).count();
  await until('it and those above have been read', async () => (await heard(id)) === 1 && (await heard(before[0][0])) === 1);
  // "< 1 s ago" is no whole second yet.
  const age = async () => {
    const text = await other.locator(`tr[data-parameter="${id}"] [data-field=age]`).innerText();
    return text.startsWith('<') ? 0 : Number.parseInt(text, 10);
  };
  await until('it gets old', async () => (await age()) >= 2 || (await age()));
  await until('it is read again', async () => (await age()) < 2 || (await age()));
  assert.deepEqual(await places(), before);
  assert.equal(await field.inputValue(), '12');
  assert.ok(await field.evaluate((e) => e === document.activeElement), 'the keyboard is where it was');
  assert.equal(await other.evaluate(() => globalThis.touched), 0);
  assert.deepEqual(other.faults(), []);
  await other.context().close();
});

test('a command makes old what was read before it, and it is read again', async () => {
  const value = page.locator(`tr[data-parameter="${list.find((p) => p.access !== 'W' && !p.count).id}"] [data-live]`);
  await becomes('it is live', () => value.getAttribute('data-live'), 'true');
  await program.command('feeder', { command: 'enable' });
  await becomes('it is old', () => value.getAttribute('data-live'), 'false');
  await becomes('it is live again', () => value.getAttribute('data-live'), 'true');
  await program.command('feeder', { command: 'disable' });
});

test('a filter shows what it was set to: a value that comes later takes no row away, and says so', async () => {
  await put(c.id, 1);
  await page.getByLabel('Show').selectOption('changed');
  await row(c.id).waitFor();
  await put(c.id, 0);
  const again = page.getByRole('button', { name: /^Filter again \(.*1 no longer/ });
  await again.waitFor();
  assert.equal(await row(c.id).count(), 1);
  await again.click();
  await row(c.id).waitFor({ state: 'detached' });
  await put(c.id, 1);
  await page.getByLabel('Show').selectOption('all');
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
  await until('it is counted', async () => /^\d+ of \d+ values differ/.test(await told('compare-told')) || (await told('compare-told')));
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
    // As a file, like whoever has mended it in a spreadsheet: thousands of lines typed one by one would take Chromium seconds.
    await page.getByText('Choose a file').locator('input').setInputFiles({ name, mimeType: 'text/plain', buffer: Buffer.from(text.replace('1234', String(a.max + 1))) });
    await becomes('the field has it', async () => (await box.inputValue()).includes(String(a.max + 1)), true);
    await until('the fault is told', async () => /must be mended/.test(await told('transfer-count')) || (await told('transfer-count')));
    assert.equal(await page.getByRole('button', { name: /^Write \d+ values? to the drive$/ }).last().isDisabled(), true);
    assert.equal(await get(a.id), 1234);
    // Read only values of the export would be refused; what is written is a file of one's own.
    await box.fill(kind === 'CSV' ? `parameter,value\n${a.id},1500\n${b.id},${await get(b.id)}` : JSON.stringify({ [a.id]: 1600 }));
    await page.getByRole('button', { name: 'Write 1 value to the drive' }).click();
    await until('it is written', async () => /1 parameter written/.test(await told('transfer-told')) || (await told('transfer-told')));
    assert.equal(await get(a.id), kind === 'CSV' ? 1500 : 1600);
    await becomes('the field is empty again', () => box.inputValue(), '');
    await put(a.id, 1234);
  });
}

test('snapshots: saved, compared, restored after a look', async () => {
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
  const remove = entry.getByRole('button', { name: 'Delete as delivered', exact: true });
  const question = entry.locator('[data-field=delete]');
  await remove.click();
  assert.equal(await question.locator('span').innerText(), 'Delete as delivered? It cannot be brought back.');
  await page.keyboard.press('Enter'); // the keyboard is at the answer that changes nothing
  await question.waitFor({ state: 'detached' });
  assert.ok((await program.call('GET', '/axes/feeder/snapshots')).body.some((s) => s.name === 'as delivered'));
  await remove.click();
  await question.getByRole('button', { name: 'Delete', exact: true }).click();
  await until('it is gone', async () => (await entry.count()) === 0);
});

test('what acts at once is left out of a restore, and goes with it when that is asked for; the page says what that is', async () => {
  const live = list.find((p) => p.live && p.name === 'jog_speed'); // a set-point, which alone moves nothing
  assert.ok(live, 'a parameter that acts at once');
  const name = 'with what acts';
  await program.call('GET', `/axes/feeder/parameters/${encodeURIComponent(live.id)}`);
  assert.ok([200, 201].includes((await program.call('POST', '/axes/feeder/snapshots', { name, from: 'device' })).status));
  await page.reload();
  await page.getByText('act the moment they are written: switches, set-points, outputs').waitFor();
  const sent = [];
  const listen = (r) => /\/restore$/.test(r.url()) && sent.push(r.postDataJSON());
  page.on('request', listen);
  await put(a.id, 1900);
  const was = await get(live.id);
  assert.equal((await put(live.id, was + 77)).status, 200);
  await page.getByRole('button', { name: `Restore ${name}` }).click();
  const out = page.locator('[data-field=left-out]');
  await out.waitFor({ timeout: 60_000 });
  /** Why it is left out. */
  const why = () => out.locator('li').evaluateAll((l, id) => l.map((e) => [e.querySelector('.mono').textContent.split(', '), e.textContent]).find(([ids]) => ids.includes(id))?.[1].split(':')[0] ?? 'not left out', live.id);
  await until('it is left out because it acts', async () => /acts at once|live/.test(await why()) || (await why()));
  await page.getByLabel('Restore also what acts at once').check();
  await until('it is not left out for that any more', async () => (await why()) === 'not left out' || (await why()), 60_000);
  const changes = page.locator('.changes');
  await until('it is among the changes', async () => (await changes.innerText()).includes(live.id) || (await changes.innerText()));
  assert.deepEqual(sent, [{ dry_run: true }, { dry_run: true, include_live: true }]);
  page.off('request', listen);
  await shot(page, 'parameters-live', { fullPage: true });
  await page.getByRole('button', { name: 'Change nothing' }).click();
  await put(live.id, was);
  await put(a.id, 1234);
});

test('a snapshot of another family says so, and can be neither restored nor compared', async () => {
  const list = (await program.call('GET', '/axes/feeder/snapshots')).body;
  const mine = list.at(-1);
  await until('it says of what it is', async () => /UIM342/.test(await page.locator(`[data-snapshot="${mine.n}"]`).innerText()) || (await page.locator(`[data-snapshot="${mine.n}"]`).innerText()));
  const before = (await program.call('GET', '/site')).body;
  const after = structuredClone(before);
  after.lines.push({ name: 'other', uri: 'twin', family: 'mcode' });
  Object.assign(after.drives.find((d) => d.name === 'feeder'), { line: 'other', address: 'A' });
  assert.equal((await program.call('PUT', '/site', after)).status, 200);
  const other = await open(browser, program.url + path);
  const entry = other.locator(`[data-snapshot="${mine.n}"]`);
  await entry.getByText(/the drive is .*mcode.* now, so it is neither compared nor restored/).waitFor();
  const restore = entry.getByRole('button', { name: /^Restore/ });
  await becomes('it is not restored', () => restore.isDisabled(), true);
  assert.match(await restore.getAttribute('title'), /neither compared nor restored/);
  const form = other.getByRole('form', { name: 'Compare' });
  for (const label of ['Compare', 'with']) await becomes(`it is not in "${label}"`, () => form.getByLabel(label, { exact: true }).locator('option', { hasText: `snapshot ${mine.name}` }).isDisabled(), true);
  // The gateway says the same.
  assert.equal((await program.call('GET', `/axes/feeder/snapshots/${mine.n}/diff?with=default`)).status, 409);
  assert.equal((await program.call('POST', `/axes/feeder/snapshots/${mine.n}/restore`, { dry_run: true })).status, 409);
  await shot(other, 'parameters-foreign', { fullPage: true });
  assert.deepEqual(other.faults(), []);
  await other.context().close();
  assert.equal((await program.call('PUT', '/site', before)).status, 200);
  await program.call('DELETE', `/axes/feeder/snapshots/${mine.n}`);
});

test('reading again takes at most a quarter of the time of the line, one value at a time', async () => {
  const other = await open(browser, program.url);
  // As long as a slow line takes; by the page's own clock, since this process may be late.
  await other.route(/\/api\/v1\/axes\/feeder\/parameters\/[^/?]+$/, async (r) => {
    if (r.request().method() === 'GET') await new Promise((done) => setTimeout(done, 200));
    return r.continue();
  });
  await other.goto(program.url + path);
  const answers = () => other.evaluate(() => performance.getEntriesByType('resource')
    .filter((e) => /\/api\/v1\/axes\/feeder\/parameters\/[^/?]+$/.test(e.name)).map((e) => [e.startTime, e.responseEnd]));
  await until('it has read again often enough', async () => (await answers()).length >= 6, 20_000);
  const seen = (await answers()).slice(0, 6);
  for (let i = 1; i < seen.length; i += 1) {
    const took = seen[i - 1][1] - seen[i - 1][0];
    assert.ok(took >= 190, `answer ${i} took ${took} ms`);
    assert.ok(seen[i][0] - seen[i - 1][1] >= 2.9 * took, `answer ${i} took ${took} ms, the next was asked for ${seen[i][0] - seen[i - 1][1]} ms later`);
  }
  await other.context().close();
});

test('what was read before the connection was lost is old while it is away, and live again only when the drive has said it anew', async () => {
  const other = await open(browser, program.url + path);
  for (const p of [page, other]) p.expectLoss(true);
  const id = list.find((p) => p.access !== 'W' && !p.count).id;
  const value = other.locator(`tr[data-parameter="${id}"] [data-live]`);
  await becomes('it is live', () => value.getAttribute('data-live'), 'true');
  await program.stop();
  await becomes('it is old', () => value.getAttribute('data-live'), 'false');
  assert.ok(await value.evaluate((e) => e.classList.contains('is-old-value')), 'it is grey');
  const asked = other.waitForRequest((r) => r.method() === 'GET' && new URL(r.url()).pathname.endsWith(`/parameters/${encodeURIComponent(id)}`), { timeout: 30_000 });
  await program.run();
  await becomes('it is live again', () => value.getAttribute('data-live'), 'true', 30_000);
  assert.ok(await asked, 'the drive was asked for it');
  await other.context().close();
});

test('nothing on the way was a fault of the page', () => assert.deepEqual(page.faults(), []));
