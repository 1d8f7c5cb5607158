// Page benchmark: from the navigation to the first axis tile that shows a position, with an empty cache, from loopback; and what was loaded. The same
// for the register map of 4096 mappings, to its first value, and its pictures a second while values of 8 axes change and while one scrolls.
// In: AXISGATE_BIN, CHROMIUM. Out: the ratios to the limits, and both figures; exit 1 if one is not kept. The median of five navigations,
// each in a context of its own. Needs the packages of tests/browser, and a machine that does nothing else.
import { launch } from '../browser/lib/browser.mjs';
import { manyMappings } from '../browser/lib/many.mjs';
import { Program } from '../browser/lib/program.mjs';
import { median, say, sayOf } from './page_report.mjs';

const firstPaint_ms = 1000;
const leastPictures = 60;
/** The browser's own clock of pictures is a little off 60 Hz. */
const clock = 0.98;
const mostLoaded_kB = 300;
const times = 5;
/** Bytes; what is smaller gains nothing by packing (web/scripts/pack.mjs). */
const leastPacked = 512;

/** In the page, before any of its code: notes when it has shown a live value; the picture after that frame is on the screen. */
const watch = (selector) => {
  const look = () => {
    const field = document.querySelector(selector);
    if (field && field.getAttribute('data-value') !== '') requestAnimationFrame(() => (globalThis.painted_ms = performance.now()));
    else requestAnimationFrame(look);
  };
  requestAnimationFrame(look);
};

async function once(browser, url, selector) {
  const context = await browser.newContext({ viewport: { width: 1440, height: 900 } });
  const page = await context.newPage();
  const cdp = await context.newCDPSession(page);
  await cdp.send('Network.enable');
  let bytes = 0;
  let requests = 0;
  const unpacked = [];
  cdp.on('Network.responseReceived', ({ response }) => {
    const headers = Object.fromEntries(Object.entries(response.headers).map(([h, v]) => [h.toLowerCase(), v]));
    if (/\.(js|css)$/.test(response.url) && Number(headers['content-length']) >= leastPacked && !headers['content-encoding']) unpacked.push(response.url);
  });
  cdp.on('Network.loadingFinished', (e) => {
    bytes += e.encodedDataLength;
    requests += 1;
  });
  await page.addInitScript(watch, selector);
  await page.goto(url);
  await page.waitForFunction(() => globalThis.painted_ms > 0, null, { timeout: 20_000 });
  const result = { painted_ms: await page.evaluate(() => globalThis.painted_ms), bytes, requests, unpacked };
  await context.close();
  return result;
}

/** Pictures a second during two seconds; `scrolls`: the map goes on meanwhile, 800 px a second. */
const pictures = (page, scrolls) =>
  page.evaluate(
    (moves) =>
      new Promise((resolve) => {
        const map = document.querySelector('.register-map');
        const begin = performance.now();
        let n = 0;
        const next = (now) => {
          n += 1;
          if (moves) map.scrollTop = (now - begin) * 0.8;
          if (now - begin < 2000) requestAnimationFrame(next);
          else resolve((n * 1000) / (now - begin));
        };
        requestAnimationFrame(next);
      }),
    scrolls,
  );

async function ofTheMap(browser, program) {
  for (let i = 1; i <= 8; i += 1) {
    await program.command(`axis${i}`, { command: 'enable' });
    await program.command(`axis${i}`, { command: 'move_velocity', velocity: 5 });
  }
  const page = await (await browser.newContext({ viewport: { width: 1440, height: 900 } })).newPage();
  await page.goto(`${program.url}/mappings`);
  await page.locator(mapValue).first().waitFor();
  const changing = [];
  const scrolling = [];
  for (let i = 0; i < times; i += 1) {
    changing.push(await pictures(page, false));
    scrolling.push(await pictures(page, true));
  }
  return { changing: median(changing), scrolling: median(scrolling) };
}

const tile = '[data-axis] [data-field=position][data-live=true]';
const mapValue = '[data-mapping] [data-field=value][data-live=true]';
const browser = await launch();
const runs = [];
const mapRuns = [];
let frames;
try {
  const program = await Program.start();
  try {
    for (let i = 0; i < times; i += 1) runs.push(await once(browser, program.url, tile));
  } finally {
    await program.end();
  }
  const big = await Program.start({ site: manyMappings() });
  try {
    for (let i = 0; i < times; i += 1) mapRuns.push(await once(browser, `${big.url}/mappings`, mapValue));
    frames = await ofTheMap(browser, big);
  } finally {
    await big.end();
  }
} finally {
  await browser.close();
}
console.log(`the page, empty cache, ${times} times: ${runs.map((r) => r.painted_ms.toFixed(0)).join(', ')} ms; ${runs[0].requests} answers`);
let kept = say('first tile shows a position (median)', median(runs.map((r) => r.painted_ms)), firstPaint_ms, 'ms');
kept = say('loaded until then, compressed', median(runs.map((r) => r.bytes)) / 1000, mostLoaded_kB, 'kB') && kept;
kept = say('larger scripts, styles uncompressed', new Set(runs.flatMap((r) => r.unpacked)).size, 0, 'files') && kept;
console.log(`the register map of 4096 mappings, empty cache, ${times} times: ${mapRuns.map((r) => r.painted_ms.toFixed(0)).join(', ')} ms`);
kept = say('first mapping shows its value (median)', median(mapRuns.map((r) => r.painted_ms)), firstPaint_ms, 'ms') && kept;
kept = sayOf('pictures while values change', frames.changing, leastPictures, clock, 'wanted', 'per s') && kept;
kept = sayOf('pictures while one scrolls', frames.scrolling, leastPictures, clock, 'wanted', 'per s') && kept;
console.log(kept ? 'all limits kept' : 'NOT all limits kept');
process.exitCode = kept ? 0 : 1;
