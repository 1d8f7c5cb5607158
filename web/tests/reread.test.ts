// What is read again: the oldest on the screen, at once after a command, never what was just refused, never more than a quarter of a line's time.
import { describe, expect, it } from 'vitest';
import { again_ms, dueNext, isLive, old_ms, pauseAfter } from '../src/state/reread';

const row = (id: string, at_ms: number | null, refused_ms: number | null = null) => ({ id, at_ms, refused_ms });
const now = 1_000_000;

describe('what is read next', () => {
  it('nothing while all is fresh', () => expect(dueNext([row('a', now - 100), row('b', now - again_ms + 1)], now, 0)).toBeNull());
  it('what was never read before what is old, the oldest first', () => {
    const rows = [row('a', now - 5_000), row('b', now - 9_000), row('c', null), row('d', now)];
    expect(dueNext(rows, now, 0)?.id).toBe('c');
    expect(dueNext(rows.filter((r) => r.id !== 'c'), now, 0)?.id).toBe('b');
  });
  it('after a command everything from before it is due at once', () => {
    expect(dueNext([row('a', now - 50), row('b', now - 10)], now, now - 20)?.id).toBe('a');
    expect(dueNext([row('b', now - 10)], now, now - 20)).toBeNull();
  });
  it('what was refused is left alone for a minute', () => {
    expect(dueNext([row('a', null, now - 59_999)], now, now)).toBeNull();
    expect(dueNext([row('a', null, now - 60_000)], now, now)?.id).toBe('a');
  });
  it.each([[0, 150], [20, 150], [100, 300], [2_000, 6_000]])('an answer of %i ms is followed by a pause of %i ms', (took, pause) => expect(pauseAfter(took)).toBe(pause));
});

it('a value is live that came on this connection, after the last command, not long ago', () => {
  expect(isLive(now - 1_000, now, now - 2_000)).toBe(true);
  expect(isLive(now - 3_000, now, now - 2_000)).toBe(false);
  expect(isLive(now - old_ms, now, 0)).toBe(false);
  expect(isLive(null, now, 0)).toBe(false);
});
