// Trends: what the gateway remembers of the last minutes of any axes, in one plot: axes and points to choose, zoom, cursors, a table as CSV.
// In: GET /recorder/trends, asked for what is seen, at most every second and soon after each zoom. Out: a plot that a reload does not empty.
import { midSentence, t } from '../language';
import { marked } from './marked';
import { useSignal } from '@preact/signals';
import { useEffect, useMemo, useRef } from 'preact/hooks';
import { asProblem } from '../api/problem';
import { RecorderDoor } from '../api/recorder';
import type { Trends } from '../api/types';
import { useGateway } from '../gateway';
import { capital } from '../state/commander';
import { persisted } from '../state/persisted';
import { readAt } from '../state/plot';
import { joined, trendPart, type Drawn } from '../state/recorder';
import { instantText, pointNames, points, pointUnit, rateText, type TracePoint } from '../text/recorder';
import { Empty } from './lines';
import { CursorTable, Plot, PlotButtons, PlotView, type Curve } from './plot';
import { saveText } from './save';

const chosenAxes = persisted('recorder.axes');
const chosenPoints = persisted('recorder.points', 'position,velocity', 'browser');
const chosenSpan = persisted('recorder.span', '60', 'browser');
const spans = [30, 60, 300, 600] as const;
export const mostAxes = 6;
const inks = ['--series-1', '--series-2', '--series-3', '--series-4', '--series-5'];
const period_ms = 1_000;

/** The axes of a list that are chosen by a click on one of them. */
export const toggled = (list: readonly string[], one: string) => (list.includes(one) ? list.filter((x) => x !== one) : [...list, one]);

export function TrendsPart({ at_ms, axis }: { at_ms: number | undefined; axis: string | undefined }) {
  const { client, store } = useGateway();
  const door = useMemo(() => new RecorderDoor(client), [client]);
  const view = useRef<PlotView>(null as unknown as PlotView);
  view.current ??= new PlotView();
  const v = view.current;
  const names = store.axisNames.value;
  const follow = useSignal(at_ms === undefined);
  const shown = useSignal<Trends | null>(null);
  const drawn = useRef<Drawn>({ at: [], columns: [] });
  const version = useSignal(0);
  const fault = useSignal('');
  const minutes = useSignal(10);
  const picked = chosenAxes.value.split(',').filter((n) => names.includes(n));
  const axes = (axis && names.includes(axis) && chosenAxes.value === '' ? [axis] : picked.length > 0 ? picked : names.slice(0, 2)).slice(0, mostAxes);
  const seen = points.filter((p) => chosenPoints.value.split(',').includes(p));
  const span = Number(chosenSpan.value) || 60;
  const now = () => (Date.now() + store.clockOffset_ms) / 1000;
  const key = `${axes.join()}|${seen.join()}`;

  useEffect(() => {
    if (axis) chosenAxes.value = axis;
  }, [axis, at_ms]);
  useEffect(() => {
    void door.recordings().then((r) => (minutes.value = r.trend_minutes), () => undefined);
  }, [door]);
  useEffect(() => {
    if (at_ms !== undefined) follow.value = false;
  }, [at_ms]);

  useEffect(() => {
    if (axes.length === 0 || seen.length === 0) return;
    let here = true;
    let soon: ReturnType<typeof setTimeout> | undefined;
    let own = false;
    let asking = false;
    let again = false;
    const load = async () => {
      if (asking) return void (again = true);
      asking = true;
      const [from, to] = v.range.peek();
      try {
        const doc = await door.trends({ axes, points: [...seen, 'state'], from_ms: from * 1000, to_ms: to * 1000, columns: Math.min(2000, Math.max(200, globalThis.innerWidth)) });
        if (!here) return;
        drawn.current = joined(doc.axes.map((a) => trendPart(a, seen, to)));
        shown.value = doc;
        fault.value = '';
        version.value += 1;
      } catch (error) {
        if (here) fault.value = capital(asProblem(error).text);
      } finally {
        asking = false;
        if (here && again) {
          again = false;
          void load();
        }
      }
    };
    const turn = () => {
      if (document.hidden) return;
      const instant = now();
      v.whole.value = [instant - minutes.peek() * 60, instant];
      if (!follow.peek()) return;
      own = true;
      v.range.value = [instant - span, instant];
      own = false;
      void load();
    };
    if (!follow.peek() && at_ms !== undefined) {
      const instant = now();
      v.whole.value = [instant - minutes.peek() * 60, instant];
      v.range.value = [at_ms / 1000 - span / 2, at_ms / 1000 + span / 2];
    }
    turn();
    void load();
    const timer = setInterval(turn, period_ms);
    const end = v.range.subscribe(() => {
      if (own || !here) return;
      if (soon === undefined) follow.value = follow.peek() && v.range.peek()[1] >= v.whole.peek()[1] && v.range.peek()[1] - v.range.peek()[0] === span;
      clearTimeout(soon);
      soon = setTimeout(() => {
        soon = undefined;
        void load();
      }, 120);
    });
    return () => {
      here = false;
      clearInterval(timer);
      clearTimeout(soon);
      end();
    };
  }, [key, span, door, at_ms]);

  const doc = shown.value;
  const curves = useMemo(() => trendCurves(doc, axes, seen), [doc?.axes.map((a) => a.unit).join(), key]);
  const save = () => {
    const [from, to] = v.range.peek();
    void door.trendsCsv({ axes, points: [...seen, 'state'], from_ms: from * 1000, to_ms: to * 1000, columns: 5000 }).then((text) => saveText('trends.csv', 'text/csv', text), (e: unknown) => (fault.value = capital(asProblem(e).text)));
  };
  if (names.length === 0) return <Empty text={store.listed.value ? t('There is no axis yet.') : t('Waiting for the gateway.')} />;
  return (
    <div class="scope card recorder-plot">
      <div class="scope-head">
        <div class="group scope-channels" role="group" aria-label={t('Points')}>
          {points.map((p) => (
            <button key={p} type="button" class="button small" aria-pressed={seen.includes(p)} onClick={() => (chosenPoints.value = toggled(seen, p).join(',') || p)}>
              {pointNames[p]}
            </button>
          ))}
        </div>
        <div class="group" role="group" aria-label={t('Time shown')}>
          {spans.map((s) => (
            <button
              key={s}
              type="button"
              class="button small"
              aria-pressed={follow.value && span === s}
              onClick={() => {
                chosenSpan.value = String(s);
                follow.value = true;
              }}
            >
              {s < 60 ? `${s} s` : t('{n} min', { n: s / 60 })}
            </button>
          ))}
        </div>
        <PlotButtons view={v} />
        <button type="button" class="button small" onClick={save} title={t('What is seen now, as a table')}>
          {t('CSV')}
        </button>
      </div>
      <div class="group recorder-axes" role="group" aria-label={t('Axes, at most {mostAxes}', { mostAxes })}>
        {names.map((n) => (
          <button key={n} type="button" class="button small" aria-pressed={axes.includes(n)} disabled={!axes.includes(n) && axes.length >= mostAxes} onClick={() => (chosenAxes.value = toggled(axes, n).join(','))}>
            {n}
          </button>
        ))}
      </div>
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
      <ul class="curve-list" aria-label={t('Curves')} data-version={version.value}>
        {curves.map((c) => (
          <li key={c.id} class={`curve-key ink${c.color}`}>
            {c.name}
          </li>
        ))}
      </ul>
      <p class="where" role="status" data-field="trend-rate">
        {fault.value ? marked(fault.value) : (doc ? doc.axes.map((a) => `${a.axis} ${rateText(a.rate_hz)}`).join(' · ') : t('Waiting for the gateway.'))}
        {!follow.value && !fault.value && ` · ${t('held: choose a time to follow again')}`}
      </p>
      <CursorTable view={v} curves={curves} read={(c, instant) => readAt(drawn.current.at, drawn.current.columns[curves.indexOf(c)] ?? [], instant)} clock={(instant) => instantText(instant, 1)} />
    </div>
  );
}

/** Curves of points share a side where they share a unit; each has an ink, and further ones are dashed. */
export const traceCurves = (list: readonly { id: string; name: string; unit: string }[], seen: readonly TracePoint[]): Curve[] =>
  list.flatMap((a, i) =>
    seen.map((p, k) => {
      const n = i * seen.length + k;
      const round = Math.floor(n / inks.length);
      return { id: `${a.id} ${p}`, name: `${a.name} ${midSentence(pointNames[p])}`, unit: pointUnit(p, a.unit), scale: scaleOf(p, a.unit), color: inks[n % inks.length] as string, withZero: p === 'velocity' || p === 'following_error', ...(p === 'following_error' ? { least: 1e-3 } : {}), ...(round > 0 ? { dash: [6, 3 * round] } : {}) };
    }),
  );
export const scaleOf = (p: TracePoint, unit: string): string => `${p === 'demand' ? 'position' : p} ${unit}`;

/** A curve for each point of each axis. */
export const trendCurves = (doc: Pick<Trends, 'axes'> | null, axes: readonly string[], seen: readonly TracePoint[]): Curve[] =>
  traceCurves(
    axes.map((a) => ({ id: a, name: a, unit: doc?.axes.find((x) => x.axis === a)?.unit ?? '' })),
    seen,
  );
