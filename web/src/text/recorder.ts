// The recorder in words: trends, captures and recordings of the gateway. In: its documents. Out: words, curves' names, instants. Pure.
import type { Capture, CaptureTrigger, Recording } from '../api/types';
import { formatNumber } from './number';
import type { Word } from './axis';

export const recorderTitles = { trends: 'Trends', captures: 'Captures', recordings: 'Recordings' } as const;

export const points = ['position', 'demand', 'velocity', 'following_error'] as const;
export type TracePoint = (typeof points)[number];
export const pointNames: Record<TracePoint, string> = { position: 'Position', demand: 'Demand', velocity: 'Velocity', following_error: 'Following error' };
export const pointUnit = (p: TracePoint, unit: string): string => (p === 'velocity' ? `${unit}/s` : unit);

export const stateNames: Record<NonNullable<CaptureTrigger['state']>, string> = {
  moving: 'it moves',
  target_reached: 'its target is reached',
  fault: 'fault',
  warning: 'warning',
  referenced: 'referenced',
  online: 'online',
  fail_safe: 'fail-safe has acted',
};

/** What a capture waits for, or waited for. */
export function triggerWords(t: CaptureTrigger | null, unit = ''): string {
  if (!t) return 'not known';
  const axis = t.axis ? ` of ${t.axis}` : '';
  if (t.kind === 'at_once') return 'at once';
  if (t.kind === 'command') return `a command that moves ${t.axis ?? 'it'}`;
  if (t.kind === 'state') return `“${stateNames[t.state ?? 'moving']}”${axis} ${t.edge === 'falling' ? 'goes' : 'comes'}`;
  const point = t.point ?? 'position';
  return `${pointNames[point].toLowerCase()}${axis} ${t.edge === 'falling' ? 'falls' : 'rises'} through ${formatNumber(t.level ?? 0, 3)} ${pointUnit(point, unit)}`.trim();
}

export function captureWord(c: Capture): Word {
  if (c.fault) return { text: 'Damaged', icon: 'triangle', tone: 'fault', long: c.fault };
  switch (c.state) {
    case 'armed':
      return { text: 'Armed', icon: 'clock', tone: 'warning', long: 'It waits for its trigger' };
    case 'triggered':
      return { text: 'Recording', icon: 'play', tone: 'warning', long: 'The trigger has come' };
    case 'done':
      return { text: 'Done', icon: 'check', tone: 'good', long: c.why ?? 'It is kept on the disk' };
    default:
      return { text: 'Given up', icon: 'unplugged', tone: 'muted', long: c.why ?? 'Cancelled' };
  }
}

/** "997 Hz, 1,197 rows" of each axis. */
export const captureAbout = (c: Capture): string =>
  c.axes.map((a) => `${a.axis}: ${a.rate_hz > 0 ? `${formatNumber(a.rate_hz, 0)} of ${formatNumber(c.wanted_hz ?? 0, 0)} Hz, ` : ''}${formatNumber(a.rows, 0)} rows`).join(' · ');

export const recordingWord = (r: Recording): Word =>
  r.fault
    ? { text: 'Damaged', icon: 'triangle', tone: 'fault', long: r.fault }
    : r.replayable
      ? { text: 'Replayable', icon: 'check', tone: 'good', long: 'axisgate replay plays it' }
      : { text: 'To be read', icon: 'list', tone: 'muted', long: r.not_replayable ?? '' };

export const bytesWords = (n: number): string => (n < 10_000 ? `${n} bytes` : n < 10_000_000 ? `${formatNumber(n / 1000, 0)} kB` : `${formatNumber(n / 1_000_000, 0)} MB`);

/** "20.0 Hz", or why there is none. */
export const rateWords = (rate_hz: number): string => (rate_hz > 0 ? `told ${rate_hz < 10 ? rate_hz.toFixed(1) : Math.round(rate_hz)} times a second` : 'not told now');

/** Registers 0 to 11 of an axis as they were, in hexadecimal. */
export const registerWords = (r: { address: number; words: readonly number[] } | undefined): string =>
  r ? `${r.address}: ${r.words.slice(0, 12).map((w) => w.toString(16).toUpperCase().padStart(4, '0')).join(' ')}` : '–';

/** The next free name of a kind: "capture-3". */
export function freeName(stem: string, taken: readonly string[]): string {
  for (let n = 1; ; n += 1) if (!taken.includes(`${stem}-${n}`)) return `${stem}-${n}`;
}

/** Time of day with as many places as the part of time that is seen needs. */
export function instantText(t_s: number, span_s: number): string {
  const iso = new Date(t_s * 1000).toISOString();
  return span_s > 60 ? iso.slice(11, 19) : iso.slice(11, span_s > 5 ? 21 : 23);
}
export const sinceText = (t_s: number, span_s: number): string => {
  const text = Math.abs(t_s).toFixed(span_s < 0.05 ? 4 : span_s < 0.5 ? 3 : span_s < 5 ? 2 : 1);
  return `${t_s < 0 && Number(text) !== 0 ? '−' : ''}${text} s`;
};

export const nameFault = (name: string): string | undefined => (/^[A-Za-z0-9_-][A-Za-z0-9_.-]{0,63}$/.test(name) ? undefined : 'A name has 1 to 64 letters, digits, - _ or . and does not begin with a dot.');
