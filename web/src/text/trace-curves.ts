// Trace curves: the points of axes as the curves of a plot: which share a side, in which ink, with which unit; and the levels that captures waited for. In: axes,
// points, captures. Out: curves, levels. Pure.
import type { Capture } from '../api/types';
import type { Curve, Level } from '../components/plot-options';
import { midSentence } from '../language';
import { levelText, pointNames, pointUnit, type TracePoint } from './recorder';

const inks = ['--series-1', '--series-2', '--series-3', '--series-4', '--series-5'];

/** Curves of points share a side where they share a unit; each has an ink, and further ones are dashed. */
export const traceCurves = (list: readonly { id: string; name: string; unit: string }[], seen: readonly TracePoint[]): Curve[] =>
  list.flatMap((a, i) =>
    seen.map((p, k): Curve => {
      const n = i * seen.length + k;
      const round = Math.floor(n / inks.length);
      return { id: `${a.id} ${p}`, name: `${a.name} ${midSentence(pointNames[p])}`, unit: pointUnit(p, a.unit), scale: scaleOf(p, a.unit), color: inks[n % inks.length] as string, withZero: p === 'velocity' || p === 'following_error', ...(p === 'following_error' ? { least: 1e-3 } : {}), ...(round > 0 ? { dash: [6, 3 * round] } : {}) };
    }),
  );
const scaleOf = (p: TracePoint, unit: string): string => `${p === 'demand' ? 'position' : p} ${unit}`;

/** A curve for each point of each axis. */
export const trendCurves = (doc: { axes: readonly { axis: string; unit: string }[] } | null, axes: readonly string[], seen: readonly TracePoint[]): Curve[] =>
  traceCurves(
    axes.map((a) => ({ id: a, name: a, unit: doc?.axes.find((x) => x.axis === a)?.unit ?? '' })),
    seen,
  );

/** The levels that captures waited for, where their scale is among what is seen. */
export const levelsOf = (captures: readonly Pick<Capture, 'axes' | 'trigger'>[], seen: readonly TracePoint[]): Level[] =>
  captures.flatMap(({ axes, trigger }) => {
    if (trigger?.kind !== 'level' || !trigger.point) return [];
    const unit = axes.find((a) => a.axis === trigger.axis)?.unit ?? '';
    const scale = scaleOf(trigger.point, unit);
    return seen.some((p) => scaleOf(p, unit) === scale) ? [{ scale, value: trigger.level ?? 0, text: levelText(trigger, unit) }] : [];
  });
