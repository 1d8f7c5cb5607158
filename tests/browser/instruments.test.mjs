// The instruments of a commissioning engineer: the scope with its cursors, trigger and recording; the trace of a line, byte by byte; and a
// jog whose page dies.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { after, before, test } from 'node:test';
import { becomes, launch, open, shot, until } from './lib/browser.mjs';
import { Program, isMock } from './lib/program.mjs';

let program, browser;
before(async () => {
  program = await Program.start();
  browser = await launch();
});
after(async () => {
  await browser?.close();
  await program?.end();
});

const move = { command: 'move_relative', position: 20, velocity: 40, acceleration: 400, deceleration: 400 };
const arrived = () => until('it has arrived', async () => (await program.axis('feeder')).target_reached === true);

test('the scope: channels, a trigger that holds, cursors that read, a recording as a table', async () => {
  const page = await open(browser, `${program.url}/axes/feeder`);
  await page.locator('.scope canvas').waitFor();
  await program.command('feeder', { command: 'enable' });
  await until('enabled', async () => (await program.axis('feeder')).state === 'operation_enabled');
  await page.getByRole('group', { name: 'Time shown' }).getByRole('button', { name: '2 s' }).click();

  const start = (await program.axis('feeder')).position;
  const trigger = page.locator('.scope-trigger');
  await trigger.getByLabel('Trigger').selectOption('single');
  await trigger.locator('input').fill(String(Math.round(start + 10)));
  await until('it waits', async () => /Waiting/.test(await trigger.innerText()) || (await trigger.innerText()));
  await program.command('feeder', move);
  await arrived();
  await until('it holds', async () => /Held by the trigger/.test(await trigger.innerText()) || (await trigger.innerText()));

  const plot = await page.locator('.scope .u-over').boundingBox();
  await page.mouse.click(plot.x + plot.width * 0.1, plot.y + 20);
  await page.getByRole('group', { name: /^Cursor/ }).getByRole('button', { name: 'B', exact: true }).click();
  await page.mouse.click(plot.x + plot.width * 0.9, plot.y + 20);
  const table = page.locator('.cursor-table');
  const difference = async () => Number((await table.locator('tr').last().locator('td').nth(1).innerText()).replace('−', '-'));
  await until('the cursors have read the move', async () => Math.abs((await difference()) - 20) < 2 || (await difference()));
  // B by keys: to the very end of the picture and away again
  await page.locator('.scope-plot').focus();
  await page.keyboard.press('Home');
  await until('B is at the left edge', async () => Math.abs(await difference()) < 2 || (await difference()));
  await page.keyboard.press('End');
  await until('B is at the right edge', async () => Math.abs((await difference()) - 20) < 2 || (await difference()));
  await shot(page, 'scope-held', { fullPage: true });

  const [download] = await Promise.all([page.waitForEvent('download'), page.locator('.scope').getByRole('button', { name: 'CSV' }).click()]);
  const lines = readFileSync(await download.path(), 'utf8').trim().split('\r\n');
  assert.match(download.suggestedFilename(), /^feeder-.*\.csv$/);
  assert.match(lines[0], /^time,seconds,feeder\.position \[mm\],/);
  const positions = lines.slice(1).map((l) => Number(l.split(',')[2]));
  assert.ok(Math.max(...positions) - Math.min(...positions) > 15, `${positions.length} rows, ${Math.min(...positions)} to ${Math.max(...positions)}`);

  await page.locator('.scope').getByRole('button', { name: 'Velocity' }).click();
  await becomes('it is left out', () => page.locator('.scope').getByRole('button', { name: 'Velocity' }).getAttribute('aria-pressed'), 'false');
  assert.deepEqual(page.faults(), []);
  await page.context().close();
});

test('demand and following error: drawn, said to be computed, and growing while the shaft is held', async () => {
  const page = await open(browser, `${program.url}/axes/feeder`);
  await page.locator('.scope canvas').waitFor();
  const said = page.locator('[data-field=demand-source]');
  const trigger = page.locator('.scope-trigger');
  const channel = (name) => page.getByRole('group', { name: 'Channels' }).getByRole('button', { name, exact: true });
  /** Points of the plot, its sides left out, in the colour of a curve. */
  const drawn = (colour) =>
    page.evaluate((name) => {
      const probe = document.createElement('span');
      probe.style.color = `var(${name})`;
      document.body.append(probe);
      const wanted = getComputedStyle(probe).color.match(/\d+/g).map(Number);
      probe.remove();
      const canvas = document.querySelector('.scope canvas');
      const [outer, inner] = [canvas.getBoundingClientRect(), document.querySelector('.scope .u-over').getBoundingClientRect()];
      const k = canvas.width / outer.width;
      const { data } = canvas.getContext('2d').getImageData((inner.x - outer.x) * k, (inner.y - outer.y) * k, inner.width * k, inner.height * k);
      let n = 0;
      for (let i = 0; i < data.length; i += 4) if (data[i + 3] > 200 && [0, 1, 2].every((c) => Math.abs(data[i + c] - wanted[c]) < 24)) n += 1;
      return n;
    }, colour);
  // In closed loop the drive ends it after so many lost pulses: as many as it takes, so that there is something to be seen before.
  if (!isMock) assert.equal((await program.call('PUT', '/axes/feeder/parameters/QE%5B1%5D', { value: 60000 })).status, 200);
  await program.command('feeder', { command: 'enable' });
  await until('enabled', async () => (await program.axis('feeder')).state === 'operation_enabled');
  await page.getByRole('group', { name: 'Time shown' }).getByRole('button', { name: '2 s' }).click();
  for (const name of ['Velocity', 'Target']) if ((await channel(name).getAttribute('aria-pressed')) === 'true') await channel(name).click();
  assert.equal(await said.count(), 0, 'nothing is said of what is not shown');
  await program.command('feeder', { command: 'move_relative', position: 400, velocity: 40, acceleration: 400, deceleration: 400 });
  assert.deepEqual([await drawn('--series-4'), await drawn('--series-5')], [0, 0]);
  await channel('Following error').click();
  await until('the following error is drawn', async () => (await drawn('--series-5')) > 20 || (await drawn('--series-5')));
  await channel('Demand').click();
  await until('it says whose word it is', async () => /computed by the gateway from the order, not measured by the drive/.test(await said.innerText()) || (await said.innerText()));
  assert.equal(await said.getAttribute('data-source'), 'computed');

  await trigger.getByLabel('Trigger').selectOption('single');
  await trigger.getByLabel('when').selectOption('error');
  await trigger.locator('input').fill('5');
  await until('it follows', async () => Math.abs((await program.axis('feeder')).following_error) < 2 || (await program.axis('feeder')).following_error);
  assert.equal((await program.call('PATCH', '/drives/feeder/hand', { stall: true })).status, 200);
  await until('the drive has noticed', async () => (await program.axis('feeder')).state === 'fault' || (await program.axis('feeder')).following_error);
  await until('the trigger holds it', async () => /Held by the trigger/.test(await trigger.innerText()) || (await trigger.innerText()));
  await shot(page, 'scope-following-error', { fullPage: true });

  const [download] = await Promise.all([page.waitForEvent('download'), page.locator('.scope').getByRole('button', { name: 'CSV' }).click()]);
  const [head, ...rows] = readFileSync(await download.path(), 'utf8').trim().split('\r\n').map((l) => l.split(','));
  const column = (name) => {
    const at = head.indexOf(name);
    assert.ok(at >= 0, `${name} is not in ${head}`);
    return rows.map((r) => r[at]);
  };
  const error = column('feeder.following_error (computed) [mm]').map((t) => (t === '' ? null : Number(t)));
  column('feeder.position_demand (computed) [mm]').forEach((d, i) => assert.equal(d === '', error[i] === null));
  assert.deepEqual([...new Set(column('feeder.demand_source'))].filter(Boolean), ['computed']);
  const most = error.reduce((best, e, i) => (e !== null && e > (error[best] ?? 0) ? i : best), 0);
  assert.ok(error[most] > 10, `it grew to ${error[most]} mm only`);
  const begin = error.findLastIndex((e, i) => i < most && e !== null && e < 2);
  assert.ok(begin > 0 && begin < most, JSON.stringify(error));
  const grown = error.slice(begin, most + 1);
  assert.ok(grown.length > 3 && grown.every((e, i) => e !== null && (i === 0 || e >= grown[i - 1])), `it does not grow: ${grown}`);

  // The same by eye: a cursor a little behind the trigger's quarter.
  const plot = await page.locator('.scope .u-over').boundingBox();
  await page.mouse.click(plot.x + plot.width * 0.28, plot.y + 20);
  const titles = await page.locator('.cursor-table thead th').allInnerTexts();
  await until('the cursor reads 5 to 10 mm', async () => {
    const read = await page.locator('.cursor-table tbody tr').first().locator('th, td').allInnerTexts();
    const seen = Number(read[titles.findIndex((t) => t.startsWith('Following error'))].replace('−', '-'));
    return (seen > 5 && seen < 10) || seen;
  });

  await program.call('PATCH', '/drives/feeder/hand', { stall: false });
  await program.command('feeder', { command: 'reset_fault' });
  await program.command('feeder', { command: 'disable' });
  if (isMock) await until('nobody tells it while it is off', async () => /not known now/.test(await said.innerText()) || (await said.innerText()));
  assert.deepEqual(page.faults(), []);
  await page.context().close();
});

test('the trace: readings, filter, a frame byte by byte, pause', { skip: isMock && 'the stand-in crosses no line' }, async () => {
  const page = await open(browser, `${program.url}/lines/can0`);
  const rows = page.locator('.frame-list li');
  await rows.first().waitFor();
  await until('frames have readings', async () => (await page.locator('.frame-list .reading').allInnerTexts()).some((t) => t.length > 3));
  const filter = page.getByRole('searchbox', { name: /Filter frames/ });
  await page.getByRole('combobox', { name: 'Direction' }).selectOption('to');
  await becomes('those from the drive are left out', () => page.locator('.frame-list .from').count(), 0);
  await filter.fill('no such word');
  await page.getByText('No frame fits the filter.').waitFor();
  await filter.fill('');
  await page.getByRole('button', { name: 'Pause' }).click();
  await page.getByRole('button', { name: 'Paused' }).waitFor();
  const first = await rows.first().getAttribute('data-sequence');
  await rows.first().getByRole('button').click();
  const details = page.locator('.frame-details');
  await details.waitFor();
  assert.match(await details.innerText(), /Identifier[\s\S]*extended, 29 bits/);
  assert.ok((await details.locator('.byte-table tbody tr').count()) <= 8);
  await program.command('feeder', { command: 'halt' });
  await new Promise((r) => setTimeout(r, 500)); // time for frames to come that must not be shown
  assert.equal(await rows.first().getAttribute('data-sequence'), first);
  await shot(page, 'trace-details', { fullPage: true });
  await page.getByRole('button', { name: 'Paused' }).click();
  await until('it goes on', async () => (await rows.first().getAttribute('data-sequence')) !== first);
  await page.getByRole('switch', { name: /stall/i }).first().waitFor(); // the hand of the line's twins
  assert.deepEqual(page.faults(), []);
  await page.context().close();
});

test('a jog ends by itself when its page dies', { skip: isMock && 'the stand-in has no dead-man time-out' }, async () => {
  const page = await open(browser, `${program.url}/axes/feeder`);
  await page.getByRole('button', { name: 'Enable', exact: true }).click();
  await until('enabled', async () => (await program.axis('feeder')).state === 'operation_enabled');
  await page.getByRole('textbox', { name: 'Speed', exact: true }).fill('5');
  const jog = page.getByRole('button', { name: 'Jog feeder forward while held' });
  const box = await jog.boundingBox();
  await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
  await page.mouse.down();
  await until('it moves', async () => (await program.axis('feeder')).moving);
  // Longer than the time-out: it is renewed.
  const begun = Date.now();
  while (Date.now() - begun < 2000) {
    assert.equal((await program.axis('feeder')).moving, true, `it stopped ${Date.now() - begun} ms after the button was pressed`);
    await new Promise((r) => setTimeout(r, 100));
  }
  await page.context().setOffline(true); // no word from this page reaches the gateway any more, not even the halt
  await until('the gateway has halted it', async () => !(await program.axis('feeder')).moving);
  await until('the reason is kept', async () => {
    const events = (await program.call('GET', '/events?axis=feeder&limit=20')).body;
    return events.some((e) => e.kind === 'hold' && /not renewed/.test(e.text)) || events.map((e) => e.text);
  });
  await page.context().close();
});
