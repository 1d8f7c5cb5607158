// Page benchmark: from the navigation to the first axis tile that shows a position, with an empty cache, from loopback; and what was loaded.
// In: AXISGATE_BIN, CHROMIUM. Out: the ratios to the limits, and both figures; exit 1 if one is not kept. The median of five navigations,
// each in a context of its own. Needs the packages of tests/browser.
import { launch } from '../browser/lib/browser.mjs';
import { Program } from '../browser/lib/program.mjs';
import { median, say } from './page_report.mjs';

const firstPaint_ms = 1000;
const mostLoaded_kB = 300;
const times = 5;

/** In the page, before any of its code: notes when a tile has shown a live position; the picture after that frame is on the screen. */
const watch = () => {
  const look = () => {
    const field = document.querySelector('[data-axis] [data-field=position][data-live=true]');
    if (field && field.getAttribute('data-value') !== '') requestAnimationFrame(() => (globalThis.painted_ms = performance.now()));
    else requestAnimationFrame(look);
  };
  requestAnimationFrame(look);
};

async function once(browser, url) {
  const context = await browser.newContext({ viewport: { width: 1440, height: 900 } });
  const page = await context.newPage();
  const cdp = await context.newCDPSession(page);
  await cdp.send('Network.enable');
  let bytes = 0;
  let requests = 0;
  const unpacked = [];
  cdp.on('Network.responseReceived', ({ response }) => {
    if (/\.(js|css)$/.test(response.url) && !Object.keys(response.headers).some((h) => h.toLowerCase() === 'content-encoding')) unpacked.push(response.url);
  });
  cdp.on('Network.loadingFinished', (e) => {
    bytes += e.encodedDataLength;
    requests += 1;
  });
  await page.addInitScript(watch);
  await page.goto(url);
  await page.waitForFunction(() => globalThis.painted_ms > 0, null, { timeout: 20_000 });
  const result = { painted_ms: await page.evaluate(() => globalThis.painted_ms), bytes, requests, unpacked };
  await context.close();
  return result;
}

const program = await Program.start();
const browser = await launch();
const runs = [];
try {
  for (let i = 0; i < times; i += 1) runs.push(await once(browser, program.url));
} finally {
  await browser.close();
  await program.end();
}
console.log(`the page, empty cache, ${times} times: ${runs.map((r) => r.painted_ms.toFixed(0)).join(', ')} ms; ${runs[0].requests} answers`);
let kept = say('first tile shows a position (median)', median(runs.map((r) => r.painted_ms)), firstPaint_ms, 'ms');
kept = say('loaded until then, compressed', median(runs.map((r) => r.bytes)) / 1000, mostLoaded_kB, 'kB') && kept;
kept = say('scripts and styles sent uncompressed', new Set(runs.flatMap((r) => r.unpacked)).size, 0, 'files') && kept;
console.log(kept ? 'all limits kept' : 'NOT all limits kept');
process.exitCode = kept ? 0 : 1;
