// Packs what was built: a .gz beside each file that becomes smaller by it, for the program to embed and to send to whoever takes gzip.
// By zopfli, which finds a shorter form of the same gzip. In: dist/. Out: dist/**/*.gz. Never changes the files themselves; the same files give the same bytes.
import { readdirSync, readFileSync, statSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { gzipAsync } from '@gfx/zopfli';

const least = 512; // below, the headers are the larger part
const dist = fileURLToPath(new URL('../dist', import.meta.url));
/** @param {string} dir @returns {string[]} */
const walk = (dir) => readdirSync(dir).flatMap((n) => (statSync(join(dir, n)).isDirectory() ? walk(join(dir, n)) : [join(dir, n)]));
for (const file of walk(dist)) {
  if (file.endsWith('.gz')) continue;
  const bytes = readFileSync(file);
  const packed = await gzipAsync(bytes, { numiterations: 15 });
  if (bytes.length >= least && packed.length < bytes.length * 0.9) writeFileSync(`${file}.gz`, packed);
}
