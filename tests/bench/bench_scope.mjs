// Scope benchmark: the page's scope draws four channels at 1000 samples a second for a minute; beside an empty page in the same run.
// In: AXISGATE_BIN, CHROMIUM, seconds (default 60). Out: the share of animation frames in time, the samples that the page kept, and the
// memory they took, each with its limit; exit 1 if one is not kept. A frame is late when two periods of the screen or more lie between it
// and the one before. The samples come through the page's own WebSocket (feed_relay.mjs) and are read back from the CSV that the scope saves.
import { readFileSync } from 'node:fs';
import { launch, until } from '../browser/lib/browser.mjs';
import { Program } from '../browser/lib/program.mjs';
import { relayTo, sampleOf } from './feed_relay.mjs';
import { say, sayOf } from './page_report.mjs';

const seconds = Number(process.argv[2] ?? 60);
const empty_s = Math.max(2, seconds / 3); // before and after
const warmUp_s = 5;
const leastInTime = 0.95; // of the empty page's frames in time
const mostGrown_MB = 12; // 1000 samples a second for a minute are 2.4 MB, in arrays that double as they grow; the rest is what a heap breathes

/** Counts the frames of a page for so long. */
const countFrames = (page, s) =>
  page.evaluate(
    (ms) =>
      new Promise((resolve) => {
        const late_ms = 2 * (1000 / 60) - 1; // a clock's ticks are not exact
        const r = { total: 0, late: 0, longest_ms: 0 };
        let before = performance.now();
        const begun = before;
        const next = () => {
          const now = performance.now();
          const d = now - before;
          before = now;
          r.total += 1;
          if (d >= late_ms) r.late += 1;
          r.longest_ms = Math.max(r.longest_ms, d);
          if (now - begun < ms) requestAnimationFrame(next);
          else resolve({ ...r, took_s: (now - begun) / 1000 });
        };
        requestAnimationFrame(next);
      }),
    s * 1000,
  );

async function emptyPage(browser) {
  const context = await browser.newContext({ viewport: { width: 1440, height: 900 } });
  const page = await context.newPage();
  const r = await countFrames(page, empty_s);
  await context.close();
  return r;
}

/** Seconds that the page's main thread has been at work, all and in scripts: a busy machine changes them less than it does the frames. */
async function worked_s(cdp) {
  await cdp.send('Performance.enable');
  const { metrics } = await cdp.send('Performance.getMetrics');
  const of = (name) => metrics.find((m) => m.name === name)?.value ?? 0;
  return { all: of('TaskDuration'), scripts: of('ScriptDuration') };
}

/** Bytes in use after the collector has been. */
async function memory_MB(cdp) {
  await cdp.send('HeapProfiler.collectGarbage');
  const u = await cdp.send('Runtime.getHeapUsage');
  return (u.usedSize + (u.backingStorageSize ?? 0)) / 1e6;
}

const program = await Program.start();
const relay = await relayTo(program.url, 'feeder');
const browser = await launch();
let kept = true;
try {
  const empty = [await emptyPage(browser)];

  const context = await browser.newContext({ viewport: { width: 1440, height: 900 }, reducedMotion: 'no-preference', acceptDownloads: true });
  const page = await context.newPage();
  const cdp = await context.newCDPSession(page);
  await page.goto(`${relay.url}/axes/feeder`);
  await page.locator('.scope canvas').waitFor();
  const scope = page.locator('.scope');
  for (const name of ['Position', 'Demand', 'Velocity', 'Target']) {
    const b = scope.getByRole('button', { name, exact: true });
    if ((await b.getAttribute('aria-pressed')) !== 'true') await b.click();
  }
  await until('the axis is live', async () => (await page.locator('[data-field=position]').first().getAttribute('data-live')) === 'true');
  const feed = relay.feeds.at(-1);
  const count = (seconds + warmUp_s + 2) * 1000;
  const given = feed.give(count);
  given.catch(() => {});
  await page.waitForTimeout(warmUp_s * 1000);
  const before_MB = await memory_MB(cdp);
  const work = await worked_s(cdp);
  const busy = await countFrames(page, seconds);
  const worked = await worked_s(cdp);
  const after_MB = await memory_MB(cdp);
  await given;

  await scope.getByRole('group', { name: 'Time shown' }).getByRole('button', { name: '2 min' }).click();
  await page.waitForTimeout(1000);
  const [download] = await Promise.all([page.waitForEvent('download'), scope.getByRole('button', { name: 'CSV' }).click()]);
  const rows = readFileSync(await download.path(), 'utf8').trim().split('\r\n').slice(1).map((l) => l.split(','));
  await context.close();
  empty.push(await emptyPage(browser));

  // columns: time, seconds, position, demand, velocity, following error, target
  const seen = new Set();
  let wrong = 0;
  for (const r of rows) {
    const n = Math.round(Number(r[6]) * 1000);
    const s = sampleOf(n);
    if (Number(r[2]) === s.position && Number(r[3]) === s.position_demand && Number(r[4]) === s.velocity && Number(r[6]) === s.target_position) seen.add(n);
    else wrong += 1;
  }
  const missing = count - seen.size;

  const inTime = (r) => ((r.total - r.late) / r.took_s) * 60;
  const quiet = empty.reduce((a, r) => ({ total: a.total + r.total, late: a.late + r.late, took_s: a.took_s + r.took_s, longest_ms: Math.max(a.longest_ms, r.longest_ms) }));
  const words = (r) => `${r.total} frames in ${r.took_s.toFixed(1)} s, ${((r.late / r.took_s) * 60).toFixed(0)} late in a minute, longest ${r.longest_ms.toFixed(0)} ms`;
  console.log(`the scope, 4 channels at 1 kHz, ${seconds} s: ${words(busy)}`);
  console.log(`an empty page, before and after:        ${words(quiet)}`);
  const share = (a, b) => (((b - a) / busy.took_s) * 100).toFixed(0);
  console.log(`    the main thread was at work ${share(work.all, worked.all)} % of the time, ${share(work.scripts, worked.scripts)} % in scripts`);
  kept = sayOf('frames in time in a minute', inTime(busy), inTime(quiet), leastInTime, 'empty page', '/min') && kept;
  kept = say('samples that the page does not have', missing, 0, `of ${count}`) && kept;
  console.log(`    ${rows.length} rows were read back; ${wrong} of them are the drive's own, from before and after`);
  kept = say(`memory grown in ${seconds} s`, Math.max(0, after_MB - before_MB), mostGrown_MB, 'MB') && kept;
  console.log(`    from ${before_MB.toFixed(1)} to ${after_MB.toFixed(1)} MB after the collector`);
} finally {
  await browser.close();
  relay.close();
  await program.end();
}
console.log(kept ? 'all limits kept' : 'NOT all limits kept');
process.exitCode = kept ? 0 : 1;
