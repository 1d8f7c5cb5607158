// Trends: what the gateway remembers of the last minutes of any axes, in one plot: axes and points to choose, zoom, cursors, a table as CSV.
// In: GET /recorder/trends, asked for what is seen, at most every second and soon after each zoom. Out: a plot that a reload does not empty.
import { useSignal } from '@preact/signals';
import { useEffect, useMemo } from 'preact/hooks';
import { asProblem } from '../api/problem';
import { RecorderDoor } from '../api/recorder';
import { useDoor, useGateway } from '../gateway';
import { t } from '../language';
import { capital } from '../state/commander';
import { persisted } from '../state/persisted';
import { PlotView } from '../state/plot-view';
import { toggled } from '../state/toggled';
import { useTrendFeed } from '../state/trend-feed';
import { instantText, rateText } from '../text/recorder';
import { trendCurves } from '../text/trace-curves';
import { Empty } from './lines';
import { marked } from './marked';
import { Plot, usePlotView } from './plot';
import { PlotButtons } from './plot-cursors';
import { PressGroup } from './press-group';
import { saveText } from './save';
import { CurveList, PointGroup, pointsOf, TraceCursors } from './trace-plot';

const chosenAxes = persisted('recorder.axes');
const chosenPoints = persisted('recorder.points', 'position,velocity', 'browser');
const chosenSpan = persisted('recorder.span', '60', 'browser');
const spans = [30, 60, 300, 600] as const;
const mostAxes = 6;

export function TrendsPart({ at_ms, axis }: { at_ms: number | undefined; axis: string | undefined }) {
  const { store } = useGateway();
  const door = useDoor(RecorderDoor);
  const v = usePlotView(() => new PlotView());
  const names = store.axisNames.value;
  const follow = useSignal(at_ms === undefined);
  const picked = chosenAxes.value.split(',').filter((n) => names.includes(n));
  const axes = (axis && names.includes(axis) && chosenAxes.value === '' ? [axis] : picked.length > 0 ? picked : names.slice(0, 2)).slice(0, mostAxes);
  const seen = pointsOf(chosenPoints);
  const span = Number(chosenSpan.value) || 60;
  useEffect(() => {
    if (axis) chosenAxes.value = axis;
  }, [axis, at_ms]);
  const { shown, drawn, version, fault } = useTrendFeed({ door, view: v, axes, seen, span_s: span, at_ms, follow, now_s: () => (Date.now() + store.clockOffset_ms) / 1000 });
  const doc = shown.value;
  const curves = useMemo(() => trendCurves(doc, axes, seen), [doc?.axes.map((a) => a.unit).join(), axes.join(), seen.join()]);
  const save = () => {
    const [from, to] = v.range.peek();
    void door.trendsCsv({ axes, points: [...seen, 'state'], from_ms: from * 1000, to_ms: to * 1000, columns: 5000 }).then((text) => saveText('trends.csv', 'text/csv', text), (e: unknown) => (fault.value = capital(asProblem(e).text)));
  };
  if (names.length === 0) return <Empty text={store.listed.value ? t('There is no axis yet.') : t('Waiting for the gateway.')} />;
  return (
    <div class="scope card recorder-plot">
      <div class="scope-head">
        <PointGroup label={t('Points')} chosen={chosenPoints} />
        <PressGroup
          label={t('Time shown')}
          of={spans.map((s) => ({ value: s, text: s < 60 ? `${s} s` : t('{n} min', { n: s / 60 }), on: follow.value && span === s }))}
          press={(s) => {
            chosenSpan.value = String(s);
            follow.value = true;
          }}
        />
        <PlotButtons view={v} />
        <button type="button" class="button small" onClick={save} title={t('What is seen now, as a table')}>
          {t('CSV')}
        </button>
      </div>
      <PressGroup label={t('Axes, at most {mostAxes}', { mostAxes })} class="recorder-axes" of={names.map((n) => ({ value: n, text: n, on: axes.includes(n), disabled: !axes.includes(n) && axes.length >= mostAxes }))} press={(n) => (chosenAxes.value = toggled(axes, n).join(','))} />
      <Plot
        zoomable
        view={v}
        curves={curves}
        data={() => (drawn.current.columns.length === curves.length ? ([drawn.current.at, ...drawn.current.columns] as never) : ([[]] as never))}
        version={version.value}
        marks={at_ms === undefined ? [] : [{ at: at_ms / 1000, text: t('alarm') }]}
        timeText={(instant, _end, s) => instantText(instant, s)}
        label={t('Trends of {n}. Drag to come closer, 0 shows all. Arrow keys move the cursor {n2}, Delete takes it away, plus and minus zoom, page keys move.', { n: axes.join(', '), n2: v.active.value === 0 ? 'A' : 'B' })}
      />
      <CurveList curves={curves} version={version.value} />
      <p class="where" role="status" data-field="trend-rate">
        {fault.value ? marked(fault.value) : (doc ? doc.axes.map((a) => `${a.axis} ${rateText(a.rate_hz)}`).join(' · ') : t('Waiting for the gateway.'))}
        {!follow.value && !fault.value && ` · ${t('held: choose a time to follow again')}`}
      </p>
      <TraceCursors view={v} curves={curves} drawn={() => drawn.current} clock={(instant) => instantText(instant, 1)} />
    </div>
  );
}
