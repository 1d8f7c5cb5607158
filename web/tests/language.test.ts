// Languages: which is spoken, how numbers and days are read and written in each, and what the check of the sentences finds, by faults planted for it.
import { mkdirSync, mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { afterEach, describe, expect, it } from 'vitest';
import { compare, examine, placeholders, tableOf } from '../scripts/language.mjs';
import { languageOf, rich, speak, t } from '../src/language';
import { formatExact, formatNumber, localFigures, parseNumber, parseQuantity, typedNumber } from '../src/text/number';
import { clockTime, day } from '../src/text/time';

afterEach(() => speak('en'));

describe('the language spoken', () => {
  it.each([['', ['de-AT', 'en'], 'de'], ['', ['fr', 'zh-CN'], 'zh'], ['', ['fr'], 'en'], ['en', ['de'], 'en'], ['xx', ['de'], 'de'], ['zh', [], 'zh']] as const)('chosen %j, of the browser %j: %s', (chosen, browser, l) => expect(languageOf(chosen, browser)).toBe(l));
  it('says a sentence with its values in its own order; one without a translation stays English', () => {
    speak('de', { '{n} axes of {gateway}': 'Von {gateway}: {n} Achsen', 'See {link}.': '{link} ansehen.' });
    expect(t('{n} axes of {gateway}', { n: 3, gateway: '$&' })).toBe('Von $&: 3 Achsen');
    expect(t('Nobody answers {who}', { who: 'x' })).toBe('Nobody answers x');
    expect(rich('See {link}.', { link: 7 })).toEqual(['', 7, ' ansehen.']);
    expect(rich('See {other}.', { link: 7 })).toEqual(['See ', '{other}', '.']);
  });
});

describe('numbers in German', () => {
  it.each([['1,5', 1.5], ['-0,25', -0.25], ['1.234,5', 1234.5], ['1.234.567', 1234567], ['1 234,5', 1234.5], ['0.125', 0.125], ['1.5', 1.5], ['12.3456', 12.3456], [',5', 0.5], ['1,5e3', 1500], ['0x10', 16], ['1,234', 1.234]])('reads %j', (text, value) => {
    speak('de');
    expect(parseNumber(text)).toEqual({ good: true, value });
  });
  it.each([['1.234', '1234'], ['-12.500', '-12500']])('refuses %j, which may be two numbers', (text, whole) => {
    speak('de');
    const r = parseNumber(text);
    expect(r.good ? '' : r.why).toContain(`may be ${whole} or`);
  });
  it.each(['1,2,3', '1.23.456', '1.234.5', '12,345.6', '1.2,5', '5mm', ''])('refuses %j', (text) => {
    speak('de');
    expect(parseNumber(text).good).toBe(false);
    expect(parseQuantity(text).good).toBe(false);
  });
  it('are written with a comma, and what a field begins with is read as it was meant', () => {
    speak('de');
    expect([formatNumber(-12345.678, 2), formatExact(0.5), typedNumber(-1.234), localFigures('3.0')]).toEqual(['\u221212\u202f345,68', '0,5', '-1,234', '3,0']);
    for (const v of [0.001, -1.234, 12.5, 1234.567, 1e6, 1e-9]) expect(parseNumber(typedNumber(v))).toEqual({ good: true, value: v });
  });
});

it('a number typed with figures of full width is the same number; English does not guess what a comma means', () => {
  speak('zh');
  expect([parseNumber('\uff0d\uff11\uff12\uff0e\uff15'), parseNumber('1\uff0c5').good, formatNumber(1234.5, 1)]).toEqual([{ good: true, value: -12.5 }, false, '1234.5']);
});

it('days are written as the language does, the time of today alone', () => {
  const at = new Date(2026, 0, 2, 14, 3, 7);
  const published = (['en', 'de', 'zh'] as const).map((l) => (speak(l), [day(at), clockTime(at.toISOString(), new Date(2026, 0, 3)), clockTime(at.toISOString(), at)]));
  expect(published).toEqual([['2026-01-02', '2026-01-02 14:03:07', '14:03:07'], ['02.01.2026', '02.01.2026 14:03:07', '14:03:07'], ['2026年1月2日', '2026年1月2日 14:03:07', '14:03:07']]);
});

describe('the check of the sentences', () => {
  const look = (source: string, exempt = {}) => {
    const root = mkdtempSync(join(tmpdir(), 'axisgate-language-'));
    try {
      mkdirSync(join(root, 'language'));
      writeFileSync(join(root, 'language/index.ts'), 'export function t(text: string, values?: Record<string, string | number>): string { return text + String(values); }\nexport function rich(text: string, values: object): unknown { return [text, values]; }\n');
      writeFileSync(join(root, 'a.tsx'), `import { t } from './language';\nexport const said = t('Said');\n${source}\n`);
      const { uses, faults } = examine({ root, files: [join(root, 'a.tsx'), join(root, 'language/index.ts')], exempt });
      return { keys: uses.map((u) => u.key), faults: faults.map((f) => f.text) };
    } finally {
      rmSync(root, { recursive: true });
    }
  };
  it.each([
    ['text between tags', 'export const a = <p>Nobody <b>answers</b></p>;', 2],
    ['an attribute that is read', 'export const a = <input aria-label="Target" title={`of ${said}`} class="big one" data-x="Not Read" />;', 2],
    ['a sentence in a constant', "export const a = 'the line is down';", 1],
    ['a capital word in a table', "export const a: Record<string, string> = { b: 'Fault' };", 1],
    ['a small word that is shown', "export const a = (b: boolean) => <i>{b ? 'yes' : ''}</i>;", 1],
    ['a sentence glued of pieces', 'export const a = `${said} is gone`;', 1],
    ['a sentence in a value', "export const a = t('All of {what}', { what: 'the axes' });", 1],
    ['no literal', 'export const a = t(said);', 1],
    ['a value that is missing, one too many', "export const a = [t('{n} axes', { m: 1 }), t('{n} axes')];", 3],
    ['a piece of a sentence', "export const a = t('axes of ');", 1],
  ])('finds %s', (_, source, n) => expect(look(source).faults).toHaveLength(n), 30_000);
  it.each([
    ['what is said', "export const a = <p title={t('Two words', {})}>{t('One')}</p>;"],
    ['names of which only some fit', "type K = 'Two words' | 'One'; export const a: K = 'Two words'; export const b = (k: K) => k === 'One';"],
    ['addresses, looks, elements of code', "export const a = <a href='/a b' class='big one'><code>Some Code</code></a>;"],
    ['patterns and keys', "export const a = 'x'.startsWith('Some text') || new Map([[1, 2]]).has(1);"],
    ['another t', "export const a = (t: (s: string) => string, key: string) => t(key);"],
  ])('lets %s through', (_, source) => expect(look(source).faults).toEqual([]), 30_000);
  it('lets through what the list names, and lists what is said', () => {
    expect(look("export const a = 'Some Name';", { 'a.tsx': [/^Some Name$/] })).toEqual({ keys: ['Said'], faults: [] });
  }, 30_000);
  it('compares a table with the sentences: missing, left over, other places for values, nothing said', () => {
    expect(compare('de', ['A', '{n} of {all}', 'C', 'D'], { '{n} of {all}': '{all}, davon {m}', C: '', E: 'e', D: 'd ' }).map((f) => f.split(' ').slice(1, 4).join(' '))).toEqual(['no sentence for', '"{n} of {all}"', '"C" is said', '"D" is said', 'nothing says "E"']);
    expect(placeholders('{b} {a} {b}')).toEqual(['a', 'b']);
  });
  it('reads a table with its parts; a sentence that stands twice is a fault', () => {
    const root = mkdtempSync(join(tmpdir(), 'axisgate-table-'));
    try {
      writeFileSync(join(root, 'part.ts'), "export const part = { A: 'a', 'B c': \"d'e\" };\n");
      writeFileSync(join(root, 'de.ts'), "import { part } from './part';\nexport const table = { ...part, A: 'x' };\n");
      const { table, faults } = tableOf(join(root, 'de.ts'));
      expect([table['B c'], faults.length]).toEqual(["d'e", 1]);
    } finally {
      rmSync(root, { recursive: true });
    }
  });
});
