// The recorder in words: trends, captures and recordings of the gateway. In: its documents. Out: words, curves' names, instants. Pure.
import { midSentence, t } from '../language';
import type { Capture, CaptureTrigger, Recording } from '../api/types';
import { formatNumber, localFigures } from './number';
import type { Word } from './axis';

export const recorderTitles = { trends: t('Trends'), captures: t('Captures'), recordings: t('Recordings') } as const;

export const points = ['position', 'demand', 'velocity', 'following_error'] as const;
export type TracePoint = (typeof points)[number];
export const pointNames: Record<TracePoint, string> = { position: t('Position'), demand: t('Demand'), velocity: t('Velocity'), following_error: t('Following error') };
export const pointUnit = (p: TracePoint, unit: string): string => (p === 'velocity' ? `${unit}/s` : unit);

export const stateNames: Record<NonNullable<CaptureTrigger['state']>, string> = {
  moving: t('it moves'),
  target_reached: t('its target is reached'),
  fault: t('fault'),
  warning: t('warning'),
  referenced: t('referenced'),
  online: t('online'),
  fail_safe: t('fail-safe has acted'),
};

/** What a capture waits for, or waited for. */
export function triggerText(trigger: CaptureTrigger | null, unit = ''): string {
  if (!trigger) return t('not known');
  const axis = trigger.axis ?? t('the axis');
  if (trigger.kind === 'at_once') return t('at once');
  if (trigger.kind === 'command') return t('a command that moves {axis}', { axis });
  if (trigger.kind === 'state') {
    const state = stateNames[trigger.state ?? 'moving'];
    return trigger.edge === 'falling' ? t('“{state}” of {axis} goes', { state, axis }) : t('“{state}” of {axis} comes', { state, axis });
  }
  const point = trigger.point ?? 'position';
  const values = { point: midSentence(pointNames[point]), axis, level: `${formatNumber(trigger.level ?? 0, 3)} ${pointUnit(point, unit)}`.trim() };
  return trigger.edge === 'falling' ? t('{point} of {axis} falls through {level}', values) : t('{point} of {axis} rises through {level}', values);
}

/** "↑ 1.5 mm": the level of a trigger with its edge. */
export const levelText = (trigger: CaptureTrigger, unit: string): string => `${trigger.edge === 'falling' ? '↓' : '↑'} ${formatNumber(trigger.level ?? 0, 3)} ${pointUnit(trigger.point ?? 'position', unit)}`.trim();

export function captureWord(c: Capture): Word {
  if (c.fault) return { text: t('Damaged'), icon: 'triangle', tone: 'fault', long: c.fault };
  switch (c.state) {
    case 'armed':
      return { text: t('Armed'), icon: 'clock', tone: 'warning', long: t('It waits for its trigger') };
    case 'triggered':
      return { text: t('Recording'), icon: 'play', tone: 'warning', long: t('The trigger has come') };
    case 'done':
      return { text: t('Done'), icon: 'check', tone: 'good', long: c.why ?? t('It is kept on the disk') };
    default:
      return { text: t('Given up'), icon: 'unplugged', tone: 'muted', long: c.why ?? t('Cancelled') };
  }
}

/** "997 Hz, 1,197 rows" of each axis. */
export const captureAbout = (c: Capture): string =>
  c.axes.map((a) => {
    const rows = formatNumber(a.rows, 0);
    return a.rate_hz > 0 ? t('{axis}: {rate} of {wanted} Hz, {rows} rows', { axis: a.axis, rate: formatNumber(a.rate_hz, 0), wanted: formatNumber(c.wanted_hz ?? 0, 0), rows }) : t('{axis}: {rows} rows', { axis: a.axis, rows });
  }).join(' · ');

export const recordingWord = (r: Recording): Word =>
  r.fault
    ? { text: t('Damaged'), icon: 'triangle', tone: 'fault', long: r.fault }
    : r.replayable
      ? { text: t('Replayable'), icon: 'check', tone: 'good', long: t('axisgate replay plays it') }
      : { text: t('To be read'), icon: 'list', tone: 'muted', long: r.not_replayable ?? '' };

export const bytesText = (n: number): string => (n < 10_000 ? t('{n} bytes', { n }) : n < 10_000_000 ? t('{n} kB', { n: formatNumber(n / 1000, 0) }) : t('{n} MB', { n: formatNumber(n / 1_000_000, 0) }));

/** "20.0 Hz", or why there is none. */
export const rateText = (rate_hz: number): string => (rate_hz > 0 ? t('told {n} times a second', { n: rate_hz < 10 ? localFigures(rate_hz.toFixed(1)) : Math.round(rate_hz) }) : t('not told now'));

/** Registers 0 to 11 of an axis as they were, in hexadecimal. */
export const registerText = (r: { address: number; words: readonly number[] } | undefined): string =>
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
  return `${t_s < 0 && Number(text) !== 0 ? '−' : ''}${localFigures(text)} s`;
};

export const nameFault = (name: string): string | undefined => (/^[A-Za-z0-9_-][A-Za-z0-9_.-]{0,63}$/.test(name) ? undefined : t('A name has 1 to 64 letters, digits, - _ or . and does not begin with a dot.'));
