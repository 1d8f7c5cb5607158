// The site's part of the page: a tree with ports of the machine and a calculator, the end of the wizard, help beside fields; the words of an axis bit by
// bit. In: the program. Out: counts; pictures under build/browser.
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { becomes, open, shot, tileOf, until } from './lib/browser.mjs';
import { start } from './lib/machine.mjs';
import { isMock, Program } from './lib/program.mjs';

let program, browser, page;
before(async () => void ({ program, browser, page } = await start()));
after(async () => {
  await browser?.close();
  await program?.end();
});

test('the site is a tree: line, drives on it, axes of them, each with its state; a line folds', async () => {
  await page.goto(`${program.url}/site`);
  const line = page.locator('[data-entry="lines/can0"]');
  const under = (e) => e.locator('[data-entry]').evaluateAll((l) => l.map((x) => x.dataset.entry));
  await becomes('all of it is below the line', () => under(line), ['drives/d5', 'axes/lift', 'drives/d6', 'axes/feeder', 'drives/d7', 'axes/slide.x', 'drives/d8', 'axes/axis10']);
  assert.deepEqual(await under(line.locator('[data-entry="drives/d6"]')), ['axes/feeder']);
  const state = (e) => page.locator(`[data-entry="${e}"] > .tree-row [data-field=tree-state] .pill-text`).innerText();
  await becomes('states', async () => [await state('lines/can0'), await state('drives/d6'), await state('axes/axis10')], ['Up', 'Simulated', 'Disabled']);
  await program.command('axis10', { command: 'enable' });
  await becomes('it is live', () => state('axes/axis10'), 'Enabled');
  await program.command('axis10', { command: 'disable' });
  const fold = line.getByRole('button', { name: 'What is on can0' });
  await fold.click();
  assert.deepEqual(await under(line), []);
  assert.match(await line.innerText(), /4 drives, 4 axes/);
  await fold.press('Enter');
  await becomes('it is there again', async () => (await under(line)).length, 8);
  await line.getByRole('button', { name: 'New axis of d6' }).click();
  const form = page.getByRole('form', { name: 'Add an axis' });
  await becomes('the drive is chosen', () => form.getByLabel('Drive', { exact: true }).inputValue(), 'd6');
  await form.getByRole('button', { name: 'Cancel' }).click();
  await shot(page, 'shape-tree', { fullPage: true });
});

test('ports of the machine are offered to choose from, and the rest of the URI stays', { skip: isMock && 'the stand-in has no machine' }, async () => {
  const ports = [
    { kind: 'can', name: 'can7', uri: 'can:can7', text: 'mcp251x', up: false, line: null },
    { kind: 'serial', name: 'ttyUSB0', uri: 'serial:/dev/serial/by-id/usb-FTDI_FT232R-if00-port0', text: 'FTDI FT232R USB UART', up: true, line: null },
  ];
  await page.route('**/api/v1/host/ports', (r) => r.fulfill({ status: 200, contentType: 'application/json', body: JSON.stringify(ports) }));
  await page.getByRole('button', { name: 'Add a line' }).click();
  const form = page.getByRole('form', { name: 'Add a line' });
  const port = form.getByLabel('Port of this machine');
  await port.selectOption('can:can7');
  await becomes('the URI is the port', () => form.getByLabel('URI').inputValue(), 'can:can7');
  await form.getByText('The interface is switched off').waitFor();
  await form.getByLabel('URI').fill('serial:/dev/ttyUSB9?baud=19200&rs485=1');
  await becomes('serial ports alone', () => port.locator('option').allInnerTexts(), ['as typed', 'ttyUSB0 · FTDI FT232R USB UART']);
  await port.selectOption(ports[1].uri);
  await becomes('bit rate and form stay', () => form.getByLabel('URI').inputValue(), `${ports[1].uri}?baud=19200&rs485=1`);
  await page.unroute('**/api/v1/host/ports');
  await form.getByRole('button', { name: 'Look again' }).click();
  // What this machine really has, which may be nothing.
  const own = (await program.call('GET', '/host/ports')).body.filter((p) => p.kind === 'serial').length;
  await (own === 0 ? form.getByText('This machine has no serial port now.') : form.getByLabel('Port of this machine')).waitFor();
  await form.getByRole('button', { name: 'Cancel' }).click();
});

test('increments per unit are worked out from motor, gear and pitch', async () => {
  await page.getByRole('button', { name: 'Change axis feeder' }).click();
  const form = page.getByRole('form', { name: 'Change axis feeder' });
  await form.getByText('Work it out from motor, gear and screw').click();
  await form.getByLabel('Micro-steps').fill('32');
  await form.getByLabel('Gear: motor turns').fill('5');
  await form.getByLabel('Travel per output turn, mm').fill('0');
  await form.getByText('A number above 0.').waitFor();
  assert.equal(await form.getByRole('button', { name: 'Take this number' }).isDisabled(), true);
  await form.getByLabel('Travel per output turn, mm').fill('4');
  await form.getByText('8000 increments per mm').waitFor();
  await form.getByRole('button', { name: 'Take this number' }).click();
  await becomes('it is taken', () => form.getByLabel('Increments per unit', { exact: true }).inputValue(), '8000');
  await form.getByLabel('Counted in').selectOption('counts');
  await form.getByText('5120 increments per mm').waitFor();
  await shot(page, 'shape-increments', { fullPage: true });
  await form.getByRole('button', { name: 'Cancel' }).click();
});

test('the wizard: names to keep, the question after the first move, and how the HMI reads the axis', async () => {
  const empty = await Program.start({ site: null });
  const p = await open(browser, `${empty.url}/site`, { permissions: ['clipboard-read', 'clipboard-write'] });
  try {
    const wizard = (n) => p.locator(`.wizard[data-step="${n}"]`);
    await wizard(1).waitFor();
    await p.getByLabel('CAN', { exact: true }).check();
    await becomes('the interface is its name', () => p.getByLabel('Name').inputValue(), 'can0');
    await p.getByLabel('No drive yet: simulate it').check();
    await p.getByLabel('Family').selectOption('uim342');
    await p.getByLabel('Name').press('Enter');
    await wizard(2).waitFor();
    assert.equal(await p.getByLabel('Name').inputValue(), 'feeder1');
    await p.getByLabel('Name').press('Enter');
    await wizard(3).waitFor();
    assert.equal(await p.getByLabel('Name').inputValue(), 'feeder1');
    await p.getByLabel('Increments per unit', { exact: true }).fill('3200');
    await p.getByLabel('Name').press('Enter');
    await wizard(4).waitFor();
    await p.getByRole('button', { name: 'Check', exact: true }).click();
    const apply = p.getByRole('button', { name: 'Apply', exact: true });
    await until('it can be applied', async () => !(await apply.isDisabled()));
    await apply.click();
    await p.getByRole('button', { name: 'Go on to moving feeder1' }).click();
    await wizard(5).waitFor();
    const keep = p.locator('[data-field=keep-after-move]');
    assert.equal(await keep.getAttribute('data-asks'), 'false');
    await keep.getByText(/The site is on trial, for 2\d\d s more: move feeder1 first/).waitFor();
    const feeder = tileOf(p, 'feeder1');
    await until('it is live', async () => (await feeder.field('position').getAttribute('data-live')) === 'true', 15_000);
    await p.getByRole('button', { name: 'Enable feeder1' }).click();
    await until('it is enabled', async () => /Enabled/.test(await feeder.text('state')));
    await p.getByRole('textbox', { name: 'Distance of feeder1' }).fill('2');
    await p.getByRole('button', { name: 'Move by distance of feeder1' }).click();
    await keep.getByText('feeder1 has moved. Was it right?').waitFor({ timeout: 15_000 });
    await shot(p, 'shape-wizard-keep', { fullPage: true });
    await keep.getByRole('button', { name: 'Keep', exact: true }).click();
    await keep.waitFor({ state: 'detached' });
    assert.equal((await empty.call('GET', '/site/stage')).body.state, 'none');
    const read = p.locator('[data-field=read-from-hmi]');
    const raw = async () => (await empty.call('GET', '/registers?unit=1&address=0&count=4')).body.words;
    await until('the live words are those of the door', async () => {
      const [, , high, low] = await raw();
      const hex = [high, low].map((w) => w.toString(16).toUpperCase().padStart(4, '0')).join(' ');
      return (await read.innerText()).includes(`${hex} = ${(high << 16) | low}`) || (await read.innerText());
    });
    const about = (await empty.call('GET', '/about')).body.doors.find((d) => d.name === 'modbus').address;
    const [host, port] = about.split(':');
    assert.equal(await read.locator('[data-field=mbpoll]').innerText(), `mbpoll -m tcp -p ${port} -a 1 -t 4:int -B -0 -r 2 -c 1 -1 ${host}`);
    assert.match(await read.innerText(), new RegExp(`Host ${host}, port ${port}, unit 1`));
    assert.match(await read.innerText(), /40003/);
    await read.getByRole('button', { name: 'Copy the line' }).click();
    await read.getByText('Copied.').waitFor();
    assert.equal(await p.evaluate(() => navigator.clipboard.readText()), await read.locator('[data-field=mbpoll]').innerText());
    await shot(p, 'shape-wizard-hmi', { fullPage: true });
    assert.deepEqual(p.faults(), []);
  } finally {
    await p.context().close();
    await empty.end();
  }
});

test('help stands beside every field of the site, and is opened by finger and keyboard where there is no room', async () => {
  await page.goto(`${program.url}/site`);
  for (const [button, form] of [['Change line can0', 'Change line can0'], ['Change drive d5', 'Change drive d5'], ['Change axis lift', 'Change axis lift']]) {
    await page.getByRole('button', { name: button }).click();
    const f = page.getByRole('form', { name: form });
    await f.waitFor();
    await f.locator('details').evaluateAll((l) => l.forEach((d) => (d.open = true)));
    const bare = await f.locator('.form-field').evaluateAll((l) => l.filter((e) => !e.querySelector('.form-told')?.textContent.trim()).map((e) => e.querySelector('label')?.textContent));
    assert.deepEqual(bare, [], `${form}: fields without help`);
    await f.getByRole('button', { name: 'Cancel' }).click();
  }
  await page.goto(`${program.url}/axes/feeder/parameters`);
  const row = page.locator('tr[data-parameter]').first();
  await row.waitFor();
  const help = row.getByRole('button', { name: /^Help: / });
  await help.focus();
  await page.keyboard.press('Enter');
  await becomes('it is open', () => help.getAttribute('aria-expanded'), 'true');
  const first = (await program.call('GET', '/axes/feeder/parameters')).body.find((x) => x.description);
  assert.ok((await row.locator('.help-text').innerText()).length > 20, first.description);
  await help.click();
  await row.locator('.help-text').waitFor({ state: 'hidden' });
  const without = await page.locator('tr[data-parameter]').evaluateAll((l) => l.filter((r) => !r.querySelector('.help-button')).map((r) => r.dataset.parameter));
  assert.deepEqual(without, [], 'parameters without help');
  await page.goto(`${program.url}/axes/feeder`);
  await page.getByRole('button', { name: 'Help: the controls' }).click();
  await page.getByText('Reset fault clears a fault whose cause is gone.').waitFor();
});

test('status and control word stand beside the state machine, bit by bit with their names', async () => {
  await page.goto(`${program.url}/axes/feeder`);
  await page.locator('.machine .node.is-now').waitFor();
  const [drawing, words] = await Promise.all(['.machine svg', '.machine .words'].map((s) => page.locator(s).boundingBox()));
  assert.ok(words.x >= drawing.x + drawing.width && words.y < drawing.y + drawing.height, JSON.stringify({ drawing, words }));
  for (const [word, bits] of [['Status word', 16], ['Control word', 10]]) assert.equal(await page.locator(`[data-word="${word}"] li`).count(), bits);
});

test('nothing on the way was a fault of the page', () => assert.deepEqual(page.faults(), []));
