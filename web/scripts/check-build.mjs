// Checks what was built and packed: small enough, hashed names, nothing inline, nothing from another host. In: dist/. Out: figures, or a failure.
import { existsSync, readdirSync, readFileSync, statSync } from 'node:fs';
import { join } from 'node:path';
import { fileURLToPath } from 'node:url';

const most = 200_000; // in English; a language is loaded only when it is chosen
const mostOfLanguage = 80_000;
const dist = fileURLToPath(new URL('../dist', import.meta.url));
const faults = [];
let packed = 0;
/** @param {string} dir @returns {string[]} */
const walk = (dir) => readdirSync(dir).flatMap((n) => (statSync(join(dir, n)).isDirectory() ? walk(join(dir, n)) : [join(dir, n)]));
for (const file of walk(dist)) {
  if (file.endsWith('.gz')) continue; // the same files, packed: what is sent
  const name = file.slice(dist.length + 1);
  if (name.startsWith('help/')) continue; // the handbook is read apart, and looked at where it is made (help.mjs)
  const bytes = readFileSync(file);
  const size = existsSync(`${file}.gz`) ? statSync(`${file}.gz`).size : bytes.length;
  const language = /^assets\/(de|zh)-/.exec(name)?.[1];
  if (language === undefined) packed += size;
  else if (size > mostOfLanguage) faults.push(`${size} bytes compressed for ${language}; the limit is ${mostOfLanguage}`);
  if (name.startsWith('assets/') && !/-[\w-]{8}\.\w+$/.test(name)) faults.push(`${name} has no hash in its name`);
  const text = bytes.toString('utf8');
  if (name === 'index.html') {
    if (/<script(?![^>]*\bsrc=)/i.test(text)) faults.push('index.html has an inline script');
    if (/<style|\sstyle=|\son\w+=/i.test(text)) faults.push('index.html has an inline style or handler');
  }
  if (/\.(html|css|js)$/.test(name)) {
    const others = [...text.matchAll(/(?:https?:)?\/\/([a-z0-9-]+(?:\.[a-z0-9-]+)+)/gi)].map((m) => m[1]).filter((h) => h !== 'www.w3.org');
    if (others.length > 0) faults.push(`${name} names another host: ${[...new Set(others)].join(', ')}`);
    if (/\beval\(|new Function\(/.test(text)) faults.push(`${name} makes code from text`);
  }
}
if (packed > most) faults.push(`${packed} bytes compressed; the limit is ${most}`);
console.log(`page: ${packed} bytes compressed (limit ${most})`);
for (const f of faults) console.error(`page: ${f}`);
process.exit(faults.length > 0 ? 1 : 0);
