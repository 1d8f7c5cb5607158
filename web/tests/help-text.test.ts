// Every chapter and heading of the handbook that the page links to is there.
import { readdirSync, readFileSync, statSync } from 'node:fs';
import { join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { expect, it } from 'vitest';
import { routeOf } from '../src/router';
import { helpOfPage, helpPath } from '../src/text/help';

const top = fileURLToPath(new URL('../..', import.meta.url));
const anchors = (chapter: string) =>
  [...readFileSync(join(top, 'docs/handbook', `${chapter}.md`), 'utf8').matchAll(/^##+ (.*)$/gm)].map((m) => (m[1] ?? '').toLowerCase().replace(/[^\w\s-]/g, '').trim().replace(/\s/g, '-'));
const walk = (dir: string): string[] => readdirSync(dir).flatMap((n) => (statSync(join(dir, n)).isDirectory() ? walk(join(dir, n)) : [join(dir, n)]));
const chapterOf = (address: string) => /^\/help\/([a-z0-9-]+)\.html(?:#([a-z0-9-]+))?$/.exec(address)?.slice(1) ?? [];

it.each(['/', '/axes/feeder', '/lines', '/lines/can0', '/mappings', '/site', '/recipes', '/recipes/x', '/events', '/gateway', '/fleet', '/axes/feeder/parameters', '/users', '/sign-in'])('the page %s has a chapter', (path) => {
  const [name] = chapterOf(helpOfPage(routeOf(path).page));
  expect(name).toBeTruthy();
  expect(statSync(join(top, 'docs/handbook', `${name}.md`)).isFile()).toBe(true);
});

it('the contents are what is left for a page that is none', () => expect(helpOfPage('unknown')).toBe('/help/'));

it('sections name chapters and headings that are there', () => {
  const named = walk(join(top, 'web/src')).flatMap((f) => [...readFileSync(f, 'utf8').matchAll(/<Section[^>]*\bhelp="([^"]+)"/g)].map((m) => m[1] ?? ''));
  expect(named.length).toBeGreaterThan(5);
  for (const n of named) {
    const [name, anchor] = chapterOf(helpPath(n));
    expect(name, n).toBeTruthy();
    const there = anchors(name ?? '');
    if (anchor) expect(there, n).toContain(anchor);
  }
});
