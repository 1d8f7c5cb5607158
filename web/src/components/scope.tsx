// Scope: position, demand, velocity, following error and target over time. In: the axis' history. Out: plots on one time axis, newest at the
// right; two cursors with their readings; a trigger; the picture as CSV. Follows the gateway's clock; holds still when told to, or when the
// trigger has fired; a gap stays a gap. Redrawn at most 20 times a second (once with reduced motion), with at most two rows per pixel.
import { useEffect, useRef } from 'preact/hooks';
import { computed, signal, useComputed } from '@preact/signals';
import type uPlot from 'uplot';
import { useGateway } from '../gateway';
import { persisted } from '../state/persisted';
import { channels, columnOf, csvOf, needsDemand, Trigger, valueAt, type Channel, type TriggerSetting } from '../state/scope';
import type { AxisHistory, HistoryColumns } from '../state/history';
import { demandWords } from '../text/axis';
import { parseNumber } from '../text/number';
import { CursorTable, Plot, PlotView, type Curve } from './plot';
import { saveText } from './save';

const windows = [2, 10, 30, 120] as const;
const chosen = persisted('scope.window', '30', 'browser');
const shown = persisted('scope.channels', 'position,velocity,target', 'browser');
const visible = computed(() => new Set(shown.value.split(',')));
/** Enough for two minutes at 1 kHz. */
const closeCapacity = 131_072;

const names: Record<Channel, string> = { position: 'Position', demand: 'Demand', velocity: 'Velocity', error: 'Following error', target: 'Target' };
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
    const t = store.history(axis).seen(from * 1000, to * 1000, Math.max(200, globalThis.innerWidth));
    const entry = store.axis(axis)?.peek();
    if (entry && store.trustOf(entry) === 'live' && t.at.length > 0 && to >= now_s) extend(t, now_s);
    return [t.at, ...curves.map((c) => columnOf(t, c.id as Channel))] as uPlot.AlignedData;
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
        <div class="group scope-channels" role="group" aria-label="Channels">
          {channels.map((c) => (
            <button key={c} type="button" class={`button small key key-${c}`} aria-pressed={seen.has(c)} onClick={() => toggle(c)}>
              {names[c]}
            </button>
          ))}
        </div>
        <div class="group" role="group" aria-label="Time shown">
          {windows.map((w) => (
            <button key={w} type="button" class="button small" aria-pressed={chosen.value === String(w)} onClick={() => (chosen.value = String(w))}>
              {w < 60 ? `${w} s` : `${w / 60} min`}
            </button>
          ))}
        </div>
        <button type="button" class="button small" title="What is seen now, as a table" onClick={save}>
          CSV
        </button>
        <button type="button" class="button small hold" aria-pressed={v.paused.value} onClick={hold}>
          {v.paused.value ? 'Held' : 'Hold'}
        </button>
      </div>
      <Plot
        live
        view={v}
        curves={curves}
        data={data}
        timeText={secondsBefore}
        label={`Scope of ${axis}, the last ${chosen.value} seconds. Arrow keys move the cursor ${v.active.value === 0 ? 'A' : 'B'}, Delete takes it away.`}
      />
      <DemandLine axis={axis} seen={seen} view={v} />
      <CursorTable view={v} curves={curves} read={(c, t) => readOf(store.history(axis), c.id as Channel, t)} clock={(t) => new Date(t * 1000).toISOString().slice(11, 23)} />
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
function extend(t: HistoryColumns, now_s: number): void {
  t.at.push(now_s);
  for (const column of [t.position, t.velocity, t.target, t.demand, t.error]) column.push(column.at(-1) ?? null);
  t.source.push(t.source.at(-1) ?? null);
}

const readOf = (history: AxisHistory, c: Channel, t: number) => valueAt(history.since(t * 1000 - 60_000, t * 1000 + 60_000), c, t);

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
      {demandWords(source)}
    </p>
  );
}

const triggerWords = { off: '', waiting: 'Waiting for the trigger', fired: 'Triggered, recording', shown: 'Held by the trigger' } as const;

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
        <span>Trigger</span>
        <select value={setting.mode} onChange={(e) => change({ mode: e.currentTarget.value as TriggerSetting['mode'] })}>
          <option value="off">off</option>
          <option value="single">once</option>
          <option value="again">each time</option>
        </select>
      </label>
      {setting.mode !== 'off' && (
        <>
          <label>
            <span>when</span>
            <select value={setting.channel} onChange={(e) => change({ channel: e.currentTarget.value as Channel })}>
              {channels.map((c) => (
                <option key={c} value={c}>
                  {names[c].toLowerCase()}
                </option>
              ))}
            </select>
          </label>
          <label>
            <span class="visually-hidden">Edge</span>
            <select value={setting.edge} onChange={(e) => change({ edge: e.currentTarget.value as TriggerSetting['edge'] })}>
              <option value="rising">rises through</option>
              <option value="falling">falls through</option>
            </select>
          </label>
          <label>
            <span class="visually-hidden">Level, {perSecond(setting.channel, unit)}</span>
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
            Arm
          </button>
          <span class="where" role="status">
            {parsed.good ? triggerWords[view.triggerState.value] : parsed.why}
          </span>
        </>
      )}
    </div>
  );
}

const secondsBefore = (t: number, end: number): string => {
  const s = Math.round((t - end) * 10) / 10;
  return s === 0 ? '0 s' : `${s < 0 ? '−' : ''}${Math.abs(s) < 10 ? Math.abs(s).toFixed(1).replace(/\.0$/, '') : Math.abs(Math.round(s))} s`;
};
