// The page of an axis: parameters with their range, the native console, the twin's hand, the state machine, the scope.
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { becomes, launch, open, shot, until } from './lib/browser.mjs';
import { Program, isMock } from './lib/program.mjs';

let program, browser, page, list;
before(async () => {
  program = await Program.start();
  browser = await launch();
  page = await open(browser, `${program.url}/axes/feeder/parameters`);
  await page.locator('[data-parameter]').first().waitFor();
  list = (await program.call('GET', '/axes/feeder/parameters')).body;
});
after(async () => {
  await browser?.close();
  await program?.end();
});

/** By its tab, as a person goes. */
const tab = async (name) => {
  await page.getByRole('navigation', { name: 'Parts of feeder' }).getByRole('link', { name, exact: true }).click();
  await becomes('it is marked', () => page.locator('.axis-tabs [aria-current=page]').innerText(), name);
};
/** A parameter that may be written without harm, with a range. */
const writable = () => list.find((p) => p.access === 'RW' && p.min !== null && p.max !== null && p.min >= 0 && !p.allowed && !p.count && /acceleration|AC\b/i.test(`${p.name} ${p.id}`)) ?? list.find((p) => p.access === 'RW' && p.max !== null && !p.allowed && !p.count);
const row = (id) => page.locator(`tr[data-parameter="${id}"]`);

test('a value out of range is refused with the range, and stays typed', async () => {
  const p = writable();
  const r = row(p.id);
  await page.getByRole('searchbox', { name: 'Search parameters' }).fill(p.id);
  await r.getByRole('textbox').fill(String(p.max + 1));
  await r.getByRole('button', { name: `Write ${p.id}` }).click();
  const note = r.locator('.row-note');
  await until('the range is told', async () => /outside the range/.test(await note.innerText()) || (await note.innerText()));
  const digits = (await note.innerText()).replace(/\D/g, '');
  assert.ok(digits.includes(String(p.max)), `${p.max} is not in: ${await note.innerText()}`);
  assert.equal(await r.getByRole('textbox').inputValue(), String(p.max + 1));
  assert.equal(await r.getByRole('textbox').getAttribute('aria-invalid'), 'true');
  await shot(page, 'parameter-range');
});

test('a value in the range is written, and who wrote it is shown', async () => {
  const p = writable();
  const r = row(p.id);
  const value = p.min + Math.min(1000, Math.floor((p.max - p.min) / 2));
  await r.getByRole('textbox').fill(String(value));
  await r.getByRole('textbox').press('Enter');
  await until('it is written', async () => /^Written/.test(await r.locator('.row-note').innerText()) || (await r.locator('.row-note').innerText()));
  const now = (await program.call('GET', `/axes/feeder/parameters/${encodeURIComponent(p.id)}`)).body;
  assert.equal(now.value, value);
  assert.equal(now.stored, value);
  await until('the writer is shown', async () => /127\.0\.0\.1/.test(await r.locator('.written').innerText()) || (await r.locator('.written').innerText()));
  await becomes('the field is empty again', () => r.getByRole('textbox').inputValue(), '');
});

test('a value that somebody else wrote is seen', async () => {
  const p = writable();
  const value = p.min + 7;
  await program.call('PUT', `/axes/feeder/parameters/${encodeURIComponent(p.id)}`, { value });
  await until('it is seen', async () => (await row(p.id).locator('[data-field=live]').innerText()).replace(/\D/g, '').startsWith(String(value)) || (await row(p.id).locator('[data-field=live]').innerText()));
});

test('a parameter is read from the drive on demand', async () => {
  const p = list.find((x) => x.access !== 'W' && !x.count);
  await page.getByRole('searchbox', { name: 'Search parameters' }).fill(p.id);
  await row(p.id).getByRole('button', { name: `Read ${p.id} from the drive` }).click();
  await until('it is there', async () => (await row(p.id).locator('[data-field=live]').innerText()) !== '–' && (await row(p.id).locator('.row-note').innerText()) === '');
  await page.getByRole('searchbox', { name: 'Search parameters' }).fill('');
});

test('a line in the drive\'s own language is answered in the console', async () => {
  await tab('Drive');
  const input = page.getByRole('textbox', { name: 'Line to send to feeder' });
  const line = isMock ? 'PR P' : 'MO';
  await input.fill(line);
  await input.press('Enter');
  const last = page.locator('.console-log li').last();
  await until('a reply', async () => /\d+ ms/.test(await last.innerText()) || (await last.innerText()));
  await input.press('ArrowUp');
  await becomes('the last line is there again', () => input.inputValue(), line);
  await input.fill('this is no instruction ~~');
  await input.press('Enter');
  await until('the refusal is told', async () => (await page.locator('.console-log li.result-refused').count()) === 1);
  assert.equal(await input.inputValue(), 'this is no instruction ~~');
});

test('the hand of the twin has switches that take', async () => {
  await tab('Simulation');
  const stall = page.getByRole('switch', { name: 'Stall' });
  await stall.waitFor();
  await becomes('it is off', () => stall.getAttribute('aria-checked'), 'false');
  await stall.click();
  await until('it took', async () => (await stall.getAttribute('aria-checked')) === 'true');
  await becomes('the gateway has it', async () => (await program.call('GET', '/drives/feeder/hand')).body.stall, true);
  await stall.click();
  await until('it took', async () => (await program.call('GET', '/drives/feeder/hand')).body.stall === false);
});

test('the state machine marks the present state, in words too', async () => {
  await tab('Move');
  const drawing = page.getByRole('img', { name: /^Present state: / });
  await becomes('it is off', () => drawing.getAttribute('aria-label'), 'Present state: Switch on disabled');
  await page.getByRole('button', { name: 'Enable', exact: true }).click();
  await page.getByRole('img', { name: 'Present state: Operation enabled' }).waitFor();
  await becomes('the drawing says so', async () => (await page.locator('.node.is-now').textContent()).trim(), 'Operation enabled');
  const set = (word) => page.locator(`[data-word="${word}"] .is-set`).allInnerTexts().then((all) => all.map((t) => t.replace(/^\d+\s+\d\s+/, '').trim()));
  await until('the status word says it bit by bit', async () => (await set('Status word')).includes('Operation enabled') || (await set('Status word')));
  await until('so does the control word', async () => (await set('Control word')).includes('Enable operation') || (await set('Control word')));
});

test('the scope draws a move', async () => {
  await program.command('feeder', { command: 'move_relative', position: 20, velocity: 40, acceleration: 400, deceleration: 400 });
  await until('it has arrived', async () => (await program.axis('feeder')).target_reached === true);
  const inked = () => page.evaluate(() => {
    const c = document.querySelector('.scope canvas');
    const pixels = c.getContext('2d').getImageData(0, 0, c.width, c.height).data;
    let n = 0;
    for (let i = 3; i < pixels.length; i += 4) if (pixels[i] > 0) n += 1;
    return n;
  });
  await until('it is drawn', async () => (await inked()) > 1000 || `${await inked()} pixels`);
  await shot(page, 'scope', { fullPage: true });
});

test('the present position can be given another name without a motion', async () => {
  const field = page.getByRole('textbox', { name: 'What the present position shall be called' });
  await becomes('nothing is offered that nobody typed', () => field.inputValue(), '');
  const before = (await program.axis('feeder')).position;
  assert.ok(Math.abs(before) > 1, `it stands at ${before}`);
  await field.fill('0');
  await field.press('Enter');
  const question = page.locator('[data-field=set-position]');
  await question.waitFor();
  assert.match((await question.innerText()).replace(/\s/g, ' '), new RegExp(`its position is ${before.toFixed(3).replace('-', '\u2212')} mm now and will be called 0\\.000 mm`));
  await becomes('the keyboard is at the answer that changes nothing', () => page.evaluate(() => document.activeElement.textContent), 'Leave it');
  await page.keyboard.press('Enter');
  await question.waitFor({ state: 'detached' });
  assert.equal((await program.axis('feeder')).position, before);
  await page.getByRole('button', { name: 'Set position …', exact: true }).click();
  await question.getByRole('button', { name: 'Set position', exact: true }).click();
  await until('it took', async () => Math.abs((await program.axis('feeder')).position) < 0.01 || (await program.axis('feeder')).position);
});

test('each tab has an address, a heading and a way back', async () => {
  for (const [name, path, heading] of [['Scope', '/axes/feeder/scope', 'Scope of feeder'], ['Events', '/axes/feeder/events', 'Events of feeder'], ['Parameters', '/axes/feeder/parameters', 'Parameters of feeder'], ['Move', '/axes/feeder', 'feeder']]) {
    await tab(name);
    assert.equal(new URL(page.url()).pathname, path);
    await page.getByRole('heading', { level: 1, name: heading, exact: true }).waitFor();
    await page.getByRole('button', { name: 'Stop feeder', exact: true }).waitFor();
  }
  await page.goBack();
  await page.getByRole('heading', { level: 1, name: 'Parameters of feeder' }).waitFor();
  await page.goto(`${program.url}/axes/feeder/scope`);
  await page.locator('.scope canvas').waitFor();
});

test('every state in the drawing stands whole inside its box, also where the mark of the present one is', async () => {
  for (const width of [320, 390, 1440]) {
    const other = await open(browser, `${program.url}/axes/feeder`, { viewport: { width, height: 844 } });
    await other.locator('.machine .node.is-now').waitFor();
    const wrong = await other.evaluate(() => {
      const svg = document.querySelector('.machine svg').viewBox.baseVal;
      return [...document.querySelectorAll('.machine .node')].flatMap((node) => {
        const [box, text] = [node.querySelector('rect').getBBox(), node.querySelector('text').getBBox()];
        const at = node.transform.baseVal.consolidate().matrix.e;
        const free = box.x + box.width - (text.x + text.width);
        const word = node.textContent.trim();
        return [...(text.x < 18 || free < 4 ? [`${word}: begins at ${text.x}, ${free} free`] : []), ...(at < 0 || at + box.width > svg.width ? [`${word} is outside`] : [])];
      });
    });
    assert.deepEqual(wrong, [], `${width} px`);
    await shot(other.locator('.machine'), `machine-${width}`);
    await other.context().close();
  }
});

test('on a phone no tab is higher than three screens', async () => {
  const phone = await open(browser, program.url, { viewport: { width: 390, height: 844 }, hasTouch: true, isMobile: true });
  for (const [path, ready] of [['/axes/feeder', '.machine'], ['/axes/feeder/scope', '.scope canvas'], ['/axes/feeder/parameters', 'tr[data-parameter]'], ['/axes/feeder/drive', '[data-part=actions]'], ['/axes/feeder/simulation', '[data-hand]'], ['/axes/feeder/events', '.event']]) {
    await phone.goto(program.url + path);
    await phone.locator(ready).first().waitFor();
    const height = await phone.evaluate(() => document.querySelector('main').getBoundingClientRect().height);
    assert.ok(height <= 3 * 844, `${path} is ${height} px high`);
  }
  await phone.context().close();
});

test('nothing on the way was a fault of the page', () => {
  assert.deepEqual(page.faults(), []);
});
