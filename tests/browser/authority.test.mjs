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
  const who = a.locator('[data-field=who]');
  await until('it is said who one is', async () => /local access, engineer/.test(await who.innerText()) || (await who.innerText()));
  await held(a, /Nobody holds it/);
  await bar(a).getByRole('button', { name: 'Take', exact: true }).click();
  await held(a, /Held by this page, \d+ s left/);
  await held(b, /Held by 127\.0\.0\.1, \d+ s left/);
  await b.getByRole('button', { name: 'Enable', exact: true }).click();
  await until('the refusal is told', async () => { const t = await b.locator('.result').first().innerText(); return /refused.*127\.0\.0\.1/is.test(t) || t; });
  await bar(b).getByRole('button', { name: 'Take over' }).click();
  await held(b, /Held by this page/);
  await held(a, /Held by 127\.0\.0\.1/);
  await until('"Taken." is not said any more', async () => /has it now/.test(await a.locator('[data-field=authority-told]').innerText()));
  await a.getByRole('button', { name: 'Stop feeder' }).click();
  await until('a stop is taken from anybody', async () => /accepted/i.test(await a.locator('.result').first().innerText()));
  await bar(b).getByRole('button', { name: 'Release' }).click();
  await held(a, /Nobody holds it/);
  assert.deepEqual([...a.faults(), ...b.faults()], []);
  await a.context().close();
  await b.context().close();
});

test('the holder hands the axis over, to a client of the list or a typed one', async () => {
  const a = await open(browser, `${program.url}/axes/feeder`);
  await bar(a).getByRole('button', { name: 'Take', exact: true }).click();
  await held(a, /Held by this page/);
  await program.call('PUT', '/axes/slide.x/authority', { ttl_s: 60 });
  await bar(a).getByRole('button', { name: 'Hand over …' }).click();
  const form = a.getByRole('form', { name: 'Hand feeder over' });
  await form.getByRole('button', { name: 'http 127.0.0.1', exact: true }).waitFor(); // any client of this host; its pages stand beside it
  await form.getByLabel('To').fill('modbus 127.0.0.1');
  await form.getByRole('button', { name: 'Hand over', exact: true }).click();
  await held(a, /Held by 127\.0\.0\.1[^]*Handed over to modbus 127\.0\.0\.1\./);
  await bar(a).getByRole('button', { name: 'Take over' }).click();
  await bar(a).getByRole('button', { name: 'Release' }).click();
  await held(a, /Nobody holds it/);
  assert.deepEqual(a.faults(), []);
  await a.context().close();
});

test('the Modbus door tells its rules, and is made read-only and writable again', async () => {
  const a = await open(browser, `${program.url}/gateway`);
  const writing = a.locator('[data-field=modbus-writing]');
  await until('it is told', async () => (await writing.innerText()) === 'allowed');
  assert.match(await a.locator('[data-field=modbus-functions]').innerText(), /all that the door knows|3 read holding registers/);
  assert.match(await a.locator('[data-field=modbus-allow]').innerText(), /\S/);
  await a.getByRole('button', { name: 'Make it read-only' }).click();
  await until('it is read-only', async () => /read-only/.test(await writing.innerText()));
  assert.equal((await program.call('GET', '/modbus')).body.read_only, true);
  await a.getByRole('button', { name: 'Allow writing' }).click();
  await until('it is not', async () => (await writing.innerText()) === 'allowed');
  assert.deepEqual(a.faults(), []);
  await a.context().close();
});

test('a duplicated tab is a client of its own, a reload is not', async () => {
  const a = await open(browser, `${program.url}/axes/feeder`);
  await bar(a).getByRole('button', { name: 'Take', exact: true }).click();
  await held(a, /Held by this page/);
  // The new tab begins with a copy of the first one's session, as one does that was duplicated.
  const [b] = await Promise.all([a.waitForEvent('popup'), a.evaluate(() => void globalThis.open(location.href))]);
  const names = () => Promise.all([a, b].map((p) => p.evaluate(() => sessionStorage.getItem('axisgate.client'))));
  await held(b, /Held by 127\.0\.0\.1/);
  const [first, second] = await names();
  assert.match(second, /^page-/);
  assert.notEqual(first, second);
  await b.getByRole('button', { name: 'Enable', exact: true }).click();
  await until('the copy is refused', async () => { const t = await b.locator('.result').first().innerText(); return /refused.*127\.0\.0\.1/is.test(t) || t; });
  await a.reload();
  await held(a, /Held by this page/);
  assert.deepEqual(await names(), [first, second]);
  await bar(a).getByRole('button', { name: 'Release' }).click();
  await held(b, /Nobody holds it/);
  assert.deepEqual(a.faults(), []);
  await a.context().close();
});

test('nothing moves when somebody takes an axis, on its tile and on its page', async () => {
  const hold = (method, body) => fetch(`${program.url}/api/v1/axes/feeder/authority`, { method, headers: { 'content-type': 'application/json', 'x-client': 'hmi' }, ...(body ? { body } : {}) });
  const places = (p) => p.evaluate(() => [...document.querySelectorAll('main button, main input, main .tile, main .tile-foot, main h2, main h3')].filter((e) => e.offsetParent !== null && !e.closest('.authority')).map((e) => {
    const r = e.getBoundingClientRect();
    return [e.getAttribute('aria-label') ?? (e.matches('h2, h3, button') ? e.textContent : e.className), Math.round(r.x), Math.round(r.y + scrollY), Math.round(r.width), Math.round(r.height)].join(' ');
  }));
  for (const [path, width] of [['/', 1440], ['/', 390], ['/axes/feeder', 1440], ['/axes/feeder', 390]]) {
    const p = await open(browser, program.url + path, { viewport: { width, height: 900 } });
    await p.locator('[data-axis=feeder] [data-live=true]').first().waitFor();
    // The events at the end of a page grow; what stands above them may not move.
    const still = async () => (await places(p)).filter((t) => !/Events|Write|Read /.test(t));
    const before = await still();
    const words = p.locator('[data-axis=feeder] [data-field=authority]').first();
    await hold('PUT', '{"ttl_s":600}');
    await until('it is told', async () => /Held by/.test(await words.innerText()));
    assert.deepEqual(await still(), before, `${path} ${width}`);
    const whole = await words.evaluate((e) => { const r = e.getBoundingClientRect(); const f = e.closest('.tile-foot, .authority').getBoundingClientRect(); return r.top >= f.top && r.bottom <= f.bottom; });
    assert.equal(whole, true, 'the holder is in sight');
    await hold('DELETE');
    await until('it is free', async () => !/Held by/.test(await words.innerText()));
    assert.deepEqual(await still(), before);
    await p.context().close();
  }
});

test('pictures of a held axis', async () => {
  await fetch(`${program.url}/api/v1/axes/feeder/authority`, { method: 'PUT', headers: { 'content-type': 'application/json', 'x-client': 'hmi' }, body: '{"ttl_s":600}' });
  await pictures(browser, program.url, '/', 'authority-tiles', (p) => p.locator('[data-axis=feeder] [data-field=authority]').waitFor());
  await pictures(browser, program.url, '/axes/feeder', 'authority-axis', (p) => p.getByRole('button', { name: 'Take over' }).waitFor());
});
