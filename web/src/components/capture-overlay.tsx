// Overlay: captures in one plot, laid over each other at their triggers, with the level that each waited for. In: captures with their rows. Out: a plot, a list of
// curves, readings of the cursors. Which points are drawn is chosen once for all captures, and kept.
import { useEffect, useMemo } from 'preact/hooks';
import type { CaptureWithRows } from '../api/types';
import { t } from '../language';
import { persisted } from '../state/persisted';
import { PlotView } from '../state/plot-view';
import { captureParts, joined } from '../state/recorder';
import { sinceText } from '../text/recorder';
import { levelsOf, traceCurves } from '../text/trace-curves';
import { Plot, usePlotView } from './plot';
import { PlotButtons } from './plot-cursors';
import { Section } from './section';
import { CurveList, PointGroup, pointsOf, TraceCursors } from './trace-plot';

const chosenPoints = persisted('captures.points', 'position,following_error', 'browser');

export function Overlay({ captures }: { captures: readonly CaptureWithRows[] }) {
  const v = usePlotView(() => new PlotView());
  const seen = pointsOf(chosenPoints);
  const several = captures.length > 1;
  const names = captures.map((c) => c.name);
  const key = names.join() + seen.join();
  const levels = levelsOf(captures, seen);
  const { data, curves } = useMemo(() => {
    const list = traceCurves(captures.flatMap((c) => c.columns.map((x) => ({ id: `${c.name} ${x.axis}`, name: `${several ? `${c.name}: ` : ''}${x.axis}`, unit: x.unit }))), seen);
    return { data: joined(captures.flatMap((c) => captureParts(c, seen))), curves: list };
  }, [key]);
  useEffect(() => {
    const low = data.at[0] ?? 0;
    const high = data.at.at(-1) ?? 1;
    v.whole.value = [low, Math.max(high, low + 0.001)];
    v.all();
  }, [names.join()]);
  return (
    <Section title={several ? t('Laid over each other at their triggers') : t('Capture {n}', { n: names[0] ?? '' })}>
      <div class="scope card recorder-plot" data-field="overlay">
        <div class="scope-head">
          <PointGroup label={t('Points of the captures')} chosen={chosenPoints} />
          <PlotButtons view={v} />
        </div>
        <Plot
          zoomable
          view={v}
          curves={curves}
          data={() => [data.at, ...data.columns] as never}
          version={key}
          marks={[{ at: 0, text: t('trigger') }]}
          levels={levels}
          timeText={(entered, _end, span) => sinceText(entered, span)}
          label={t('Captures {n}, seconds from the trigger. Drag to come closer, 0 shows all. Arrow keys move the cursor {n2}, Delete takes it away.', { n: names.join(', '), n2: v.active.value === 0 ? 'A' : 'B' })}
        />
        {levels.length > 0 && (
          <p class="where" data-field="levels">
            {t('Level of the trigger, drawn across: {levels}', { levels: levels.map((l) => l.text).join(', ') })}
          </p>
        )}
        <CurveList curves={curves} />
        <TraceCursors view={v} curves={curves} drawn={() => data} clock={(entered) => sinceText(entered, 0.1)} />
      </div>
    </Section>
  );
}
