// The scope's rules: peaks survive thinning, triggers fire once and hold, cursors read between samples, CSV is what was seen.
import { describe, expect, it } from 'vitest';
import { channels, columnOf, crossing, csvOf, needsDemand, Trigger, valueAt, type TriggerSetting } from '../src/state/scope';
import { Store } from '../src/state/store';
import { AxisHistory, type DemandSource } from '../src/state/history';
import { World } from '../dev/mock/world.mjs';
import { axis } from './fixtures';

const sample = (at_ms: number, position: number | null, demand: number | null = position, source: DemandSource = 'drive') => {
  const known = position !== null && demand !== null;
  return { at_ms, position, velocity: position === null ? null : 1, target: null, demand, error: known ? demand - position : null, source: known ? source : null };
};
const rising: TriggerSetting = { mode: 'single', channel: 'position', edge: 'rising', level: 5 };

describe('a history at 1 kHz', () => {
  const t = new AxisHistory(4096);
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
  it('keeps the peak of the following error too, though demand and position are thinned each by itself', () => {
    const t = new AxisHistory(4096);
    // The error has its peak where neither the demand nor the position has one.
    for (let i = 0; i < 4000; i += 1) t.add(sample(1_000_000 + i, i, i + (i % 40 === 17 ? 9 : 1)));
    const c = t.seen(1_000_000, 1_004_000, 100);
    expect(c.at.length).toBeLessThanOrEqual(202);
    const error = columnOf(c, 'error') as number[];
    expect([Math.min(...error), Math.max(...error)]).toEqual([1, 9]);
    expect(new Set(c.source)).toEqual(new Set(['drive']));
    expect([c.error.length, c.source.length]).toEqual([c.at.length, c.at.length]);
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
    const t = new AxisHistory();
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
  const t = new AxisHistory();
  t.add(sample(1000, 0, 1));
  t.add(sample(2000, 10, 12));
  t.add(sample(3000, null));
  const c = t.since(0);
  it('of a cursor lie on the line between two samples, and are unknown outside', () => {
    expect(valueAt(c, 'position', 1.25)).toBeCloseTo(2.5);
    expect(valueAt(c, 'error', 1.5)).toBeCloseTo(1.5);
    expect(valueAt(c, 'position', 0.5)).toBeNull();
    expect(valueAt(c, 'position', 2.5)).toBe(10);
    expect(valueAt(c, 'position', 3.5)).toBeNull();
  });
  it('of a target are as it was set, never a ramp between two', () => {
    const steps = new AxisHistory();
    for (const [at, target] of [[1000, 0], [2000, 10]] as const) steps.add({ ...sample(at, at / 1000), target });
    const s = steps.since(0);
    expect(valueAt(s, 'target', 1.99)).toBe(0);
    expect(valueAt(s, 'target', 2)).toBe(10);
    expect(crossing(s, { ...rising, channel: 'target' }, 0)).toBe(2);
  });
  it('of an axis whose demand nobody tells are a gap, and are back with the next order', () => {
    const store = new Store();
    const tell = (at: number, more: object) => store.take({ topic: 'axes/feeder', at: at * 1e6, data: axis({ name: 'feeder', position: 3, ...more }) });
    tell(1000, {});
    tell(1100, { demand_known: true, demand_source: 'computed', position_demand: 3.5, following_error: 0.5 });
    tell(1200, {});
    const c = store.history('feeder').since(0);
    expect([c.position, c.demand, c.error, c.source]).toEqual([[3, 3, 3], [null, 3.5, null], [null, 0.5, null], [null, 'computed', null]]);
    expect([valueAt(c, 'error', 1.05), valueAt(c, 'error', 1.15), valueAt(c, 'error', 1.25)]).toEqual([null, 0.5, null]);
    expect(channels.filter(needsDemand)).toEqual(['demand', 'error']);
  });
  it('of the stand-in lead the position while it moves, are unknown while it is off, and grow while the shaft is held', () => {
    const world = new World();
    const look = (name: string) => {
      const { demand_known, demand_source, position_demand, following_error, position } = world.axis(name);
      expect([demand_known, position_demand === null, following_error === null]).toEqual([demand_source !== null, demand_source === null, demand_source === null]);
      if (position_demand !== null) expect(following_error).toBeCloseTo(position_demand - Number(position), 3);
      return { source: demand_source, error: following_error };
    };
    const go = (seconds: number) => Array.from({ length: seconds * 100 }, () => world.step(0.01));
    expect(look('feeder')).toEqual({ source: null, error: null });
    world.command('feeder', { command: 'enable' }, 'x');
    expect(look('feeder').source).toBeNull();
    world.command('feeder', { command: 'move_relative', position: 100, velocity: 50 }, 'x');
    go(0.5);
    expect(look('feeder').source).toBe('computed');
    expect(look('feeder').error).toBeCloseTo(1, 1);
    world.setHand('feeder', { stall: true });
    go(0.2);
    const held = Number(look('feeder').error);
    expect(held).toBeGreaterThan(8);
    go(0.2);
    expect(Number(look('feeder').error)).toBeGreaterThan(held + 8);
    go(0.2);
    expect(world.axis('feeder')).toMatchObject({ state: 'fault', demand_source: null });
    expect(look('gantry-x')).toEqual({ source: 'open_loop', error: 0 });
  });
});

describe('a recording as CSV', () => {
  const recorded = (...all: DemandSource[]) => {
    const t = new AxisHistory();
    all.forEach((source, i) => t.add(sample(1000 * (i + 1), 10 * i, source === null ? null : 10 * i + 1, source)));
    return csvOf(t.since(0), 'a,b', 'mm').split('\r\n');
  };
  it('has a head with units, a point as decimal sign, and nothing where nothing was known', () => {
    const lines = recorded('drive', 'drive', null);
    expect(lines[0]).toBe('time,seconds,"a,b.position [mm]","a,b.position_demand [mm]","a,b.velocity [mm/s]","a,b.following_error [mm]","a,b.target_position [mm]","a,b.demand_source"');
    expect(lines[1]).toBe('1970-01-01T00:00:01.000Z,0,0,1,1,1,,drive');
    expect(lines[3]).toBe('1970-01-01T00:00:03.000Z,2,20,,1,,,');
    expect(lines).toHaveLength(5);
  });
  it.each([
    [['computed', null, 'computed'], ' (computed)'],
    [['drive', 'computed', null], ' (mixed: computed and drive)'],
    [['open_loop'], ' (open loop)'],
    [[null, null], ''],
  ] as const)('of %j says so in the names of demand and following error, and of each row in the last column', (all, mark) => {
    const [head, ...rows] = recorded(...all);
    expect(head).toContain(`"a,b.position_demand${mark} [mm]"`);
    expect(head).toContain(`"a,b.following_error${mark} [mm]"`);
    expect(head).toContain('"a,b.velocity [mm/s]"');
    expect(rows.slice(0, -1).map((r) => r.split(',').at(-1))).toEqual(all.map((s) => s ?? ''));
  });
});
