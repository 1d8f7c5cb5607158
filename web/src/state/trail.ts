// Trail: the last positions and velocities of one axis, for sparkline and scope. In: samples with the gateway's time. Out: columns.
// Holds at most `capacity` samples (a ring; the oldest give way). A gap in the knowledge is kept as a gap, never bridged by a line.

export interface TrailSample {
  at_ms: number;
  position: number | null;
  velocity: number | null;
  target: number | null;
}

export interface TrailColumns {
  /** seconds since 1970 */
  at: number[];
  position: (number | null)[];
  velocity: (number | null)[];
  target: (number | null)[];
}

export class Trail {
  private readonly ring: TrailSample[] = [];
  private first = 0;

  constructor(
    private readonly capacity = 4096,
    /** Samples that are further apart than this were not far apart in time by accident: nothing changed in between. */
    private readonly period_ms = 150,
  ) {}

  get size(): number {
    return this.ring.length;
  }

  get last(): TrailSample | undefined {
    return this.ring.length === 0 ? undefined : this.ring[(this.first + this.ring.length - 1) % this.ring.length];
  }

  add(sample: TrailSample): void {
    const last = this.last;
    if (last && sample.at_ms <= last.at_ms) {
      if (sample.at_ms < last.at_ms - 1000) this.clear(); // the clock was set back: the old trail means nothing
      else return;
    }
    // The gateway tells of changes only. After a rest the old value held until just before: without this sample a line from the
    // last one would show a slow drift that never was. What was moving went on moving: there the straight line is the better guess.
    const before = this.last;
    if (before && before.position !== null && !before.velocity && sample.position !== null && sample.at_ms - before.at_ms > 2 * this.period_ms && sample.position !== before.position) {
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
    this.ring.length = 0;
    this.first = 0;
  }

  since(from_ms: number): TrailColumns {
    const out: TrailColumns = { at: [], position: [], velocity: [], target: [] };
    let begin = this.ring.length;
    while (begin > 0 && this.at(begin - 1).at_ms >= from_ms) begin -= 1;
    if (begin > 0) begin -= 1; // one before, so that the line enters from the left edge
    for (let i = begin; i < this.ring.length; i += 1) {
      const s = this.at(i);
      out.at.push(s.at_ms / 1000);
      out.position.push(s.position);
      out.velocity.push(s.velocity);
      out.target.push(s.target);
    }
    return out;
  }

  private at(i: number): TrailSample {
    return this.ring[(this.first + i) % this.ring.length] as TrailSample;
  }

  private push(sample: TrailSample): void {
    if (this.ring.length < this.capacity) {
      this.ring.push(sample);
    } else {
      this.ring[this.first] = sample;
      this.first = (this.first + 1) % this.capacity;
    }
  }
}
