// A first day with the program, once in each language: the registers of a panel drawn by mouse, an axis tuned with two captures laid over each
// other, a fault and the loss of command rehearsed, the report printed, and a recording handed on that plays the fault back. Its words are those of
// the page's own table, so that one walk serves all languages. In: the program. Out: what it took; pictures under build/browser.
import assert from 'node:assert/strict';
import { execFile } from 'node:child_process';
import { join } from 'node:path';
import { promisify } from 'node:util';
import { after, before, test } from 'node:test';
import { becomes, launch, open, quiet, shot, tooWide, until } from './lib/browser.mjs';
import { binary, isMock, Program } from './lib/program.mjs';

const skip = isMock && 'the stand-in keeps nothing';
let browser;
before(async () => {
  browser = await launch();
});
after(async () => {
  await browser?.close();
});

/** The sentences of the language that the page speaks, as it has loaded them: the English one is the key. */
async function speech(page, language) {
  const table = await page.evaluate(async () => {
    const file = performance.getEntriesByType('resource').map((e) => e.name).find((n) => /\/(de|zh)-[\w-]+\.js$/.test(n));
    return file ? Object.values(await import(file)).find((v) => typeof v === 'object') : {};
  });
  assert.equal(Object.keys(table).length > 1000, language !== 'en', 'the table of the language, and no other');
  return (text, values = {}) => {
    assert.ok(language === 'en' || text in table, `${language} has no "${text}"`);
    return (table[text] ?? text).replace(/\{(\w+)\}/g, (all, name) => values[name] ?? all);
  };
}

for (const language of ['en', 'de', 'zh']) {
  test(`${language}: a register map, two captures, a rehearsed fault, the report, a recording for a colleague`, { skip }, async () => {
    const program = await Program.start();
    try {
      await day(program, language);
    } finally {
      await program.end();
    }
  });
}

async function day(program, language) {
  // The reader's browser speaks English, and the language is switched on the page: at the end the choice still holds.
  const page = await open(browser, program.url, { locale: 'en', viewport: { width: 1280, height: 900 } });
  page.setDefaultTimeout(30_000); // a day is long beside other tests
  const part = (path) => page.locator(`.nav a[href="${path}"]`).click();
  await page.locator('[data-axis=feeder] [data-live=true]').first().waitFor();
  if (language !== 'en') {
    await part('/gateway');
    await page.locator('main [data-field=language]').selectOption(language);
    await until('the page speaks it', () => page.evaluate((l) => document.documentElement.lang === l, language).catch(() => false));
    await page.locator('main [data-field=language]').waitFor();
  }
  const s = await speech(page, language);
  const picture = async (name) => {
    assert.ok((await tooWide(page)) <= 0, `${name} is too wide`);
    assert.ok((await page.locator('.nav').evaluate((e) => e.scrollWidth - e.clientWidth)) <= 0, `${name}: a part of the navigation is out of sight`);
    await shot(page, `first-day-${language}-${name}`, { fullPage: true });
  };
  const press = (text, values) => page.getByRole('button', { name: s(text, values), exact: true }).click();

  // The registers of a panel, by mouse.
  await part('/mappings');
  await page.locator('[data-point=position_units]').waitFor();
  for (const [i, [point, place]] of [['position_units', 0], ['statusword', 2], ['target_position', 10]].entries()) {
    await drag(page, `[data-point=${point}]`, `[data-place="${place}"]`);
    await becomes(`${point} has its place`, () => page.locator('[data-mapping]').count(), i + 1); // the grid has moved by then
  }
  await becomes('three places are taken', async () => (await program.call('GET', '/mappings')).body.map((m) => `${m.address} ${m.point}`).sort(), ['0 position_units', '10 target_position', '2 statusword']);
  await becomes('they are live', () => page.locator('[data-mapping] [data-field=value][data-live=true]').count(), 3);
  await picture('registers');

  // The axis, tuned: the same way twice, with other ramps.
  await part('/');
  await page.locator('[data-axis=feeder] h3 a').click();
  const tab = (name) => page.locator('.axis-tabs').getByRole('link', { name: s(name), exact: true });
  await tab('Move').waitFor();
  await press('Enable');
  await becomes('it is enabled', async () => (await program.axis('feeder')).state, 'operation_enabled');
  await tab('Scope').click();
  await page.locator('a[href*="captures"]').first().click();
  const form = page.getByRole('form', { name: s('New capture') });
  for (const [name, ramp, place] of [['before', '60', 10], ['after', '400', 20]]) {
    await form.getByLabel(s('Name'), { exact: true }).fill(name);
    await form.getByLabel(s('After it, ms'), { exact: true }).fill('900');
    await form.getByRole('button', { name: s('Arm'), exact: true }).click();
    await becomes('it is armed', () => page.locator(`[data-capture="${name}"]`).getAttribute('data-state'), 'armed');
    await page.goBack();
    await tab('Move').click();
    for (const [field, text] of [['Distance', '10'], ['Speed', '30'], ['Acceleration', ramp], ['Deceleration', ramp]]) await page.getByRole('textbox', { name: s(field), exact: true }).fill(text);
    await press('Move forward by distance');
    await until('it has arrived', async () => {
      const a = await program.axis('feeder');
      return (a.target_reached && Math.abs(a.position - place) < 0.01) || a.position;
    });
    await tab('Scope').click();
    await page.locator('a[href*="captures"]').first().click();
    await becomes(`${name} is done`, () => page.locator(`[data-capture="${name}"]`).getAttribute('data-state'), 'done');
  }
  for (const name of ['before', 'after']) await press('Draw {name}', { name });
  const overlay = page.locator('[data-field=overlay]');
  await page.getByRole('heading', { name: s('Laid over each other at their triggers') }).waitFor();
  const curves = overlay.getByRole('list', { name: s('Curves') }).locator('li');
  await becomes('two curves of each', async () => (await curves.allInnerTexts()).map((c) => c.split(' ').slice(0, 2).join(' ')), ['before: feeder', 'before: feeder', 'after: feeder', 'after: feeder']);
  await overlay.locator('.u-over').waitFor();
  await picture('captures');

  // What if the shaft is held: by the hand of the simulation, until the drive tells its fault.
  await page.goBack();
  await tab('Simulation').click();
  const stall = page.locator('[data-hand]').getByRole('switch', { name: s('Stall'), exact: true });
  await stall.click();
  await becomes('the shaft is held', async () => (await program.call('GET', '/drives/feeder/hand')).body.stall, true);
  await tab('Move').click();
  await page.getByRole('textbox', { name: s('Distance'), exact: true }).fill('50');
  await press('Move forward by distance');
  await until('an alarm stands', async () => (await program.call('GET', '/alarms')).body.alarms.some((a) => a.axis === 'feeder') || (await program.axis('feeder')));
  await part('/events');
  await page.locator('[data-alarm]').first().waitFor();
  await picture('alarm');

  // Loss of command: on models, with times.
  await part('/site');
  await press('Rehearse on models');
  await page.locator('[data-field="rehearsal-report"]').waitFor({ timeout: 90_000 });

  // What happened goes to a colleague.
  await page.goto(`${program.url}/recorder/recordings/`);
  const freeze = page.getByRole('form', { name: s('New recording') });
  await freeze.getByLabel(s('Name'), { exact: true }).fill('held');
  const freezes = freeze.getByRole('button', { name: s('Freeze the last minutes'), exact: true });
  await freezes.click();
  // An alarm makes one by itself: while that is written, another one is refused and asked for again.
  await until('the recording is there', async () => {
    if (await page.locator('[data-recording="held"]').count()) return true;
    if (await page.locator('[data-field="recording-told"].result-refused').count()) await freezes.click();
    return page.locator('[data-field="recording-told"]').innerText();
  }, 30_000);
  const [download] = await Promise.all([page.waitForEvent('download'), page.getByRole('link', { name: s('Download {name}', { name: 'held' }) }).click()]);
  const file = join(program.data, download.suggestedFilename());
  await download.saveAs(file);
  await press('Play back {name}', { name: 'held' });
  const feeder = page.locator('[data-field=playback] tr[data-axis="feeder"]');
  await feeder.waitFor();
  const happened = page.locator('.playback-happened');
  assert.match(await feeder.locator('td').nth(4).innerText(), /^29\b/, 'the code of the fault stands at the axis');
  await until('the held shaft is in it', async () => /stall/i.test(await happened.innerText()) || (await happened.innerText()));
  const reads = page.locator('[data-field=playback] .cursor-table tr').filter({ has: page.getByRole('rowheader', { name: 'A', exact: true }) }).locator('td').nth(1);
  await until('the cursor reads the place at the end', async () => Math.abs(Number((await reads.innerText()).replace(',', '.')) - 20) < 0.1 || (await reads.innerText()));
  await picture('playback');
  await page.getByRole('slider', { name: s('Instant of the recording') }).focus();
  await page.keyboard.press('Home');
  await until('at its beginning nothing of it has happened', async () => !/stall/i.test(await happened.innerText()));

  // The report, printed.
  await part('/gateway');
  await page.getByRole('link', { name: s('Commissioning report'), exact: true }).click();
  await page.getByLabel(s('Machine'), { exact: true }).fill('Press 7');
  const report = page.locator('[data-field=report]');
  await report.waitFor();
  await quiet(page);
  const said = await report.innerText();
  for (const part of ['Press 7', s('Site and wiring'), 'position_units', s('Register list'), 'before', 'after', s('Loss of command'), s('Hash of the mapping:')]) assert.ok(said.includes(part), `${part} is not in ${said.slice(0, 3000)}`);
  await page.evaluate(() => (globalThis.print = () => (globalThis.printed = true)));
  await press('Print');
  assert.equal(await page.evaluate(() => globalThis.printed), true);
  await page.emulateMedia({ media: 'print' });
  assert.deepEqual(await cutShort(report), [], 'all of it is on the paper');
  await picture('report');
  await page.emulateMedia({ media: 'screen' });
  assert.equal(await page.evaluate(() => document.documentElement.lang), language, 'the choice has held all day');
  assert.deepEqual(page.faults(), []);
  await page.context().close();

  // The colleague has the file and the program, and no drive: what was recorded comes about again.
  const { stdout } = await promisify(execFile)(binary, ['replay', file]);
  assert.match(stdout, /^\d{4,} inputs, \d{4,} outcomes compared, 0 differences/);
}

/** Parts of the report that are lower than what they hold: it would lie upon what stands below, or not be printed. */
const cutShort = (report) =>
  report.evaluate((e) => [...e.querySelectorAll('*')].filter((p) => p.scrollHeight > p.clientHeight + 2 && getComputedStyle(p).display !== 'inline' && !p.closest('.scope-plot')).map((p) => `${p.className}: ${p.clientHeight} of ${p.scrollHeight} px`));

/** From the middle of one to the middle of the other, in steps, as a hand does. */
async function drag(page, from, to) {
  const middle = async (what) => {
    const b = await page.locator(what).first().boundingBox();
    return [b.x + b.width / 2, b.y + b.height / 2];
  };
  for (const what of [to, from]) await page.locator(what).first().scrollIntoViewIfNeeded();
  const [a, b] = [await middle(from), await middle(to)]; // both where they are now: the second may have scrolled the first
  await page.mouse.move(...a);
  await page.mouse.down();
  await page.mouse.move((a[0] + b[0]) / 2, (a[1] + b[1]) / 2, { steps: 4 });
  await page.mouse.move(...b, { steps: 4 });
  await page.mouse.up();
  await page.locator('.map-ghost').waitFor({ state: 'detached' });
}
