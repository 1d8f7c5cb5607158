// Checks what was built and packed: small enough, hashed names, nothing inline, nothing from another host. In: dist/. Out: figures, or a failure.
// The first load is what a browser needs before it shows the axes: index.html, what it names, what these scripts import, and what the first script loads
// behind the language; all of it found in the manifest of the build, which is removed afterwards.
import { existsSync, readdirSync, readFileSync, rmSync, statSync } from 'node:fs';
import { join } from 'node:path';
import { fileURLToPath } from 'node:url';

/** Bytes, compressed. */
const most = { first: 110_000, later: 60_000, english: 320_000, language: 80_000 };

/** @typedef {Record<string, { file: string, src?: string, imports?: string[], dynamicImports?: string[] }>} Manifest */

const isLanguage = (/** @type {string | undefined} */ src) => src?.startsWith('src/language/') ?? false;

/**
 * Files of the first load, as they are named in dist/. The first script loads the language and then the rest of the beginning; what that one loads later
 * are the pages. @param {string} html @param {Manifest} manifest @returns {Set<string>}
 */
export function firstLoad(html, manifest) {
  const named = [...html.matchAll(/<(?:script|link)\b[^>]*\b(?:src|href)="\/([^"]+)"/g)].map((m) => m[1] ?? '');
  const files = new Set(['index.html', ...named]);
  const seen = new Set();
  const add = (/** @type {string} */ key) => {
    const chunk = manifest[key];
    if (!chunk || seen.has(key)) return;
    seen.add(key);
    files.add(chunk.file);
    for (const i of chunk.imports ?? []) add(i);
  };
  const scripts = Object.keys(manifest).filter((k) => named.includes(manifest[k]?.file ?? ''));
  for (const key of scripts) {
    add(key);
    for (const i of manifest[key]?.dynamicImports ?? []) if (!isLanguage(manifest[i]?.src)) add(i);
  }
  return files;
}

/** Faults in the text of one file. @param {string} name @param {string} text @returns {string[]} */
function faultsOf(name, text) {
  const faults = [];
  if (name.startsWith('assets/') && !/-[\w-]{8}\.\w+$/.test(name)) faults.push(`${name} has no hash in its name`);
  if (name === 'index.html') {
    if (/<script(?![^>]*\bsrc=)/i.test(text)) faults.push('index.html has an inline script');
    if (/<style|\sstyle=|\son\w+=/i.test(text)) faults.push('index.html has an inline style or handler');
  }
  if (/\.(html|css|js)$/.test(name)) {
    const others = [...text.matchAll(/(?:https?:)?\/\/([a-z0-9-]+(?:\.[a-z0-9-]+)+)/gi)].map((m) => m[1]).filter((h) => h !== 'www.w3.org');
    if (others.length > 0) faults.push(`${name} names another host: ${[...new Set(others)].join(', ')}`);
    if (/\beval\(|new Function\(/.test(text)) faults.push(`${name} makes code from text`);
  }
  return faults;
}

/**
 * Whether the bytes are within the limits. `sizes`: of each file, compressed. @param {Map<string, number>} sizes @param {Set<string>} first
 * @param {Set<string>} languages @returns {{ told: string, faults: string[] }}
 */
export function weigh(sizes, first, languages) {
  const faults = [];
  const sum = (/** @type {(name: string) => boolean} */ which) => [...sizes].reduce((n, [name, size]) => n + (which(name) ? size : 0), 0);
  const [begin, english] = [sum((n) => first.has(n)), sum((n) => !languages.has(n))];
  for (const name of first) if (!sizes.has(name)) faults.push(`${name} of the first load was not built`);
  if (![...first].some((n) => n.endsWith('.js'))) faults.push('no script of the first load was found');
  if (begin > most.first) faults.push(`the first load has ${begin} bytes compressed; the limit is ${most.first}`);
  if (english > most.english) faults.push(`all in English has ${english} bytes compressed; the limit is ${most.english}`);
  let [largest, size] = ['', 0];
  for (const [name, n] of sizes) {
    if (first.has(name)) continue;
    const limit = languages.has(name) ? most.language : most.later;
    if (n > limit) faults.push(`${name} has ${n} bytes compressed; the limit is ${limit}`);
    if (!languages.has(name) && n > size) [largest, size] = [name, n];
  }
  return { told: `first load ${begin} bytes compressed (limit ${most.first}), all in English ${english} (limit ${most.english}), the largest later bundle is ${largest} with ${size} (limit ${most.later})`, faults };
}

/** @param {string} dir @returns {string[]} */
const walk = (dir) => readdirSync(dir).flatMap((n) => (statSync(join(dir, n)).isDirectory() ? walk(join(dir, n)) : [join(dir, n)]));

if (process.argv[1] === fileURLToPath(import.meta.url)) {
  const dist = fileURLToPath(new URL('../dist', import.meta.url));
  /** @type {Manifest} */
  const manifest = JSON.parse(readFileSync(join(dist, '.vite/manifest.json'), 'utf8'));
  const faults = [];
  const sizes = new Map();
  for (const file of walk(dist)) {
    const name = file.slice(dist.length + 1);
    // The same files, packed: what is sent. The handbook is read apart, and looked at where it is made (help.mjs).
    if (file.endsWith('.gz') || name.startsWith('help/') || name.startsWith('.vite/')) continue;
    sizes.set(name, existsSync(`${file}.gz`) ? statSync(`${file}.gz`).size : statSync(file).size);
    faults.push(...faultsOf(name, readFileSync(file, 'utf8')));
  }
  const languages = new Set(Object.values(manifest).flatMap((c) => (isLanguage(c.src) ? [c.file] : [])));
  const weighed = weigh(sizes, firstLoad(readFileSync(join(dist, 'index.html'), 'utf8'), manifest), languages);
  faults.push(...weighed.faults);
  rmSync(join(dist, '.vite'), { recursive: true });
  console.log(`page: ${weighed.told}`);
  for (const f of faults) console.error(`page: ${f}`);
  process.exit(faults.length > 0 ? 1 : 0);
}
