// Playback: a recording at one instant: a slider over its time, the curves of its axes with that instant as cursor A, the axes as they were,
// their registers, the frames before it in words, and what had happened. In: GET .../playback, one at a time, as the slider moves or four times a
// second while it plays. Out: a part of the page, which says of which instant it is. Nothing in it can be commanded.
import { useSignal, type Signal } from '@preact/signals';
import { useEffect, useMemo } from 'preact/hooks';
import { asProblem } from '../api/problem';
import { RecorderDoor } from '../api/recorder';
import type { Playback } from '../api/types';
import { useDoor } from '../gateway';
import { t } from '../language';
import { capital } from '../state/commander';
import { Moments } from '../state/playback';
import { PlotView } from '../state/plot-view';
import { joined, trendPart } from '../state/recorder';
import { instantText, type TracePoint } from '../text/recorder';
import { trendCurves } from '../text/trace-curves';
import { marked } from './marked';
import { PlaybackMoment } from './playback-moment';
import { Plot, usePlotView } from './plot';
import { PlotButtons } from './plot-cursors';
import { PressGroup } from './press-group';
import { Section } from './section';
import { TraceCursors } from './trace-plot';

const drawnPoints: readonly TracePoint[] = ['position', 'velocity'];
const step_ms = 250;

export function PlaybackPart({ name, at_ms, close }: { name: string; at_ms?: number | undefined; close: () => void }) {
  const door = useDoor(RecorderDoor);
  const whole = useSignal<Playback | null>(null);
  const moment = useSignal<Playback | null>(null);
  const fault = useSignal('');
  const playing = useSignal(false);
  const axis = useSignal('');
  const at = useSignal<number | null>(null);
  const v = usePlotView(() => new PlotView());
  const reported = (error: unknown) => (fault.value = capital(asProblem(error).text));

  const moments = useMemo(
    () =>
      new Moments<Playback>(
        (ms) => door.playback(name, { at_ms: ms, frames: 40 }),
        (doc) => {
          fault.value = '';
          moment.value = doc;
        },
        reported,
      ),
    [name, door],
  );
  useEffect(() => {
    let here = true;
    door.playback(name, { ...(at_ms === undefined ? {} : { at_ms }), frames: 40, columns: 1500 }).then((doc) => {
      if (!here) return;
      const [from, to] = [Date.parse(doc.from) / 1000, Date.parse(doc.to) / 1000];
      v.whole.value = [from, Math.max(to, from + 0.01)];
      v.all();
      const first = at_ms === undefined ? to : Math.min(to, Math.max(from, at_ms / 1000));
      moments.known(first * 1000, doc);
      at.value = first;
      whole.value = doc;
      axis.value = doc.curves[0]?.axis ?? '';
    }, reported);
    return () => {
      here = false;
      moments.end();
    };
  }, [name, door]);
  useEffect(() => {
    const instant = at.value;
    if (instant === null || !whole.value) return;
    v.cursors[0].value = instant;
    moments.want(instant * 1000);
  }, [at.value]);
  // A click into the plot is an instant, too.
  useEffect(() => v.cursors[0].subscribe((instant) => void (instant !== null && whole.peek() && instant !== at.peek() && (at.value = instant))), [v]);
  useEffect(() => {
    if (!playing.value) return;
    const timer = setInterval(() => {
      const next = (at.peek() ?? 0) + step_ms / 1000;
      if (next >= v.whole.peek()[1]) playing.value = false;
      at.value = Math.min(next, v.whole.peek()[1]);
    }, step_ms);
    return () => clearInterval(timer);
  }, [playing.value]);

  const doc = whole.value;
  const now = moment.value;
  const [low, high] = v.whole.value;
  return (
    <Section
      title={t('Playback of {name}', { name })}
      beside={
        <button type="button" class="button" onClick={close}>
          {t('Close')}
        </button>
      }
    >
      <div class="card form playback" data-field="playback" data-at={now?.at}>
        {fault.value && <p class="notice tone-fault" role="status">{marked(fault.value)}</p>}
        {!doc && !fault.value && <p class="where">{t('Reading the recording.')}</p>}
        {doc && now && (
          <>
            <div class="playback-time">
              <button type="button" class="button" aria-pressed={playing.value} onClick={() => {
                if (!playing.peek() && (at.peek() ?? 0) >= high) at.value = low;
                playing.value = !playing.peek();
              }}>
                {playing.value ? t('Pause') : t('Play')}
              </button>
              <input
                type="range"
                min={low}
                max={high}
                step={0.01}
                value={at.value ?? high}
                aria-label={t('Instant of the recording')}
                aria-valuetext={instantText(at.value ?? high, 1)}
                onInput={(e) => {
                  playing.value = false;
                  at.value = Number(e.currentTarget.value);
                }}
              />
              <output class="mono">{instantText(at.value ?? high, 1)}</output>
            </div>
            <PlaybackPlot doc={doc} name={name} axis={axis} view={v} />
            <PlaybackMoment now={now} />
          </>
        )}
      </div>
    </Section>
  );
}

/** The curves of one axis of the recording, chosen from all of them. */
function PlaybackPlot({ doc, name, axis, view: v }: { doc: Playback; name: string; axis: Signal<string>; view: PlotView }) {
  const curve = doc.curves.find((c) => c.axis === axis.value);
  // The last word of each axis holds until the recording ends, which is where it is opened.
  const { drawn, curves } = useMemo(() => {
    const end = v.whole.peek()[1];
    return curve ? { drawn: joined([trendPart({ ...curve, newest: end * 1000 }, drawnPoints, end)]), curves: trendCurves({ axes: [curve] }, [curve.axis], drawnPoints) } : { drawn: { at: [], columns: [] }, curves: [] };
  }, [doc, axis.value]);
  if (!curve) return null;
  return (
    <div class="scope recorder-plot">
      <div class="scope-head">
        <PressGroup label={t('Axis of the curves')} class="scope-channels" of={doc.curves.map((c) => ({ value: c.axis, text: c.axis, on: axis.value === c.axis }))} press={(a) => (axis.value = a)} />
        <PlotButtons view={v} />
      </div>
      <Plot zoomable view={v} curves={curves} data={() => [drawn.at, ...drawn.columns] as never} version={`${axis.value} ${drawn.at.length}`} timeText={(instant, _e, s) => instantText(instant, s)} label={t('Curves of {n} in {name}. Cursor A is the instant that is shown below.', { n: axis.value, name })} />
      <TraceCursors view={v} curves={curves} drawn={() => drawn} clock={(instant) => instantText(instant, 1)} />
    </div>
  );
}
