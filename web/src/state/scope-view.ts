// Scope view: what the scope keeps between two pictures: whether it is held, its trigger, the part of time that it shows. In: the history of an axis, the time,
// the length of the window. Out: the ends of the picture. Never draws and never asks for the time.
import { signal } from '@preact/signals';
import type { AxisHistory, HistoryColumns } from './history';
import { PlotView } from './plot-view';
import { Trigger, type TriggerSetting } from './scope';

export class ScopeView extends PlotView {
  readonly paused = signal(false);
  readonly trigger = signal<TriggerSetting>({ mode: 'off', channel: 'position', edge: 'rising', level: 0 });
  readonly triggerState = signal<'off' | 'waiting' | 'fired' | 'shown'>('off');
  readonly machine = new Trigger();
  private heldAt_s = 0;

  /** Holds the picture, or lets it run on. */
  hold(): void {
    this.heldAt_s = this.paused.peek() ? 0 : this.range.peek()[1];
    this.paused.value = !this.paused.peek();
  }

  /** The part of time that the picture shows. */
  look(history: AxisHistory, now_s: number, window_s: number): [number, number] {
    const setting = this.trigger.peek();
    if (this.paused.peek()) return [this.heldAt_s - window_s, this.heldAt_s];
    if (setting.mode === 'off') {
      this.triggerState.value = 'off';
      return [now_s - window_s, now_s];
    }
    const left = this.machine.look(history.since((now_s - 2 * window_s) * 1000), setting, now_s, window_s);
    this.triggerState.value = this.machine.state;
    return left === null ? [now_s - window_s, now_s] : [left, left + window_s];
  }
}

/** The newest values hold until now. */
export function extend(instant: HistoryColumns, now_s: number): void {
  instant.at.push(now_s);
  for (const column of [instant.position, instant.velocity, instant.target, instant.demand, instant.error]) column.push(column.at(-1) ?? null);
  instant.source.push(instant.source.at(-1) ?? null);
}
