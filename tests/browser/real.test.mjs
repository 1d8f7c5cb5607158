// A drive on a line of its own, played by `axisgate twin` on the far side of a TCP connection: for the gateway it is real, and the page
// says so. When it is pulled out, its axis alone is lost, with the reason; when it is back, all heals.
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { becomes, launch, open, shot, tileOf, until } from './lib/browser.mjs';
import { freePort, isMock, Process, Program } from './lib/program.mjs';

if (isMock) {
  console.log('the mock knows no lines: the tests with a drive on a line are left out');
} else {
  let program, browser, page, drive, port;
  const plugIn = () => Process.run(['twin', 'uim342', '--line', `tcp-listen:127.0.0.1:${port}`], /^ready /m);
  before(async () => {
    port = await freePort();
    drive = await plugIn();
    program = await Program.start({
      site: {
        lines: [{ name: 'can0', uri: 'twin', family: 'uim342' }, { name: 'bench', uri: `tcp:127.0.0.1:${port}`, family: 'uim342' }],
        drives: [{ name: 'feeder', line: 'can0', address: 5, presence: 'auto' }, { name: 'press', line: 'bench', address: 5, presence: 'device' }],
        axes: [
          { name: 'feeder', drive: 'feeder', channel: 1, number: 1, unit: 'mm', increments_per_unit: 3200 },
          { name: 'press', drive: 'press', channel: 1, number: 2, unit: 'mm', increments_per_unit: 1000 },
        ],
        mappings: [],
      },
    });
    browser = await launch();
    page = await open(browser, program.url);
  });
  after(async () => {
    await browser?.close();
    await program?.end();
    await drive?.stop();
  });
  const condition = (name) => tileOf(page, name).tile.getAttribute('data-condition');

  test('real and simulated are told apart in words', async () => {
    await until('the drive is live', async () => (await condition('press')) === 'live' || (await condition('press')));
    assert.equal(await tileOf(page, 'press').text('mark'), 'REAL');
    await becomes('the other is simulated', () => tileOf(page, 'feeder').text('mark'), 'SIMULATED');
    const line = page.locator('[data-drive=press]');
    await until('its line says so too', async () => /Real drive/.test(await line.innerText()) || (await line.innerText()));
    await shot(page, 'real-and-simulated');
  });

  test('there is no hand for a real drive', async () => {
    await page.goto(`${program.url}/axes/press/simulation`);
    await page.getByText('This drive is not simulated now').waitFor();
    await page.goto(program.url);
    await page.locator('[data-axis=press]').waitFor();
  });

  test('a real drive is compared with its twin, a value that differs is shown, and the twin adopts what the drive holds', async () => {
    assert.equal((await program.call('PUT', '/axes/press/parameters/AC', { value: 4321 })).status, 200);
    await page.goto(`${program.url}/axes/press/simulation`);
    await page.getByRole('button', { name: 'Compare with the twin' }).click();
    const row = page.locator('[data-compared=AC]');
    await row.waitFor({ timeout: 60_000 });
    assert.match(await row.innerText(), /4321.*differs/s);
    await until('it is summed up', async () => /values read, differences: 1\b/.test(await page.locator('[data-field=compare-drive-told]').innerText()));
    await shot(page, 'drive-compared');
    await page.getByRole('button', { name: 'Adopt in the twin' }).click();
    await until('the adoption is told', async () => /were adopted/.test(await page.locator('[data-field=compare-drive-told]').innerText()));
    assert.equal((await program.call('GET', '/axes/press/parameters/AC')).body.value, 4321, 'nothing is written to the drive');
    await page.goto(`${program.url}/axes/feeder/simulation`);
    await page.getByRole('button', { name: 'Compare with the twin' }).click();
    await until('a simulated drive is refused', async () => /is simulated now/.test(await page.locator('[data-field=compare-drive-told]').innerText()));
    await page.goto(program.url);
    await page.locator('[data-axis=press]').waitFor();
  });

  test('a drive that is pulled out costs its own axis alone, and the reason is told', async () => {
    await drive.stop('SIGKILL');
    const press = tileOf(page, 'press');
    await until('its axis is offline', async () => (await condition('press')) === 'offline' || (await condition('press')), 15_000);
    assert.match(await press.text('notice'), /^Offline: .{5,}/);
    assert.match(await press.text('state'), /Offline/);
    await until('its line is down', async () => /Down/.test(await page.locator('[data-line=bench]').innerText()));
    assert.equal(await condition('feeder'), 'live');
    assert.equal(await page.locator('[data-field=connection]').innerText(), 'Live');
    await shot(page, 'drive-pulled-out');
  });

  test('a command for it is refused in words', async () => {
    await page.getByRole('button', { name: 'Enable press' }).click();
    await until('it is refused', async () => /refused|failed/.test(await tileOf(page, 'press').result()) || (await tileOf(page, 'press').result()));
  });

  test('it heals when the drive is plugged in again', async () => {
    drive = await plugIn();
    await until('its axis is live', async () => (await condition('press')) === 'live' || (await condition('press')), 40_000);
    assert.deepEqual(page.faults(), []);
  });
}
