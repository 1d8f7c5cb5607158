// The scope's rules: peaks survive thinning, triggers fire once and hold, cursors read between samples, CSV is what was seen.
import { describe, expect, it } from 'vitest';
import { crossing, csvOf, followingError, needsDemand, Trigger, valueAt, type TriggerSetting } from '../src/state/scope';
import { Store } from '../src/state/store';
import { Trail } from '../src/state/trail';
import { axis } from './fixtures';

const sample = (at_ms: number, position: number | null, demand: number | null = position) => ({ at_ms, position, velocity: position === null ? null : 1, target: null, demand });
const rising: TriggerSetting = { mode: 'single', channel: 'position', edge: 'rising', level: 5 };

describe('a trail at 1 kHz', () => {
  const t = new Trail(4096);
  t.keep(131_072);
  for (let i = 0; i < 60_000; i += 1) t.add(sample(1_000_000 + i, i === 31_234 ? 900 : i === 31_240 ? -900 : Math.sin(i / 500)));
  it('keeps a minute of it', () => expect(t.size).toBe(60_000));
  it('is thinned to what a screen can show, and no peak is lost', () => {
    const c = t.seen(1_000_000, 1_060_000, 800);
    expect(c.at.length).toBeLessThanOrEqual(1602);
    expect(Math.max(...(c.position as number[]))).toBe(900);
    expect(Math.min(...(c.position as number[]))).toBe(-900);
    expect(c.at).toEqual([...c.at].sort((a, b) => a - b));
    const up = c.position.indexOf(900);
    const down = c.position.indexOf(-900);
    expect(up).toBeLessThan(down); // in the order in which they came
  });
  it('is given whole where it fits', () => expect(t.seen(1_000_000, 1_000_100, 800).at.length).toBe(101));
  it('forgets the oldest beyond its capacity', () => {
    for (let i = 60_000; i < 200_000; i += 1) t.add(sample(1_000_000 + i, 0));
    expect(t.size).toBe(131_072);
    expect(t.since(0).at[0]).toBeCloseTo((1_000_000 + 200_000 - 131_072) / 1000, 6);
  });
});

describe('trigger', () => {
  const ramp = (from_s: number, points: [number, number | null][]) => {
    const t = new Trail();
    for (const [s, p] of points) t.add(sample((from_s + s) * 1000, p));
    return t.since(0);
  };
  it('fires where the line between two samples crosses the level', () => {
    expect(crossing(ramp(100, [[0, 0], [1, 10]]), rising, 0)).toBeCloseTo(100.5);
    expect(crossing(ramp(100, [[0, 10], [1, 0]]), rising, 0)).toBeNull();
    expect(crossing(ramp(100, [[0, 10], [1, 0]]), { ...rising, edge: 'falling' }, 0)).toBeCloseTo(100.5);
    expect(crossing(ramp(100, [[0, 0], [1, 10]]), rising, 100.6)).toBeNull();
    expect(crossing(ramp(100, [[0, 5], [1, 10]]), rising, 0)).toBeNull(); // it began on the level
  });
  it('never fires across a gap', () => expect(crossing(ramp(100, [[0, 0], [0.5, null], [1, 10]]), rising, 0)).toBeNull());
  it('holds a quarter of the window before it, once', () => {
    const c = ramp(100, [[0, 0], [1, 10], [2, 0], [3, 10]]);
    const t = new Trigger();
    t.arm(100);
    expect(t.look(c, rising, 101, 4)).toBeNull();
    expect(t.state).toBe('fired');
    expect(t.look(c, rising, 104, 4)).toBeCloseTo(99.5);
    expect(t.state).toBe('shown');
    expect(t.look(c, rising, 200, 4)).toBeCloseTo(99.5);
    t.arm(102);
    expect(t.look(c, rising, 106, 4)).toBeCloseTo(101.5);
  });
  it('each time shows the newest one whose window is full', () => {
    const again: TriggerSetting = { ...rising, mode: 'again' };
    const t = new Trigger();
    t.arm(100);
    expect(t.look(ramp(100, [[0, 0], [1, 10]]), again, 104, 4)).toBeCloseTo(99.5);
    const later = ramp(100, [[0, 0], [1, 10], [5, 0], [6, 10]]);
    expect(t.look(later, again, 107, 4)).toBeCloseTo(99.5);
    expect(t.look(later, again, 109, 4)).toBeCloseTo(104.5);
  });
});

describe('readings', () => {
  const t = new Trail();
  t.add(sample(1000, 0, 1));
  t.add(sample(2000, 10, 12));
  t.add(sample(3000, null));
  const c = t.since(0);
  it('of the following error are demand less position', () => expect(followingError(c)).toEqual([1, 2, null]));
  it('of a cursor lie on the line between two samples, and are unknown outside', () => {
    expect(valueAt(c, 'position', 1.25)).toBeCloseTo(2.5);
    expect(valueAt(c, 'error', 1.5)).toBeCloseTo(1.5);
    expect(valueAt(c, 'position', 0.5)).toBeNull();
    expect(valueAt(c, 'position', 2.5)).toBe(10);
    expect(valueAt(c, 'position', 3.5)).toBeNull();
  });
  it('of a target are as it was set, never a ramp between two', () => {
    const steps = new Trail();
    for (const [at, target] of [[1000, 0], [2000, 10]] as const) steps.add({ ...sample(at, at / 1000), target });
    const s = steps.since(0);
    expect(valueAt(s, 'target', 1.99)).toBe(0);
    expect(valueAt(s, 'target', 2)).toBe(10);
    expect(crossing(s, { ...rising, channel: 'target' }, 0)).toBe(2);
  });
  it('of a drive that does not say where it wants to be have neither demand nor following error', () => {
    const store = new Store();
    const tell = (at: number, more: object) => store.take({ topic: 'axes/feeder', at: at * 1e6, data: { ...axis({ name: 'feeder', position: 3 }), position_demand: 0, ...more } });
    tell(1000, { demand_known: false });
    const silent = store.trail('feeder').since(0);
    expect([silent.demand, followingError(silent)]).toEqual([[null], [null]]);
    expect(csvOf(silent, 'feeder', 'mm').split('\r\n')[1]).toMatch(/^[^,]*,0,3,,[^,]*,,/);
    tell(2000, {});
    expect(store.trail('feeder').since(0).demand.at(-1)).toBe(0);
    expect(['position', 'demand', 'velocity', 'error', 'target'].filter((c) => needsDemand(c as never))).toEqual(['demand', 'error']);
  });
  it('as CSV have a head with units, a point as decimal sign, and nothing where nothing was known', () => {
    const lines = csvOf(c, 'a,b', 'mm').split('\r\n');
    expect(lines[0]).toBe('time,seconds,"a,b.position [mm]","a,b.position_demand [mm]","a,b.velocity [mm/s]","a,b.following_error [mm]","a,b.target_position [mm]"');
    expect(lines[1]).toBe('1970-01-01T00:00:01.000Z,0,0,1,1,1,');
    expect(lines[3]).toBe('1970-01-01T00:00:03.000Z,2,,,,,');
    expect(lines).toHaveLength(5);
  });
});
