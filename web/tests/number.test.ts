// Numbers: what is typed and what is shown. Table-driven.
import { describe, expect, it } from 'vitest';
import { decimalsOf, formatExact, formatNumber, parseNumber, tickLabels } from '../src/text/number';
import { clockTime, duration } from '../src/text/time';

describe('parseNumber', () => {
  it.each([
    ['0', 0], ['100', 100], [' 1.5 ', 1.5], ['-2', -2], ['\u22122', -2], ['+3', 3], ['.5', 0.5], ['5.', 5], ['1e3', 1000], ['1 000 000', 1e6], ['0x01020304', 0x01020304], ['-0x10', -16],
  ])('takes %j', (text, value) => expect(parseNumber(text)).toEqual({ good: true, value }));
  it.each(['', '  ', '1,5', 'abc', '1.2.3', '--1', '1e', 'Infinity', 'NaN', '0x', '1e999', '5mm'])('refuses %j in words', (text) => {
    const r = parseNumber(text);
    expect(r.good).toBe(false);
    if (!r.good) expect(r.why.length).toBeGreaterThan(5);
  });
  it.each([['', 'Type a number.'], ['1e999', 'This number is too large.'], ['5mm', '“5mm” is not a number.']])('says of %j why', (text, why) => expect(parseNumber(text)).toEqual({ good: false, why }));
  it('does not guess what a comma means', () => expect(parseNumber('1,000')).toEqual({ good: false, why: 'Write the decimal sign as a point: 1.5' }));
});

describe('formatNumber', () => {
  it.each([
    [123.456789, 3, '123.457'], [-2, 0, '\u22122'], [0, 3, '0.000'], [-0.0001, 3, '0.000'], [1234, 0, '1234'], [12345, 0, '12\u202f345'], [-1234567.5, 1, '\u22121\u202f234\u202f567.5'],
    [null, 3, '–'], [undefined, 0, '–'], [Number.NaN, 0, '–'], [16909060, 0, '16\u202f909\u202f060'],
  ])('%s with %s places is %s', (value, decimals, text) => expect(formatNumber(value, decimals)).toBe(text));
  it('keeps its width while the value changes within the same magnitude', () => {
    const widths = new Set([100.1, 250.25, 999.999].map((v) => formatNumber(v, 3).length));
    expect(widths.size).toBe(1);
  });
  it.each([[1, 0], [8.89, 1], [88, 2], [3200, 3], [1e9, 3], [0, 0], [-5, 0], [0.01, 0]])('an axis of %s increments per unit shows %s places', (ipu, d) => expect(decimalsOf(ipu)).toBe(d));
  it.each([[65000000, '65\u202f000\u202f000'], [0.25, '0.25'], [-0.5, '\u22120.5']])('formatExact(%s)', (v, t) => expect(formatExact(v)).toBe(t));
});

describe('times', () => {
  it.each([[0, '< 1 s'], [999, '< 1 s'], [1000, '1 s'], [89_000, '89 s'], [120_000, '2 min'], [7_200_000, '2 h'], [3 * 86_400_000, '3 d'], [-5, '< 1 s']])('%s ms', (ms, t) => expect(duration(ms)).toBe(t));
  it('leaves the day out only for today', () => {
    const now = new Date(2026, 0, 2, 15, 0, 0);
    expect(clockTime(new Date(2026, 0, 2, 14, 3, 7).toISOString(), now)).toBe('14:03:07');
    expect(clockTime(new Date(2026, 0, 1, 14, 3, 7).toISOString(), now)).toBe('2026-01-01 14:03:07');
    expect(clockTime('nonsense', now)).toBe('nonsense');
  });
});

describe('labels of a scale', () => {
  it.each([[[0, 10, 20]], [[0, 0.25, 0.5]], [[0.00001, 0.00002, 0.00003]], [[5e-7, 10e-7, 15e-7]], [[1234.5678, 1234.5679, 1234.568]]])('%j are all different', (at) => {
    expect(new Set(tickLabels(at)).size).toBe(at.length);
  });
  it('are no longer than they need to be', () => {
    expect(tickLabels([0, 10, 20])).toEqual(['0', '10', '20']);
    expect(tickLabels([0, 0.25, 0.5])).toEqual(['0.00', '0.25', '0.50']);
    expect(tickLabels([0, 0.00002])).toEqual(['0.00000', '0.00002']);
  });
});
