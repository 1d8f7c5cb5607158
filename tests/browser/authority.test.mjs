// Authority on the page of the real program: two pages and one axis: taking, refusing, taking over, releasing; local access is told in the head.
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { launch, open, pictures, until } from './lib/browser.mjs';
import { Program } from './lib/program.mjs';

let program, browser;
before(async () => {
  program = await Program.start();
  browser = await launch();
});
after(async () => {
  await browser?.close();
  await program?.end();
});
const bar = (p) => p.getByRole('group', { name: 'Authority over feeder' });
const held = (p, words) => until(`"${words}" is shown`, async () => { const t = await bar(p).innerText(); return words.test(t) || t; });

test('one page holds the axis, the other is refused with the name of the holder, takes it over, and gives it back', async () => {
  const a = await open(browser, `${program.url}/axes/feeder`);
  const b = await open(browser, `${program.url}/axes/feeder`);
  assert.match(await a.locator('[data-field=who]').innerText(), /local access, engineer/);
  await held(a, /Nobody holds it/);
  await bar(a).getByRole('button', { name: 'Take', exact: true }).click();
  await held(a, /Held by this page, \d+ s left/);
  await held(b, /Held by 127\.0\.0\.1, \d+ s left/);
  await b.getByRole('button', { name: 'Enable', exact: true }).click();
  await until('the refusal is told', async () => { const t = await b.locator('.result').first().innerText(); return /refused.*127\.0\.0\.1/is.test(t) || t; });
  await bar(b).getByRole('button', { name: 'Take over' }).click();
  await held(b, /Held by this page/);
  await held(a, /Held by 127\.0\.0\.1/);
  await a.getByRole('button', { name: 'Stop feeder' }).click();
  await until('a stop is taken from anybody', async () => /accepted/i.test(await a.locator('.result').first().innerText()));
  await bar(b).getByRole('button', { name: 'Release' }).click();
  await held(a, /Nobody holds it/);
  assert.deepEqual([...a.faults(), ...b.faults()], []);
  await a.context().close();
  await b.context().close();
});

test('pictures of a held axis and of the users page', async () => {
  await fetch(`${program.url}/api/v1/axes/feeder/authority`, { method: 'PUT', headers: { 'content-type': 'application/json', 'x-client': 'hmi' }, body: '{"ttl_s":600}' });
  await pictures(browser, program.url, '/', 'authority-tiles', (p) => p.locator('[data-axis=feeder] [data-field=authority]').waitFor());
  await pictures(browser, program.url, '/axes/feeder', 'authority-axis', (p) => p.getByRole('button', { name: 'Take over' }).waitFor());
  await pictures(browser, program.url, '/users', 'users', (p) => p.getByRole('heading', { name: 'Tokens' }).waitFor());
});
