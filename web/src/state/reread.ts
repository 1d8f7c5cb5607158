// Reread: which value of a table is read again next, and when. In: the rows on the screen with the time of their value, the gateway's clock, what has
// happened since. Out: one row, or none; a pause. Pure. One value at a time and at most a quarter of the time of a line, so that whoever
// moves axes on it is not kept waiting; what the drive has refused is left alone for a minute.
export interface Rereadable {
  /** When the drive said it; null: never. */
  at_ms: number | null;
  /** When reading it was last refused; null: it was not. */
  refused_ms: number | null;
}

/** A value on the screen is read again when it is older than this. */
export const again_ms = 4_000;
/** From here on a value is called old. */
export const old_ms = 20_000;
const leftAlone_ms = 60_000;
const leastPause_ms = 150;

/** The value that waits longest; first what was read before `since_ms`, the last command or the last loss of the connection. */
export function dueNext<R extends Rereadable>(rows: readonly R[], now_ms: number, since_ms: number): R | null {
  let best: R | null = null;
  for (const r of rows) {
    if (r.refused_ms !== null && now_ms - r.refused_ms < leftAlone_ms) continue;
    const at = r.at_ms ?? -Infinity;
    if (at >= since_ms && now_ms - at < again_ms) continue;
    if (best === null || at < (best.at_ms ?? -Infinity)) best = r;
  }
  return best;
}

export const pauseAfter = (took_ms: number): number => Math.max(leastPause_ms, 3 * took_ms);

/** Whether a value may be read as live: heard on this connection, since the last command, and not long ago. */
export const isLive = (at_ms: number | null, now_ms: number, since_ms: number): boolean => at_ms !== null && at_ms >= since_ms && now_ms - at_ms < old_ms;
