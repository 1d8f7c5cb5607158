// The bounds of the page's parts: a component, a file, a function that is over its bound is found, by its name and its line; what is within it is not.
import { spawnSync } from 'node:child_process';
import { mkdirSync, mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { describe, expect, it } from 'vitest';
import { bounds, faultsIn, faultsOf, functionsOf } from '../scripts/bounds.mjs';

const lines = (n: number, line = '  f();') => Array.from({ length: n }, () => line).join('\n');
/** A function of so many lines. */
const body = (head: string, n: number) => `${head} {\n${lines(n - 2)}\n}\n`;

describe('a bound', () => {
  it('is kept by a component of 200 lines, and broken by one line more: the file and the component', () => {
    expect(faultsOf('components/a.tsx', body('export function A()', bounds.component_lines))).toEqual([]);
    expect(faultsOf('components/a.tsx', body('export function A()', bounds.component_lines + 1))).toEqual(['components/a.tsx has 201 lines; the bound is 200', 'components/a.tsx:1: A has 201 lines; the bound is 200']);
    expect(faultsOf('pages/a.tsx', lines(201, '// one line'))).toEqual(['pages/a.tsx has 201 lines; the bound is 200']);
  });
  it('is narrower for what is no component: no capital letter, or no .tsx; and wider for a file of other rooms', () => {
    expect(faultsOf('components/a.tsx', body('function draw()', 80))).toEqual([]);
    expect(faultsOf('components/a.tsx', body('function draw()', 81))).toEqual(['components/a.tsx:1: draw has 81 lines; the bound is 80']);
    expect(faultsOf('state/a.ts', body('export const Big = () =>', 81))).toEqual(['state/a.ts:1: Big has 81 lines; the bound is 80']);
    expect(faultsOf('state/a.ts', lines(500, '// one line'))).toEqual([]);
    expect(faultsOf('state/a.ts', lines(501, '// one line'))).toEqual(['state/a.ts has 501 lines; the bound is 500']);
  });
  it('counts the branches of a function, not those of the functions within it', () => {
    const many = (n: number) => `function f(a: number) {\n  return ${Array.from({ length: n }, (_, i) => `a === ${i}`).join(' || ')} || a;\n}\n`;
    expect(faultsOf('text/a.ts', many(40))).toEqual([]);
    expect(faultsOf('text/a.ts', many(41))).toEqual(['text/a.ts:1: f has 41 branches; the bound is 40']);
    const [outer, inner] = functionsOf('text/a.ts', 'function outer(a: number) {\n  if (a) g();\n  const inner = () => (a && b ? c ?? d : e);\n}\n');
    expect(outer).toMatchObject({ name: 'outer', line: 1, lines: 4, branches: 1 });
    expect(inner).toMatchObject({ name: 'inner', line: 3, branches: 3 });
  });
  it('counts each kind of branch once', () => {
    const of = (text: string) => functionsOf('text/a.ts', `function f() { ${text} }`)[0]!.branches;
    expect(of('if (a) b(); else c();')).toBe(1);
    expect(of('switch (a) { case 1: case 2: b(); break; default: c(); }')).toBe(2);
    expect(of('for (const x of y) z(x); while (a) b(); do c(); while (d);')).toBe(3);
    expect(of('try { a(); } catch { b(); }')).toBe(1);
    expect(of('return a?.b;')).toBe(0);
  });
});

describe('the check', () => {
  it('fails for a component over the bound, with its name', () => {
    const root = mkdtempSync(join(tmpdir(), 'bounds-'));
    try {
      mkdirSync(join(root, 'components'));
      writeFileSync(join(root, 'components', 'large.tsx'), body('export function Large()', 201));
      const run = spawnSync(process.execPath, [fileURLToPath(new URL('../scripts/bounds.mjs', import.meta.url)), '--src', root], { encoding: 'utf8' });
      expect(run.stderr).toContain('components/large.tsx:1: Large has 201 lines; the bound is 200');
      expect(run.status).toBe(1);
    } finally {
      rmSync(root, { recursive: true });
    }
  });
  it('finds nothing in the page', () => {
    const { files, faults } = faultsIn(fileURLToPath(new URL('../src', import.meta.url)));
    expect(files).toBeGreaterThan(200);
    expect(faults).toEqual([]);
  });
});
