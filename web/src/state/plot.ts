// Plot's rules: what part of time is seen, how it is zoomed and moved, and what a cursor reads. In: ranges, columns. Out: ranges, values.
// Never draws: that is components/plot.tsx.

export type Range = readonly [number, number];
type Column = readonly (number | null | undefined)[];

/** The narrowest that can be looked at, seconds. */
export const narrowest_s = 0.002;

/** `factor` below 1 comes closer; the instant `about` stays where it is; never beyond `whole`. */
export function zoomed(range: Range, about: number, factor: number, whole: Range): Range {
  const span = Math.min(whole[1] - whole[0], Math.max(narrowest_s, (range[1] - range[0]) * factor));
  const share = range[1] > range[0] ? (about - range[0]) / (range[1] - range[0]) : 0.5;
  return within([about - share * span, about + (1 - share) * span], whole);
}

/** By a share of what is seen. */
export const panned = (range: Range, share: number, whole: Range): Range => {
  const by = (range[1] - range[0]) * share;
  return within([range[0] + by, range[1] + by], whole);
};

/** Moved, not squeezed, into `whole`; all of it where it is longer. */
export function within(range: Range, whole: Range): Range {
  const span = range[1] - range[0];
  if (!(span < whole[1] - whole[0])) return whole;
  const low = Math.min(Math.max(range[0], whole[0]), whole[1] - span);
  return [low, low + span];
}

/** What a column was at an instant: on the straight line between its known neighbours, or as it was set; null in a gap or outside. */
export function readAt(at: readonly number[], v: Column, t: number, stepped = false): number | null {
  const n = at.length;
  if (n === 0 || t < (at[0] as number) || t > (at[n - 1] as number)) return null;
  let low = 0;
  let high = n;
  while (low < high) {
    const m = (low + high) >> 1;
    if ((at[m] as number) <= t) low = m + 1;
    else high = m;
  }
  let i = low - 1;
  while (i >= 0 && v[i] === undefined) i -= 1; // columns of others have rows in between
  const a = i < 0 ? null : (v[i] ?? null);
  if (a === null || stepped) return a;
  let k = low;
  while (k < n && v[k] === undefined) k += 1;
  const b = k < n ? (v[k] ?? null) : null;
  if (b === null) return a;
  const [t0, t1] = [at[i] as number, at[k] as number];
  return t1 > t0 ? a + ((b - a) * (t - t0)) / (t1 - t0) : b;
}

/** Room above and below; never a range of nothing; `withZero`: its zero is always seen. */
export function spread(low: number | null, high: number | null, withZero = false, least = 0.5): [number, number] {
  if (low === null || high === null || !Number.isFinite(low) || !Number.isFinite(high)) return [-1, 1];
  const a = withZero ? Math.min(low, 0) : low;
  const b = withZero ? Math.max(high, 0) : high;
  const room = Math.max((b - a) * 0.1, Math.abs(b) * 1e-3, least);
  return [a - room, b + room];
}
