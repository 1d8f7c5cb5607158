// The shape of the page: the overview as a list with headings, orders and groups, one command for several axes; the site as a tree with ports of the
// machine and a calculator; the end of the wizard; help beside fields; one width of content. In: the program. Out: counts; pictures under build/browser.
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { readFileSync } from 'node:fs';
import { becomes, examine, launch, look, open, quiet, shot, tileOf, until } from './lib/browser.mjs';
import { manyMappings } from './lib/many.mjs';
import { furnish, parts } from './lib/parts.mjs';
import { isMock, Program } from './lib/program.mjs';

const document = {
  lines: [{ name: 'can0', uri: 'twin', family: 'uim342', bitrate: 1000000 }],
  drives: [5, 6, 7, 8].map((address) => ({ name: `d${address}`, line: 'can0', address, presence: 'twin' })),
  axes: [
    { name: 'lift', drive: 'd5', channel: 1, number: 1, unit: 'mm', increments_per_unit: 3200, group: 'Outfeed' },
    { name: 'feeder', drive: 'd6', channel: 1, number: 2, unit: 'mm', increments_per_unit: 3200, group: 'Infeed' },
    { name: 'slide.x', drive: 'd7', channel: 1, number: 3, unit: 'mm', increments_per_unit: 3200, group: 'Infeed' },
    { name: 'axis10', drive: 'd8', channel: 1, number: 4, unit: 'mm', increments_per_unit: 3200 },
  ],
  mappings: [],
};
let program, browser, page;
before(async () => {
  program = await Program.start({ site: document });
  browser = await launch();
  page = await open(browser, program.url, { permissions: ['clipboard-read', 'clipboard-write'] });
  await page.locator('[data-axis=lift] [data-live=true]').waitFor();
});
after(async () => {
  await browser?.close();
  await program?.end();
});
const names = () => page.locator('.axis-row').evaluateAll((l) => l.map((e) => e.dataset.axis));
const heading = (name) => page.getByRole('columnheader', { name });

test('axes stand under their machine parts, as tiles and as a list with headings and velocity', async () => {
  const groups = () => page.locator('[data-group]').evaluateAll((l) => l.map((e) => [e.dataset.group, [...e.querySelectorAll('[data-axis]')].map((a) => a.dataset.axis).filter((n, i, all) => all.indexOf(n) === i)]));
  const wanted = [['Outfeed', ['lift']], ['Infeed', ['feeder', 'slide.x']], ['', ['axis10']]];
  assert.deepEqual(await groups(), wanted);
  await shot(page, 'shape-tiles', { fullPage: true });
  await page.getByRole('button', { name: 'List', exact: true }).click();
  await page.locator('.axis-row').first().waitFor();
  assert.deepEqual(await groups(), wanted);
  for (const name of ['Axis', 'Position', 'Velocity', 'State', 'Message']) await heading(name).waitFor();
  await page.getByRole('rowheader', { name: /Infeed\s+2 axes/ }).waitFor();
  await program.command('slide.x', { command: 'enable' });
  await program.command('slide.x', { command: 'move_velocity', velocity: 5, acceleration: 50 });
  const velocity = page.locator('[data-axis="slide.x"] [data-field=velocity]');
  await until('the velocity is told', async () => /^5\.0\d* mm\/s$/.test((await velocity.innerText()).trim()) || (await velocity.innerText()));
  await page.getByRole('button', { name: 'By machine part' }).click();
  await becomes('one list', names, ['lift', 'feeder', 'slide.x', 'axis10']);
});

test('a heading sorts, the other way round, and as in the site again; a live value moves no row', async () => {
  await heading('Axis').getByRole('button').click();
  await becomes('by name', names, ['axis10', 'feeder', 'lift', 'slide.x']);
  assert.equal(await heading('Axis').getAttribute('aria-sort'), 'ascending');
  await heading('Axis').getByRole('button').click();
  await becomes('backward', names, ['slide.x', 'lift', 'feeder', 'axis10']);
  await heading('Axis').getByRole('button').click();
  await becomes('as in the site', names, ['lift', 'feeder', 'slide.x', 'axis10']);
  await heading('Velocity').getByRole('button').click();
  await becomes('the fastest first', async () => (await names())[0], 'slide.x');
  await program.command('slide.x', { command: 'halt' });
  await until('it stands', async () => (await program.axis('slide.x')).moving === false);
  await until('the page knows', async () => /^[−-]?0\.0/.test((await page.locator('[data-axis="slide.x"] [data-field=velocity]').innerText()).trim()));
  assert.equal((await names())[0], 'slide.x', 'it stays where it is');
  await page.getByLabel('Order').selectOption('number');
  await becomes('as in the site', names, ['lift', 'feeder', 'slide.x', 'axis10']);
});

test('one command goes to the axes that are selected, and each one answers', async () => {
  const bar = page.locator('[data-field=selection]');
  assert.equal(await bar.getByRole('button', { name: 'Enable the selected axes' }).isDisabled(), true);
  const places = () => page.locator('.axis-row').evaluateAll((l) => l.map((e) => Math.round(e.getBoundingClientRect().y)));
  const before = await places();
  for (const n of ['lift', 'feeder']) await page.getByRole('checkbox', { name: `Select ${n}`, exact: true }).check();
  await bar.getByText('2 axes selected').waitFor();
  assert.deepEqual(await places(), before, 'a selection moves nothing');
  await bar.getByRole('button', { name: 'Enable the selected axes' }).click();
  const enabled = async () => (await Promise.all(document.axes.map((a) => program.axis(a.name)))).filter((a) => a.state === 'operation_enabled').map((a) => a.name);
  await becomes('they are enabled, and no other', async () => (await enabled()).filter((n) => n !== 'slide.x').sort(), ['feeder', 'lift']);
  await bar.getByText('Enable: 2 good').waitFor();
  // Two of three can home; the third says why not.
  await page.getByRole('checkbox', { name: 'Select axis10', exact: true }).check();
  await bar.getByRole('button', { name: 'Home the selected axes' }).click();
  const question = page.locator('[data-field=selection-home]');
  assert.match(await question.innerText(), /Home lift, feeder, axis10\? Each of them moves/);
  await becomes('the keyboard is at the answer that changes nothing', () => page.evaluate(() => globalThis.document.activeElement.textContent), 'Leave it');
  await page.keyboard.press('Enter');
  await question.waitFor({ state: 'detached' });
  await bar.getByRole('button', { name: 'Home the selected axes' }).click();
  await question.getByRole('button', { name: 'Home them' }).click();
  const answer = (n) => bar.locator(`[data-answer="${n}"]`);
  await until('the one that has no power says so', async () => /enable it first|the axis is disabled now/i.test(await answer('axis10').innerText()) || (await bar.innerText()));
  await until('the others are told apart', async () => !/refused/.test(await answer('lift').innerText()) || (await bar.innerText()));
  await shot(page, 'shape-selection', { fullPage: true });
  await bar.getByRole('button', { name: 'Stop the selected axes' }).click();
  await until('all have answered', async () => /Stop: 3 good/.test(await bar.innerText()) || (await bar.innerText()));
  await bar.getByRole('button', { name: 'Select nothing' }).click();
  assert.equal(await page.locator('.axis-row input:checked').count(), 0);
});

test('tiles have no empty footer, and what is said in them is whole', async () => {
  await page.getByRole('button', { name: 'List', exact: true }).click();
  await page.locator('.tile').first().waitFor();
  const feet = await page.locator('.tile-foot').evaluateAll((l) => l.map((e) => ({ said: [...e.children].filter((c) => c.checkVisibility()).map((c) => c.textContent.trim()), high: e.getBoundingClientRect().height })));
  for (const { said, high } of feet) {
    assert.ok(said.length >= 1 && said.every((t) => t !== ''), JSON.stringify(said));
    assert.ok(high <= 20 * said.length + 14, `${said.length} lines in ${high} px`);
  }
});

test('the list at four widths: nothing is cut, nothing scrolls sideways, nothing serious for axe-core', async () => {
  const wrong = [];
  for (const [width, device] of [[1440, {}], [1024, {}], [768, {}], [390, { hasTouch: true, isMobile: true }], [320, { hasTouch: true, isMobile: true }]]) {
    const p = await open(browser, program.url, { viewport: { width, height: 900 }, bypassCSP: true, ...device });
    await p.locator('[data-axis=lift] [data-live=true]').waitFor();
    await p.getByRole('button', { name: 'List', exact: true }).click();
    await p.locator('.axis-row').first().waitFor();
    assert.equal(await p.locator('.axis-row [data-field=mark]:visible').count(), 4, `${width} px: each row says whether it is simulated`);
    wrong.push(...(await look(p, 'shape-list')));
    await p.context().close();
  }
  assert.deepEqual(wrong, []);
});

test('of many axes those in sight are written with every reading, the others once a second, until they come into sight', async () => {
  const many = await Program.start({ site: { ...manyMappings(), mappings: [] } });
  try {
    for (const axis of ['axis1', 'axis64']) {
      await many.command(axis, { command: 'enable' });
      await many.command(axis, { command: 'move_velocity', velocity: 5, acceleration: 50 });
    }
    const p = await open(browser, many.url);
    await p.locator('[data-axis=axis64] [data-live=true]').waitFor();
    /** How often its position is written within 3 s. */
    const written = (axis) =>
      p.locator(`[data-axis=${axis}] [data-field=position]`).evaluate(
        (cell) =>
          new Promise((resolve) => {
            let n = 0;
            const eye = new MutationObserver((all) => (n += all.length));
            eye.observe(cell, { attributeFilter: ['data-value'] });
            setTimeout(() => resolve((eye.disconnect(), n)), 3000); // a rate is measured
          }),
      );
    const seen = async () => Promise.all(['axis1', 'axis64'].map(written));
    const near = (n) => n > 6 && n <= 17; // five times a second
    const far = (n) => n >= 1 && n <= 4;
    const [first, last] = await seen();
    assert.ok(near(first) && far(last), `above ${first}, below ${last}`);
    await p.locator('[data-axis=axis64]').scrollIntoViewIfNeeded();
    const [above, here] = await seen();
    assert.ok(far(above) && near(here), `above ${above}, here ${here}`);
    // Its state is that of now when it is come back to.
    await many.command('axis1', { command: 'halt' });
    await p.locator('[data-axis=axis1]').scrollIntoViewIfNeeded();
    await until('it stands', async () => /At rest|In position/.test(await p.locator('[data-axis=axis1] [data-field=motion]').innerText()));
    assert.deepEqual(p.faults(), []);
    await p.context().close();
  } finally {
    await many.end();
  }
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

test('no tab of an axis is higher than three screens of a small phone', async () => {
  await furnish(program).catch(() => undefined); // events, snapshots, an alarm
  const phone = await open(browser, program.url, { viewport: { width: 360, height: 740 }, hasTouch: true, isMobile: true });
  const wrong = [];
  for (const [path, ready] of [['/axes/feeder', '.machine'], ['/axes/feeder/scope', '.scope canvas'], ['/axes/feeder/parameters', 'tr[data-parameter]'], ['/axes/feeder/drive', '[data-part=actions]'], ['/axes/feeder/simulation', '[data-hand]'], ['/axes/feeder/events', '.event']]) {
    await phone.goto(program.url + path);
    await phone.locator(ready).first().waitFor();
    const height = await phone.evaluate(() => globalThis.document.querySelector('main').getBoundingClientRect().height);
    if (height > 3 * 740) wrong.push(`${path} is ${Math.round(height)} px high`);
  }
  assert.deepEqual(wrong, []);
  await phone.context().close();
});

test('no page is higher than three screens of a small phone; what is folded is there when it is asked for, and whole on paper', async () => {
  const furnished = await Program.start();
  try {
    await furnish(furnished);
    const phone = await open(browser, furnished.url, { viewport: { width: 360, height: 740 }, hasTouch: true, isMobile: true, bypassCSP: true });
    const pages = [...parts, { path: '/report', ready: '[data-field=report]' }, { path: '/fleet', ready: 'main h1' }, ...['trends', 'captures', 'recordings'].map((tab) => ({ path: `/recorder/${tab}`, ready: 'main h1' }))];
    const wrong = [];
    for (const { path, ready } of pages) {
      await phone.goto(furnished.url + path);
      await phone.locator(ready).first().waitFor();
      await quiet(phone);
      const height = await phone.evaluate(() => globalThis.document.querySelector('main').getBoundingClientRect().height);
      if (height > 3 * 740) wrong.push(`${path} is ${Math.round(height)} px high`);
    }
    const linked = await phone.locator('.nav a').evaluateAll((l) => l.map((a) => new URL(a.href).pathname));
    assert.ok(linked.length > 5, `${linked}`);
    wrong.push(...linked.filter((path) => !pages.some((p) => p.path === path || p.path.startsWith(`${path}/`))).map((path) => `${path} is not looked at`));
    assert.deepEqual(wrong, []);
    for (const path of ['/lines/can0', '/mappings', '/recipes/there-and-back', '/events', '/report']) {
      await phone.goto(furnished.url + path);
      await phone.locator(pages.find((p) => p.path === path).ready).first().waitFor();
      await quiet(phone);
      wrong.push(...(await examine(phone)).map((v) => `${path}: ${JSON.stringify(v)}`));
      const folds = phone.locator('main .fold');
      if (/events|report/.test(path)) assert.ok(await phone.locator('.window[role=region][tabindex="0"]').count() > 0, path);
      else assert.match((await folds.allInnerTexts()).join('; '), /\w \(\d+\)/, path);
      for (const fold of await folds.all()) {
        assert.equal(await fold.getAttribute('aria-expanded'), 'false');
        await fold.press('Enter');
        await becomes('it is open', () => fold.getAttribute('aria-expanded'), 'true');
        assert.ok(await fold.evaluate((e) => [...e.closest('.section').children].every((c) => c.checkVisibility())), path);
        await fold.press('Enter');
        await becomes('it is folded', () => fold.getAttribute('aria-expanded'), 'false');
      }
      assert.equal(await phone.locator('.is-folded > :not(.section-head):visible').count(), 0, path);
      await phone.emulateMedia({ media: 'print' });
      const cut = await phone.evaluate(() => [...globalThis.document.querySelectorAll('main .window, main .is-folded, main .report .scroll')].filter((e) => e.matches('.is-folded') ? [...e.children].some((c) => getComputedStyle(c).display === 'none' && !c.matches('.section-head')) : getComputedStyle(e).maxHeight !== 'none').map((e) => e.className));
      wrong.push(...cut.map((c) => `${path} on paper: ${c}`));
      await phone.emulateMedia({ media: null });
    }
    await phone.goto(`${furnished.url}/mappings`);
    // Not the fold of the form itself, which is called so, too.
    await phone.getByRole('button', { name: 'Add a mapping', exact: true }).and(phone.locator('.button')).tap();
    await becomes('the form is open, and the keyboard in it', () => phone.evaluate(() => globalThis.document.activeElement.closest('form')?.id), 'mapping-form');
    assert.deepEqual(wrong, []);
    assert.deepEqual(phone.faults(), []);
    await phone.context().close();
  } finally {
    await furnished.end();
  }
});

test('one width of content: head, strip and every part begin and end at the same two lines', async () => {
  const wide = await open(browser, program.url, { viewport: { width: 1920, height: 900 } });
  const wrong = [];
  for (const part of parts) {
    await wide.goto(program.url + part.path);
    await wide.locator('main h1').first().waitFor();
    const edges = await wide.evaluate(() => ['.head', '.strip', 'main'].map((s) => {
      const e = globalThis.document.querySelector(s);
      const [r, c] = [e.getBoundingClientRect(), getComputedStyle(e)];
      return [Math.round(r.left + parseFloat(c.paddingLeft)), Math.round(r.right - parseFloat(c.paddingRight))].join('-');
    }));
    if (new Set(edges).size !== 1) wrong.push(`${part.path}: ${edges}`);
  }
  assert.deepEqual(wrong, []);
  await wide.context().close();
});

test('a strip never cuts a message, at any width', async () => {
  for (const width of [1440, 900, 390]) {
    const p = await open(browser, program.url, { viewport: { width, height: 844 }, ...(width < 500 ? { hasTouch: true, isMobile: true } : {}) });
    await p.locator('[data-axis=lift] [data-live=true]').waitFor();
    const detail = `axis lift is held by modbus 192.0.2.17 for 57 s more, and so are all others of this machine part; ask there, or take it over as an engineer, which is told there. ${'This sentence goes on. '.repeat(4)}`;
    await p.route('**/commands', (r) => r.fulfill({ status: 409, contentType: 'application/problem+json', body: JSON.stringify({ type: 'about:blank', title: 'x', status: 409, detail, reason: 'held' }) }));
    await p.locator('.stop-all').click();
    const said = p.locator('.strip-stop');
    await until('it is told', async () => /NOT confirmed/.test(await said.innerText()));
    const whole = await said.evaluate((e) => {
      const r = e.getBoundingClientRect();
      return { cut: e.scrollWidth > e.clientWidth + 1 || (e.scrollHeight > e.clientHeight + 1 && getComputedStyle(e).overflowY !== 'auto'), out: r.left < 0 || r.right > innerWidth + 1 };
    });
    assert.deepEqual(whole, { cut: false, out: false }, `${width} px`);
    await shot(p, `shape-strip-${width}`);
    await p.context().close();
  }
});

test('choices have room for their longest text', async () => {
  const p = await open(browser, program.url);
  const wrong = [];
  const cut = () => p.evaluate(() => {
    const pen = globalThis.document.createElement('canvas').getContext('2d');
    return [...globalThis.document.querySelectorAll('select')].filter((e) => e.checkVisibility()).flatMap((e) => {
      const c = getComputedStyle(e);
      pen.font = `${c.fontWeight} ${c.fontSize} ${c.fontFamily}`;
      const room = e.clientWidth - parseFloat(c.paddingLeft) - parseFloat(c.paddingRight) - 16; // the arrow
      return [...e.options].filter((o) => pen.measureText(o.text).width > room + 1).map((o) => `${e.getAttribute('aria-label') ?? e.labels?.[0]?.textContent}: ${o.text}`).slice(0, 2);
    });
  });
  for (const part of parts.filter((x) => ['overview', 'site', 'axis', 'parameters', 'axis-drive', 'axis-simulation', 'line'].includes(x.name))) {
    await p.goto(program.url + part.path);
    await p.locator('main h1').first().waitFor();
    if (part.name === 'parameters') await p.locator('tr[data-parameter]').first().waitFor();
    if (part.name === 'site') {
      for (const b of ['Change line can0', 'Change drive d5', 'Change axis lift']) await p.getByRole('button', { name: b }).click();
      await p.locator('form details').evaluateAll((l) => l.forEach((d) => (d.open = true)));
    }
    wrong.push(...(await cut()).map((w) => `${part.name}: ${w}`));
  }
  assert.deepEqual(wrong, []);
  await p.context().close();
});

test('the stop is an octagon and nothing else is', async () => {
  await page.goto(program.url);
  await page.locator('[data-axis=lift] [data-live=true]').waitFor();
  const octagon = /octagon: <path d="([^"]+)"/.exec(readFileSync(new URL('../../web/src/components/icon.tsx', import.meta.url), 'utf8'))[1];
  const others = () => page.evaluate((d) => [...globalThis.document.querySelectorAll(`svg.icon path[d="${d}"]`)].filter((e) => !e.closest('.stop')).map((e) => e.closest('[class]:not(svg)')?.className), octagon);
  for (const path of ['/', '/events']) {
    await page.goto(program.url + path);
    await page.locator('main h1').first().waitFor();
    await page.locator('.event').first().waitFor();
    assert.deepEqual(await others(), [], path);
  }
});

test('nothing on the way was a fault of the page', () => assert.deepEqual(page.faults(), []));
