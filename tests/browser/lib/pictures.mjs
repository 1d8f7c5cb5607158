// Pictures of the page for README and handbook: the demo is furnished, each scene is opened at one size, in light and in dark, and written as WebP.
// In: the demo's site, a folder. Out: NAME-light.webp and NAME-dark.webp. A picture that looks as the one that is there already leaves that as it is,
// so that ages and clocks alone change no file. Never more than `most` bytes for one picture: its quality gives way first.
import { existsSync, mkdirSync, readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { launch, open, quiet, until } from './browser.mjs';
import { Program } from './program.mjs';

export const folder = fileURLToPath(new URL('../../../docs/handbook/pictures', import.meta.url));
const demo = JSON.parse(readFileSync(new URL('../../../deploy/examples/demo-site.json', import.meta.url), 'utf8'));
export const size = { width: 1200, height: 760 };
export const most = 60_000;
/** Of all points: so many may be others before a picture counts as another one. */
const same = 0.02;

export const scenes = [
  { name: 'overview', path: '/', ready: '[data-axis=feeder] [data-live=true]' },
  { name: 'move', path: '/axes/feeder', ready: '.machine' },
  { name: 'scope', path: '/axes/feeder/scope', ready: '.scope canvas', see: moved },
  { name: 'map', path: '/mappings', ready: '[data-mapping] [data-field=value][data-live=true]' },
  { name: 'playback', path: '/recorder/recordings/', ready: '[data-recording=there-and-back]', see: playedBack },
  { name: 'site', path: '/site', ready: '[data-revision]' },
  { name: 'report', path: '/report', ready: '[data-field=report]' },
];

const must = async (program, method, path, body) => {
  const r = await program.call(method, path, body);
  if (r.status >= 300) throw new Error(`${method} ${path}: ${r.status} ${JSON.stringify(r.body)}`);
  return r.body;
};
const go = (program, position) => must(program, 'POST', '/axes/feeder/commands?wait=20', { command: 'move_absolute', position, velocity: 60, acceleration: 300, deceleration: 300 });

/** A machine with parts, an axis that has moved, some registers of its own and one recording. */
async function furnish(program) {
  const points = [['position_units', 'f32', 2], ['velocity', 'i32', 2], ['statusword', 'u16', 1], ['error_code', 'u16', 1]];
  let address = 0;
  for (const axis of ['feeder', 'lift', 'shuttle']) {
    for (const [point, type, words] of points) {
      await must(program, 'POST', '/mappings', { unit: 2, table: 'holding_registers', address, axis, point, type, access: 'R' });
      address += words;
    }
    address += 2;
  }
  await must(program, 'POST', '/axes/feeder/commands?wait=10', { command: 'enable' });
  await go(program, 40);
  await go(program, 10);
  await must(program, 'POST', '/recorder/recordings', { name: 'there-and-back' });
}

/** The curve of a move that began and ended in the window. */
async function moved(page, program) {
  await page.getByRole('group', { name: 'Time shown' }).getByRole('button', { name: /^10 s/ }).click();
  await go(program, 40);
  await go(program, 10);
}
async function playedBack(page) {
  await page.getByRole('button', { name: 'Play back there-and-back' }).click();
  const playback = page.locator('[data-field=playback]');
  await playback.locator('tr[data-axis=feeder]').waitFor();
  await playback.evaluate((e) => scrollTo(0, e.getBoundingClientRect().top + scrollY - 70));
}

/** As small as it must be, and no worse than that asks for. */
async function webp(page) {
  const cdp = await page.context().newCDPSession(page);
  try {
    for (let quality = 70; quality > 20; quality -= 10) {
      const bytes = Buffer.from((await cdp.send('Page.captureScreenshot', { format: 'webp', quality })).data, 'base64');
      if (bytes.length <= most) return bytes;
    }
  } finally {
    await cdp.detach();
  }
  throw new Error(`${page.url()} is no picture of ${most} bytes at any quality`);
}

/** The share of points in which two pictures differ so that an eye sees it. */
const apart = (blank, one, other) =>
  blank.evaluate(async (both) => {
    const [a, b] = await Promise.all(
      both.map(async (data) => {
        const bitmap = await createImageBitmap(await (await fetch(`data:image/webp;base64,${data}`)).blob());
        const canvas = new OffscreenCanvas(bitmap.width, bitmap.height).getContext('2d');
        canvas.drawImage(bitmap, 0, 0);
        return canvas.getImageData(0, 0, bitmap.width, bitmap.height);
      }),
    );
    if (a.width !== b.width || a.height !== b.height) return 1;
    let n = 0;
    for (let i = 0; i < a.data.length; i += 4) if (Math.abs(a.data[i] - b.data[i]) + Math.abs(a.data[i + 1] - b.data[i + 1]) + Math.abs(a.data[i + 2] - b.data[i + 2]) > 96) n += 1;
    return n / (a.data.length / 4);
  }, [one.toString('base64'), other.toString('base64')]);

/** Makes them, `wanted` of them. What it tells of each: its name, its bytes, whether the file that was there is kept. */
export async function make(into, wanted = scenes) {
  mkdirSync(into, { recursive: true });
  const program = await Program.start({ site: { ...demo, drives: demo.drives.filter((d) => !d.description), axes: demo.axes.filter((a) => a.drive !== 'spindle') } });
  const browser = await launch();
  const told = [];
  try {
    await until('the feeder answers', async () => (await program.axis('feeder')).online === true);
    await furnish(program);
    const blank = await (await browser.newContext()).newPage();
    for (const { name, path, ready, see } of wanted) {
      const page = await open(browser, program.url + path, { viewport: size, locale: 'en-GB', timezoneId: 'UTC' });
      await page.locator(ready).first().waitFor();
      await see?.(page, program);
      await quiet(page);
      for (const colorScheme of ['light', 'dark']) {
        await page.emulateMedia({ colorScheme });
        await quiet(page);
        const bytes = await webp(page);
        const file = join(into, `${name}-${colorScheme}.webp`);
        const kept = existsSync(file) && (await apart(blank, readFileSync(file), bytes)) < same;
        if (!kept) writeFileSync(file, bytes);
        told.push({ name: `${name}-${colorScheme}`, bytes: bytes.length, kept });
      }
      if (page.faults().length > 0) throw new Error(`${path}: ${page.faults().join('; ')}`);
      await page.context().close();
    }
  } finally {
    await browser.close();
    await program.end();
  }
  return told;
}
