// A latched stop on the overview, as tile and as row, and on the page of the axis: who has stopped it, and what has to be done by whom to move it again.
// In: the program, a script that moves an axis, a page that stops it, a lease that ends. Out: what three pages say; pictures under build/browser.
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { becomes, launch, open, shot, tileOf, until } from './lib/browser.mjs';
import { Program } from './lib/program.mjs';

let program, browser, tiles, rows, own;
before(async () => {
  program = await Program.start();
  browser = await launch();
  [tiles, rows, own] = await Promise.all(['/', '/', '/axes/feeder'].map((path) => open(browser, program.url + path, { viewport: { width: 1440, height: 900 } })));
  await rows.getByRole('button', { name: 'List', exact: true }).click();
  for (const p of [tiles, rows, own]) await p.locator('[data-axis=feeder] [data-live=true]').first().waitFor();
});
after(async () => {
  await browser?.close();
  await program?.end();
});

const notice = (p) => tileOf(p, 'feeder').text('notice');
const moves = async (lease_s) => {
  await program.command('feeder', { command: 'enable' });
  await until('enabled', async () => (await program.axis('feeder')).state === 'operation_enabled');
  if (lease_s) await program.call('PUT', '/axes/feeder/authority', { ttl_s: lease_s });
  await program.command('feeder', { command: 'move_velocity', velocity: 5, acceleration: 100 });
  await until('it moves', async () => (await program.axis('feeder')).moving);
};
const person = 'Enable it and order a new motion.';
const controller = 'A controller that repeats its words does not move it: it has to change them.';

test('a stop from one page is told by its name on all of them, until a new motion', async () => {
  await moves();
  for (const p of [tiles, rows, own]) assert.doesNotMatch(await notice(p), /Stopped by/);
  await tiles.getByRole('button', { name: 'Halt feeder' }).click();
  await becomes('the page that stopped', () => notice(tiles), `Stopped by this page. ${person}`);
  await becomes('a row of another page', () => notice(rows), `Stopped by 127.0.0.1 (http). ${person}`);
  await becomes('the page of the axis says all of it', () => notice(own), `Stopped by 127.0.0.1 (http). ${person} ${controller}`);
  const { stop_latch: bits, stop_latch_by: by, stop_latch_text: text } = await program.axis('feeder');
  assert.equal(bits, 0b101);
  assert.match(by, /^http 127\.0\.0\.1 page-/);
  assert.ok(text.startsWith(`${by} has stopped it: `), text);
  for (const [p, name] of [[tiles, 'tiles'], [rows, 'rows'], [own, 'axis']]) await shot(p, `latch-${name}`);
  await moves(); // it was enabled still
  for (const p of [tiles, rows, own]) await until('it is let go', async () => !/Stopped by/.test(await notice(p)) || notice(p));
  assert.equal((await program.axis('feeder')).stop_latch, 0);
});

test('a stop of the gateway is told with the loss that made it', async () => {
  await moves(5);
  const words = `Stopped by the gateway (lease ended). ${person}`;
  for (const p of [tiles, rows]) await becomes('the loss is told', () => notice(p), words, 40_000);
  await becomes('on the page of the axis', () => notice(own), `${words} ${controller}`);
  await shot(own, 'latch-lease');
  for (const p of [tiles, rows, own]) assert.deepEqual(p.faults(), []);
});

test('in German', async () => {
  const p = await open(browser, program.url, { locale: 'de-DE' });
  await p.locator('[data-axis=feeder] [data-live=true]').first().waitFor();
  await until('it is told', async () => /^Gestoppt durch das Gateway \(.+\)\. Freigeben und eine neue Bewegung befehlen\.$/.test(await notice(p)) || notice(p));
  await p.context().close();
});
