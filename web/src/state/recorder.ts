// Recorder: documents of /recorder as columns that a plot draws. In: trends, captures. Out: one time axis with a column for each curve: where
// others have a row and this one has none the column has a hole (undefined), which is no gap (null). Pure.
import type { CaptureWithRows, Trends } from '../api/types';
import type { TracePoint } from '../text/recorder';

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
      p.at.forEach((t, i) => (out[place.get(t) as number] = c[i]));
      columns.push(out);
    }
  }
  return { at, columns };
}

/** Words of a drive that are further apart than this: nothing changed in between. */
const rest_s = 0.4;
/** A step is drawn within this time. */
const hair_s = 1e-6;
type TrendAxis = Trends['axes'][number];
type Values = NonNullable<TrendAxis['points']['position']>;

/** Rows of a part as they are put together. */
class Rows {
  readonly at: number[] = [];
  readonly columns: Column[];
  constructor(of: readonly unknown[]) {
    this.columns = of.map(() => []);
  }
  put(t: number, values: Column): void {
    this.at.push(t);
    values.forEach((v, k) => this.columns[k]!.push(v));
  }
  /** What was known last holds until then. */
  hold(t: number): void {
    if (this.at.length > 0 && t - (this.at.at(-1) as number) > hair_s) this.put(t, this.columns.map((c) => c.findLast((v) => v !== undefined) ?? null));
  }
}

/** What a part of time is drawn as: rows where they are told; thinned, each column from its first value over its least and greatest to its last
    one. Between two rows of a rest and from a column's last value on the older value holds, until the newest word. */
export function trendPart(a: TrendAxis, chosen: readonly TracePoint[], to_s: number): Part {
  const rows = new Rows(chosen);
  const of = chosen.map((p): Values => a.points[p] ?? {});
  if (a.thinned) a.at.forEach((ms, i) => thinnedColumn(rows, of, i, ms / 1000, (a.until?.[i] ?? ms) / 1000, a.gaps?.[i] === true));
  else
    a.at.forEach((ms, i) => {
      if (ms / 1000 - (rows.at.at(-1) ?? Infinity) > rest_s) rows.hold(ms / 1000 - hair_s);
      rows.put(ms / 1000, of.map((v) => v.values?.[i] ?? null));
    });
  rows.hold(Math.min(to_s, (a.newest ?? 0) / 1000));
  return rows;
}

function thinnedColumn(rows: Rows, of: readonly Values[], i: number, from: number, until: number, gap: boolean): void {
  const at = (name: 'first' | 'min' | 'max' | 'last') => of.map((v) => v[name]?.[i] ?? null);
  const [first, min, max, last] = [at('first'), at('min'), at('max'), at('last')];
  const length = Math.max(until - from, 2 * hair_s);
  // Something new was told as the column began: before it the older value held.
  if (rows.columns.some((c, k) => c.length > 0 && c.at(-1) !== first[k])) rows.hold(from - hair_s);
  rows.put(from, first);
  // Beyond its ends a column had a peak; when it was, nobody tells. Where an end is not known, all that was known is drawn in between.
  if (gap || first.some((a, k) => min[k] !== null && (min[k]! < Math.min(a ?? Infinity, last[k] ?? Infinity) || max[k]! > Math.max(a ?? -Infinity, last[k] ?? -Infinity)))) {
    rows.put(from + length * 0.3, min);
    if (gap) rows.put(from + length * 0.5, first.map((a, k) => (a !== null && last[k] !== null ? null : undefined)));
    rows.put(from + length * 0.7, max);
  }
  rows.put(from + length, last);
}

/** CiA 402 leaves this bit of the status word free; here it says that the values are old. */
const staleBit = 0x4000;

/** Each word of a drive; what is too old is not known. */
export function captureParts(c: CaptureWithRows, chosen: readonly TracePoint[]): Part[] {
  return c.columns.map((a) => {
    const rows = new Rows(chosen);
    a.seconds.forEach((t, i) => {
      const old = ((a.statusword[i] ?? 0) & staleBit) !== 0;
      rows.put(t, chosen.map((p) => (old ? null : ((a[p] as Column)[i] ?? null))));
    });
    return rows;
  });
}
