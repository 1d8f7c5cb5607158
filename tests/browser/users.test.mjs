// Users on the page of the real program: first sign-in with the printed code, users and tokens, what a role may not do, the way back after a lost session.
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { becomes, launch, open, shot, pictures, until } from './lib/browser.mjs';
import { Program } from './lib/program.mjs';

const password = 'a long enough phrase';
let program, browser, page;
before(async () => {
  program = await Program.start({ set: ['users.local_role=none'] });
  browser = await launch();
});
after(async () => {
  await browser?.close();
  await program?.end();
});
const text = (p, field) => p.locator(`[data-field="${field}"]`).first().innerText();
const signIn = async (p, user, word = password) => {
  await p.getByLabel('Name', { exact: true }).fill(user);
  await p.getByLabel('Password', { exact: true }).fill(word);
  await p.getByRole('button', { name: 'Sign in', exact: true }).click();
};

test('the first sign-in asks for the code; pictures of it', async () => {
  assert.match(program.firstCode, /^\S{8,}$/);
  await pictures(browser, program.url, '/', 'sign-in-first', (p) => p.getByRole('heading', { name: 'First sign-in' }).waitFor());
});

test('the first administrator is made, and lands where one was', async () => {
  page = await open(browser, `${program.url}/events`);
  await page.getByLabel('Code').fill(program.firstCode);
  await page.getByLabel('Name', { exact: true }).fill('anna');
  await page.getByLabel('Password', { exact: true }).fill('short');
  await page.getByLabel('Password again').fill('short');
  const send = page.getByRole('button', { name: 'Make the first administrator' });
  await send.click();
  await until('it is too short', async () => /at least 12/.test(await text(page, 'sign-in-told')) || (await text(page, 'sign-in-told')));
  await page.getByLabel('Password', { exact: true }).fill(password);
  await page.getByLabel('Password again').fill(password);
  await send.click();
  await page.getByRole('heading', { name: 'Events and alarms', exact: true }).first().waitFor();
  await until('it is said who one is', async () => /anna, administrator/.test(await text(page, 'who')) || (await text(page, 'who')));
  await until('the stream is live', async () => /Live/.test(await text(page, 'connection')));
});

test('a user is added, a token is shown once, a deletion is asked twice', async () => {
  await page.goto(`${program.url}/users`);
  const add = page.getByRole('form', { name: 'Add a user' });
  await add.getByLabel('Name').fill('vera');
  await add.getByLabel('Role').selectOption('viewer');
  await add.getByLabel('Password').fill(password);
  await add.getByRole('button', { name: 'Add user' }).click();
  await page.locator('[data-user=vera]').waitFor();
  const token = page.getByRole('form', { name: 'Add a token' });
  await token.getByLabel('Name of the token').fill('line3');
  await token.getByRole('button', { name: 'Add token' }).click();
  await page.locator('[data-field=secret]').waitFor();
  const secret = await text(page, 'secret');
  const asked = await fetch(`${program.url}/api/v1/session`, { headers: { authorization: `Bearer ${secret}` } });
  assert.equal((await asked.json()).via, 'token');
  await page.reload();
  await page.locator('[data-token=line3]').waitFor();
  assert.equal(await page.locator('[data-field=secret]').count(), 0);
  await page.getByRole('button', { name: 'Delete line3' }).click();
  assert.equal(await page.locator('[data-token=line3]').count(), 1);
  await page.locator('[data-token=line3] [data-field=delete]').getByRole('button', { name: 'Delete', exact: true }).click();
  await page.locator('[data-token=line3]').waitFor({ state: 'detached' });
  assert.deepEqual(page.faults(), []);
});

test('a viewer sees, may stop, and is told why the rest is disabled', async () => {
  const viewer = await open(browser, `${program.url}/axes/feeder`);
  await signIn(viewer, 'vera');
  await viewer.getByRole('heading', { name: 'feeder', exact: true }).waitFor();
  const enable = viewer.getByRole('button', { name: 'Enable', exact: true });
  await becomes('it is barred', () => enable.isDisabled(), true);
  assert.match(await enable.getAttribute('title'), /needs the role operator\. Yours is viewer/);
  assert.equal(await viewer.getByRole('button', { name: 'Disable', exact: true }).isDisabled(), true);
  for (const name of ['Halt', 'Quick stop']) assert.equal(await viewer.getByRole('button', { name, exact: true }).isDisabled(), false);
  await viewer.getByRole('button', { name: 'Stop feeder' }).click();
  await until('the stop is accepted', async () => /accepted/.test(await viewer.locator('.result').first().innerText()));
  await viewer.context().close();
});

test('a session that ended leads to the sign-in, and back to what was typed', async () => {
  const eva = await open(browser, `${program.url}/axes/feeder`);
  await signIn(eva, 'vera');
  await eva.getByLabel('Target', { exact: true }).fill('42');
  await eva.context().clearCookies();
  // The next request tells, a click's or one that the page makes by itself; then the button is gone already.
  await eva.getByRole('button', { name: 'Halt', exact: true }).click({ timeout: 2_000 }).catch(() => undefined);
  await eva.getByRole('heading', { name: 'Sign in' }).waitFor();
  await signIn(eva, 'vera', 'not the password');
  await until('it is refused', async () => (await text(eva, 'sign-in-told')).length > 15 && !/Signing in/.test(await text(eva, 'sign-in-told')));
  await signIn(eva, 'vera');
  await eva.getByRole('heading', { name: 'feeder', exact: true }).waitFor();
  assert.equal(await eva.getByLabel('Target', { exact: true }).inputValue(), '42');
  await eva.context().close();
});

test('a restart ends all sessions: the page says so, and keeps what was typed', async () => {
  const eva = await open(browser, `${program.url}/axes/feeder`);
  await signIn(eva, 'vera');
  await eva.getByLabel('Target', { exact: true }).fill('43');
  eva.expectLoss(true);
  await program.stop();
  await program.run();
  await eva.getByRole('heading', { name: 'Sign in' }).waitFor({ timeout: 20_000 });
  await until('it is told why', async () => /Your session has ended: .*restarted/.test(await text(eva, 'session-ended')) || (await text(eva, 'session-ended')));
  await until('the strip says so', async () => /session has ended/.test(await text(eva, 'strip')) || (await text(eva, 'strip')));
  await shot(eva, 'session-ended');
  await signIn(eva, 'vera');
  await eva.getByRole('heading', { name: 'feeder', exact: true }).waitFor();
  assert.equal(await eva.getByLabel('Target', { exact: true }).inputValue(), '43');
  await eva.context().close();
});
