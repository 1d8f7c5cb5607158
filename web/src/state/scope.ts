// Scope's rules: what a trigger is, where it fires, what the cursors read, and a recording as CSV. In: columns of a history. Out: values.
// Never draws and never asks for the time: both are the component's.
import type { HistoryColumns } from './history';

export const channels = ['position', 'demand', 'velocity', 'error', 'target'] as const;
export type Channel = (typeof channels)[number];

export const columnOf = (c: HistoryColumns, channel: Channel): (number | null)[] => c[channel];

export interface TriggerSetting {
  mode: 'off' | 'single' | 'again';
  channel: Channel;
  edge: 'rising' | 'falling';
  level: number;
}

/** Part of the window that is shown before the trigger. */
export const before = 0.25;

/** The first instant after `after_s` at which the channel crosses the level, between two neighbouring samples that are both known. */
export function crossing(c: HistoryColumns, setting: TriggerSetting, after_s: number): number | null {
  const v = columnOf(c, setting.channel);
  for (let i = 1; i < v.length; i += 1) {
    const t1 = c.at[i] as number;
    if (t1 <= after_s) continue;
    const [a, b] = [v[i - 1], v[i]];
    if (a === null || b === null || a === undefined || b === undefined) continue;
    const fires = setting.edge === 'rising' ? a < setting.level && b >= setting.level : a > setting.level && b <= setting.level;
    if (!fires) continue;
    const t0 = c.at[i - 1] as number;
    if (setting.channel === 'target') return t1; // a target is set, it does not drift
    const t = t0 + ((setting.level - a) / (b - a)) * (t1 - t0);
    if (t > after_s) return t;
  }
  return null;
}

/** Arms, fires when a crossing is in the data, and holds the picture as soon as the window behind it is full. */
export class Trigger {
  private armedAt_s = 0;
  private fired_s: number | null = null;
  private shown_s: number | null = null;

  arm(now_s: number): void {
    this.armedAt_s = now_s;
    this.fired_s = null;
    this.shown_s = null;
  }

  /** The instant at the left edge of the picture that is held; null: none yet. */
  look(c: HistoryColumns, setting: TriggerSetting, now_s: number, window_s: number): number | null {
    if (setting.mode === 'off') return null;
    if (this.fired_s === null && !(setting.mode === 'single' && this.shown_s !== null)) this.fired_s = crossing(c, setting, this.armedAt_s);
    if (this.fired_s !== null && now_s >= this.fired_s + window_s * (1 - before)) {
      this.shown_s = this.fired_s - window_s * before;
      this.armedAt_s = now_s;
      this.fired_s = null;
    }
    return this.shown_s;
  }

  get state(): 'waiting' | 'fired' | 'shown' {
    if (this.fired_s !== null) return 'fired';
    return this.shown_s === null ? 'waiting' : 'shown';
  }
}

/** These two are somebody's word about where the axis should be; the others are what the drive did, or was told. */
export const needsDemand = (c: Channel): boolean => c === 'demand' || c === 'error';

/** What a channel was at an instant: on the straight line between its neighbours, a target as it was set; null in a gap or outside the recording. */
export function valueAt(c: HistoryColumns, channel: Channel, t: number): number | null {
  const n = c.at.length;
  if (n === 0 || t < (c.at[0] as number)) return null;
  let low = 0;
  let high = n;
  while (low < high) {
    const m = (low + high) >> 1;
    if ((c.at[m] as number) <= t) low = m + 1;
    else high = m;
  }
  const i = low - 1;
  const v = columnOf(c, channel);
  const a = v[i] ?? null;
  if (i + 1 >= n || a === null || channel === 'target') return a;
  const b = v[i + 1] ?? null;
  if (b === null) return a;
  const [t0, t1] = [c.at[i] as number, c.at[i + 1] as number];
  return t1 > t0 ? a + ((b - a) * (t - t0)) / (t1 - t0) : b;
}

/** What stands behind the names of the two columns that need a demand; empty: all of it is the drive's word, or none was known. */
function demandMark(c: HistoryColumns): string {
  const kinds = [...new Set(c.source)].filter((s) => s !== null).map((s) => s.replace('_', ' '));
  if (kinds.length > 1) return ` (mixed: ${kinds.sort().join(' and ')})`;
  return kinds.length === 0 || kinds[0] === 'drive' ? '' : ` (${kinds[0]})`;
}

/** A recording as CSV (RFC 4180): a full stop as decimal sign, empty where nothing was known. The last column tells of each row whose word its demand is. */
export function csvOf(c: HistoryColumns, axis: string, unit: string): string {
  const quote = (s: string) => (/[",\r\n]/.test(s) ? `"${s.replaceAll('"', '""')}"` : s);
  const begin = c.at[0] ?? 0;
  const mark = demandMark(c);
  const text = (v: number | null | undefined) => (v === null || v === undefined ? '' : String(Number(v.toPrecision(12))));
  const named = (n: string, more = '', per = '') => `${axis}.${n}${more} [${unit}${per}]`;
  const head = ['time', 'seconds', named('position'), named('position_demand', mark), named('velocity', '', '/s'), named('following_error', mark), named('target_position'), `${axis}.demand_source`];
  const lines = c.at.map((t, i) => [new Date(t * 1000).toISOString(), text(t - begin), text(c.position[i]), text(c.demand[i]), text(c.velocity[i]), text(c.error[i]), text(c.target[i]), c.source[i] ?? ''].join(','));
  return [head.map(quote).join(','), ...lines].join('\r\n') + '\r\n';
}
