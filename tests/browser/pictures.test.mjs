// Pictures of README and handbook: each that a paper names is there, in light and dark, small, and named by a paper; the script that makes them makes
// just these, and leaves alone what looks as it did. In: the papers, the program. Out: judgements; the pictures go to a temporary folder.
import assert from 'node:assert/strict';
import { mkdtempSync, readdirSync, readFileSync, rmSync, statSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { basename, join } from 'node:path';
import { test } from 'node:test';
import { fileURLToPath } from 'node:url';
import { launch, open } from './lib/browser.mjs';
import { folder, make, most, scenes } from './lib/pictures.mjs';
import { isMock, Program } from './lib/program.mjs';

const top = fileURLToPath(new URL('../..', import.meta.url));
const files = (kind) => readdirSync(folder).filter((f) => kind === undefined || f.endsWith(kind)).sort();

test('each picture that a paper shows is there in light and dark, and each that is there is shown', () => {
  const book = join(top, 'docs/handbook');
  const papers = [join(top, 'README.md'), ...readdirSync(book).filter((f) => f.endsWith('.md')).map((f) => join(book, f))];
  const named = new Set(papers.flatMap((p) => [...readFileSync(p, 'utf8').matchAll(/[\w-]+-(?:light|dark)\.(?:webp|svg)/g)].map((m) => m[0])));
  for (const n of [...named]) named.add(n.replace('-light.', '-dark.'));
  assert.deepEqual(files(), [...named].sort());
  // What is no picture of the page is drawn by hand.
  assert.deepEqual(files('.webp'), scenes.flatMap((s) => [`${s.name}-dark.webp`, `${s.name}-light.webp`]).sort());
  const sizes = files().map((f) => statSync(join(folder, f)).size);
  assert.ok(Math.max(...sizes) <= most, `${Math.max(...sizes)} bytes`);
  assert.ok(sizes.reduce((a, b) => a + b) < 1_000_000);
});

test('the script makes them all, of about the same size, and a second run leaves what looks the same', { skip: isMock && 'the stand-in has no recorder' }, async () => {
  const into = mkdtempSync(join(tmpdir(), 'axisgate-pictures-'));
  try {
    const first = await make(into);
    assert.deepEqual(first.map((p) => `${p.name}.webp`).sort(), files('.webp'));
    for (const p of first) {
      const kept = statSync(join(folder, `${p.name}.webp`)).size;
      assert.ok(p.bytes <= most && p.bytes > kept / 2 && p.bytes < kept * 2, `${p.name}: ${p.bytes} bytes, kept ${kept}`);
    }
    // A machine that has just been started, at another time: the tree of its site looks the same, and a map is no tree.
    const again = scenes.filter((s) => s.name === 'site');
    writeFileSync(join(into, 'site-dark.webp'), readFileSync(join(into, 'map-dark.webp')));
    assert.deepEqual((await make(into, again)).map((p) => [p.name, p.kept]), [['site-light', true], ['site-dark', false]]);
  } finally {
    rmSync(into, { recursive: true, force: true });
  }
});

for (const [chapter, kind] of [['operate', 'webp'], ['commanding', 'svg']]) test(`the handbook at /help shows the pictures of ${chapter} in the theme, and fetches no other`, { skip: isMock && 'the stand-in has no handbook' }, async () => {
  const program = await Program.start();
  const browser = await launch();
  try {
    for (const colorScheme of ['light', 'dark']) {
      const page = await open(browser, `${program.url}/help/${chapter}.html`, { colorScheme, viewport: { width: 1200, height: 4000 } });
      const shown = page.locator('img.picture:visible');
      await shown.first().waitFor();
      await page.waitForFunction(() => [...document.images].filter((i) => i.checkVisibility()).every((i) => i.complete && i.naturalWidth === 1200));
      for (const src of await shown.evaluateAll((l) => l.map((i) => i.src))) assert.match(basename(src), new RegExp(`-${colorScheme}\\.${kind}$`));
      const fetched = await page.evaluate(() => performance.getEntriesByType('resource').map((e) => e.name).filter((n) => /\.(webp|svg)$/.test(n) && !n.endsWith('favicon.svg')));
      assert.ok(fetched.length > 0 && fetched.every((n) => n.includes(`-${colorScheme}.`)), fetched.join(', '));
      assert.deepEqual(page.faults(), []);
      await page.context().close();
    }
  } finally {
    await browser.close();
    await program.end();
  }
});
