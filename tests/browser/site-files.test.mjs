// What the page of the site has beside its draft: applied states and their restore, a backup and the restore that waits, options of the families.
// In: the program. Out: counts; pictures under build/browser. Nothing here is left out because the program lacks it.
import assert from 'node:assert/strict';
import { readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { becomes, launch, open, pictures, shot, until } from './lib/browser.mjs';
import { deskOf } from './lib/desk.mjs';
import { Program } from './lib/program.mjs';

let program, browser, page;
const { told, site, axis, applyIt, keepIt } = deskOf(() => ({ program, page }));

before(async () => {
  program = await Program.start();
  browser = await launch();
  page = await open(browser, `${program.url}/site`);
  await page.locator('[data-entry="axes/feeder"]').waitFor();
});
after(async () => {
  await browser?.close();
  await program?.end();
});

test('applied states can be looked at and restored', async () => {
  const history = page.locator('[data-field=history]');
  for (const unit of ['deg', 'mm']) assert.equal((await program.call('PATCH', '/axes/feeder', { unit })).status, 200);
  await becomes('the state in force is marked', () => history.locator('[data-revision]', { has: page.locator('[data-field=in-force]') }).evaluateAll((l) => l.map((e) => Number(e.dataset.revision))), [(await program.call('GET', '/about')).body.site_revision]);
  await until('there are states', async () => (await history.locator('[data-revision]').count()) > 0);
  const revisions = await history.locator('[data-revision]').evaluateAll((l) => l.map((e) => Number(e.dataset.revision)));
  let wanted;
  for (const r of revisions) {
    const old = (await program.call('GET', `/site/history/${r}`)).body;
    if (old.axes.find((a) => a.name === 'feeder')?.unit === 'deg') wanted = r;
  }
  assert.ok(wanted, 'the state before the last one is kept');
  await history.getByRole('button', { name: `Difference to revision ${wanted}` }).click();
  await until('the difference is shown', async () => /mm → deg/.test(await history.innerText()) || (await history.innerText()));
  await history.getByRole('button', { name: `Restore revision ${wanted}` }).click();
  await until('it is staged', async () => /is staged/.test(await told('stage-told')) || (await told('stage-told')));
  await applyIt(60);
  await keepIt();
  assert.equal((await axis('feeder')).unit, 'deg');
});

test('a backup goes out; a restore is asked for twice', async () => {
  // A copy of everything is for administrators.
  const first = await page.context().request.post(`${program.url}/api/v1/session/first`, { data: { code: program.process.code, user: 'anna', password: 'correct-horse-9' } });
  assert.equal(first.status(), 200);
  await page.reload();
  const [download] = await Promise.all([page.waitForEvent('download'), page.getByRole('button', { name: 'Backup of everything' }).click()]);
  assert.match(download.suggestedFilename(), /\.tar$/);
  // With a passphrase it is sealed, and nobody takes it without.
  const passphrase = page.getByLabel('Passphrase of the backup');
  await passphrase.fill('four wörds nobody guesses');
  const [sealed] = await Promise.all([page.waitForEvent('download'), page.getByRole('button', { name: 'Backup of everything' }).click()]);
  assert.match(sealed.suggestedFilename(), /\.sealed$/);
  assert.equal(readFileSync(await sealed.path()).subarray(0, 15).toString(), 'AXISGATE-SEALED');
  await passphrase.fill('four words nobody guesses');
  await page.getByLabel('Restore a backup', { exact: true }).and(page.locator('input')).setInputFiles(await sealed.path());
  await page.getByRole('button', { name: 'Replace everything' }).click();
  await until('the wrong one is refused', async () => /passphrase is wrong/.test(await told('files-told')) || (await told('files-told')));
  await page.getByRole('button', { name: 'Leave it' }).click();
  await passphrase.fill('');
  const file = join(program.data, 'copy.db');
  writeFileSync(file, 'no database');
  await page.getByLabel('Restore a backup', { exact: true }).and(page.locator('input')).setInputFiles(file);
  await page.getByText('replaces site, mappings, parameters').waitFor();
  await page.getByRole('button', { name: 'Leave it' }).click();
  const copy = await download.path();

  // What is laid down waits, in sight of every administrator, until the next start; dropped, it does not.
  const pending = page.locator('[data-field=pending]');
  await becomes('nothing waits', () => pending.count(), 0);
  await page.getByLabel('Restore a backup', { exact: true }).and(page.locator('input')).setInputFiles({ name: 'copy.tar', mimeType: 'application/octet-stream', buffer: readFileSync(copy) });
  await page.getByRole('button', { name: 'Replace everything' }).click();
  await pending.getByText('A restore waits: it takes effect with the next start.').waitFor();
  assert.match(await told('pending-what'), /^Laid down .* by .*anna.*, \d.*It brings site revision \d+ with it, and a database of structure \d+\./);
  await page.reload();
  await pending.getByText('A restore waits').waitFor();
  await shot(page, 'site-restore-waits');
  const nobody = await open(browser, `${program.url}/site`);
  await nobody.getByText('whether one waits for the next start needs the role administrator. Yours is engineer.').waitFor();
  await becomes('nobody else is told', () => nobody.locator('[data-field=pending]').count(), 0);
  assert.deepEqual(nobody.faults(), []);
  await nobody.context().close();
  await pending.getByRole('button', { name: 'Drop the restore …' }).click();
  await pending.getByRole('button', { name: 'Drop it', exact: true }).click();
  await pending.getByText('Dropped: the next start goes on with the database as it is.').waitFor();
  await becomes('nothing waits at the gateway', async () => (await (await page.context().request.get(`${program.url}/api/v1/backup/pending`)).json()).waiting, false);
  await becomes('nothing is said to wait', () => pending.getByText('A restore waits').count(), 0);
  await page.context().clearCookies();
  assert.deepEqual(page.faults(), []);
});

test('a restore that waits: pictures at three widths in light and dark, nothing serious for axe-core', async () => {
  const waiting = { waiting: true, at: '2026-03-01T10:11:12Z', who: 'anna 192.0.2.17:50123', bytes: 319488, version: 5, site_revision: 7 };
  await pictures(browser, program.url, '/site', 'site-restore', async (p) => {
    await p.route('**/api/v1/backup/pending', (r) => r.fulfill({ json: waiting }));
    await p.route('**/api/v1/session', (r) => r.fulfill({ json: { user: 'anna', role: 'administrator', via: 'cookie', csrf: 'x', expires_at: null, ended: null, first_sign_in: false, roles: ['viewer', 'operator', 'engineer', 'administrator'] } }));
    await p.reload();
    await p.locator('[data-field=pending-what]').waitFor();
    await p.getByRole('button', { name: 'Drop the restore …' }).click();
  });
});

test('older states are fetched page by page, to the first one', async () => {
  for (let i = 0; i < 60; i += 1) assert.equal((await program.call('PATCH', '/axes/slide.x', { velocity_max: 100 + i })).status, 200);
  const other = await open(browser, `${program.url}/site`);
  const count = other.locator('[data-field=history-count]');
  await until('the newest are there', async () => (await count.innerText()) === '50 states shown; there may be older ones.' || (await count.innerText()));
  await other.getByRole('button', { name: 'Older', exact: true }).click();
  await until('all are there', async () => /^\d+ states, the oldest that is kept included\.$/.test(await count.innerText()) || (await count.innerText()));
  const kept = (await program.call('GET', '/site/history?limit=1000')).body.map((h) => h.revision);
  assert.ok(kept.length > 60, `${kept.length} are kept`);
  await becomes('each is there once', () => other.locator('[data-revision]').evaluateAll((l) => l.map((e) => Number(e.dataset.revision))), kept);
  assert.deepEqual(other.faults(), []);
  await other.context().close();
});

test('options are fields of the family, judged while they are typed, and in force when they are applied', async () => {
  const document = await site();
  document.drives.find((d) => d.name === 'feeder').options = { old_one: 'a,b' };
  const before = await program.call('PUT', '/site', document);
  const other = await open(browser, `${program.url}/site`);
  assert.equal(before.status, 200, JSON.stringify(before.body));
  const families = (await program.call('GET', '/families')).body;
  const uim = families.find((x) => x.name === 'uim342');
  await other.getByRole('button', { name: 'Change drive feeder' }).click();
  const f = other.getByRole('form', { name: 'Change drive feeder' });
  const freedoms = uim.freedoms.filter((f) => uim.options.every((o) => o.name !== f.name)); // options of the twin by their names
  const own = [...uim.options.filter((o) => o.of.includes('drive') || o.of.includes('twin')), ...freedoms];
  await f.getByText(`Options of uim342: ${own.length}; set: old_one`).waitFor(); // open, as there is one that is not known
  assert.equal(await f.locator('.option').count(), own.length, 'one field for each');
  for (const o of own) await f.getByText(o.description.slice(0, 40)).first().waitFor();
  await f.getByText('uim342 has no such option here: it counts as not given.').waitFor();
  await f.getByLabel('Home timeout, s').fill('9999');
  await f.getByText('1 to 3600 s.', { exact: true }).waitFor();
  await f.getByRole('button', { name: 'Save to draft' }).click();
  await becomes('it is not taken', () => f.getByLabel('Home timeout, s').getAttribute('aria-invalid'), 'true');
  await shot(other, 'site-options', { fullPage: true });
  await f.getByLabel('Home timeout, s').fill('30');
  await f.getByLabel('Notify').selectOption('on');
  await f.getByRole('button', { name: 'Remove option old_one' }).click();
  await f.getByRole('button', { name: 'Save to draft' }).click();
  await other.locator('[data-diff="drives/feeder"]').waitFor();
  const at = other.locator('[data-field=stage]').first();
  await at.getByRole('button', { name: 'Check', exact: true }).click();
  await until('it is checked', async () => /^Checked/.test(await at.locator('[data-field=stage-told]').innerText()) || (await at.innerText()));
  await at.getByRole('button', { name: 'Apply', exact: true }).click();
  await at.getByRole('button', { name: 'Keep', exact: true }).click();
  await becomes('it is in force', async () => (await site()).drives.find((d) => d.name === 'feeder').options, { home_timeout_s: '30', notify: 'on' });
  await becomes('the axis says what an increment is', async () => {
    await other.getByRole('button', { name: 'Change axis feeder' }).click();
    return other.getByText(`one increment of uim342 is one ${uim.position_unit}`).count();
  }, 1);
  assert.deepEqual(other.faults(), []);
  await other.context().close();
});
