// Roles on the page of the real program: reading is open, what is barred tells why, and a session that ended is never local access without a word. One
// user of each role is signed in; what there is to see is made beforehand.
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { becomes, until } from './lib/browser.mjs';
import { Program } from './lib/program.mjs';
import { end, pageOf, password, refusals, start } from './lib/roles.mjs';

let program;
before(async () => void ({ program } = await start()));
after(end);

// What is enabled, and what is not, for whom. `why`: the role in the reason.
const reads = [
  ['/site', 'link', 'Export the site'], ['/site', 'button', /^Difference to revision/], ['/mappings', 'button', 'What the HMI sees'], ['/mappings', 'link', 'Export CSV'],
  ['/axes/feeder/parameters', 'button', 'Export CSV'], ['/axes/feeder/parameters', 'button', /^Read (all|shown)/], ['/axes/feeder/parameters', 'button', 'Compare'],
  ['/events', 'button', /^Save \d+ as CSV/], ['/lines/can0', 'link', 'candump'], ['/axes/feeder', 'button', 'Quick stop'], ['/axes/feeder', 'button', 'Halt'],
];
const changes = [
  ['/', 'button', 'Enable feeder', 'operator'], ['/', 'button', 'Move to target of feeder', 'operator'], ['/axes/feeder', 'button', 'Take', 'operator'], ['/axes/feeder', 'button', 'Home', 'operator'], ['/axes/feeder', 'button', 'Disable', 'operator'],
  ['/events', 'button', /^Shelve/, 'operator'], ['/events', 'button', 'Acknowledge all shown', 'operator'], ['/recipes/there-and-back', 'button', 'Run', 'operator'], ['/recipes/there-and-back', 'button', 'Check only', 'operator'],
  ['/site', 'button', 'Add a line', 'engineer'], ['/site', 'button', 'Change axis feeder', 'engineer'], ['/site', 'button', 'Remove drive slide', 'engineer'], ['/site', 'button', /^Restore revision/, 'engineer'], ['/site', 'button', 'Wizard: to a moving axis', 'engineer'],
  ['/mappings', 'button', 'Add a mapping', 'engineer'], ['/mappings', 'button', 'Add a template', 'engineer'], ['/mappings', 'button', /^Undo/, 'engineer'], ['/mappings', 'button', 'Paste or import', 'engineer'], ['/mappings', 'button', /^position i32/, 'engineer'],
  ['/axes/feeder/parameters', 'button', 'Save snapshot', 'engineer'], ['/axes/feeder/parameters', 'button', /^Delete first/, 'engineer'], ['/axes/feeder/parameters', 'button', /^Write /, 'engineer'],
  ['/axes/feeder/drive', 'button', 'Send', 'engineer'], ['/lines/can0', 'button', 'Look for drives', 'engineer'], ['/lines/can0', 'switch', 'Power', 'engineer'], ['/recipes', 'button', 'New recipe', 'engineer'], ['/recipes/there-and-back', 'button', 'Delete there-and-back', 'engineer'],
  ['/site', 'button', 'Backup of everything', 'administrator'],
];
const alsoWithout = /Undo|Check with/; // disabled for another reason too, as long as there is nothing to undo or to check
const order = ['viewer', 'operator', 'engineer', 'administrator'];

for (const role of order.slice(0, 3)) {
  test(`as ${role}, reading is open, and what is barred tells why`, async () => {
    const page = await pageOf(role);
    for (const path of [...new Set([...reads, ...changes].map((r) => r[0]))]) {
      await page.goto(program.url + path);
      for (const [, kind, name] of reads.filter((r) => r[0] === path)) {
        const c = page.getByRole(kind, { name, exact: true }).first();
        await c.waitFor();
        await becomes(`${path}: ${name} is open`, () => c.isDisabled(), false);
      }
      for (const [, kind, name, need] of changes.filter((r) => r[0] === path)) {
        const c = page.getByRole(kind, { name, exact: true }).first();
        await c.waitFor();
        const barred = order.indexOf(role) < order.indexOf(need);
        if (barred || !alsoWithout.test(name instanceof RegExp ? name.source : name)) await becomes(`${path}: ${name} is ${barred ? 'barred' : 'open'}`, () => c.isDisabled(), barred);
        if (!barred) continue;
        const why = await c.evaluate((e) => e.title || e.closest('fieldset[title]')?.title || '');
        assert.match(why, new RegExp(`needs the role ${need}. Yours is ${role}.`), `${path}: ${name}`);
        await page.getByText(`needs the role ${need}. Yours is ${role}.`).first().waitFor();
      }
    }
    assert.deepEqual(page.faults(), []);
    await page.context().close();
  });
}

test('Enter in the target of an axis says why it is not sent', async () => {
  const page = await pageOf('viewer');
  for (const [path, label] of [['/', 'Target of feeder'], ['/axes/feeder', 'Target']]) {
    await page.goto(program.url + path);
    await page.getByLabel(label, { exact: true }).fill('3');
    await page.getByLabel(label, { exact: true }).press('Enter');
    await until('it is said', async () => /not sent.*needs the role operator/is.test(await page.locator('.result').first().innerText()) || (await page.locator('.result').first().innerText()));
  }
  await page.context().close();
});

test('an administrator may copy everything', async () => {
  const page = await pageOf('administrator');
  await page.goto(`${program.url}/site`);
  const backup = page.getByRole('button', { name: 'Backup of everything' });
  await backup.waitFor();
  await becomes('it is open', () => backup.isDisabled(), false);
  assert.equal(await page.locator('input[aria-label="Restore a backup"]').isDisabled(), false);
  assert.equal(await page.locator('[data-field=barred]').count(), 0);
  await page.context().close();
});

test('a session that ended elsewhere is never local access without a word, after a reload neither', async () => {
  const page = await pageOf('viewer');
  await page.goto(program.url);
  const who = page.locator('[data-field=who]');
  await until('it is said who one is', async () => /viewer, viewer/.test(await who.innerText()) || (await who.innerText()));
  await page.context().clearCookies(); // as another page, or another gateway of this host, would have it
  await page.reload();
  await page.getByRole('heading', { name: 'Sign in' }).waitFor();
  await page.reload();
  await page.locator('[data-field=session-ended]').waitFor();
  await page.getByRole('button', { name: 'Go on without signing in' }).click();
  await until('it is on purpose then', async () => /local access, engineer/.test(await who.innerText()) || (await who.innerText()));
  await page.context().close();
});

test('two gateways of one host do not sign each other out', async () => {
  const other = await Program.start();
  try {
    const page = await pageOf('engineer');
    const door = page.context().request;
    const first = await door.post(`${other.url}/api/v1/session/first`, { data: { code: other.firstCode, user: 'anna', password } });
    assert.equal(first.status(), 200, await first.text());
    const who = async (url) => (await (await door.get(`${url}/api/v1/session`)).json()).user;
    assert.deepEqual([await who(program.url), await who(other.url)], ['engineer', 'anna']);
    const names = (await page.context().cookies()).map((c) => c.name);
    assert.ok(names.length === 2 && names.every((n) => /^axisgate_session_[0-9a-f]{8}$/.test(n)), names.join(' '));
    await page.context().close();
  } finally {
    await other.end();
  }
});

test('a press that the gateway refuses would be seen', async () => {
  const page = await pageOf('viewer');
  await page.goto(program.url);
  const refused = refusals(page);
  await page.evaluate(() => fetch('/api/v1/axes/feeder/commands', { method: 'POST', headers: { 'content-type': 'application/json' }, body: '{"command":"enable"}' }));
  await becomes('it is noted', async () => refused.seen, ['POST /api/v1/axes/feeder/commands']);
  await page.context().close();
});
