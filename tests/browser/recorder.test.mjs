// The recorder's page: trends of two axes that a reload does not empty, zoomed and read by a real mouse; two captures laid over each other; a
// recording played back by its slider; the report. In: the program. Out: pictures under build/browser.
import assert from 'node:assert/strict';
import { readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { becomes, launch, open, shot, until } from './lib/browser.mjs';
import { isMock, Program } from './lib/program.mjs';

const skip = isMock && 'the stand-in keeps nothing';
let program, browser;
before(async () => {
  program = await Program.start();
  browser = await launch();
});
after(async () => {
  await browser?.close();
  await program?.end();
});
const move = (position) => program.command('feeder', { command: 'move_relative', position, velocity: 40, acceleration: 400, deceleration: 400 });
const arrived = () => until('it has arrived', async () => (await program.axis('feeder')).target_reached === true);
const enabled = async () => {
  await program.command('feeder', { command: 'enable' });
  await until('enabled', async () => (await program.axis('feeder')).state === 'operation_enabled');
};
/** Deletes what has this row: a question comes first, the keyboard is at the answer that changes nothing, and nothing is gone before the other one. */
async function remove(page, row, name, there) {
  const question = row.locator('[data-field=delete]');
  await row.getByRole('button', { name: `Delete ${name}` }).click();
  assert.equal(await question.locator('span').innerText(), `Delete ${name}? It cannot be brought back.`);
  await becomes('the keyboard is at the answer that changes nothing', () => page.evaluate(() => document.activeElement.textContent), 'Leave it');
  await page.keyboard.press('Enter');
  await question.waitFor({ state: 'detached' });
  assert.ok((await there()).includes(name), `${name} is still there`);
  await row.getByRole('button', { name: `Delete ${name}` }).click();
  await shot(page, `recorder-delete-${name}`, { fullPage: true });
  assert.ok((await there()).includes(name), `${name} is there until the answer`);
  await question.getByRole('button', { name: 'Delete', exact: true }).click();
  await row.waitFor({ state: 'detached' });
  assert.ok(!(await there()).includes(name), `${name} is gone`);
}
const kept = (kind) => async () => (await program.call('GET', `/recorder/${kind}`)).body[kind].map((e) => e.name);
const differences = (page) => page.locator('.cursor-table tr').last().locator('td').allInnerTexts();
const number = (t) => Number(t.replace('−', '-').replace(' s', ''));

test('trends: two axes in one plot, zoom by a drag, cursors with their difference, all of it after a reload', { skip }, async () => {
  await enabled();
  await new Promise((r) => setTimeout(r, 1000)); // some samples at rest before the move: what the first cursor reads
  await move(20);
  await arrived();
  let page = await open(browser, `${program.url}/recorder/trends/`);
  const plot = () => page.locator('.scope .u-over');
  await plot().waitFor();
  const axes = page.getByRole('group', { name: /^Axes/ });
  for (const name of ['feeder', 'slide.x']) if ((await axes.getByRole('button', { name, exact: true }).getAttribute('aria-pressed')) !== 'true') await axes.getByRole('button', { name, exact: true }).click();
  await becomes('both are drawn', () => page.getByRole('list', { name: 'Curves' }).locator('li').count(), 4);
  await until('the rate is told', async () => /feeder told/.test(await page.locator('[data-field=trend-rate]').innerText()) || (await page.locator('[data-field=trend-rate]').innerText()));
  await page.reload();
  await plot().waitFor();
  const reads = async (a, b) => {
    const box = await plot().boundingBox();
    await page.getByRole('group', { name: /^Cursor/ }).getByRole('button', { name: 'A', exact: true }).click();
    await page.mouse.click(box.x + box.width * a, box.y + 30);
    await page.getByRole('group', { name: /^Cursor/ }).getByRole('button', { name: 'B', exact: true }).click();
    await page.mouse.click(box.x + box.width * b, box.y + 30);
  };
  // What was known first, from the left on, and the end: before and after the move.
  await page.getByRole('group', { name: /^Cursor/ }).getByRole('button', { name: 'B', exact: true }).click();
  await page.locator('.scope-plot').focus();
  await page.keyboard.press('End');
  await page.getByRole('group', { name: /^Cursor/ }).getByRole('button', { name: 'A', exact: true }).click();
  await page.locator('.scope-plot').focus();
  await page.keyboard.press('Home');
  for (let i = 0; i < 110 && (await differences(page))[1] === '–'; i += 1) await page.keyboard.press('ArrowRight');
  await until('the move is still there', async () => Math.abs(number((await differences(page))[1]) - 20) < 0.5 || (await differences(page)));
  await page.getByRole('group', { name: 'Part of time' }).getByRole('button', { name: 'Closer' }).click(); // it stands still
  await reads(0.2, 0.98);
  const wide = Math.abs(number((await differences(page))[0]));
  const box = await plot().boundingBox();
  await page.mouse.move(box.x + box.width * 0.4, box.y + 60);
  await page.mouse.down();
  await page.mouse.move(box.x + box.width * 0.5, box.y + 60, { steps: 4 });
  await page.mouse.move(box.x + box.width * 0.6, box.y + 60, { steps: 4 });
  await page.mouse.up();
  await reads(0.2, 0.98);
  await until('a fifth of the time is seen', async () => Math.abs(Math.abs(number((await differences(page))[0])) - wide * 0.2) < wide * 0.03 || (await differences(page)));
  await page.locator('.scope-plot').focus();
  await page.keyboard.press('0');
  await reads(0.2, 0.98);
  await until('all of it is seen', async () => Math.abs(number((await differences(page))[0])) > wide || (await differences(page)));
  await shot(page, 'recorder-trends', { fullPage: true });
  const [download] = await Promise.all([page.waitForEvent('download'), page.locator('.scope').getByRole('button', { name: 'CSV' }).click()]);
  assert.equal(download.suggestedFilename(), 'trends.csv');
  assert.deepEqual(page.faults(), []);
  await page.context().close();
});

test('captures: armed by a command, drawn with the trigger, a second one laid over it', { skip }, async () => {
  const page = await open(browser, `${program.url}/axes/feeder/scope`);
  await page.getByRole('link', { name: /Capture it/ }).click();
  await enabled();
  const form = page.getByRole('form', { name: 'New capture' });
  for (const name of ['before', 'after']) {
    await form.getByLabel('Name').fill(name);
    await form.getByLabel('After it, ms').fill('600');
    await form.getByRole('button', { name: 'Arm' }).click();
    await until('it is armed', async () => /is armed/.test(await page.locator('[data-field=capture-told]').innerText()) || (await page.locator('[data-field=capture-told]').innerText()));
    await move(5);
    await becomes(`${name} is done`, () => page.locator(`[data-capture="${name}"]`).getAttribute('data-state'), 'done');
    await arrived();
  }
  const overlay = page.locator('[data-field=overlay]');
  await until('both are drawn', async () => /before: feeder position[\s\S]*after: feeder position/.test(await overlay.innerText()) || (await overlay.innerText()));
  const rows = await page.locator('[data-capture="after"]').innerText();
  assert.ok(Number(/feeder: ([\d\s ]+) of/.exec(rows)?.[1].replace(/\D/g, '')) > 200, rows);
  await shot(page, 'recorder-captures', { fullPage: true });
  await form.getByLabel('Begins with').selectOption('level');
  await form.getByLabel(/^Level/).fill('1,5');
  assert.match(await form.innerText(), /decimal sign as a point/);
  assert.equal(await form.getByRole('button', { name: 'Arm' }).isDisabled(), true);
  await form.getByLabel('Name').fill('through');
  await form.getByLabel(/^Level/).fill('2');
  const here = (await program.axis('feeder')).position;
  await form.getByLabel(/^Level/).fill(String(here + 2));
  await form.getByRole('button', { name: 'Arm' }).click();
  await becomes('it waits', () => page.locator('[data-capture="through"]').getAttribute('data-state'), 'armed');
  await move(5);
  await becomes('the level has come', () => page.locator('[data-capture="through"]').getAttribute('data-state'), 'done');
  await until('its level is drawn', async () => /drawn across: ↑/.test(await overlay.locator('[data-field=levels]').innerText().catch(() => '')));
  await page.getByRole('button', { name: 'Rename before' }).click();
  await page.getByRole('form', { name: 'New name of before' }).getByLabel('Name').fill('kept');
  await page.keyboard.press('Enter');
  await page.locator('[data-capture="kept"]').waitFor();
  await remove(page, page.locator('[data-capture="after"]'), 'after', kept('captures'));
  assert.deepEqual(page.faults(), []);
  await page.context().close();
});

/** The sections of a recording, as the handbook has them: name, size, hash, data. */
function sectionsOf(file) {
  const found = new Map();
  for (let at = 16; at + 44 <= file.length; ) {
    const size = Number(file.readBigUInt64LE(at + 4));
    found.set(file.toString('latin1', at, at + 4), file.subarray(at + 44, at + 44 + size));
    at += 44 + size;
  }
  return found;
}

test('recordings: made, played back by the slider, downloaded, deleted', { skip }, async () => {
  const page = await open(browser, `${program.url}/recorder/recordings/`);
  const form = page.getByRole('form', { name: 'New recording' });
  await form.getByLabel('Name').fill('crash');
  await form.getByLabel('Why').fill('a try');
  await form.getByRole('button', { name: /^Freeze/ }).click();
  await page.locator('[data-recording="crash"]').waitFor();
  await page.getByRole('button', { name: 'Play back crash' }).click();
  const playback = page.locator('[data-field=playback]');
  const feeder = () => playback.locator('tr[data-axis="feeder"]').innerText();
  await until('its end is shown', async () => /\benabled/.test(await feeder().catch(() => '')));
  const end = await feeder();
  assert.match(end, /[0-9A-F]{4} [0-9A-F]{4}/, 'its registers');
  assert.ok((await playback.getByRole('region', { name: /^Frames/ }).locator('li').count()) > 5);
  const slider = playback.getByRole('slider', { name: 'Instant of the recording' });
  await slider.focus();
  await page.keyboard.press('Home');
  await until('the beginning is another one', async () => (await feeder().catch(() => '')) !== end);
  await shot(page, 'recorder-playback', { fullPage: true });
  const [download] = await Promise.all([page.waitForEvent('download'), page.getByRole('link', { name: 'Download crash' }).click()]);
  assert.equal(download.suggestedFilename(), 'crash.axr');
  const sections = sectionsOf(readFileSync(await download.path()));
  for (const name of ['META', 'SITE', 'RECS', 'PCAP', 'END ']) assert.ok(sections.has(name), `${name} is not in ${[...sections.keys()]}`);
  const frames = sections.get('PCAP'); // for Wireshark: each line's frames begin with the block that begins a pcapng
  assert.equal(frames.readUInt32LE(0), 0x0a0d0d0a);
  assert.equal(frames.readUInt32LE(8), 0x1a2b3c4d);
  assert.ok(frames.length > 500, `${frames.length} bytes of frames`);
  await remove(page, page.locator('[data-recording="crash"]'), 'crash', kept('recordings'));
  assert.deepEqual(page.faults(), []);
  await page.context().close();
});

test('a recording that is cut off, altered or of another version is named so and cannot be played', { skip }, async () => {
  await program.call('POST', '/recorder/recordings', { name: 'whole' });
  const file = (name) => join(program.data, 'recordings', `${name}.axr`);
  const bytes = readFileSync(file('whole'));
  const altered = Buffer.from(bytes);
  altered[altered.length - 500] ^= 1;
  const newer = Buffer.from(bytes);
  newer[8] = 2;
  const wrong = { short: [bytes.subarray(0, -100), /cut off/], changed: [altered, /was altered/], newer: [newer, /version 2/] };
  for (const [name, [data]] of Object.entries(wrong)) writeFileSync(file(name), data);
  const page = await open(browser, `${program.url}/recorder/recordings/`);
  page.expectLoss(true);
  await program.stop();
  await program.run();
  await becomes('they are known', async () => (await program.call('GET', '/recorder/recordings')).body.recordings.filter((r) => r.fault).map((r) => r.name).sort(), Object.keys(wrong).sort());
  await page.reload();
  for (const [name, [, words]] of Object.entries(wrong)) {
    const row = page.locator(`[data-recording="${name}"]`);
    await row.waitFor();
    assert.match(await row.innerText(), /Damaged/);
    assert.match(await row.innerText(), words);
    assert.equal(await row.getByRole('button', { name: /^Play back/ }).count(), 0);
    await remove(page, row, name, kept('recordings'));
  }
  await page.locator('[data-recording="whole"]').getByRole('button', { name: /^Play back/ }).waitFor();
  await remove(page, page.locator('[data-recording="whole"]'), 'whole', kept('recordings'));
  await page.context().close();
});

test('the commissioning report holds site, parameters, registers, curves and room to sign', { skip }, async () => {
  const page = await open(browser, `${program.url}/gateway`);
  await page.getByRole('link', { name: 'Commissioning report' }).click();
  await page.getByLabel('Machine').fill('Press 7');
  const report = page.locator('[data-field=report]');
  await report.waitFor();
  const text = await report.innerText();
  for (const part of ['Press 7', 'Site and wiring', 'can0', 'values known', 'Hash of the mapping', 'kept', 'Not rehearsed', 'Taken over by']) assert.ok(text.includes(part), `${part} is not in ${text.slice(0, 1500)}`);
  // What nobody has read yet is read when it is asked for, with progress.
  await page.locator('[data-field=report-read]', { hasText: /\d+ are not read yet/ }).waitFor();
  // Its progress may be over before one looks: every text that stands there is kept.
  await page.evaluate(() => {
    globalThis.seen = [];
    const foot = document.querySelector('.report-form .form-foot');
    new MutationObserver(() => globalThis.seen.push(foot.innerText)).observe(foot, { childList: true, characterData: true, subtree: true });
  });
  await page.getByRole('button', { name: 'Read what is missing' }).click();
  await until('all is known', async () => /values known, all of them read/.test(await report.innerText()) || page.locator('[data-field=report-read]').innerText(), 30_000);
  const seen = await page.evaluate(() => globalThis.seen);
  assert.ok(seen.some((text) => /Reading feeder: \d+ of \d+/.test(text) && text.includes('End reading')), seen.join(' | ').slice(0, 1000));
  await page.emulateMedia({ media: 'print' });
  await becomes('the form is not printed', () => page.locator('.report-form').isVisible(), false);
  await shot(page, 'recorder-report', { fullPage: true });
  // On a sheet of A4 each column stands under its heading.
  await page.setViewportSize({ width: 718, height: 1000 });
  const columns = await report.locator('.report-table').evaluateAll((all) => all.flatMap((t) => [...t.tHead.rows[0].cells].map((h, i) => Math.abs(h.getBoundingClientRect().x - t.tBodies[0].rows[0].cells[i].getBoundingClientRect().x))));
  assert.ok(columns.length > 15 && columns.every((off) => off < 1), JSON.stringify(columns));
  await page.emulateMedia({ media: 'screen' });
  assert.deepEqual(page.faults(), []);
  await page.context().close();
});
