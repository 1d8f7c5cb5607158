// The check of what was built: which files the first load is made of, and which limit each file is held to, by builds made up for it.
import { describe, expect, it } from 'vitest';
import { firstLoad, weigh } from '../scripts/check-build.mjs';

const html = '<link rel="icon" href="/favicon.svg"><script type="module" crossorigin src="/assets/first-AAAAAAAA.js"></script><link rel="stylesheet" href="/assets/style-AAAAAAAA.css">';
const manifest = {
  _first: { file: 'assets/first-AAAAAAAA.js', imports: ['_kept'], dynamicImports: ['src/language/de.ts', '_beginning'] },
  _kept: { file: 'assets/kept-AAAAAAAA.js' },
  _beginning: { file: 'assets/beginning-AAAAAAAA.js', imports: ['_first', '_shared'], dynamicImports: ['src/pages/site.tsx'] },
  _shared: { file: 'assets/shared-AAAAAAAA.js', imports: ['_beginning'] },
  'src/pages/site.tsx': { file: 'assets/site-AAAAAAAA.js', src: 'src/pages/site.tsx', imports: ['_beginning'] },
  'src/language/de.ts': { file: 'assets/de-AAAAAAAA.js', src: 'src/language/de.ts' },
};
const first = ['index.html', 'favicon.svg', 'assets/first-AAAAAAAA.js', 'assets/style-AAAAAAAA.css', 'assets/kept-AAAAAAAA.js', 'assets/beginning-AAAAAAAA.js', 'assets/shared-AAAAAAAA.js'];

it('counts to the first load what index.html names and what its scripts import, not the pages that come later', () => {
  expect([...firstLoad(html, manifest)].sort()).toEqual([...first].sort());
});

describe('the limits', () => {
  const sizes = (more: Record<string, number> = {}) => new Map(Object.entries({ ...Object.fromEntries(first.map((n) => [n, 1_000])), 'assets/site-AAAAAAAA.js': 60_000, 'assets/de-AAAAAAAA.js': 80_000, ...more }));
  const faults = (s: Map<string, number>, of = new Set(first)) => weigh(s, of, new Set(['assets/de-AAAAAAAA.js'])).faults;
  it('are kept', () => expect(faults(sizes())).toEqual([]));
  it.each([
    ['the first load', { 'assets/shared-AAAAAAAA.js': 104_001 }, 'the first load has 110001 bytes compressed; the limit is 110000'],
    ['a later bundle', { 'assets/site-AAAAAAAA.js': 60_001 }, 'assets/site-AAAAAAAA.js has 60001 bytes compressed; the limit is 60000'],
    ['a language', { 'assets/de-AAAAAAAA.js': 80_001 }, 'assets/de-AAAAAAAA.js has 80001 bytes compressed; the limit is 80000'],
    ['all in English', Object.fromEntries([1, 2, 3, 4, 5].map((n) => [`assets/p${n}-AAAAAAAA.js`, 51_000])), 'all in English has 322000 bytes compressed; the limit is 320000'],
  ])('%s may be too large', (_, more, fault) => expect(faults(sizes(more))).toEqual([fault]));
  it('are nothing without a first load', () => {
    expect(faults(sizes(), new Set(['index.html', 'assets/none-AAAAAAAA.js']))).toEqual(['assets/none-AAAAAAAA.js of the first load was not built']);
    expect(faults(sizes(), new Set(['index.html']))).toEqual(['no script of the first load was found']);
  });
});
