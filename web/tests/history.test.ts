// The history: a ring with gaps; no drift is drawn where there was rest.
import { describe, expect, it } from 'vitest';
import { AxisHistory } from '../src/state/history';

const at = (at_ms: number, position: number | null, velocity = 0) => ({ at_ms, position, velocity, target: null });

describe('history', () => {
  it('gives columns from a time on, with one sample before', () => {
    const t = new AxisHistory();
    for (let i = 0; i < 10; i += 1) t.add(at(i * 100, i, 1));
    const c = t.since(700);
    expect(c.at).toEqual([0.6, 0.7, 0.8, 0.9]);
    expect(c.position).toEqual([6, 7, 8, 9]);
  });
  it('keeps the newest when it is full', () => {
    const t = new AxisHistory(5);
    for (let i = 0; i < 12; i += 1) t.add(at(i * 100, i, 1));
    expect(t.since(0).position).toEqual([7, 8, 9, 10, 11]);
    expect(t.size).toBe(5);
  });
  it('holds the value through a rest instead of drawing a drift', () => {
    const t = new AxisHistory();
    t.add(at(0, 0));
    t.add(at(5000, 10, 50));
    expect(t.since(0)).toMatchObject({ at: [0, 4.85, 5], position: [0, 0, 10] });
  });
  it('holds a demand through a rest too, also where the position rests on', () => {
    const t = new AxisHistory();
    const error = (at_ms: number, demand: number | null) => ({ ...at(at_ms, 10), demand, error: demand === null ? null : demand - 10, source: demand === null ? null : ('computed' as const) });
    t.add(error(0, 10));
    t.add(error(5000, 12));
    t.add({ ...error(10_000, null) });
    expect(t.since(0)).toMatchObject({ at: [0, 4.85, 5, 9.85, 10], error: [0, 0, 2, 2, null], source: ['computed', 'computed', 'computed', 'computed', null] });
  });
  it('draws straight on where the axis was moving', () => {
    const t = new AxisHistory();
    t.add(at(0, 0, 50));
    t.add(at(5000, 10, 50));
    expect(t.since(0).position).toEqual([0, 10]);
  });
  it('keeps one gap, not many', () => {
    const t = new AxisHistory();
    t.add(at(0, 1));
    t.gap();
    t.gap();
    t.add(at(1000, 2));
    expect(t.since(0).position).toEqual([1, null, 2]);
  });
  it('takes no sample twice and none from the past', () => {
    const t = new AxisHistory();
    t.add(at(1000, 1));
    t.add(at(1000, 2));
    t.add(at(900, 3));
    expect(t.since(0).position).toEqual([1]);
  });
  it('begins anew when the clock of the gateway was set back', () => {
    const t = new AxisHistory();
    t.add(at(100_000, 1));
    t.add(at(50_000, 2));
    expect(t.since(0).position).toEqual([2]);
  });
  it('has nothing to give when empty', () => {
    const t = new AxisHistory();
    t.gap();
    expect(t.since(0).at).toEqual([]);
    expect(t.last).toBeUndefined();
  });
  it('goes on from the last value of a condensed stretch, not from its greatest', () => {
    const t = new AxisHistory(100_000);
    // Each second it moves to and fro within 40 ms and rests: 1000 samples a second, which a plot of 100 points condenses.
    for (let i = 0; i < 20_000; i += 1) t.add(at(1_000_000 + i, i % 1000 < 40 ? 50 - Math.abs(50 - (i % 1000)) : 0, 1));
    const c = t.seen(1_000_000, 1_020_000, 100);
    expect(c.at.length).toBeLessThanOrEqual(204);
    expect(Math.max(...(c.position as number[]))).toBe(39);
    // From the end of each condensed stretch to the beginning of the next one.
    const whole = t.since(0).position;
    const told = (s: number | undefined) => whole[Math.round(((s as number) - 1000) * 1000)];
    for (let i = 4; i < c.at.length; i += 4) expect([c.position[i - 1], c.position[i]], `${c.at[i]} s`).toEqual([told(c.at[i - 1]), told(c.at[i])]);
  });
  it('holds a velocity through a rest', () => {
    const t = new AxisHistory();
    t.add(at(0, 10, 0));
    t.add(at(5000, 10, 15));
    expect(t.since(0)).toMatchObject({ at: [0, 4.85, 5], velocity: [0, 0, 15] });
  });
});
