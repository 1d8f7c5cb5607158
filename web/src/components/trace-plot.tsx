// Trace plot: what stands around the plots of trends, captures and recordings: the points to choose, the names of the curves in their ink, the readings of the
// cursors. In: what is chosen, curves, columns. Out: buttons, a list, a table.
import type { Signal } from '@preact/signals';
import { t } from '../language';
import { readAt } from '../state/plot';
import type { PlotView } from '../state/plot-view';
import type { Drawn } from '../state/recorder';
import { toggled } from '../state/toggled';
import { pointNames, points } from '../text/recorder';
import { CursorTable } from './plot-cursors';
import type { Curve } from './plot-options';
import { PressGroup } from './press-group';

/** `chosen`: points with commas between them. */
export const pointsOf = (chosen: Signal<string>) => points.filter((p) => chosen.value.split(',').includes(p));

/** One of them at least stays chosen. */
export function PointGroup({ label, chosen }: { label: string; chosen: Signal<string> }) {
  const seen = pointsOf(chosen);
  return <PressGroup label={label} class="scope-channels" of={points.map((p) => ({ value: p, text: pointNames[p], on: seen.includes(p) }))} press={(p) => (chosen.value = toggled(seen, p).join(',') || p)} />;
}

export function CurveList({ curves, version }: { curves: readonly Curve[]; version?: number }) {
  return (
    <ul class="curve-list" aria-label={t('Curves')} data-version={version}>
      {curves.map((c) => (
        <li key={c.id} class={`curve-key ink${c.color}`}>
          {c.name}
        </li>
      ))}
    </ul>
  );
}

export function TraceCursors({ view, curves, drawn, clock }: { view: PlotView; curves: readonly Curve[]; drawn: () => Drawn; clock: (instant: number) => string }) {
  return <CursorTable view={view} curves={curves} read={(c, instant) => readAt(drawn().at, drawn().columns[curves.indexOf(c)] ?? [], instant)} clock={clock} />;
}
