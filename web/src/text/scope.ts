// Scope in words: what its channels are called, in which unit, as which curve, and how far before its newest end an instant is. In: channels, units, instants.
// Out: words, curves. Pure.
import type { Curve } from '../components/plot-options';
import { t } from '../language';
import { channels, type Channel } from '../state/scope';
import { localFigures } from './number';

export const channelNames: Record<Channel, string> = { position: t('Position'), demand: t('Demand'), velocity: t('Velocity'), error: t('Following error'), target: t('Target') };
const scaleOf: Record<Channel, string> = { position: 'p', demand: 'p', target: 'p', velocity: 'v', error: 'e' };
const colorOf: Record<Channel, string> = { position: '--series-1', velocity: '--series-2', target: '--series-3', demand: '--series-4', error: '--series-5' };
export const channelUnit = (c: Channel, unit: string): string => (c === 'velocity' ? `${unit}/s` : unit);

const curveOf = (c: Channel, unit: string): Curve => ({
  id: c,
  name: channelNames[c],
  unit: channelUnit(c, unit),
  scale: scaleOf[c],
  color: colorOf[c],
  width: c === 'position' ? 2 : 1.25,
  withZero: c === 'velocity' || c === 'error',
  ...(c === 'error' ? { least: 1e-3 } : {}),
  ...(c === 'target' ? { dash: [4, 4], stepped: true } : {}),
});

/** The most important one first on its side: it gives the colour. */
export const curvesOf = (seen: ReadonlySet<string>, unit: string): Curve[] => channels.filter((c) => seen.has(c)).map((c) => curveOf(c, unit));

/** Words at the time axis: "−12.5 s". */
export const secondsBefore = (instant: number, end: number): string => {
  const s = Math.round((instant - end) * 10) / 10;
  return s === 0 ? '0 s' : `${s < 0 ? '−' : ''}${Math.abs(s) < 10 ? localFigures(Math.abs(s).toFixed(1).replace(/\.0$/, '')) : Math.abs(Math.round(s))} s`;
};
