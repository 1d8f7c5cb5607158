// The loss of the gateway: shown at once, nothing old is shown as live, and it heals by itself when the gateway is back.
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { becomes, launch, open, shot, tileOf, until } from './lib/browser.mjs';
import { Program } from './lib/program.mjs';

let program, browser, page, feeder;
before(async () => {
  program = await Program.start();
  browser = await launch();
  page = await open(browser, program.url);
  feeder = tileOf(page, 'feeder');
  await feeder.tile.locator('[data-live=true]').waitFor();
});
after(async () => {
  await browser?.close();
  await program?.end();
});

const trust = () => feeder.tile.getAttribute('data-condition');
let attempts = []; // when the page tried to connect again, since the loss
const attempted = () => attempts.push(Date.now());

test('the loss is shown within a second, and every value is said to be old', async () => {
  page.expectLoss(true);
  page.on('websocket', attempted);
  await program.stop('SIGKILL');
  await until('the loss is shown', async () => (await trust()) === 'disconnected' || (await trust()), 1_000);
  assert.match(await page.locator('[data-field=strip]').innerText(), /Connection lost\..*last known/s);
  // Between two attempts: while one is on its way, it says that it connects.
  await becomes('it is said', () => page.locator('[data-field=connection]').innerText(), 'Not connected', 5_000);
  assert.equal(await page.locator('[data-live=true]').count(), 0);
  assert.match(await feeder.text('position'), /^Last known position, not live/);
  assert.match(await feeder.text('notice'), /^Not live: last known/);
  assert.match(await feeder.text('state'), /Was /);
  await shot(page, 'connection-lost');
});

test('a stop that cannot be delivered is said loudly; a move is not even sent', async () => {
  await page.keyboard.press('Escape');
  await until('the failure is told', async () => /NOT confirmed/.test(await page.locator('[data-field=strip]').innerText()));
  await page.getByRole('textbox', { name: 'Target of feeder' }).fill('5');
  await page.getByRole('button', { name: 'Move to target of feeder' }).click();
  await until('it is told', async () => /not sent/.test(await feeder.result()) || (await feeder.result()));
});

test('the pauses between attempts grow', async () => {
  await until('there were four attempts', async () => attempts.length >= 4 || attempts.length, 20_000);
  page.off('websocket', attempted);
  const pauses = attempts.slice(1, 4).map((at, i) => at - attempts[i]); // 1, 2 and 4 s, each spread by a fifth
  assert.ok(pauses[0] > 700, `${pauses} ms`);
  for (const i of [1, 2]) assert.ok(pauses[i] > 1.2 * pauses[i - 1], `${pauses} ms`);
});

test('it heals by itself when the gateway is back, and what was typed is still there', async () => {
  await program.run();
  await until('it is live again', async () => (await trust()) === 'live' || (await trust()), 15_000);
  page.expectLoss(false);
  assert.equal(await page.locator('[data-field=connection]').innerText(), 'Live');
  assert.equal(await page.getByRole('textbox', { name: 'Target of feeder' }).inputValue(), '5');
  await program.command('feeder', { command: 'enable' });
  const begin = await feeder.position();
  await program.command('feeder', { command: 'move_relative', position: 3, velocity: 20 });
  await until('the position is live', async () => (await feeder.position()) > begin + 2.9 || (await feeder.position()));
  assert.deepEqual(page.faults(), []);
});

test('an orderly stop of the gateway is told as such', async () => {
  page.expectLoss(true);
  // Everything that the strip says, since what the next attempt meets takes its place half a second later.
  await page.evaluate(() => {
    globalThis.told = [];
    new MutationObserver(() => globalThis.told.push(document.querySelector('[data-field=strip]').textContent)).observe(document.body, { subtree: true, childList: true, characterData: true });
  });
  await program.stop('SIGTERM');
  await until('the loss is shown', async () => (await trust()) === 'disconnected', 3_000);
  const told = await page.evaluate(() => globalThis.told);
  assert.ok(told.some((t) => /Connection lost\..*The gateway stops\./.test(t)), told.join('\n'));
  await program.run();
  await page.getByRole('button', { name: 'Try now' }).click({ timeout: 2_000 }).catch(() => undefined); // it may have healed already
  await until('it is live again', async () => (await trust()) === 'live', 15_000);
  page.expectLoss(false);
});

test('a drive that falls silent costs its own axis alone', async () => {
  const other = () => tileOf(page, 'slide.x').tile.getAttribute('data-condition');
  await until('both axes are live', async () => ((await trust()) === 'live' && (await other()) === 'live') || [await trust(), await other()], 5_000);
  // All that the other axis is called from now on, also between two looks.
  await page.evaluate(() => {
    const tile = document.querySelector('[data-axis="slide.x"]');
    globalThis.called = [tile.dataset.condition];
    new MutationObserver(() => globalThis.called.push(tile.dataset.condition)).observe(tile, { attributeFilter: ['data-condition'] });
  });
  const answer = await program.call('PATCH', '/drives/feeder/hand', { power: false });
  assert.equal(answer.status, 200, JSON.stringify(answer.body));
  await until('the axis is not live any more', async () => (await trust()) !== 'live' || 'live', 15_000);
  await until('its drive is given up', async () => (await trust()) === 'offline' || (await trust()), 15_000);
  await shot(page, 'drive-silent');
  await program.call('PATCH', '/drives/feeder/hand', { power: true });
  await until('the axis is back', async () => (await trust()) === 'live' || (await trust()), 20_000);
  assert.deepEqual(await page.evaluate(() => [...new Set(globalThis.called)]), ['live']);
});

test('a gateway that hangs without closing anything: nothing is shown as live 1.5 s later, and is again with its next word', async () => {
  await until('it is live', async () => (await trust()) === 'live', 15_000);
  // Once a second something comes even when nothing changes; the bound counts from the last of it.
  const begin = Date.now();
  let took = 0;
  program.process.child.kill('SIGSTOP');
  try {
    await until('it is not live', async () => (await page.locator('[data-live=true]').count()) === 0, 3_000);
    took = Date.now() - begin;
    assert.match(await page.locator('[data-field=strip]').innerText(), /No answer from the gateway\..*last known/s);
    assert.equal(await page.locator('.result-good').count(), 0);
  } finally {
    program.process.child.kill('SIGCONT');
  }
  await until('it is live again', async () => (await trust()) === 'live', 5_000);
  assert.ok(took < 1_700, `${took} ms`);
});
