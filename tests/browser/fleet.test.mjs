// The fleet page over two real gateways of one domain: states, ages, a command to an axis of the other one, its loss and its namesake.
// In: the program, three times. Out: pictures under build/browser.
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { becomes, launch, open, pictures, until } from './lib/browser.mjs';
import { Program } from './lib/program.mjs';

const domain = 10 + Math.floor(Math.random() * 60);
const member = (name) => Program.start({ set: ['dds.enabled=true', `dds.domain=${domain}`, `dds.name=${name}`] });
let here, there, browser, page;
const axis = (at) => page.locator(`[data-axis="${at}"]`);
const text = async (at, field) => (await axis(at).locator(`[data-field="${field}"]`).innerText()).trim();
const result = (at) => axis(at).locator('.result').innerText();

before(async () => {
  [here, there] = [await member('hall-1'), await member('hall-2')];
  browser = await launch();
  page = await open(browser, `${here.url}/`);
});
after(async () => {
  await browser?.close();
  await here?.end();
  await there?.end();
});

test('the page is named in the navigation, and shows every gateway with its axes', async () => {
  await page.getByRole('navigation', { name: 'Pages' }).getByRole('link', { name: 'Fleet' }).click();
  await axis('hall-2/feeder').waitFor();
  await until('the other one is live', async () => /Simulated|SIMULATED/.test(await axis('hall-2/feeder').innerText()) || (await axis('hall-2/feeder').innerText()));
  assert.match(await page.locator('[data-gateway="hall-2"] [data-field=heard]').innerText(), /heard/);
  assert.equal(await page.locator('[data-gateway="hall-2"] a').getAttribute('href'), `${there.url}/`);
  assert.equal(await axis('hall-1/feeder').count(), 1);
});

test('an axis of the other gateway is enabled, moved and stopped, and the page tells each result', async () => {
  const at = 'hall-2/feeder';
  await page.getByRole('button', { name: `Command ${at}` }).click();
  await page.getByRole('button', { name: `Enable ${at}` }).click();
  await until('it is enabled', async () => /^Enable: done/.test(await result(at)) || (await result(at)));
  await page.getByLabel(`Target of ${at}`, { exact: true }).fill('x');
  await page.getByRole('button', { name: `Move to target of ${at}` }).click();
  assert.match(await result(at), /Target: .*not a number/);
  await page.getByLabel(`Target of ${at}`, { exact: true }).fill('7');
  await page.getByLabel(`Speed of ${at}`, { exact: true }).fill('30');
  await page.getByRole('button', { name: `Move to target of ${at}` }).click();
  await until('it has moved', async () => /^Move to 7 .*: done/.test(await result(at)) || (await result(at)));
  assert.equal((await there.axis('feeder')).position, 7);
  assert.equal((await here.axis('feeder')).position, 0);
  await becomes('the page shows it', async () => Number(await axis(at).locator('[data-field=position]').getAttribute('data-value')), 7);
  await page.getByLabel(`Target of ${at}`, { exact: true }).fill('60');
  await page.getByLabel(`Speed of ${at}`, { exact: true }).fill('5');
  await page.getByRole('button', { name: `Move to target of ${at}` }).click();
  await until('it moves', async () => /Moving/.test(await text(at, 'motion')) || (await text(at, 'motion')));
  await page.getByRole('button', { name: `Stop ${at}` }).click();
  await until('it stands', async () => !(await there.axis('feeder')).moving);
  assert.ok((await there.axis('feeder')).position < 60);
  await until('the stop is told', async () => /Stop: accepted/.test(await result(at)) || (await result(at)));
  assert.deepEqual(page.faults(), []);
});

test('a refusal of the other gateway is told in its words, and moves no stop', async () => {
  const stops = () => page.evaluate(() => [...document.querySelectorAll('.fleet-axis .stop')].map((b) => [b.getAttribute('aria-label'), b.getBoundingClientRect().y + scrollY].join(' ')));
  const at = 'hall-2/slide.x';
  await page.getByRole('button', { name: `Command ${at}` }).click();
  await page.getByLabel(`Target of ${at}`, { exact: true }).fill('3');
  const before = await stops();
  assert.ok(before.length >= 4, before.join('; '));
  await page.getByRole('button', { name: `Move to target of ${at}` }).click();
  await until('it is refused', async () => /refused\./.test(await result(at)) || (await result(at)));
  assert.deepEqual(await stops(), before);
  // Nor does the word that the gateway of this page is gone.
  await page.route('**/api/v1/fleet**', (r) => r.fulfill({ status: 503, contentType: 'application/problem+json', body: JSON.stringify({ type: 'about:blank', title: 'x', status: 503, detail: 'no fleet for a reason that takes some words to tell. '.repeat(8), reason: 'busy' }) }));
  await page.locator('[data-field=fleet-fault]').waitFor();
  assert.deepEqual(await stops(), before);
  await page.unroute('**/api/v1/fleet**');
  await page.locator('[data-field=fleet-fault]').waitFor({ state: 'detached' });
});

test('pictures, accessibility', async () => {
  await pictures(browser, here.url, '/fleet', 'fleet', async (p) => {
    await p.locator('[data-axis="hall-2/feeder"]').waitFor();
    await p.getByRole('button', { name: 'Command hall-2/feeder' }).click();
    await p.getByRole('button', { name: 'Enable hall-2/feeder' }).waitFor();
  });
});

test('two of one name are told apart; the lost one is told within its lease, with the age of what it said', async () => {
  const twin = await member('hall-2');
  try {
    await until('both say it', async () => (await page.locator('[data-gateway="hall-2"] [data-field=namesake]').count()) === 2);
    const both = await page.locator('[data-gateway="hall-2"]').evaluateAll((all) => all.map((e) => e.dataset.instance));
    assert.notEqual(both[0], both[1]);
  } finally {
    await twin.end();
  }
  await until('the other one has no namesake any more', async () => (await page.locator('[data-gateway="hall-2"][data-alive=true] [data-field=namesake]').count()) === 0);
  await there.stop('SIGKILL');
  await becomes('none of the name is alive', () => page.locator('[data-gateway="hall-2"][data-alive=true]').count(), 0);
  await until('its axis is not live', async () => /Was |Not live/.test(await axis('hall-2/feeder').first().innerText()) || (await axis('hall-2/feeder').first().innerText()));
  await until('its words have an age', async () => /s old/.test(await axis('hall-2/feeder').first().innerText()) || (await axis('hall-2/feeder').first().innerText()), 15_000);
  await pictures(browser, here.url, '/fleet', 'fleet-lost', (p) => p.locator('[data-gateway="hall-2"]').first().waitFor());
});
