// The store: what is live, what is old; lists and messages in any order; events without loss or double.
import { describe, expect, it, vi } from 'vitest';
import type { StreamState } from '../src/api/stream';
import type { Drive, Line } from '../src/api/types';
import { Store } from '../src/state/store';
import { axis, event, world } from './fixtures';

const live = (epoch = 1): StreamState => ({ phase: 'live', epoch, lastLiveAt: 1, retryAt: 0, attempts: 0, why: '' });
const lost = (epoch = 1): StreamState => ({ ...live(epoch), phase: 'waiting', retryAt: 2 });
const tell = (s: Store, name: string, data: unknown, at_ms = 1_000) => s.take({ topic: `axes/${name}`, at: at_ms * 1e6, data });
const w = world();
const lists = (names: string[]) => ({ axes: names.map((name, i) => axis({ name, number: i + 1 })), drives: [w.driveOf('feeder').document()] as Drive[], lines: [w.line('can0')] as Line[] });

describe('trust', () => {
  it.each([
    [{}, 'live'],
    [{ stale: true }, 'stale'],
    [{ online: false }, 'offline'],
    [{ online: false, stale: true }, 'offline'],
  ] as const)('%o is %s', (change, trust) => {
    const s = new Store();
    s.setConnection(live());
    tell(s, 'feeder', axis(change));
    expect(s.trustOf(s.axis('feeder')!.value)).toBe(trust);
  });
  it('ends with the connection, at once, and does not come back by itself with the next one', () => {
    const s = new Store();
    s.setConnection(live(1));
    tell(s, 'feeder', axis());
    s.setConnection(lost(1));
    expect(s.trustOf(s.axis('feeder')!.value)).toBe('disconnected');
    s.setConnection(live(2));
    expect(s.trustOf(s.axis('feeder')!.value)).toBe('disconnected');
    tell(s, 'feeder', axis());
    expect(s.trustOf(s.axis('feeder')!.value)).toBe('live');
  });
});

describe('lists and messages', () => {
  it('keeps axes in the order of their numbers', () => {
    const s = new Store();
    s.setConnection(live());
    tell(s, 'b', axis({ name: 'b', number: 2 }));
    tell(s, 'a', axis({ name: 'a', number: 10 }));
    tell(s, 'c', axis({ name: 'c', number: 1 }));
    expect(s.axisNames.value).toEqual(['c', 'b', 'a']);
  });
  it('does not let a list that was made earlier replace a newer message', () => {
    const s = new Store();
    s.setConnection(live());
    tell(s, 'a', axis({ name: 'a', number: 1, position: 42 }));
    s.setLists(lists(['a', 'b']), 1);
    expect(s.axis('a')!.value.data.position).toBe(42);
    expect(s.axisNames.value).toEqual(['a', 'b']);
    expect(s.listed.value).toBe(true);
  });
  it('lets a list replace what was heard on an older connection', () => {
    const s = new Store();
    s.setConnection(live(1));
    tell(s, 'a', axis({ name: 'a', number: 1, position: 42 }));
    s.setConnection(live(2));
    const l = lists(['a']);
    s.setLists({ ...l, axes: [axis({ name: 'a', number: 1, position: 7 })] }, 2);
    expect(s.axis('a')!.value).toMatchObject({ epoch: 2, data: { position: 7 } });
  });
  it('drops what is no longer in the site', () => {
    const s = new Store();
    s.setConnection(live());
    s.setLists(lists(['a', 'b']), 1);
    tell(s, 'b', null);
    expect(s.axisNames.value).toEqual(['a']);
    s.setLists(lists(['c']), 1);
    expect(s.axisNames.value).toEqual(['c']);
    expect(s.axis('a')).toBeUndefined();
  });
  it('takes drives, lines and the revision of the site', () => {
    const s = new Store();
    s.setConnection(live());
    s.take({ topic: 'drives/feeder', at: 1, data: w.driveOf('feeder').document() });
    s.take({ topic: 'lines/can0', at: 1, data: w.line('can0') });
    s.take({ topic: 'site', at: 1, data: { revision: 7 } });
    expect(s.driveNames.value).toEqual(['feeder']);
    expect(s.lineNames.value).toEqual(['can0']);
    expect(s.siteRevision.value).toBe(7);
  });
  it('leaves frames and strange topics alone', () => {
    const s = new Store();
    s.take({ topic: 'lines/can0/frames', at: 1, data: { frames: [] } });
    s.take({ topic: 'error', at: 1, data: { text: 'x' } });
    expect(s.lineNames.value).toEqual([]);
  });
  it('counts what the strip shows', () => {
    const s = new Store();
    s.setConnection(live());
    tell(s, 'a', axis({ name: 'a', moving: true, simulated: true }));
    tell(s, 'b', axis({ name: 'b', fault: true, simulated: false }));
    tell(s, 'c', axis({ name: 'c', online: false, moving: true, simulated: false }));
    expect(s.counts.value).toEqual({ axes: 3, moving: 1, fault: 1, simulated: 1, offline: 1 });
  });
});

describe('drawing', () => {
  it('shows only the newest of many states before the next picture', () => {
    const flushes: (() => void)[] = [];
    const s = new Store({ schedule: (f) => flushes.push(f) });
    s.setConnection(live());
    for (let i = 0; i < 50; i += 1) tell(s, 'a', axis({ name: 'a', position: i }), 1000 + i);
    expect(flushes).toHaveLength(1);
    const seen = vi.fn();
    flushes[0]!();
    s.axis('a')!.subscribe((e) => seen(e.data.position));
    expect(seen.mock.calls).toEqual([[49]]);
    expect(s.history('a').size).toBe(50); // the scope lost none
  });
  it('makes the history end in a gap when the connection, the drive or the trust is lost', () => {
    const s = new Store();
    s.setConnection(live());
    tell(s, 'a', axis({ name: 'a', position: 1 }), 1000);
    s.setConnection(lost());
    expect(s.history('a').last?.position).toBeNull();
    s.setConnection(live(2));
    tell(s, 'a', axis({ name: 'a', position: 2 }), 2000);
    tell(s, 'a', axis({ name: 'a', position: 2, stale: true }), 2100);
    expect(s.history('a').last?.position).toBeNull();
  });
});

describe('events', () => {
  it('are newest first, without doubles, whichever way they came', () => {
    const s = new Store();
    s.take({ topic: 'events', at: 1, data: event(3) });
    s.setEvents([event(1), event(2), event(3)]);
    s.take({ topic: 'events', at: 1, data: event(4) });
    expect(s.events.value.map((e) => e.id)).toEqual([4, 3, 2, 1]);
  });
  it('are at most 500', () => {
    const s = new Store();
    s.setEvents(Array.from({ length: 700 }, (_, i) => event(i + 1)));
    expect(s.events.value).toHaveLength(500);
    expect(s.events.value[0]!.id).toBe(700);
  });
  it('start anew when the gateway has another data directory', () => {
    const s = new Store();
    s.setEvents([event(1), event(2), event(3)]);
    s.setEvents([event(1, { at: '2030-01-01T00:00:00Z', text: 'another life' })]);
    expect(s.events.value.map((e) => e.text)).toEqual(['another life']);
  });
  it('keep the old ones when the newest list follows with a hole', () => {
    const s = new Store();
    s.setEvents([event(1), event(2)]);
    s.setEvents([event(9), event(10)]);
    expect(s.events.value.map((e) => e.id)).toEqual([10, 9, 2, 1]);
  });
  it('are told to listeners one by one, once', () => {
    const s = new Store();
    const received = vi.fn();
    const end = s.onEvent((e) => received(e.id));
    s.take({ topic: 'events', at: 1, data: event(1, { severity: 'alarm' }) });
    end();
    s.take({ topic: 'events', at: 1, data: event(2) });
    expect(received.mock.calls).toEqual([[1]]);
  });
});
