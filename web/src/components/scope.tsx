// Scope: position, demand, velocity, following error and target over time. In: the axis' history. Out: plots on one time axis, newest at the
// right; two cursors with their readings; a trigger; the picture as CSV. Follows the gateway's clock; holds still when told to, or when the
// trigger has fired; a gap stays a gap. Redrawn at most 20 times a second (once with reduced motion), with at most two rows per pixel.
import { midSentence, t } from '../language';
import { useEffect, useRef } from 'preact/hooks';
import { computed, signal, useComputed } from '@preact/signals';
import type uPlot from 'uplot';
import { useGateway } from '../gateway';
import { persisted } from '../state/persisted';
import { channels, columnOf, csvOf, needsDemand, Trigger, valueAt, type Channel, type TriggerSetting } from '../state/scope';
import type { AxisHistory, HistoryColumns } from '../state/history';
import { demandText } from '../text/axis';
import { localFigures, parseNumber } from '../text/number';
import { CursorTable, Plot, PlotView, type Curve } from './plot';
import { saveText } from './save';

const windows = [2, 10, 30, 120] as const;
const chosen = persisted('scope.window', '30', 'browser');
const shown = persisted('scope.channels', 'position,velocity,target', 'browser');
const visible = computed(() => new Set(shown.value.split(',')));
/** Enough for two minutes at 1 kHz. */
const closeCapacity = 131_072;

const names: Record<Channel, string> = { position: t('Position'), demand: t('Demand'), velocity: t('Velocity'), error: t('Following error'), target: t('Target') };
const scaleOf: Record<Channel, string> = { position: 'p', demand: 'p', target: 'p', velocity: 'v', error: 'e' };
const colorOf: Record<Channel, string> = { position: '--series-1', velocity: '--series-2', target: '--series-3', demand: '--series-4', error: '--series-5' };
/** From the bottom up: what matters most is drawn last. */
const drawn: Channel[] = ['target', 'demand', 'error', 'velocity', 'position'];
const perSecond = (c: Channel, unit: string) => (c === 'velocity' ? `${unit}/s` : unit);

const curveOf = (c: Channel, unit: string): Curve => ({
  id: c,
  name: names[c],
  unit: perSecond(c, unit),
  scale: scaleOf[c],
  color: colorOf[c],
  width: c === 'position' ? 2 : 1.25,
  withZero: c === 'velocity' || c === 'error',
  ...(c === 'error' ? { least: 1e-3 } : {}),
  ...(c === 'target' ? { dash: [4, 4], stepped: true } : {}),
});

/** What the component keeps between two pictures. */
class View extends PlotView {
  readonly paused = signal(false);
  readonly trigger = signal<TriggerSetting>({ mode: 'off', channel: 'position', edge: 'rising', level: 0 });
  readonly triggerState = signal<'off' | 'waiting' | 'fired' | 'shown'>('off');
  readonly machine = new Trigger();
  heldAt_s = 0;

  /** The part of time that the picture shows. */
  look(history: AxisHistory, now_s: number, window_s: number): [number, number] {
    const setting = this.trigger.peek();
    if (this.paused.peek()) return [this.heldAt_s - window_s, this.heldAt_s];
    if (setting.mode === 'off') {
      this.triggerState.value = 'off';
      return [now_s - window_s, now_s];
    }
    const left = this.machine.look(history.since((now_s - 2 * window_s) * 1000), setting, now_s, window_s);
    this.triggerState.value = this.machine.state;
    return left === null ? [now_s - window_s, now_s] : [left, left + window_s];
  }
}

export function Scope({ axis, unit }: { axis: string; unit: string }) {
  const { store } = useGateway();
  const view = useRef<View>(null as unknown as View);
  view.current ??= new View();
  const v = view.current;
  const seen = visible.value;
  const now = () => (Date.now() + store.clockOffset_ms) / 1000;
  const seconds = () => Number(chosen.peek()) || 30;
  useEffect(() => store.history(axis).keep(closeCapacity), [axis, store]);
  const list = drawn.filter((c) => seen.has(c));
  // The most important one first on its side: it gives the colour.
  const curves = [...list].sort((a, b) => channels.indexOf(a) - channels.indexOf(b)).map((c) => curveOf(c, unit));
  const data = (): uPlot.AlignedData => {
    const now_s = now();
    const [from, to] = v.look(store.history(axis), now_s, seconds());
    v.range.value = [from, to];
    const instant = store.history(axis).seen(from * 1000, to * 1000, Math.max(200, globalThis.innerWidth));
    const entry = store.axis(axis)?.peek();
    if (entry && store.trustOf(entry) === 'live' && instant.at.length > 0 && to >= now_s) extend(instant, now_s);
    return [instant.at, ...curves.map((c) => columnOf(instant, c.id as Channel))] as uPlot.AlignedData;
  };

  const hold = () => {
    v.heldAt_s = v.paused.peek() ? 0 : v.range.peek()[1];
    v.paused.value = !v.paused.peek();
  };
  const save = () => {
    const [from, to] = v.range.peek();
    const name = `${axis}-${new Date(to * 1000).toISOString().replaceAll(':', '').slice(0, 17)}.csv`;
    saveText(name, 'text/csv', csvOf(store.history(axis).since(from * 1000, to * 1000), axis, unit));
  };

  return (
    <div class="scope card">
      <div class="scope-head">
        <div class="group scope-channels" role="group" aria-label={t('Channels')}>
          {channels.map((c) => (
            <button key={c} type="button" class={`button small key key-${c}`} aria-pressed={seen.has(c)} onClick={() => toggle(c)}>
              {names[c]}
            </button>
          ))}
        </div>
        <div class="group" role="group" aria-label={t('Time shown')}>
          {windows.map((w) => (
            <button key={w} type="button" class="button small" aria-pressed={chosen.value === String(w)} onClick={() => (chosen.value = String(w))}>
              {w < 60 ? `${w} s` : t('{n} min', { n: w / 60 })}
            </button>
          ))}
        </div>
        <button type="button" class="button small" title={t('What is seen now, as a table')} onClick={save}>
          {t('CSV')}
        </button>
        <button type="button" class="button small hold" aria-pressed={v.paused.value} onClick={hold}>
          {v.paused.value ? t('Held') : t('Hold')}
        </button>
      </div>
      <Plot
        live
        view={v}
        curves={curves}
        data={data}
        timeText={secondsBefore}
        label={t('Scope of {axis}, the last {n} seconds. Arrow keys move the cursor {n2}, Delete takes it away.', { axis, n: chosen.value, n2: v.active.value === 0 ? 'A' : 'B' })}
      />
      <DemandLine axis={axis} seen={seen} view={v} />
      <CursorTable view={v} curves={curves} read={(c, instant) => readOf(store.history(axis), c.id as Channel, instant)} clock={(instant) => new Date(instant * 1000).toISOString().slice(11, 23)} />
      <TriggerBar view={v} unit={unit} now={now} />
    </div>
  );
}

function toggle(c: Channel): void {
  const set = new Set(visible.peek());
  if (set.has(c)) set.delete(c);
  else set.add(c);
  if (set.size > 0) shown.value = channels.filter((x) => set.has(x)).join(','); // an empty scope would only look broken
}

/** The newest values hold until now. */
function extend(instant: HistoryColumns, now_s: number): void {
  instant.at.push(now_s);
  for (const column of [instant.position, instant.velocity, instant.target, instant.demand, instant.error]) column.push(column.at(-1) ?? null);
  instant.source.push(instant.source.at(-1) ?? null);
}

const readOf = (history: AxisHistory, c: Channel, instant: number) => valueAt(history.since(instant * 1000 - 60_000, instant * 1000 + 60_000), c, instant);

/** Where the demand of the newest sample comes from, as long as something of it is drawn or waited for. */
function DemandLine({ axis, seen, view }: { axis: string; seen: ReadonlySet<string>; view: View }) {
  const { store } = useGateway();
  const trigger = view.trigger.value;
  const source = useComputed(() => {
    const entry = store.axis(axis)?.value;
    return entry && store.trustOf(entry) === 'live' ? entry.data.demand_source : null;
  }).value;
  if (!channels.some((c) => needsDemand(c) && (seen.has(c) || (trigger.mode !== 'off' && trigger.channel === c)))) return null;
  return (
    <p class="where scope-why" data-field="demand-source" data-source={source ?? 'none'}>
      {demandText(source)}
    </p>
  );
}

const triggerText = { off: '', waiting: t('Waiting for the trigger'), fired: t('Triggered, recording'), shown: t('Held by the trigger') } as const;

function TriggerBar({ view, unit, now }: { view: View; unit: string; now: () => number }) {
  const typed = useRef(signal('0')).current;
  const setting = view.trigger.value;
  const change = (part: Partial<TriggerSetting>) => {
    view.trigger.value = { ...view.trigger.peek(), ...part };
    view.machine.arm(now());
  };
  const parsed = parseNumber(typed.value);
  return (
    <div class="scope-trigger">
      <label>
        <span>{t('Trigger')}</span>
        <select value={setting.mode} onChange={(e) => change({ mode: e.currentTarget.value as TriggerSetting['mode'] })}>
          <option value="off">{t('off')}</option>
          <option value="single">{t('once')}</option>
          <option value="again">{t('each time')}</option>
        </select>
      </label>
      {setting.mode !== 'off' && (
        <>
          <label>
            <span>{t('when')}</span>
            <select value={setting.channel} onChange={(e) => change({ channel: e.currentTarget.value as Channel })}>
              {channels.map((c) => (
                <option key={c} value={c}>
                  {midSentence(names[c])}
                </option>
              ))}
            </select>
          </label>
          <label>
            <span class="visually-hidden">{t('Edge')}</span>
            <select value={setting.edge} onChange={(e) => change({ edge: e.currentTarget.value as TriggerSetting['edge'] })}>
              <option value="rising">{t('rises through')}</option>
              <option value="falling">{t('falls through')}</option>
            </select>
          </label>
          <label>
            <span class="visually-hidden">{t('Level, {channel}', { channel: perSecond(setting.channel, unit) })}</span>
            <input
              type="text"
              inputMode="decimal"
              autocomplete="off"
              size={8}
              value={typed.value}
              aria-invalid={!parsed.good}
              onInput={(e) => {
                typed.value = e.currentTarget.value;
                const p = parseNumber(typed.value);
                if (p.good) change({ level: p.value });
              }}
            />
            <span class="unit">{perSecond(setting.channel, unit)}</span>
          </label>
          <button type="button" class="button small" onClick={() => view.machine.arm(now())}>
            {t('Arm')}
          </button>
          <span class="where" role="status">
            {parsed.good ? triggerText[view.triggerState.value] : parsed.why}
          </span>
        </>
      )}
    </div>
  );
}

const secondsBefore = (instant: number, end: number): string => {
  const s = Math.round((instant - end) * 10) / 10;
  return s === 0 ? '0 s' : `${s < 0 ? '−' : ''}${Math.abs(s) < 10 ? localFigures(Math.abs(s).toFixed(1).replace(/\.0$/, '')) : Math.abs(Math.round(s))} s`;
};
