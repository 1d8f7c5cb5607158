// Plot view: what is kept between two pictures of a plot: its cursors, the part of time that is seen, and all that there is. In: instants, factors, shares,
// keys. Out: signals. Never draws; the rules of zooming are those of state/plot.ts.
import { signal, type Signal } from '@preact/signals';
import { panned, zoomed, type Range } from './plot';

export class PlotView {
  /** Instants of the cursors, seconds. */
  readonly cursors: [Signal<number | null>, Signal<number | null>] = [signal(null), signal(null)];
  readonly active = signal<0 | 1>(0);
  readonly range = signal<Range>([0, 1]);
  /** What there is; the range stays within it. */
  readonly whole = signal<Range>([0, 1]);

  put(instant: number): void {
    const [low, high] = this.range.peek();
    this.cursors[this.active.peek()].value = Math.min(high, Math.max(low, instant));
  }
  zoom(factor: number, about?: number): void {
    this.range.value = zoomed(this.range.peek(), about ?? this.here(), factor, this.whole.peek());
  }
  pan(share: number): void {
    this.range.value = panned(this.range.peek(), share, this.whole.peek());
  }
  all(): void {
    this.range.value = this.whole.peek();
  }

  /** A key on the plot; false: it is for nothing here. `zoomable`: keys may change the part of time. */
  keyed({ key, shiftKey }: Pick<KeyboardEvent, 'key' | 'shiftKey'>, zoomable: boolean): boolean {
    const [low, high] = this.range.peek();
    const step = ((high - low) / 100) * (shiftKey ? 10 : 1);
    switch (key) {
      case 'ArrowLeft': this.put(this.here() - step); return true;
      case 'ArrowRight': this.put(this.here() + step); return true;
      case 'Home': this.put(low); return true;
      case 'End': this.put(high); return true;
      case 'Delete': this.cursors[this.active.peek()].value = null; return true;
    }
    if (!zoomable) return false;
    switch (key) {
      case '+': case '=': this.zoom(0.5); return true;
      case '-': this.zoom(2); return true;
      case '0': this.all(); return true;
      case 'PageUp': this.pan(-0.5); return true;
      case 'PageDown': this.pan(0.5); return true;
    }
    return false;
  }

  /** The active cursor, else the middle of what is seen. */
  private here(): number {
    const [low, high] = this.range.peek();
    return this.cursors[this.active.peek()].peek() ?? (low + high) / 2;
  }
}
