// A tab that is older than the gateway: it is loaded again once for each page that the gateway has, and never again for the same one.
import { expect, it } from 'vitest';
import { firstScript, followUpgrade, type Around } from '../src/state/upgrade';

const html = (script: string) => `<!doctype html><head><link rel="icon" href="/favicon.svg"><script type="module" crossorigin src="${script}"></script></head>`;

/** A tab that began with the first script `mine`, at a gateway with `theirs`; null: the gateway is away. */
function tab(mine: string, theirs: string | null, memory = true) {
  let remembered = '';
  const at: Around & { reloads: number; theirs: string | null } = {
    reloads: 0,
    theirs,
    mine: () => mine,
    index: async () => {
      if (at.theirs === null) throw new TypeError('Failed to fetch');
      return html(at.theirs);
    },
    reload: () => void (at.reloads += 1),
    loadedFor: () => remembered,
    loadFor: (script) => {
      if (memory) remembered = script;
      return memory;
    },
  };
  return at;
}

it('finds the first script of an index.html', () => {
  expect(firstScript(html('/assets/first-AAAAAAAA.js'))).toBe('/assets/first-AAAAAAAA.js');
  expect(firstScript('<script>inline()</script>')).toBe('');
});

it('is loaded again when the gateway has another page, once', async () => {
  const t = tab('/assets/first-AAAAAAAA.js', '/assets/first-BBBBBBBB.js');
  expect([await followUpgrade(t), t.reloads]).toEqual(['reloading', 1]);
  // The reload has brought the old page all the same, as from a cache on the way: nothing is gained by another one.
  expect([await followUpgrade(t), t.reloads]).toEqual(['same', 1]);
  t.theirs = '/assets/first-CCCCCCCC.js';
  expect([await followUpgrade(t), t.reloads]).toEqual(['reloading', 2]);
});

it.each([
  ['the same page', tab('/assets/first-AAAAAAAA.js', '/assets/first-AAAAAAAA.js'), 'same'],
  ['a gateway that is away', tab('/assets/first-AAAAAAAA.js', null), 'away'],
  ['a browser that keeps nothing, where a reload might never end', tab('/assets/first-AAAAAAAA.js', '/assets/first-BBBBBBBB.js', false), 'same'],
  ['an answer that is no page', tab('/assets/first-AAAAAAAA.js', ''), 'same'],
  ['a page without a first script', tab('', '/assets/first-BBBBBBBB.js'), 'same'],
])('is not loaded again for %s', async (_, t, found) => {
  expect([await followUpgrade(t), t.reloads]).toEqual([found, 0]);
});
