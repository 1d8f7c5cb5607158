// Scope: position, demand, velocity, following error and target over time. In: the axis' history. Out: plots on one time axis, newest at the
// right; two cursors with their readings; a trigger; the picture as CSV. Follows the gateway's clock; holds still when told to, or when the
// trigger has fired; a gap stays a gap. Redrawn at most 20 times a second (once with reduced motion), with at most two rows per pixel.
import { useEffect, useRef } from 'preact/hooks';
import { computed, signal, useComputed, type Signal } from '@preact/signals';
import uPlot from 'uplot';
import 'uplot/dist/uPlot.min.css';
import { useGateway } from '../gateway';
import { persisted } from '../state/persisted';
import { channels, columnOf, csvOf, needsDemand, Trigger, valueAt, type Channel, type TriggerSetting } from '../state/scope';
import { dark } from '../state/theme';
import type { AxisHistory, HistoryColumns } from '../state/history';
import { demandWords } from '../text/axis';
import { formatNumber, parseNumber, tickLabels } from '../text/number';

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

/** What the component keeps between two pictures. */
class View {
  readonly paused = signal(false);
  readonly trigger = signal<TriggerSetting>({ mode: 'off', channel: 'position', edge: 'rising', level: 0 });
  readonly triggerState = signal<'off' | 'waiting' | 'fired' | 'shown'>('off');
  /** Instants of the cursors, seconds since 1970. */
  readonly cursors: [Signal<number | null>, Signal<number | null>] = [signal(null), signal(null)];
  readonly active = signal<0 | 1>(0);
  readonly range = signal<[number, number]>([0, 1]);
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

  put(t: number): void {
    const [low, high] = this.range.peek();
    this.cursors[this.active.peek()].value = Math.min(high, Math.max(low, t));
  }
}

export function Scope({ axis, unit }: { axis: string; unit: string }) {
  const { store } = useGateway();
  const box = useRef<HTMLDivElement>(null);
  const view = useRef<View>(null as unknown as View);
  view.current ??= new View();
  const v = view.current;
  const isDark = dark.value; // a new theme makes a new plot
  const seen = visible.value;
  const key = [...seen].join(',');
  const now = () => (Date.now() + store.clockOffset_ms) / 1000;
  const seconds = () => Number(chosen.peek()) || 30;

  useEffect(() => {
    const host = box.current;
    if (!host || !document.createElement('canvas').getContext('2d')) return; // a browser that forbids canvases shows no plot
    store.history(axis).keep(closeCapacity);
    const plot = new uPlot(optionsFor(host, drawn.filter((c) => seen.has(c)), v, unit), [[]], host);
    const draw = () => {
      if (document.hidden) return;
      const now_s = now();
      const [from, to] = v.look(store.history(axis), now_s, seconds());
      v.range.value = [from, to];
      const t = store.history(axis).seen(from * 1000, to * 1000, Math.max(200, host.clientWidth));
      const entry = store.axis(axis)?.peek();
      if (entry && store.trustOf(entry) === 'live' && t.at.length > 0 && to >= now_s) extend(t, now_s);
      plot.batch(() => {
        plot.setData([t.at, ...drawn.filter((c) => seen.has(c)).map((c) => columnOf(t, c))] as uPlot.AlignedData, false);
        plot.setScale('x', { min: from, max: to });
      });
    };
    draw();
    const slow = globalThis.matchMedia?.('(prefers-reduced-motion: reduce)').matches;
    const timer = setInterval(() => requestAnimationFrame(draw), slow ? 1000 : 50);
    const sizes = new ResizeObserver(() => plot.setSize({ width: host.clientWidth, height: host.clientHeight }));
    sizes.observe(host);
    const place = (e: PointerEvent) => {
      if (e.button !== 0) return;
      if (e.shiftKey) v.active.value = 1;
      v.put(plot.posToVal(e.clientX - plot.over.getBoundingClientRect().left, 'x'));
    };
    plot.over.addEventListener('pointerdown', place);
    return () => {
      clearInterval(timer);
      sizes.disconnect();
      plot.destroy();
    };
  }, [axis, store, isDark, key, v]);

  const hold = () => {
    v.heldAt_s = v.paused.peek() ? 0 : v.range.peek()[1];
    v.paused.value = !v.paused.peek();
  };
  const move = (e: KeyboardEvent) => {
    const [low, high] = v.range.peek();
    const step = ((high - low) / 100) * (e.shiftKey ? 10 : 1);
    const at = v.cursors[v.active.peek()].peek() ?? (low + high) / 2;
    if (e.key === 'ArrowLeft') v.put(at - step);
    else if (e.key === 'ArrowRight') v.put(at + step);
    else if (e.key === 'Home') v.put(low);
    else if (e.key === 'End') v.put(high);
    else if (e.key === 'Delete') v.cursors[v.active.peek()].value = null;
    else return;
    e.preventDefault();
  };
  const save = () => {
    const [from, to] = v.range.peek();
    const url = URL.createObjectURL(new Blob([csvOf(store.history(axis).since(from * 1000, to * 1000), axis, unit)], { type: 'text/csv' }));
    const a = document.createElement('a');
    a.href = url;
    a.download = `${axis}-${new Date(to * 1000).toISOString().replaceAll(':', '').slice(0, 17)}.csv`;
    a.click();
    setTimeout(() => URL.revokeObjectURL(url), 10_000);
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
      <div
        class="scope-plot"
        ref={box}
        role="application"
        tabIndex={0}
        aria-label={`Scope of ${axis}, the last ${chosen.value} seconds. Arrow keys move the cursor ${v.active.value === 0 ? 'A' : 'B'}, Delete takes it away.`}
        onKeyDown={move}
      />
      <DemandLine axis={axis} seen={seen} view={v} />
      <Cursors view={v} history={() => store.history(axis)} unit={unit} seen={seen} />
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

function optionsFor(host: HTMLElement, list: Channel[], view: View, unit: string): uPlot.Options {
  const color = (name: string) => {
    const probe = document.createElement('span');
    probe.style.color = `var(${name})`;
    host.append(probe);
    const c = getComputedStyle(probe).color;
    probe.remove();
    return c;
  };
  const grid = { stroke: color('--line'), width: 1 };
  const axisStyle = { stroke: color('--text-3'), font: '11px ' + getComputedStyle(host).fontFamily, grid, ticks: { show: false } };
  const has = (scale: string) => list.some((c) => scaleOf[c] === scale);
  const side = (scale: string, right: boolean): uPlot.Axis[] =>
    has(scale) ? [{ ...axisStyle, ...named(scale), scale, size: wideEnough(), space: 44, side: right ? 1 : 3, grid: right ? { show: false } : grid, values: (_u: uPlot, at: number[]) => tickLabels(at) }] : [];
  // The side says what it measures, in the colour of its line; of several on one side the most important one gives the colour.
  const named = (scale: string) => {
    const own = channels.filter((c) => scaleOf[c] === scale && list.includes(c));
    const ink = color(colorOf[own[0] as Channel]);
    return { stroke: ink, label: `${own.map((c) => names[c]).join(', ')}, ${perSecond(own[0] as Channel, unit)}`, labelSize: 16, labelGap: 0, labelFont: axisStyle.font };
  };
  const stepped = uPlot.paths.stepped?.({ align: 1 });
  const marks = [color('--accent'), color('--text-2')];
  return {
    width: host.clientWidth || 600,
    height: host.clientHeight || 280,
    legend: { show: false },
    cursor: { drag: { x: false, y: false }, points: { show: false } },
    padding: [8, 4, 0, 4],
    scales: {
      x: { time: false },
      p: { range: (_u, low, high) => spread(low, high) },
      v: { range: (_u, low, high) => spread(low, high, true) },
      e: { range: (_u, low, high) => spread(low, high, true, 1e-3) },
    },
    series: [
      {},
      ...list.map((c) => ({ scale: scaleOf[c], label: `${names[c]}, ${perSecond(c, unit)}`, stroke: color(colorOf[c]), width: c === 'position' ? 2 : 1.25, points: { show: false }, ...(c === 'target' ? { dash: [4, 4], ...(stepped ? { paths: stepped } : {}) } : {}) })),
    ],
    axes: [
      { ...axisStyle, size: 26, splits: (u, _i, min, max) => {
          const parts = u.width < 500 ? 2 : 5; // on a phone more of them would lie upon each other
          return Array.from({ length: parts + 1 }, (_, i) => max - ((max - min) * (parts - i)) / parts);
        }, values: (u, at) => at.map((t) => secondsBefore(t, u.scales.x?.max ?? t)) },
      ...side('p', false),
      ...side('v', true),
      ...side('e', true),
    ],
    hooks: {
      draw: [
        (u) => {
          view.cursors.forEach((cursor, i) => {
            const t = cursor.peek();
            if (t === null) return;
            const x = Math.round(u.valToPos(t, 'x', true));
            if (x < u.bbox.left || x > u.bbox.left + u.bbox.width) return;
            u.ctx.save();
            u.ctx.strokeStyle = u.ctx.fillStyle = marks[i] as string;
            u.ctx.lineWidth = devicePixelRatio;
            u.ctx.beginPath();
            u.ctx.moveTo(x, u.bbox.top);
            u.ctx.lineTo(x, u.bbox.top + u.bbox.height);
            u.ctx.stroke();
            u.ctx.fillText(i === 0 ? 'A' : 'B', x + 3 * devicePixelRatio, u.bbox.top + 12 * devicePixelRatio);
            u.ctx.restore();
          });
        },
      ],
    },
  };
}

/** As wide as the longest figure beside the plot; never narrower again, so that the plot does not jump with every digit. */
function wideEnough(): (u: uPlot, figures: string[] | null, axis: number, cycle: number) => number {
  let width = 32;
  return (_u, figures, _axis, cycle) => {
    if (cycle <= 1) width = Math.max(width, ...(figures ?? []).map((f) => f.length * 6.5 + 12));
    return width;
  };
}

/** What the two cursors read, and the difference. */
function Cursors({ view, history, unit, seen }: { view: View; history: () => AxisHistory; unit: string; seen: ReadonlySet<string> }) {
  const [a, b] = [view.cursors[0].value, view.cursors[1].value];
  const buttons = (
    <div class="group" role="group" aria-label="Cursor that a click or the arrow keys place">
      {(['A', 'B'] as const).map((name, i) => (
        <button key={name} type="button" class="button small" aria-pressed={view.active.value === i} onClick={() => (view.active.value = i as 0 | 1)}>
          {name}
        </button>
      ))}
      <button type="button" class="button small" onClick={() => view.cursors.forEach((c) => (c.value = null))} disabled={a === null && b === null}>
        None
      </button>
    </div>
  );
  if (a === null && b === null) {
    return (
      <div class="scope-cursors">
        {buttons}
        <span class="where">Click into the plot to place cursor {view.active.value === 0 ? 'A' : 'B'}.</span>
      </div>
    );
  }
  const times = [a, b].filter((t) => t !== null) as number[];
  const c = history().since(Math.min(...times) * 1000 - 60_000, Math.max(...times) * 1000 + 60_000);
  const read = (t: number | null, channel: Channel) => (t === null ? null : valueAt(c, channel, t));
  const shownChannels = channels.filter((x) => seen.has(x));
  const clock = (t: number | null) => (t === null ? '–' : new Date(t * 1000).toISOString().slice(11, 23));
  return (
    <div class="scope-cursors">
      {buttons}
      <div class="scroll">
        <table class="cursor-table">
          <thead>
            <tr>
              <th scope="col">Cursor</th>
              <th scope="col">Time</th>
              {shownChannels.map((x) => (
                <th key={x} scope="col">
                  {names[x]}, {perSecond(x, unit)}
                </th>
              ))}
            </tr>
          </thead>
          <tbody>
            {[a, b].map((t, i) => (
              <tr key={i}>
                <th scope="row">{i === 0 ? 'A' : 'B'}</th>
                <td class="mono" data-label="Time">{clock(t)}</td>
                {shownChannels.map((x) => (
                  <td key={x} class="mono" data-label={`${names[x]}, ${perSecond(x, unit)}`}>
                    {formatNumber(read(t, x), 3)}
                  </td>
                ))}
              </tr>
            ))}
            {a !== null && b !== null && (
              <tr>
                <th scope="row">B − A</th>
                <td class="mono" data-label="Time">{formatNumber(b - a, 3)} s</td>
                {shownChannels.map((x) => {
                  const [p, q] = [read(a, x), read(b, x)];
                  return (
                    <td key={x} class="mono" data-label={`${names[x]}, ${perSecond(x, unit)}`}>
                      {formatNumber(p === null || q === null ? null : q - p, 3)}
                    </td>
                  );
                })}
              </tr>
            )}
          </tbody>
        </table>
      </div>
    </div>
  );
}

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

/** Room above and below; never a range of nothing; velocity always shows its zero. */
function spread(low: number | null, high: number | null, withZero = false, least = 0.5): [number, number] {
  if (low === null || high === null || !Number.isFinite(low) || !Number.isFinite(high)) return [-1, 1];
  const a = withZero ? Math.min(low, 0) : low;
  const b = withZero ? Math.max(high, 0) : high;
  const room = Math.max((b - a) * 0.1, Math.abs(b) * 1e-3, least);
  return [a - room, b + room];
}

const secondsBefore = (t: number, end: number): string => {
  const s = Math.round((t - end) * 10) / 10;
  return s === 0 ? '0 s' : `${s < 0 ? '−' : ''}${Math.abs(s) < 10 ? Math.abs(s).toFixed(1).replace(/\.0$/, '') : Math.abs(Math.round(s))} s`;
};
