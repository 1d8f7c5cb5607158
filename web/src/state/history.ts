// AxisHistory: what one axis did lately, for sparkline and scope. In: samples with the gateway's time. Out: columns.
// Holds at most `capacity` samples (a ring of flat arrays that grow as they are needed; the oldest give way). A gap in the knowledge is
// kept as a gap, never bridged by a line. The following error has a column of its own: reckoned from thinned columns it would lose its peaks.
import type { Axis } from '../api/types';

/** Whose word the demand of a sample is; null: nobody's. */
export type DemandSource = Axis['demand_source'];

export interface HistorySample {
  at_ms: number;
  position: number | null;
  velocity: number | null;
  target: number | null;
  demand?: number | null;
  error?: number | null;
  source?: DemandSource;
}

export interface HistoryColumns {
  /** seconds since 1970 */
  at: number[];
  position: (number | null)[];
  velocity: (number | null)[];
  target: (number | null)[];
  demand: (number | null)[];
  error: (number | null)[];
  source: DemandSource[];
}

const columns = ['position', 'velocity', 'target', 'demand', 'error'] as const;
/** As a number in the last of the flat arrays. */
const sources: readonly DemandSource[] = [null, 'drive', 'computed', 'open_loop'];
const empty = (): HistoryColumns => ({ at: [], position: [], velocity: [], target: [], demand: [], error: [], source: [] });
const known = (v: number): number | null => (Number.isNaN(v) ? null : v);
const orNaN = (v: number | null | undefined): number => v ?? NaN;
/** What is drawn as a line between two samples. */
const lines = ['position', 'demand', 'error', 'velocity'] as const;
const differ = (a: HistorySample, b: HistorySample): boolean => lines.some((c) => (a[c] ?? null) !== (b[c] ?? null));

export class AxisHistory {
  private at_ms = new Float64Array(256);
  private values = [...columns, 'source'].map(() => new Float64Array(256));
  private first = 0;
  private count = 0;

  constructor(
    private capacity = 4096,
    /** Samples that are further apart than this were not far apart in time by accident: nothing changed in between. */
    private readonly period_ms = 150,
  ) {
    this.resize(Math.min(256, capacity));
  }

  get size(): number {
    return this.count;
  }

  get last(): HistorySample | undefined {
    return this.count === 0 ? undefined : this.sample(this.count - 1);
  }

  /** Room for more samples from now on, for an axis that is looked at closely. Never less. */
  keep(capacity: number): void {
    this.capacity = Math.max(this.capacity, capacity);
  }

  add(sample: HistorySample): void {
    const before = this.last;
    if (before && sample.at_ms <= before.at_ms) {
      if (sample.at_ms < before.at_ms - 1000) this.clear(); // the clock was set back: the old history means nothing
      else return;
    }
    // The gateway tells of changes only. After a rest the old value held until just before: without this sample a line from the
    // last one would show a slow drift that never was. What was moving went on moving: there the straight line is the better guess.
    if (this.count > 0 && before && before.position !== null && !before.velocity && sample.position !== null && sample.at_ms - before.at_ms > 2 * this.period_ms && differ(before, sample)) {
      this.push({ ...before, at_ms: sample.at_ms - this.period_ms });
    }
    this.push(sample);
  }

  /** From here on nothing is known until the next sample. */
  gap(): void {
    const last = this.last;
    if (last && last.position !== null) this.push({ at_ms: last.at_ms + 1, position: null, velocity: null, target: null });
  }

  clear(): void {
    this.first = 0;
    this.count = 0;
  }

  /** Everything from that time on (and up to another), with one sample before, so that the line enters from the left edge. */
  since(from_ms: number, to_ms = Infinity): HistoryColumns {
    const out = empty();
    for (let i = Math.max(0, this.lowerBound(from_ms) - 1); i < this.count; i += 1) {
      const k = this.place(i);
      const t = this.at_ms[k] as number;
      if (t > to_ms) break;
      out.at.push(t / 1000);
      columns.forEach((c, n) => out[c].push(known(this.values[n]![k] as number)));
      out.source.push(this.sourceAt(k));
    }
    return out;
  }

  /**
   * The same, for a plot that is `width` points wide: where many samples fall on one point, the first, the least, the greatest and the last of
   * them are given, the two in the middle in the order in which they came: no peak is lost, and what held at the end goes on. Of two points
   * together, so at most 2 * width + 4 rows whatever the number of samples.
   */
  seen(from_ms: number, to_ms: number, width: number): HistoryColumns {
    const begin = Math.max(0, this.lowerBound(from_ms) - 1);
    const end = this.lowerBound(to_ms + 1e-6);
    if (end - begin <= 2 * width) return this.since(from_ms, to_ms);
    const out = empty();
    const step = (2 * (to_ms - from_ms)) / width;
    let i = begin;
    while (i < end) {
      const first = i;
      const limit = from_ms + (Math.floor(((this.at_ms[this.place(i)] as number) - from_ms) / step) + 1) * step;
      while (i < end && (this.at_ms[this.place(i)] as number) < limit) i += 1;
      if (i === first) i += 1; // a sample that lies on the limit by rounding
      this.condensed(out, first, i);
    }
    return out;
  }

  /** At most four rows for the samples from `first` to before `end`. */
  private condensed(out: HistoryColumns, first: number, end: number): void {
    const last = end - 1;
    const rows = Math.min(4, end - first);
    const [begin_ms, end_ms] = [this.at_ms[this.place(first)] as number, this.at_ms[this.place(last)] as number];
    for (let r = 0; r < rows; r += 1) {
      out.at.push((rows === 1 ? begin_ms : begin_ms + ((end_ms - begin_ms) * r) / (rows - 1)) / 1000);
      out.source.push(this.sourceAt(this.place(r === 0 ? first : last)));
    }
    columns.forEach((c, n) => {
      const v = this.values[n] as Float64Array;
      if (rows < 4) {
        for (let j = first; j < end; j += 1) out[c].push(known(v[this.place(j)] as number));
        return;
      }
      let low = NaN;
      let high = NaN;
      let lowAt = 0;
      let highAt = 0;
      for (let j = first; j < end; j += 1) {
        const x = v[this.place(j)] as number;
        if (Number.isNaN(x)) continue;
        if (!(x >= low)) [low, lowAt] = [x, j];
        if (!(x <= high)) [high, highAt] = [x, j];
      }
      const middle = lowAt <= highAt ? [low, high] : [high, low];
      out[c].push(...[v[this.place(first)] as number, ...middle, v[this.place(last)] as number].map(known));
    });
  }

  /** Number of samples before that time. */
  private lowerBound(at_ms: number): number {
    let low = 0;
    let high = this.count;
    while (low < high) {
      const middle = (low + high) >> 1;
      if ((this.at_ms[this.place(middle)] as number) < at_ms) low = middle + 1;
      else high = middle;
    }
    return low;
  }

  private place(i: number): number {
    const k = this.first + i;
    return k < this.at_ms.length ? k : k - this.at_ms.length;
  }

  private sample(i: number): HistorySample {
    const k = this.place(i);
    const [position, velocity, target, demand, error] = columns.map((_, n) => known(this.values[n]![k] as number)) as [number | null, number | null, number | null, number | null, number | null];
    return { at_ms: this.at_ms[k] as number, position, velocity, target, demand, error, source: this.sourceAt(k) };
  }

  private sourceAt(place: number): DemandSource {
    return sources[this.values[columns.length]![place] as number] ?? null;
  }

  private push(s: HistorySample): void {
    if (this.count === this.at_ms.length && this.at_ms.length < this.capacity) this.resize(Math.min(this.capacity, this.at_ms.length * 2));
    let k: number;
    if (this.count < this.at_ms.length) {
      k = this.place(this.count);
      this.count += 1;
    } else {
      k = this.first;
      this.first = k + 1 === this.at_ms.length ? 0 : k + 1;
    }
    this.at_ms[k] = s.at_ms;
    columns.forEach((c, n) => ((this.values[n] as Float64Array)[k] = orNaN(s[c])));
    (this.values[columns.length] as Float64Array)[k] = sources.indexOf(s.source ?? null);
  }

  private resize(room: number): void {
    const move = (from: Float64Array): Float64Array<ArrayBuffer> => {
      const to = new Float64Array(room);
      for (let i = 0; i < this.count; i += 1) to[i] = from[this.place(i)] as number;
      return to;
    };
    const values = this.values.map(move);
    this.at_ms = move(this.at_ms);
    this.values = values;
    this.first = 0;
  }
}
