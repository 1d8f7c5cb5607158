// What was recorded is drawn as it was, also where the gateway thins it: a rest is held, a silence is a gap, the end is the last value; and playback
// shows one instant in curves, table, registers and frames, however late the gateway answers. In: the program with a motor that stalls, stands in
// fault for some seconds and is without power for some. Out: what the cursor reads, beside what the gateway tells; pictures under build/browser.
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { becomes, launch, open, shot, until } from './lib/browser.mjs';
import { isMock, Program } from './lib/program.mjs';

const skip = isMock && 'the stand-in keeps nothing';
const document = {
  lines: [{ name: 'can0', uri: 'twin', family: 'uim342', bitrate: 1000000 }],
  drives: [{ name: 'd5', line: 'can0', address: 5, presence: 'twin' }],
  axes: [{ name: 'feeder', drive: 'd5', channel: 1, number: 1, unit: 'mm', increments_per_unit: 3200 }],
  mappings: [],
};
const speed = 15;
/** Instants between which the axis certainly was so, seconds: `[from, to]`. */
const was = {};
let program, browser;
const now = () => Date.now() / 1000;
const pause = (ms) => new Promise((r) => setTimeout(r, ms)); // time has to pass: it is what is recorded
const hand = (state) => program.call('PATCH', '/drives/d5/hand', state);
const axis = () => program.axis('feeder');

before(async () => {
  if (skip) return;
  program = await Program.start({ site: document });
  browser = await launch();
  await program.command('feeder', { command: 'enable' });
  await until('enabled', async () => (await axis()).state === 'operation_enabled');
  await program.command('feeder', { command: 'move_velocity', velocity: speed, acceleration: 200 });
  await until('it has its speed', async () => Math.abs((await axis()).velocity - speed) < 0.2);
  was.moving = [now(), 0];
  await pause(4500);
  was.moving[1] = now();
  await hand({ stall: true });
  await until('it is in fault and stands', async () => { const a = await axis(); return a.fault && !a.moving && Math.abs(a.velocity) < 0.01; });
  was.fault = [now(), 0, await axis()];
  await pause(6000);
  was.fault[1] = now();
  await hand({ stall: false, power: false });
  await until('it is silent', async () => (await axis()).online === false);
  was.silent = [now(), 0];
  await pause(4500);
  was.silent[1] = now();
  await hand({ power: true });
  await until('it answers again', async () => (await axis()).online === true);
  was.again = [now(), 0];
  await pause(4500);
  was.again[1] = now();
  await program.call('POST', '/recorder/recordings', { name: 'fault' });
});
after(async () => {
  await browser?.close();
  await program?.end();
});

const figure = (text) => (text === '–' ? null : Number(text.replace('−', '-').replace(/[^\d.-]/g, '')));
/** Whatever is asked for, no more columns than this: what a long stretch is thinned to. `seen` is called with each answer's curves. */
async function thinned(page, columns, seen) {
  await page.route(/\/recorder\/(trends\?|recordings\/[^/]+\/playback\?)/, async (route) => {
    const url = new URL(route.request().url());
    if (!url.searchParams.has('columns')) return route.continue();
    url.searchParams.set('columns', String(columns));
    const answer = await route.fetch({ url: url.href });
    const doc = await answer.json();
    seen(doc.curves ?? doc.axes);
    await route.fulfill({ response: answer, json: doc });
  });
}
/** "11:40:30.250", of the day in UTC. */
const secondsOf = (text) => {
  const t = Date.parse(`${new Date().toISOString().slice(0, 11)}${text}Z`) / 1000;
  return t - now() > 43_200 ? t - 86_400 : t;
};
/** What cursor A reads as it is taken from the end of what is seen to its beginning: instants in seconds, the oldest first. */
async function read(page) {
  const row = page.locator('.cursor-table tbody tr').first().locator('td');
  const plot = page.locator('.scope-plot');
  await plot.focus();
  await page.keyboard.press('End');
  const all = [];
  for (let last = ''; all.length < 130 && !(all[0] && secondsOf(all[0].at) < was.moving[0] - 1); ) {
    const [at, position, velocity] = await row.allInnerTexts();
    if (at === last) break; // the beginning of what is seen
    all.unshift({ at: at.trim(), position: figure(position.trim()), velocity: figure(velocity.trim()) });
    last = at;
    await page.keyboard.press('ArrowLeft');
    await until('the cursor has moved, or is at the beginning', async () => (await row.first().innerText()) !== last || (await plot.evaluate(() => new Promise((r) => requestAnimationFrame(() => setTimeout(() => r(true)))))));
  }
  return all;
}
/** `edge`: how far a column reaches beyond the instants that are certain. */
function judged(all, edge) {
  const during = ([from, to]) => all.filter(({ at }) => secondsOf(at) > from + edge && secondsOf(at) < to - edge);
  const rest = during(was.fault);
  assert.ok(rest.length >= 5, `${rest.length} instants of the fault are read: ${JSON.stringify(all)}`);
  for (const r of rest) {
    assert.equal(r.velocity, 0, `${r.at}: it stood in fault`);
    assert.ok(Math.abs(r.position - was.fault[2].position) < 0.002, `${r.at}: ${r.position} mm is read, it stood at ${was.fault[2].position}`);
  }
  const silence = during(was.silent);
  assert.ok(silence.length >= 2, `${silence.length} instants of the silence are read`);
  for (const r of silence) assert.deepEqual([r.position, r.velocity], [null, null], `${r.at}: nothing was known`);
  const moving = during(was.moving);
  assert.ok(moving.length >= 2 && moving.every((r) => Math.abs(r.velocity - speed) < 1), `its motion: ${JSON.stringify(moving)}`);
  const again = during(was.again);
  assert.ok(again.length >= 1 && again.every((r) => r.velocity === 0), `behind the silence: ${JSON.stringify(again)}`);
}

for (const columns of [100, 2000]) {
  test(`trends in ${columns} columns: the fault is a rest, the silence a gap, the end the last value`, { skip }, async () => {
    const page = await open(browser, program.url);
    let told = [];
    await thinned(page, columns, (curves) => (told = curves));
    await page.goto(`${program.url}/recorder/trends/feeder/${Math.round(was.fault[0] * 1000)}`); // a minute about this instant
    await page.locator('.scope .u-over').waitFor();
    await until('what is seen was told', async () => (told[0]?.at.length > 5 && told[0].thinned === columns < 1000 && told[0].at[0] / 1000 < was.moving[0]) || told);
    const all = await read(page);
    judged(all, 60 / columns + 0.45);
    const end = all.findLast((r) => r.velocity !== null); // behind it time has not come yet
    assert.ok(secondsOf(end.at) > was.again[1] - 1 && end.velocity === 0, `the end: ${JSON.stringify(end)}`);
    await shot(page, `recorded-trends-${columns}`, { fullPage: true });
    assert.deepEqual(page.faults(), []);
    await page.context().close();
  });
}

const playback = (page) => page.locator('[data-field=playback]');

test('a recording in 60 columns: its curves have the rest, the gap and the last value as well', { skip }, async () => {
  const page = await open(browser, `${program.url}/recorder/recordings/`);
  let told = [];
  await thinned(page, 60, (curves) => (told = curves));
  await page.getByRole('button', { name: 'Play back fault' }).click();
  await playback(page).locator('.u-over').waitFor();
  await until('it is thinned', async () => told[0]?.thinned === true || told);
  const all = await read(page);
  const span = secondsOf(all.at(-1).at) - secondsOf(all[0].at);
  judged(all, span / 60 + 0.45);
  assert.equal(all.at(-1).velocity, 0);
  await shot(page, 'recorded-playback', { fullPage: true });
  await page.context().close();
});

test('playback of a slow gateway: answers that come late are shown, the instant with them, and all of it is of one instant', { skip }, async () => {
  const page = await open(browser, `${program.url}/recorder/recordings/`);
  const late_ms = 700; // almost three steps
  await page.route(/\/playback\?/, async (route) => {
    await pause(late_ms);
    await route.continue();
  });
  await page.getByRole('button', { name: 'Play back fault' }).click();
  const part = playback(page);
  await part.getByRole('button', { name: 'Play', exact: true }).waitFor();
  const shown = async () => ({
    at: await part.getAttribute('data-at'),
    told: await part.locator('[data-field=playback-shown]').innerText(),
    row: await part.locator('tr[data-axis=feeder]').innerText(),
    frames: await part.getByRole('region', { name: /^Frames/ }).locator('li').first().innerText().catch(() => ''),
  });
  const end = await shown();
  await part.getByRole('button', { name: 'Play', exact: true }).click(); // from the beginning
  const seen = new Map();
  await until('it was shown in many instants', async () => {
    const s = await shown();
    if (s.at !== end.at) seen.set(s.at, s);
    return seen.size >= 5 || [...seen.keys()];
  }, 20_000);
  const instants = [...seen.keys()].map((at) => Date.parse(at));
  assert.deepEqual(instants, instants.toSorted((a, b) => a - b), 'it goes on, never back');
  assert.ok(instants.at(-1) - instants[0] > 1500, `it has gone on by ${instants.at(-1) - instants[0]} ms`);
  await part.getByRole('button', { name: 'Pause' }).click();
  const slider = part.getByRole('slider');
  const wanted = async () => Number(await slider.inputValue()) * 1000;
  await until('the last answer is that of the slider', async () => Math.abs(Date.parse((await shown()).at) - (await wanted())) < 20 || { ...(await shown()), wanted: await wanted() });
  // In the midst of the fault: what is shown is what the gateway tells of that instant, the curves' cursor with it.
  const instant = (was.fault[0] + was.fault[1]) / 2;
  await slider.evaluate((e, value) => {
    Object.getOwnPropertyDescriptor(HTMLInputElement.prototype, 'value').set.call(e, String(value));
    e.dispatchEvent(new Event('input', { bubbles: true }));
  }, instant);
  await until('it is shown', async () => Math.abs(Date.parse((await shown()).at) / 1000 - instant) < 0.05 || (await shown()));
  const s = await shown();
  const [moment] = [(await program.call('GET', `/recorder/recordings/fault/playback?at=${Math.round(await wanted())}&frames=40`)).body];
  assert.match(s.row, /fault/i);
  assert.ok(s.row.includes(moment.axes[0].position.toFixed(3)), `${s.row} beside ${moment.axes[0].position}`);
  assert.ok(s.frames.startsWith(moment.frames.at(-1).at.slice(11, 23)), `${s.frames} beside ${JSON.stringify(moment.frames.at(-1))}`);
  const words = moment.registers.find((r) => r.axis === 'feeder').words;
  const hex = (w) => w.toString(16).toUpperCase().padStart(4, '0');
  assert.ok(s.row.includes(hex(words[0])), `${s.row} beside ${words}`);
  const cursor = await page.locator('.cursor-table tbody tr').first().locator('td').allInnerTexts();
  assert.ok(s.told.includes(cursor[0].slice(0, 8)), `${s.told} beside the cursor's ${cursor[0]}`);
  assert.equal(figure(cursor[2]), 0);
  assert.ok(Math.abs(figure(cursor[1]) - moment.axes[0].position) < 0.002, `${cursor} beside ${moment.axes[0].position}`);
  await shot(page, 'recorded-instant', { fullPage: true });
  assert.deepEqual(page.faults(), []);
  await page.context().close();
});
