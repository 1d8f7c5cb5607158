// The page of the site: forms, faults beside their fields, check and apply as one, keep or roll back, two writers, import, scan, wizard.
// In: the program. Out: counts; pictures under build/browser. Nothing here is left out because the program lacks it.
import assert from 'node:assert/strict';
import { writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { becomes, launch, open, pictures, shot, tileOf, until } from './lib/browser.mjs';
import { deskOf } from './lib/desk.mjs';
import { freePort, isMock, Process, Program } from './lib/program.mjs';

let program, browser, page;
const { stage, told, site, axis, checkIt, applyIt, keepIt } = deskOf(() => ({ program, page }));
/** Somebody else, with the revision as it is now. */
const elsewhere = async (change) => {
  const r = await fetch(`${program.url}/api/v1/site`);
  const document = await r.json();
  change(document);
  const answer = await fetch(`${program.url}/api/v1/site`, { method: 'PUT', headers: { 'content-type': 'application/json', 'if-match': r.headers.get('etag') }, body: JSON.stringify(document) });
  assert.equal(answer.status, 200, await answer.text());
};
const form = (name) => page.getByRole('form', { name });

before(async () => {
  program = await Program.start();
  browser = await launch();
  page = await open(browser, `${program.url}/site`);
  await page.locator('[data-entry="axes/feeder"]').waitFor();
});
after(async () => {
  await browser?.close();
  await program?.end();
});

test('a fault stands beside its field, in words, and what was typed stays', async () => {
  await page.getByRole('button', { name: 'Change axis feeder' }).click();
  const f = form('Change axis feeder');
  await f.getByLabel('Number').fill('2');
  await f.getByText('This number has slide.x.').waitFor();
  await f.getByRole('button', { name: 'Save to draft' }).click();
  assert.equal(await f.getByLabel('Number').inputValue(), '2');
  assert.equal(await f.getByLabel('Number').getAttribute('aria-invalid'), 'true');
  await f.getByLabel('Number').fill('1');
});

test('a change waits as a difference, survives a reload, and touches nothing before it is applied', async () => {
  const f = form('Change axis feeder');
  await f.getByLabel('Unit', { exact: true }).fill('deg');
  await f.getByLabel('Unit', { exact: true }).press('Enter');
  await page.locator('[data-diff="axes/feeder"]').waitFor();
  assert.match(await page.locator('[data-diff="axes/feeder"]').innerText(), /unit mm → deg/);
  assert.equal((await axis('feeder')).unit, 'mm');
  await page.reload();
  await page.locator('[data-diff="axes/feeder"]').waitFor();
  await checkIt();
  assert.equal((await axis('feeder')).unit, 'mm');
});

test('a second writer sees what the first one did, keeps what was typed, and goes on from there', async () => {
  await elsewhere((s) => (s.axes.find((a) => a.name === 'slide.x').velocity_max = 77));
  const theirs = page.locator('[data-field=theirs]');
  await theirs.waitFor();
  assert.match(await theirs.innerText(), /slide\.x: velocity max nothing → 77/);
  assert.match(await page.locator('.site-diff[aria-label="What would change"]').innerText(), /mm → deg/);
  assert.equal(await stage().getByRole('button', { name: 'Apply', exact: true }).isDisabled(), true);
  await shot(page, 'site-two-writers', { fullPage: true });
  await theirs.getByRole('button', { name: 'Put mine on top' }).click();
  await checkIt();
  await applyIt(60);
  await until('it is counted down', async () => /rolled back by itself in (60|[45]\d) s/.test(await told('countdown')) || (await told('countdown')));
  await shot(page, 'site-countdown', { fullPage: true });
  await keepIt();
  assert.equal((await axis('feeder')).unit, 'deg');
  assert.equal((await axis('slide.x')).velocity_max, 77);
});

test('what is not kept is rolled back by itself, and by the button', async () => {
  const change = async (unit) => {
    await page.getByRole('button', { name: 'Change axis feeder' }).click();
    await form('Change axis feeder').getByLabel('Unit', { exact: true }).fill(unit);
    await form('Change axis feeder').getByRole('button', { name: 'Save to draft' }).click();
    await checkIt();
  };
  await change('inch');
  await applyIt(5);
  assert.equal((await axis('feeder')).unit, 'inch');
  await until('it is rolled back by itself', async () => (await stage().getAttribute('data-state')) === 'none' && (await axis('feeder')).unit === 'deg', 15_000);
  await change('m');
  await applyIt(60);
  await stage().getByRole('button', { name: 'Roll back now' }).click();
  await until('it is rolled back', async () => (await axis('feeder')).unit === 'deg');
});

test('a trial is counted down in the head of every part, for everybody; kept or taken back from there by who may', async () => {
  const { parts } = await import('./lib/parts.mjs');
  const other = await open(browser, program.url);
  // What that page applies, that page can keep; somebody else can only take it back.
  let me = '';
  const post = async (path, body) => {
    const r = await fetch(`${program.url}/api/v1${path}`, { method: 'POST', headers: { 'content-type': 'application/json', 'x-client': me }, body: JSON.stringify(body) });
    assert.equal(r.status, 200, await r.text());
  };
  const change = async (unit) => {
    const document = await site();
    document.axes.find((a) => a.name === 'feeder').unit = unit;
    await post('/site/stage?replace=true', document);
    await post('/site/stage/apply', { confirm_within_s: 120 });
  };
  const trial = other.locator('[data-field=trial]');
  const height = async () => (await other.locator('.top').boundingBox()).height;
  await other.locator('[data-axis=feeder] [data-live=true]').waitFor();
  const tall = await height();
  me = await other.evaluate(() => sessionStorage.getItem('axisgate.client'));
  assert.equal(await trial.count(), 0);
  await change('inch');
  await trial.waitFor();
  assert.equal(await height(), tall, 'the head keeps its height');
  const rest = async () => Number(/(\d+) s/.exec(await other.locator('[data-field=trial-rest]').innerText())[1]);
  const first = await rest();
  assert.ok(first > 100 && first <= 120, `${first} s`);
  await until('it counts down', async () => (await rest()) < first || (await rest()));
  for (const { path } of parts.filter((p) => p.name !== 'recipe')) {
    for (const width of [1440, 390]) {
      await other.setViewportSize({ width, height: 900 });
      await other.goto(program.url + path);
      await trial.waitFor();
      for (const name of ['Keep the applied site', 'Roll back the applied site']) {
        const box = await other.getByRole('button', { name }).boundingBox();
        assert.ok(box && box.x >= 0 && box.x + box.width <= width && box.height >= 24, `${path} ${width}: ${name} at ${JSON.stringify(box)}`);
      }
    }
  }
  await shot(other, 'trial-390');
  await other.getByRole('button', { name: 'Roll back the applied site' }).click();
  await trial.waitFor({ state: 'detached' });
  await becomes('it is taken back', async () => (await axis('feeder')).unit, 'deg');
  await change('inch');
  await trial.waitFor();
  await other.getByRole('button', { name: 'Keep the applied site' }).click();
  await trial.waitFor({ state: 'detached' });
  assert.equal((await axis('feeder')).unit, 'inch');
  // Somebody else keeps it: the page that only looks on is told, though no revision changes.
  await change('deg');
  await trial.waitFor();
  await post('/site/stage/confirm', {});
  await trial.waitFor({ state: 'detached' });
  assert.deepEqual(other.faults(), []);
  await other.context().close();
});

test('a trial of somebody else says whose it is and why it cannot be kept here; the own draft stays in sight', async () => {
  await page.getByRole('button', { name: 'Change axis feeder' }).click();
  await form('Change axis feeder').getByLabel('Unit', { exact: true }).fill('cm');
  await form('Change axis feeder').getByRole('button', { name: 'Save to draft' }).click();
  await stage().locator('[data-field=apply-why]').getByText('Check first.').waitFor();
  const bert = async (path, body) => {
    const r = await fetch(`${program.url}/api/v1${path}`, { method: 'POST', headers: { 'content-type': 'application/json', 'x-client': 'page-bert00' }, body: JSON.stringify(body) });
    assert.equal(r.status, 200, await r.text());
  };
  const document = await site();
  document.axes.find((a) => a.name === 'slide.x').velocity_max = 63;
  await bert('/site/stage?replace=true', document);
  await bert('/site/stage/apply', { confirm_within_s: 120 });
  const by = page.locator('[data-field=applied-by]');
  await by.waitFor();
  assert.match(await by.innerText(), /^Applied by .* \(from the page page-bert00\)\. Only the page of .* that applied it can keep it; take it back and apply it from here if need be\.$/);
  assert.equal(await stage().getByRole('button', { name: 'Keep', exact: true }).isDisabled(), true);
  const own = page.locator('[data-field=own-draft]');
  await own.getByText('Your own draft waits: 1 change.').click();
  await own.getByText(/→ cm/).waitFor();
  await page.getByText('in force, on trial').waitFor();
  await shot(page, 'site-trial-of-another', { fullPage: true });
  await bert('/site/stage/roll-back', {});
  await until('the trial is over', async () => (await stage().getAttribute('data-state')) !== 'applied');
  await page.reload();
  await page.getByRole('button', { name: 'Drop …' }).click();
  await page.getByRole('button', { name: 'Drop all changes' }).click();
});

test('a line, a drive and an axis are added by their forms and applied as one', async () => {
  await page.getByRole('button', { name: 'Add a line' }).click();
  const line = form('Add a line');
  await line.getByLabel('Name').fill('can1');
  await line.getByLabel('Family').selectOption('uim342');
  await line.getByLabel('URI').fill('twin');
  await line.getByRole('button', { name: 'Save to draft' }).click();
  await page.getByRole('button', { name: 'Add a drive' }).click();
  const drive = form('Add a drive');
  await drive.getByLabel('Name').fill('extra');
  await drive.getByLabel('Line').selectOption('can1');
  await drive.getByLabel('Address').fill('7');
  await drive.getByRole('button', { name: 'Save to draft' }).click();
  await page.getByRole('button', { name: 'Add an axis' }).click();
  const a = form('Add an axis');
  await a.getByLabel('Name').fill('extra');
  await a.getByLabel('Drive', { exact: true }).selectOption('extra');
  await becomes('a free number is there', () => a.getByLabel('Number').inputValue(), '3');
  await a.getByRole('button', { name: 'Save to draft' }).click();
  await becomes('three differences wait', () => page.locator('[data-diff]').count(), 3);
  await checkIt();
  await applyIt(60);
  await keepIt();
  assert.equal((await axis('extra')).number, 3);
  await until('it lives', async () => (await program.axis('extra')).online === true, 15_000);
});

test('a removal says what hangs on it, and can be dropped again', async () => {
  await page.getByRole('button', { name: 'Remove line can1' }).click();
  await page.getByText('Remove line can1, and with it drives extra; axes extra?').waitFor();
  await page.locator('[data-entry="lines/can1"]').getByRole('button', { name: 'Remove', exact: true }).click();
  await becomes('three are removed', () => page.locator('[data-diff].is-removed').count(), 3);
  await stage().getByRole('button', { name: 'Drop …' }).click();
  await stage().getByRole('button', { name: 'Drop all changes' }).click();
  await page.locator('[data-entry="lines/can1"]').waitFor();
  await becomes('no difference waits', () => page.locator('[data-diff]').count(), 0);
});

test('what only the gateway can refuse stands at its entry', async () => {
  const document = await site();
  document.lines.push({ name: 'bad', uri: 'no-such-kind:x', family: 'uim342' });
  delete document.lines.at(-1).uri;
  const file = join(program.data, 'bad.json');
  writeFileSync(file, JSON.stringify(document));
  await page.getByLabel('Import a site').setInputFiles(file);
  await page.locator('[data-entry="lines/bad"]').waitFor();
  await checkIt();
  assert.match(await page.locator('[data-entry="lines/bad"]').innerText(), /uri/);
  assert.equal(await stage().getByRole('button', { name: 'Apply', exact: true }).isDisabled(), true);
  assert.equal((await site()).lines.some((l) => l.name === 'bad'), false);
});

test('an imported document is a difference first; what is none says why', async () => {
  const document = await site();
  document.axes.find((a) => a.name === 'feeder').unit = 'mm';
  const good = join(program.data, 'good.json');
  writeFileSync(good, JSON.stringify(document));
  writeFileSync(join(program.data, 'none.json'), '{"axes":');
  await page.getByLabel('Import a site').setInputFiles(join(program.data, 'none.json'));
  await until('it says why', async () => /not JSON/.test(await told('files-told')) || (await told('files-told')));
  await page.getByLabel('Import a site').setInputFiles(good);
  await until('it is a draft', async () => /1 differences/.test(await told('files-told')) || (await told('files-told')));
  await checkIt();
  await applyIt(60);
  await keepIt();
  assert.equal((await axis('feeder')).unit, 'mm');
  const [download] = await Promise.all([page.waitForEvent('download'), page.getByRole('link', { name: 'Export the site' }).click()]);
  assert.equal(download.suggestedFilename(), 'site.json');
});

test('what another client has staged is neither taken away nor applied unseen; what was typed stays', async () => {
  const other = async (change, replace = false) => {
    const document = await site();
    change(document);
    const r = await fetch(`${program.url}/api/v1/site/stage${replace ? '?replace=true' : ''}`, { method: 'POST', headers: { 'content-type': 'application/json', 'x-client': 'bert' }, body: JSON.stringify(document) });
    return { status: r.status, body: await r.json() };
  };
  const first = await other((s) => (s.axes.find((a) => a.name === 'slide.x').velocity_max = 91));
  assert.equal(typeof first.body.id, 'string', 'one stage is told from another');
  await page.getByRole('button', { name: 'Change axis feeder' }).click();
  await form('Change axis feeder').getByLabel('Unit', { exact: true }).fill('cm');
  await form('Change axis feeder').getByRole('button', { name: 'Save to draft' }).click();
  await stage().getByRole('button', { name: 'Check', exact: true }).click();
  const rival = page.locator('[data-field=rival]');
  await rival.waitFor();
  assert.match(await rival.innerText(), /slide\.x: velocity max .* → 91/);
  await shot(page, 'site-stage-taken', { fullPage: true });
  await rival.getByRole('button', { name: 'Check mine instead' }).click();
  await until('mine is checked', async () => /^Checked/.test(await told('stage-told')) || (await told('stage-told')));
  await page.route('**/api/v1/site/stage', (r) => (r.request().method() === 'GET' ? r.fulfill({ status: 503, contentType: 'application/problem+json', body: '{"type":"about:blank","title":"Later","status":503,"detail":"later","reason":"later"}' }) : r.fallback())); // the page has not looked again yet
  assert.equal((await other((s) => (s.axes.find((a) => a.name === 'slide.x').velocity_max = 92), true)).status, 200);
  await page.unroute('**/api/v1/site/stage');
  await stage().getByRole('button', { name: 'Apply', exact: true }).click().catch(() => undefined);
  await rival.waitFor();
  await until('the other stage is shown', async () => /→ 92/.test(await rival.innerText()) || (await rival.innerText()));
  assert.notEqual((await axis('slide.x')).velocity_max, 92);
  assert.notEqual((await axis('feeder')).unit, 'cm');
  await rival.getByRole('button', { name: 'Take theirs into view' }).click();
  await stage().getByRole('button', { name: 'Apply theirs' }).click();
  await until('theirs is applied', async () => /^Applied/.test(await told('stage-told')) || (await told('stage-told')));
  await keepIt();
  assert.equal((await axis('slide.x')).velocity_max, 92);
  const mine = page.locator('.site-diff[aria-label="What would change"]');
  await until('what was typed waits still', async () => /→ cm/.test(await mine.innerText()) || (await mine.innerText()));
  await page.getByRole('button', { name: 'Drop …' }).click();
  await page.getByRole('button', { name: 'Drop all changes' }).click();
});

test('a line is scanned: both drives of the site are found, and known', async () => {
  await page.getByRole('button', { name: 'Scan can0' }).click();
  const scan = page.locator('[data-entry="lines/can0"]').getByRole('form', { name: 'Scan line can0' }); // under its line
  await becomes('the keyboard goes on there', () => page.evaluate(() => document.activeElement?.textContent), 'Scan of line can0');
  await scan.getByLabel('From address').fill('5');
  await scan.getByLabel('to', { exact: true }).fill('9');
  await scan.getByRole('button', { name: 'Scan', exact: true }).click();
  const drives = isMock ? [['5', 'feeder']] : [['5', 'feeder'], ['6', 'slide']]; // the stand-in finds the first of a line alone
  for (const [address, drive] of drives) {
    const found = scan.locator(`[data-found="${address}"]`);
    await found.waitFor({ timeout: 60_000 });
    assert.match(await found.innerText(), new RegExp(`known as ${drive}`));
  }
  await until('it has an end', async () => /found/i.test(await told('scan-told')) || (await told('scan-told')), 60_000);
  if (!isMock) assert.deepEqual(await scan.locator('[data-found]').evaluateAll((l) => l.map((e) => e.dataset.found).sort()), ['5', '6']);
});

test('from a new data directory to a moving axis: overview, wizard, by keyboard', async () => {
  const empty = await Program.start({ site: null });
  try {
    const p = await open(browser, `${empty.url}/gateway`);
    await p.getByText('Site revision').waitFor();
    await p.getByRole('link', { name: 'axisgate, overview' }).click();
    await p.getByText('No axis is configured.').waitFor();
    await shot(p, 'overview-empty');
    await p.getByRole('link', { name: 'Begin with the wizard' }).click();
    const wizard = (n) => p.locator(`.wizard[data-step="${n}"]`);
    await wizard(1).waitFor();
    await p.getByLabel('Family').selectOption('uim342');
    await p.getByLabel('Name').press('Enter');
    await wizard(2).waitFor();
    await p.getByLabel('Name').press('Enter');
    await wizard(3).waitFor();
    await p.getByLabel('Name').press('Enter');
    await p.getByText('How many increments make one mm?').waitFor();
    await p.getByLabel('Increments per unit').fill('0');
    await p.getByText('Above 0.').waitFor();
    await p.getByLabel('Increments per unit').fill('3200');
    await p.getByLabel('Name').fill('first');
    await p.getByLabel('Name').press('Enter');
    await wizard(4).waitFor();
    await shot(p, 'site-wizard-apply', { fullPage: true });
    await p.getByRole('button', { name: 'Check', exact: true }).click();
    const apply = p.getByRole('button', { name: 'Apply', exact: true });
    await until('it can be applied', async () => !(await apply.isDisabled()));
    await p.getByLabel('Confirm within, s').fill('5');
    await apply.click();
    await p.getByRole('button', { name: 'Go on to moving first' }).click();
    await p.getByText('rolled back because nobody pressed Keep').waitFor({ timeout: 20_000 });
    await shot(p, 'site-wizard-rolled-back', { fullPage: true });
    await p.getByRole('button', { name: 'Apply again' }).click();
    await wizard(4).waitFor();
    await p.getByLabel('Confirm within, s').fill('60');
    await p.getByRole('button', { name: 'Check', exact: true }).click();
    await until('it can be applied again', async () => !(await apply.isDisabled()));
    await apply.click();
    await p.getByRole('button', { name: 'Keep', exact: true }).click();
    await p.getByRole('button', { name: 'Go on to moving first' }).click();
    await wizard(5).waitFor();
    const first = tileOf(p, 'first');
    await until('it is live', async () => (await first.field('position').getAttribute('data-live')) === 'true', 15_000);
    await p.getByRole('button', { name: 'Enable first' }).click();
    await until('it is enabled', async () => /Enabled/.test(await first.text('state')));
    await p.getByRole('textbox', { name: 'Distance of first' }).fill('2');
    await p.getByRole('button', { name: 'Move by distance of first' }).click();
    await until('it has moved', async () => Math.abs((await first.position()) - 2) < 0.01 || (await first.position()), 15_000);
    await shot(p, 'site-wizard-move', { fullPage: true });
    assert.deepEqual(p.faults(), []);
    await p.context().close();
    await pictures(browser, empty.url, '/site', 'site-after-wizard', (q) => q.locator('[data-entry="axes/first"]').waitFor());
  } finally {
    await empty.end();
  }
});

test('a line that is typed is in force and scanned with one click, and a reload goes on where it was', { skip: isMock && 'the stand-in opens no line' }, async () => {
  const port = await freePort();
  const drive = await Process.run(['twin', 'uim342', '--line', `tcp-listen:127.0.0.1:${port}`], /^ready /m);
  const empty = await Program.start({ site: null });
  try {
    const p = await open(browser, `${empty.url}/site`);
    const wizard = (n) => p.locator(`.wizard[data-step="${n}"]`);
    await wizard(1).waitFor();
    await p.getByLabel('Name').fill('bench');
    await p.getByLabel('Family').selectOption('uim342');
    await p.getByLabel('URI').fill(`tcp:127.0.0.1:${port}`);
    await p.getByLabel('Name').press('Enter');
    await wizard(2).waitFor();
    await p.getByText('Scanning asks the line itself, so bench must be in force first.').waitFor();
    await shot(p, 'site-wizard-scan-later', { fullPage: true });
    await p.reload();
    await wizard(2).waitFor();
    assert.deepEqual((await empty.call('GET', '/site')).body.lines ?? [], [], 'nothing is applied before it is asked for');
    await p.getByRole('button', { name: 'Apply bench and scan it' }).click();
    const scan = p.getByRole('form', { name: 'Scan line bench' });
    await scan.getByRole('button', { name: 'Add 5 as a drive' }).waitFor({ timeout: 120_000 });
    assert.equal((await empty.call('GET', '/site/stage')).body.state, 'none', 'it is kept');
    await p.reload();
    await scan.getByRole('button', { name: 'Add 5 as a drive' }).click(); // of the scan that runs on, or has ended meanwhile
    await p.getByRole('button', { name: 'Next' }).click();
    await wizard(3).waitFor();
    await shot(p, 'site-wizard-scanned', { fullPage: true });
    assert.deepEqual(p.faults(), []);
    await p.context().close();
  } finally {
    await empty.end();
    await drive.stop();
  }
});

test('axe-core finds nothing serious, nothing scrolls sideways, pictures', async () => {
  await pictures(browser, program.url, '/site', 'site', async (p) => {
    await p.locator('[data-entry="axes/feeder"]').waitFor();
    await p.getByRole('button', { name: 'Change axis feeder' }).click();
    await p.getByRole('button', { name: 'Change drive feeder' }).click();
    await p.locator('[data-field=options] summary').first().click();
    await p.getByRole('button', { name: 'Remove line can0' }).click();
  });
});
