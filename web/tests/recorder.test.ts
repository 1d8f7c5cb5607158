// The recorder's rules on the page: zoom and pan stay within what there is, cursors read across the rows of others, columns are put together
// without inventing a slope, words say what a capture waits for.
import { describe, expect, it } from 'vitest';
import { narrowest_s, panned, readAt, within, zoomed } from '../src/state/plot';
import { captureParts, joined, trendPart } from '../src/state/recorder';
import { routeOf, recorderPath } from '../src/router';
import { bytesText, freeName, instantText, nameFault, registerText, sinceText, triggerText } from '../src/text/recorder';
import { comparedSentence, parameterReport } from '../src/text/report';
import type { AxisParameter, CaptureWithRows, Trends } from '../src/api/types';

describe('the part of time that is seen', () => {
  const whole = [0, 100] as const;
  it('comes closer about an instant that stays where it is', () => {
    expect(zoomed([0, 100], 25, 0.5, whole)).toEqual([12.5, 62.5]);
    expect(zoomed([12.5, 62.5], 25, 2, whole)).toEqual([0, 100]);
  });
  it('never leaves what there is, and is never narrower than can be looked at', () => {
    expect(zoomed([90, 100], 100, 4, whole)).toEqual([60, 100]);
    const close = zoomed([50, 50.003], 50, 0.01, whole);
    expect(close[1] - close[0]).toBeCloseTo(narrowest_s, 9);
    expect(panned([80, 100], 0.5, whole)).toEqual([80, 100]);
    expect(panned([50, 70], -0.5, whole)).toEqual([40, 60]);
    expect(within([-10, 10], whole)).toEqual([0, 20]);
    expect(within([-10, 200], whole)).toEqual([0, 100]);
  });
});

describe('a cursor', () => {
  const at = [0, 1, 2, 3, 4];
  it('reads between known rows, across the rows of others, and not in a gap', () => {
    const v = [0, undefined, 20, null, 40];
    expect(readAt(at, v, 0.5)).toBe(5);
    expect(readAt(at, v, 1)).toBe(10);
    expect(readAt(at, v, 3.5)).toBe(null);
    expect(readAt(at, v, -1)).toBe(null);
    expect(readAt(at, v, 4.1)).toBe(null);
    expect(readAt(at, v, 1.5, true)).toBe(0);
  });
});

describe('columns put together', () => {
  it('keep their own rows: another curve leaves a hole, not a gap', () => {
    expect(joined([{ at: [1, 3], columns: [[10, 30]] }, { at: [2, 3], columns: [[null, 7]] }])).toEqual({ at: [1, 2, 3], columns: [[10, undefined, 30], [undefined, null, 7]] });
  });
  const trend = (more: Partial<Trends['axes'][number]>): Trends['axes'][number] => ({ axis: 'a', unit: 'mm', rate_hz: 20, thinned: false, oldest: 0, newest: 10_000, at: [1000, 9000], points: { position: { values: [1, 5] } }, ...more });
  it('of a rest are a step and no slope, and the newest value holds to the end', () => {
    const p = trendPart(trend({}), ['position'], 20);
    expect(p.columns).toEqual([[1, 1, 5, 5]]);
    expect([p.at[0], p.at[2], p.at[3]]).toEqual([1, 9, 10]);
    expect(9 - (p.at[1] as number)).toBeLessThan(0.001);
  });
  it('of a silence have no value, and nothing is drawn on behind it', () => {
    const p = trendPart(trend({ at: [1000, 1050, 5000], newest: 1040, points: { position: { values: [1, null, null] } } }), ['position'], 20);
    const d = joined([p]);
    expect(readAt(d.at, d.columns[0]!, 3)).toBe(null);
    expect(readAt(d.at, d.columns[0]!, 5)).toBe(null);
  });
  const thin = (position: object, more: object = {}) => trend({ thinned: true, at: [0, 1000, 82_000], until: [900, 1400, 82_600], gaps: [false, false, false], newest: 90_000, points: { position: position as never }, ...more });
  // It moves with 15, stands in fault for 81 s, and moves once more for a moment.
  const fault = { first: [15, 15, 0], min: [15, 0, 0], max: [15, 15, 15], last: [15, 0, 0], low: [15, 0, 0], high: [15, 15, 15] };
  it('that are thinned show no motion that was not: the last value holds, a rest is flat, the end is the last value', () => {
    const d = joined([trendPart(thin(fault), ['position'], 100)]);
    for (const t of [1.4, 1.5, 2, 40, 81.9]) expect(readAt(d.at, d.columns[0]!, t), `${t} s`).toBe(0);
    for (const t of [82.6, 85, 90]) expect(readAt(d.at, d.columns[0]!, t), `${t} s`).toBe(0);
    expect(readAt(d.at, d.columns[0]!, 0.5)).toBe(15);
    expect(Math.max(...d.columns[0]!.slice(5).map((v) => v ?? 0))).toBe(15); // the moment at the end is not lost
    expect(d.at).toEqual([...d.at].sort((a, b) => a - b));
    expect(d.at.at(-1)).toBe(90);
  });
  it('that are thinned have their gaps, and what was known beside them', () => {
    const v = { first: [3, null, null], min: [3, 4, 4], max: [3, 9, 4], last: [null, null, 4] };
    const d = joined([trendPart(thin(v, { gaps: [true, true, true] }), ['position'], 100)]);
    const read = (t: number) => readAt(d.at, d.columns[0]!, t);
    expect(read(0)).toBe(3);
    for (const t of [0.91, 1, 1.4, 40, 81.9]) expect(read(t), `${t} s`).toBe(null);
    expect(read(82.6)).toBe(4);
    expect(Math.max(...d.columns[0]!.map((x) => x ?? 0))).toBe(9);
    const silent = joined([trendPart(thin({ first: [3, 3, 5], min: [3, 3, 5], max: [3, 3, 5], last: [3, 3, 5] }, { gaps: [false, false, true] }), ['position'], 100)]);
    expect(silent.columns[0]!.filter((x) => x === null)).toHaveLength(1); // known at both ends of the column, silent in between
  });
  it('that are thinned are a step where something new was told as a column began, after a rest as well', () => {
    const v = { first: [15, 0, 7], min: [15, 0, 7], max: [15, 0, 7], last: [15, 0, 7] };
    const d = joined([trendPart(thin(v), ['position'], 100)]);
    for (const [t, value] of [[0.95, 15], [0.999, 15], [1, 0], [40, 0], [81.99, 0], [82, 7]] as const) expect(readAt(d.at, d.columns[0]!, t), `${t} s`).toBe(value);
  });
  it('that are thinned keep a peak though it was not known where the column began', () => {
    const v = { first: [null, 3, 3], min: [2, 3, 3], max: [9, 3, 3], last: [3, 3, 3] };
    expect(joined([trendPart(thin(v), ['position'], 100)]).columns[0]).toEqual(expect.arrayContaining([2, 9]));
  });
  it('of captures have no value where it was too old', () => {
    const c = { columns: [{ axis: 'a', unit: 'mm', seconds: [0, 1, 2], position: [1, 2, 3], statusword: [0x27, 0x4027, 0x27] }] } as unknown as CaptureWithRows;
    expect(joined(captureParts(c, ['position'])).columns).toEqual([[1, null, 3]]);
  });
  it('of captures are laid over each other by seconds from the trigger', () => {
    const capture = (position: number[]) => ({ columns: [{ axis: 'a', unit: 'mm', seconds: [-1, 0, 1], position, velocity: [], demand: [], following_error: [], statusword: [0x27, 0x27, 0x27] }] }) as unknown as CaptureWithRows;
    const d = joined([...captureParts(capture([1, 2, 3]), ['position']), ...captureParts(capture([4, 5, 6]), ['position'])]);
    expect(d).toEqual({ at: [-1, 0, 1], columns: [[1, 2, 3], [4, 5, 6]] });
  });
});

describe('words', () => {
  it('of triggers', () => {
    expect(triggerText({ kind: 'level', axis: 'feeder', point: 'velocity', level: 12.5, edge: 'falling' }, 'mm')).toBe('velocity of feeder falls through 12.500 mm/s');
    expect(triggerText({ kind: 'state', axis: 'feeder', state: 'fault', edge: 'rising' })).toBe('“fault” of feeder comes');
    expect(triggerText({ kind: 'command', axis: 'feeder' })).toBe('a command that moves feeder');
    expect(triggerText({ kind: 'at_once' })).toBe('at once');
    expect(triggerText(null)).toBe('not known');
  });
  it('of names, sizes, times and registers', () => {
    expect(freeName('capture', ['capture-1', 'capture-3'])).toBe('capture-2');
    expect(nameFault('before-tuning_2.1')).toBe(undefined);
    for (const bad of ['', '.a', 'a b', 'a/b', 'a'.repeat(65)]) expect(nameFault(bad)).not.toBe(undefined);
    expect(bytesText(123_456)).toBe('123 kB');
    expect(sinceText(-0.0123, 0.01)).toBe('−0.0123 s');
    expect(sinceText(-0.00001, 1)).toBe('0.00 s');
    expect(instantText(0.1234, 1)).toBe('00:00:00.123');
    expect(registerText({ address: 64, words: [0x1627, 1, 0, 0xffff] })).toBe('64: 1627 0001 0000 FFFF');
  });
});

describe('addresses', () => {
  it('lead to a tab, an axis, an instant, and back', () => {
    expect(routeOf('/recorder')).toEqual({ page: 'recorder', tab: 'trends' });
    expect(routeOf(recorderPath('recordings'))).toEqual({ page: 'recorder', tab: 'recordings' });
    expect(routeOf(recorderPath('captures', 'z.1'))).toEqual({ page: 'recorder', tab: 'captures', axis: 'z.1' });
    expect(routeOf(recorderPath('trends', 'feeder', 1_700_000_000_123.4))).toEqual({ page: 'recorder', tab: 'trends', axis: 'feeder', at_ms: 1_700_000_000_123 });
    expect(routeOf('/recorder/moon').page).toBe('unknown');
    expect(routeOf('/recorder/trends/a/x').page).toBe('unknown');
  });
});

describe('the commissioning report', () => {
  const p = (id: string, value: number | null, fallback: number | null, more = {}) => ({ id, name: id, unit: 'mm', access: 'RW', value, stored: null, default: fallback, count: null, ...more }) as unknown as AxisParameter;
  const snapshot = { n: 3, name: 'first', at: '2026-01-02T00:00:00Z', who: 'anna', parameters: [{ parameter: 'AC', value: 5 }, { parameter: 'DC', value: 7 }] };
  it('shows what differs from default or snapshot, and counts what nobody has read', () => {
    const r = parameterReport([p('AC', 5, 5), p('DC', 8, 8), p('SP', 3, 1), p('XX', null, 1), p('PO', 9, 1, { access: 'R' }), p('GO', null, null, { access: 'W' })], snapshot);
    expect(r.rows.map((x) => [x.id, x.now, x.otherwise, x.snapshot])).toEqual([['DC', 8, 8, 7], ['SP', 3, 1, undefined]]);
    expect([r.known, r.unknown, r.againstSnapshot]).toEqual([4, 1, 2]);
    expect(comparedSentence(r, snapshot)).toBe('4 values known, 1 not read and not compared; 2 beside snapshot 3, first. 2 differ:');
    expect(comparedSentence(parameterReport([], null), null)).toBe('0 values known, all of them read; no snapshot was taken. Nothing differs.');
  });
});
