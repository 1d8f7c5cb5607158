// Recorder: documents of /recorder as columns that a plot draws. In: trends, captures. Out: one time axis with a column for each curve: where
// others have a row and this one has none the column has a hole (undefined), which is no gap (null). Pure.
import type { CaptureWithRows, Trends } from '../api/types';
import { points, type TracePoint } from '../text/recorder';

export type Column = (number | null | undefined)[];
export interface Drawn {
  at: number[];
  columns: Column[];
}
interface Part {
  at: readonly number[];
  columns: readonly Column[];
}

/** Parts with time axes of their own, put together: merged in order of time, O(n log n) in all rows. */
export function joined(parts: readonly Part[]): Drawn {
  const at = [...new Set(parts.flatMap((p) => [...p.at]))].sort((a, b) => a - b);
  const place = new Map(at.map((t, i) => [t, i]));
  const columns: Column[] = [];
  for (const p of parts) {
    for (const c of p.columns) {
      const out: Column = new Array<number | null | undefined>(at.length).fill(undefined);
      p.at.forEach((t, i) => (out[place.get(t) as number] = c[i] ?? null));
      columns.push(out);
    }
  }
  return { at, columns };
}

/** Words of a drive that are further apart than this: nothing changed in between. */
const rest_s = 0.4;
type TrendAxis = Trends['axes'][number];
type Values = { values?: (number | null)[]; low?: (number | null)[]; high?: (number | null)[] };

/** A column of a thinned stretch is drawn from its least to its greatest: both at its instant, a hair apart. Held on until the newest word. */
export function trendPart(a: TrendAxis, chosen: readonly TracePoint[], to_s: number): Part {
  const at: number[] = [];
  const columns: Column[] = chosen.map(() => []);
  const seconds = a.at.map((ms) => ms / 1000);
  const newest = Math.min(to_s, (a.newest ?? 0) / 1000);
  seconds.forEach((t, i) => {
    // After a rest the old value held until just before: a line over the rest would show a slow drift that never was.
    const before = at.at(-1);
    if (!a.thinned && before !== undefined && t - before > rest_s) {
      at.push(t - rest_s / 4);
      columns.forEach((c) => c.push(c.at(-1) ?? null));
    }
    at.push(t);
    if (a.thinned) at.push(t + 1e-6);
    chosen.forEach((p, k) => {
      const v = (a.points as Record<string, Values>)[p] ?? {};
      if (a.thinned) columns[k]!.push(v.low?.[i] ?? null, v.high?.[i] ?? null);
      else columns[k]!.push(v.values?.[i] ?? null);
    });
  });
  const last = at.at(-1);
  if (last !== undefined && newest > last) {
    at.push(newest);
    columns.forEach((c) => c.push(c.at(-1) ?? null));
  }
  return { at, columns };
}

/** Each word of a drive holds until its next one where nothing moved: a step of rest is no slow drift. */
export function captureParts(c: CaptureWithRows, chosen: readonly TracePoint[]): Part[] {
  return c.columns.map((a) => ({ at: a.seconds, columns: chosen.map((p) => a[p] as Column) }));
}

export const tracePoints = points;
