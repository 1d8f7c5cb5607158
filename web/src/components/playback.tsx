// Playback: a recording at one instant: a slider over its time, the curves of its axes with that instant as cursor A, the axes as they were,
// their registers, the frames before it in words, and what had happened. In: GET .../playback, one at a time, as the slider moves or four times a
// second while it plays. Out: a part of the page, which says of which instant it is. Nothing in it can be commanded.
import { t } from '../language';
import { marked } from './marked';
import { useSignal } from '@preact/signals';
import { useEffect, useMemo, useRef } from 'preact/hooks';
import { asProblem } from '../api/problem';
import { RecorderDoor } from '../api/recorder';
import type { Playback } from '../api/types';
import { useGateway } from '../gateway';
import { capital } from '../state/commander';
import { Moments } from '../state/playback';
import { readAt } from '../state/plot';
import { joined, trendPart } from '../state/recorder';
import { formatNumber } from '../text/number';
import { plainWord } from '../text/plain';
import { instantText, registerText } from '../text/recorder';
import { CursorTable, Plot, PlotButtons, PlotView } from './plot';
import { trendCurves } from './recorder-trends';
import { Section } from './section';

const step_ms = 250;
interface FrameRow {
  line: string;
  at: string;
  to_drive: boolean;
  simulated: boolean;
  text?: string;
  data: string;
  decoded: string[];
  command: number | null;
}
interface AxisRow {
  name: string;
  unit: string;
  state: string;
  position: number | null;
  velocity: number | null;
  following_error: number | null;
  error: { code: number; text: string };
  presence: string;
}

export function PlaybackPart({ name, at_ms, close }: { name: string; at_ms?: number | undefined; close: () => void }) {
  const { client } = useGateway();
  const door = useMemo(() => new RecorderDoor(client), [client]);
  const whole = useSignal<Playback | null>(null);
  const moment = useSignal<Playback | null>(null);
  const fault = useSignal('');
  const playing = useSignal(false);
  const axis = useSignal('');
  const at = useSignal<number | null>(null);
  const view = useRef<PlotView>(null as unknown as PlotView);
  view.current ??= new PlotView();
  const v = view.current;
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
  const curve = doc?.curves.find((c) => c.axis === axis.value);
  // The last word of each axis holds until the recording ends, which is where it is opened.
  const { drawn, curves } = useMemo(
    () => ({ drawn: curve ? joined([trendPart({ ...curve, newest: v.whole.peek()[1] * 1000 }, ['position', 'velocity'], v.whole.peek()[1])]) : { at: [], columns: [] }, curves: curve ? trendCurves({ axes: [curve] }, [curve.axis], ['position', 'velocity']) : [] }),
    [doc, axis.value],
  );
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
            {curve && (
              <div class="scope recorder-plot">
                <div class="scope-head">
                  <div class="group scope-channels" role="group" aria-label={t('Axis of the curves')}>
                    {doc.curves.map((c) => (
                      <button key={c.axis} type="button" class="button small" aria-pressed={axis.value === c.axis} onClick={() => (axis.value = c.axis)}>
                        {c.axis}
                      </button>
                    ))}
                  </div>
                  <PlotButtons view={v} />
                </div>
                <Plot zoomable view={v} curves={curves} data={() => [drawn.at, ...drawn.columns] as never} version={`${axis.value} ${drawn.at.length}`} timeText={(instant, _e, s) => instantText(instant, s)} label={t('Curves of {n} in {name}. Cursor A is the instant that is shown below.', { n: axis.value, name })} />
                <CursorTable view={v} curves={curves} read={(c, instant) => readAt(drawn.at, drawn.columns[curves.indexOf(c)] ?? [], instant)} clock={(instant) => instantText(instant, 1)} />
              </div>
            )}
            <p data-field="playback-shown">{t('Axes, registers, frames and events at {at}', { at: instantText(Date.parse(now.at) / 1000, 1) })}</p>
            <div class="table-scroll" tabIndex={0} role="region" aria-label={t('Axes at that instant')}>
              <table class="table">
                <thead>
                  <tr>
                    <th scope="col">{t('Axis')}</th>
                    <th scope="col">{t('State')}</th>
                    <th scope="col" class="num">{t('Position')}</th>
                    <th scope="col" class="num">{t('Velocity')}</th>
                    <th scope="col" class="num">{t('Following error')}</th>
                    <th scope="col" class="num">{t('Error')}</th>
                    <th scope="col">{t('Registers')}</th>
                  </tr>
                </thead>
                <tbody>
                  {(now.axes as unknown as AxisRow[]).map((a) => (
                    <tr key={a.name} data-axis={a.name}>
                      <th scope="row">{a.name}</th>
                      <td data-label={t('State')}>{a.presence === 'twin' ? t('{state} (simulated)', { state: plainWord(a.state) }) : a.presence === 'offline' ? t('{state} (offline)', { state: plainWord(a.state) }) : plainWord(a.state)}</td>
                      <td data-label={t('Position')} class="num">{formatNumber(a.position, 3)} {a.unit}</td>
                      <td data-label={t('Velocity')} class="num">{formatNumber(a.velocity, 3)}</td>
                      <td data-label={t('Following error')} class="num">{formatNumber(a.following_error, 3)}</td>
                      <td data-label={t('Error')} class="num" title={a.error.text || undefined}>{a.error.code || '–'}</td>
                      <td data-label={t('Registers')} class="mono playback-words">{registerText(now.registers.find((r) => r.axis === a.name))}</td>
                    </tr>
                  ))}
                </tbody>
              </table>
            </div>
            <h3>{t('Frames before it')}</h3>
            <div class="card scroll frames" tabIndex={0} role="region" aria-label={t('Frames before that instant, newest first')}>
              <ol class="frame-list mono">
                {(now.frames as unknown as FrameRow[]).toReversed().map((f, i) => (
                  <li key={i} class="frame-row">
                    <span>{f.at.slice(11, 23)}</span>
                    <span class={f.to_drive ? 'to' : 'from'}>{f.to_drive ? t('→ drive') : t('← drive')}</span>
                    <span>{f.line}</span>
                    <span class="bytes">{f.text || f.data}</span>
                    <span class="reading">
                      {f.decoded.join(' · ')}
                      {f.command !== null && <b> {t('for command {n}', { n: f.command })}</b>}
                    </span>
                  </li>
                ))}
              </ol>
            </div>
            <h3>{t('What had happened')}</h3>
            <div class="card scroll playback-happened" tabIndex={0} role="region" aria-label={t('What had happened, newest first')}>
              <ol class="frame-list mono">
                {now.happened.toReversed().map((h, i) => (
                  <li key={i}>
                    {h.at.slice(11, 23)} {h.axis ? `${h.axis}: ` : ''}
                    {h.text}
                  </li>
                ))}
              </ol>
            </div>
          </>
        )}
      </div>
    </Section>
  );
}
