// Browser: Debian's Chromium through playwright-core, with a fresh profile, and a watch over everything that a page must not do.
// In: CHROMIUM (default /usr/bin/chromium-headless-shell), AXISGATE_PICTURES (1: pictures are made, for people to look at; no test judges one).
// Out: pages that remember console errors, exceptions and requests to other hosts.
import { mkdirSync, readFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import { join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { isDeepStrictEqual } from 'node:util';
import { chromium } from 'playwright-core';

export const artefacts = fileURLToPath(new URL('../../../build/browser', import.meta.url));
mkdirSync(artefacts, { recursive: true });

/** How long a page, or somebody else, may take on a machine that has other work, too. A test that is about a time has a limit of its own. */
const patience_ms = 30_000;

const flags = ['--no-sandbox', '--disable-gpu', '--disable-quic', '--no-first-run', '--disable-background-networking', '--disable-component-update', '--disable-sync'];

export const launch = () => chromium.launch({ executablePath: process.env.CHROMIUM ?? '/usr/bin/chromium-headless-shell', args: flags });

/** A page of its own context. `page.faults()` is what it did wrong so far. */
export async function open(browser, url, options = {}) {
  const context = await browser.newContext({ viewport: { width: 1440, height: 900 }, reducedMotion: 'reduce', ...options });
  const page = await context.newPage();
  page.setDefaultTimeout(patience_ms);
  const faults = [];
  const host = new URL(url).host;
  let lossExpected = false;
  page.on('console', (m) => {
    // While the gateway is away on purpose, the browser itself complains that it cannot be reached.
    if (m.type() !== 'error' || (lossExpected && /ERR_CONNECTION|ERR_EMPTY_RESPONSE|ERR_FAILED|WebSocket/.test(m.text()))) return;
    // A refusal is an answer that the page shows; the browser notes it as an error all the same.
    if (/responded with a status of (4\d\d|503|504)/.test(m.text()) && m.location().url.includes('/api/v1/')) return;
    faults.push(`console: ${m.text()}`);
  });
  page.on('pageerror', (e) => faults.push(`exception: ${e.message}`));
  page.on('request', (r) => {
    const u = new URL(r.url());
    if (u.host !== host) faults.push(`request to another host: ${r.url()}`);
  });
  page.on('websocket', (w) => {
    if (new URL(w.url()).host !== host) faults.push(`websocket to another host: ${w.url()}`);
  });
  // Requests that are on their way; a stream, which ends with its page, is none.
  const asked = new Set();
  page.on('request', (r) => asked.add(r));
  for (const end of ['requestfinished', 'requestfailed']) page.on(end, (r) => asked.delete(r));
  page.asks = () => [...asked].map((r) => `${r.method()} ${r.url()}`);
  page.faults = () => faults;
  page.expectLoss = (yes) => (lossExpected = yes);
  await page.goto(url);
  return page;
}

/** A picture costs more time than most of what is judged beside it, so they are made where somebody wants them. */
export const pictured = process.env.AXISGATE_PICTURES === '1';
export const shot = async (page, name, options = {}) => void (pictured && (await page.screenshot({ path: join(artefacts, `${name}.png`), ...options })));

/** One axis on the page, by its name. */
export function tileOf(page, axis) {
  const tile = page.locator(`[data-axis="${axis}"]`).first();
  const field = (name) => tile.locator(`[data-field="${name}"]`).first();
  return {
    tile,
    field,
    position: async () => Number(await field('position').getAttribute('data-value')),
    text: async (name) => (await field(name).innerText()).replace(/\s+/g, ' ').trim(),
    result: () => page.locator(`[id="result-${axis}"]`).innerText(),
  };
}

/** Waits until the condition holds; says what it was at the end if it never does. */
export async function until(what, condition, limit_ms = patience_ms) {
  const end = Date.now() + limit_ms;
  let last;
  for (;;) {
    last = await condition();
    if (last === true) return;
    if (Date.now() > end) throw new Error(`${what} did not come true within ${limit_ms} ms; last: ${JSON.stringify(last)}`);
    await new Promise((r) => setTimeout(r, 50));
  }
}

/** Waits until what is read is exactly this: for what the page, or somebody else, has yet to hear or to draw. */
export const becomes = (what, read, expected, limit_ms) =>
  until(what, async () => {
    const now = await read();
    return isDeepStrictEqual(now, expected) ? true : { now, expected };
  }, limit_ms);

/** Has been drawn once more. */
export const drawn = (page) => page.evaluate(() => new Promise((resolve) => requestAnimationFrame(() => setTimeout(resolve))));

/** Has everything that it asked for, and has drawn it: twice in a row nothing is on its way. */
export async function quiet(page) {
  let still = 0;
  await until('the page has what it asked for', async () => {
    await drawn(page);
    still = page.asks().length === 0 ? still + 1 : 0;
    return still >= 2 || page.asks();
  });
}

const axe = readFileSync(createRequire(import.meta.url).resolve('axe-core/axe.min.js'), 'utf8');

const standards = ['wcag2a', 'wcag2aa', 'wcag21a', 'wcag21aa', 'wcag22aa', 'best-practice'];
/** The rules that look at colours; to all others light and dark are the same page. */
const aboutColours = { type: 'rule', values: ['color-contrast', 'link-in-text-block'] };

/** What axe-core finds moderate, serious or critical on a page that was opened with `bypassCSP`: the policy of the page forbids foreign code. */
export async function examine(page, runOnly = standards) {
  if (!(await page.evaluate(() => 'axe' in globalThis))) await page.addScriptTag({ content: axe });
  return page.evaluate(async (only) => {
    const r = await globalThis.axe.run(document, { runOnly: only, resultTypes: ['violations'] });
    const bad = r.violations.filter((v) => v.impact !== 'minor');
    return bad.map((v) => ({ id: v.id, where: v.nodes.slice(0, 4).map((n) => n.target.join(' ')), why: v.nodes[0].failureSummary }));
  }, runOnly);
}

export const tooWide = (page) => page.evaluate(() => document.documentElement.scrollWidth - document.documentElement.clientWidth);

const desk = (width) => ({ viewport: { width, height: 900 } });
const phone = (width, height = 844) => ({ viewport: { width, height }, hasTouch: true, isMobile: true });

/** A page for pictures; with one more visit for a phone, whose fingers the styles know of. */
export const visits = [
  { widths: [1440, 1024], device: desk(1440) },
  { widths: [390], device: phone(390) },
];

/** The page as it stands, in light and in dark: pictures for people, what scrolls sideways, what axe-core finds. All that is wrong, in words. */
export async function look(page, name, options = { fullPage: true }) {
  const wrong = [];
  const width = page.viewportSize().width;
  for (const colorScheme of ['light', 'dark']) {
    await page.emulateMedia({ colorScheme });
    await drawn(page);
    await shot(page, `${name}-${width}-${colorScheme}`, options);
    const wide = await tooWide(page);
    if (wide > 0) wrong.push(`${wide} px too wide at ${width} px, ${colorScheme}`);
    for (const f of await examine(page, colorScheme === 'light' ? standards : aboutColours)) wrong.push(`${width} px, ${colorScheme}: ${JSON.stringify(f)}`);
  }
  await page.emulateMedia({ colorScheme: 'light' });
  return wrong;
}

/** A page at three widths in light and dark: it must not scroll sideways, axe-core must find nothing serious, and people get pictures. */
export async function pictures(browser, url, path, name, ready) {
  for (const { widths, device } of visits) {
    const page = await open(browser, url + path, { ...device, bypassCSP: true });
    await ready(page);
    const wrong = [];
    for (const width of widths) {
      await page.setViewportSize({ ...device.viewport, width });
      wrong.push(...(await look(page, name)));
    }
    wrong.push(...page.faults());
    if (wrong.length > 0) throw new Error(`${path}: ${wrong.join('; ')}`);
    await page.context().close();
  }
}
