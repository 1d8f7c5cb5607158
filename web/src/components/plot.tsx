// Plot: curves over time with two cursors; the one plot of the page (uPlot draws). In: curves, columns on one time axis, the part of time that
// is seen. Out: a canvas; cursors by click and arrow keys; where it may be zoomed, by a drag, by + and -, by keys, and by a double click back.
// Never asks for data: who owns it draws again when there are more. A browser that forbids canvases shows no plot.
import { t } from '../language';
import { signal, type Signal } from '@preact/signals';
import { useEffect, useRef } from 'preact/hooks';
import uPlot from 'uplot';
import 'uplot/dist/uPlot.min.css';
import { panned, spread, within, zoomed, type Range } from '../state/plot';
import { dark } from '../state/theme';
import { formatNumber, tickLabels } from '../text/number';

export interface Curve {
  id: string;
  /** What it is called, without its unit. */
  name: string;
  unit: string;
  /** Curves of one scale share a side. */
  scale: string;
  /** A custom property: "--series-1". */
  color: string;
  width?: number;
  dash?: number[];
  stepped?: boolean;
  /** Its scale always shows its zero; and the least room that it leaves. */
  withZero?: boolean;
  least?: number;
}

/** What is kept between two pictures: who shows a plot owns one. */
export class PlotView {
  /** Instants of the cursors, seconds. */
  readonly cursors: [Signal<number | null>, Signal<number | null>] = [signal(null), signal(null)];
  readonly active = signal<0 | 1>(0);
  readonly range = signal<Range>([0, 1]);
  /** What there is; the range stays within it. */
  readonly whole = signal<Range>([0, 1]);

  put(instant: number): void {
    const [low, high] = this.range.peek();
    this.cursors[this.active.peek()].value = Math.min(high, Math.max(low, instant));
  }
  zoom(factor: number, about?: number): void {
    const r = this.range.peek();
    this.range.value = zoomed(r, about ?? this.cursors[this.active.peek()].peek() ?? (r[0] + r[1]) / 2, factor, this.whole.peek());
  }
  pan(share: number): void {
    this.range.value = panned(this.range.peek(), share, this.whole.peek());
  }
  all(): void {
    this.range.value = this.whole.peek();
  }
}

export interface Mark {
  at: number;
  text: string;
}

/** A value that is drawn across the plot: the level of a trigger. */
export interface Level {
  scale: string;
  value: number;
  text: string;
}
export interface PlotProps {
  label: string;
  curves: readonly Curve[];
  view: PlotView;
  /** Asked for each picture; sets view.range itself where time runs. */
  data: () => uPlot.AlignedData;
  /** Words at the time axis. */
  timeText: (instant: number, end: number, span: number) => string;
  /** Time runs: drawn anew 20 times a second. */
  live?: boolean;
  /** May be zoomed and moved. */
  zoomable?: boolean;
  /** Instants with a word. */
  marks?: readonly Mark[];
  /** Values with a word, each on the scale of the curves that it belongs to. */
  levels?: readonly Level[];
  /** Something to draw has changed. */
  version?: unknown;
  class?: string;
}

export function Plot(p: PlotProps) {
  const box = useRef<HTMLDivElement>(null);
  const latest = useRef(p);
  latest.current = p;
  const v = p.view;
  const isDark = dark.value; // a new theme makes a new plot
  const key = p.curves.map((c) => `${c.id} ${c.name} ${c.unit} ${c.scale} ${c.color}`).join('|');
  const redraw = useRef<() => void>(() => undefined);

  useEffect(() => {
    const host = box.current;
    if (!host || !document.createElement('canvas').getContext('2d')) return;
    const plot = new uPlot(optionsFor(host, latest), [[]], host);
    const draw = () => {
      if (document.hidden) return;
      const [at, ...columns] = latest.current.data();
      const data = [at, ...columns.reverse()] as uPlot.AlignedData; // from the bottom up: what stands first is drawn last
      const [min, max] = v.range.peek();
      plot.batch(() => {
        plot.setData(data, false);
        plot.setScale('x', { min, max });
      });
    };
    redraw.current = draw;
    draw();
    const slow = globalThis.matchMedia?.('(prefers-reduced-motion: reduce)').matches;
    const timer = p.live ? setInterval(() => requestAnimationFrame(draw), slow ? 1000 : 50) : undefined;
    const sizes = new ResizeObserver(() => plot.setSize({ width: host.clientWidth, height: host.clientHeight }));
    sizes.observe(host);
    const timeAt = (x: number) => plot.posToVal(x - plot.over.getBoundingClientRect().left, 'x');
    const place = (e: PointerEvent) => {
      if (e.button !== 0) return;
      const begun = e.clientX;
      if (!latest.current.zoomable) {
        if (e.shiftKey) v.active.value = 1;
        return v.put(timeAt(begun));
      }
      const shift = e.shiftKey;
      const end = (u: PointerEvent) => {
        if (Math.abs(u.clientX - begun) > 4) return; // a drag: it zooms
        if (shift) v.active.value = 1;
        v.put(timeAt(begun));
      };
      plot.over.addEventListener('pointerup', end, { once: true });
    };
    const wheel = (e: WheelEvent) => {
      if (!latest.current.zoomable || !(e.ctrlKey || e.metaKey)) return; // a bare wheel scrolls the page
      e.preventDefault();
      v.zoom(e.deltaY > 0 ? 1.25 : 0.8, timeAt(e.clientX));
    };
    const back = () => latest.current.zoomable && v.all();
    plot.over.addEventListener('pointerdown', place);
    plot.over.addEventListener('wheel', wheel, { passive: false });
    plot.over.addEventListener('dblclick', back);
    const seen = p.live ? [] : [v.range, ...v.cursors].map((s) => s.subscribe(() => requestAnimationFrame(draw)));
    return () => {
      clearInterval(timer);
      seen.forEach((end) => end());
      sizes.disconnect();
      plot.destroy();
      redraw.current = () => undefined;
    };
  }, [v, isDark, key, p.live]);
  useEffect(() => redraw.current(), [p.version]);

  const keys = (e: KeyboardEvent) => {
    const [low, high] = v.range.peek();
    const step = ((high - low) / 100) * (e.shiftKey ? 10 : 1);
    const at = v.cursors[v.active.peek()].peek() ?? (low + high) / 2;
    if (e.key === 'ArrowLeft') v.put(at - step);
    else if (e.key === 'ArrowRight') v.put(at + step);
    else if (e.key === 'Home') v.put(low);
    else if (e.key === 'End') v.put(high);
    else if (e.key === 'Delete') v.cursors[v.active.peek()].value = null;
    else if (p.zoomable && (e.key === '+' || e.key === '=')) v.zoom(0.5);
    else if (p.zoomable && e.key === '-') v.zoom(2);
    else if (p.zoomable && e.key === '0') v.all();
    else if (p.zoomable && e.key === 'PageUp') v.pan(-0.5);
    else if (p.zoomable && e.key === 'PageDown') v.pan(0.5);
    else return;
    e.preventDefault();
  };
  return <div class={`scope-plot ${p.class ?? ''}`} ref={box} role="application" tabIndex={0} aria-label={p.label} onKeyDown={keys} />;
}

function optionsFor(host: HTMLElement, latest: { current: PlotProps }): uPlot.Options {
  const { curves, view } = latest.current;
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
  const scales = [...new Set(curves.map((c) => c.scale))];
  const stepped = uPlot.paths.stepped?.({ align: 1 });
  const inks = [color('--accent'), color('--text-2')];
  // The side says what it measures, in the colour of its line; of several on one side the most important one gives the colour.
  const side = (scale: string, n: number): uPlot.Axis => {
    const own = curves.filter((c) => c.scale === scale);
    const names = [...new Set(own.map((c) => c.name))];
    return {
      ...axisStyle,
      stroke: color(own[0]!.color),
      label: `${names.length > 3 ? t('{n} curves', { n: names.length }) : names.join(', ')}, ${own[0]!.unit}`,
      labelSize: 16,
      labelGap: 0,
      labelFont: axisStyle.font,
      scale,
      size: wideEnough(),
      space: 44,
      side: n === 0 ? 3 : 1,
      grid: n === 0 ? grid : { show: false },
      values: (_u: uPlot, at: number[]) => tickLabels(at),
    };
  };
  const level = (u: uPlot, l: Level, ink: string) => {
    if (!u.scales[l.scale]) return;
    const y = Math.round(u.valToPos(l.value, l.scale, true));
    if (!(y >= u.bbox.top && y <= u.bbox.top + u.bbox.height)) return;
    u.ctx.save();
    u.ctx.strokeStyle = u.ctx.fillStyle = ink;
    u.ctx.lineWidth = devicePixelRatio;
    u.ctx.setLineDash([8 * devicePixelRatio, 4 * devicePixelRatio]);
    u.ctx.beginPath();
    u.ctx.moveTo(u.bbox.left, y);
    u.ctx.lineTo(u.bbox.left + u.bbox.width, y);
    u.ctx.stroke();
    u.ctx.textAlign = 'right';
    u.ctx.fillText(l.text, u.bbox.left + u.bbox.width - 4 * devicePixelRatio, y - 5 * devicePixelRatio);
    u.ctx.restore();
  };
  const line = (u: uPlot, instant: number, ink: string, text: string, dashed: boolean) => {
    const x = Math.round(u.valToPos(instant, 'x', true));
    if (x < u.bbox.left || x > u.bbox.left + u.bbox.width) return;
    u.ctx.save();
    u.ctx.strokeStyle = u.ctx.fillStyle = ink;
    u.ctx.lineWidth = devicePixelRatio;
    if (dashed) u.ctx.setLineDash([4 * devicePixelRatio, 4 * devicePixelRatio]);
    u.ctx.beginPath();
    u.ctx.moveTo(x, u.bbox.top);
    u.ctx.lineTo(x, u.bbox.top + u.bbox.height);
    u.ctx.stroke();
    u.ctx.fillText(text, x + 3 * devicePixelRatio, u.bbox.top + (dashed ? 24 : 12) * devicePixelRatio);
    u.ctx.restore();
  };
  return {
    width: host.clientWidth || 600,
    height: host.clientHeight || 280,
    legend: { show: false },
    cursor: { drag: { x: latest.current.zoomable === true, y: false, setScale: false, dist: 5 }, points: { show: false } },
    padding: [8, 4, 0, 4],
    scales: {
      x: { time: false },
      ...Object.fromEntries(
        scales.map((s) => {
          const own = curves.filter((c) => c.scale === s);
          const least = Math.min(...own.map((c) => c.least ?? 0.5));
          return [s, { range: (_u: uPlot, low: number | null, high: number | null) => spread(low, high, own.some((c) => c.withZero), least) }];
        }),
      ),
    },
    series: [
      {},
      ...[...curves].reverse().map((c) => ({ scale: c.scale, label: `${c.name}, ${c.unit}`, stroke: color(c.color), width: c.width ?? 1.25, points: { show: false }, ...(c.dash ? { dash: c.dash } : {}), ...(c.stepped && stepped ? { paths: stepped } : {}) })),
    ],
    axes: [
      {
        ...axisStyle,
        size: 26,
        splits: (u, _i, min, max) => {
          const parts = u.width < 500 ? 2 : 5; // on a phone more of them would lie upon each other
          return Array.from({ length: parts + 1 }, (_, i) => max - ((max - min) * (parts - i)) / parts);
        },
        values: (u, at) => at.map((instant) => latest.current.timeText(instant, u.scales.x?.max ?? instant, (u.scales.x?.max ?? instant) - (u.scales.x?.min ?? instant))),
      },
      ...scales.map(side),
    ],
    hooks: {
      setSelect: [
        (u) => {
          if (u.select.width < 5) return;
          const picked: Range = [u.posToVal(u.select.left, 'x'), u.posToVal(u.select.left + u.select.width, 'x')];
          u.setSelect({ left: 0, top: 0, width: 0, height: 0 }, false);
          view.range.value = within(picked, view.whole.peek());
        },
      ],
      draw: [
        (u) => {
          for (const l of latest.current.levels ?? []) level(u, l, inks[1] as string);
          for (const m of latest.current.marks ?? []) line(u, m.at, inks[1] as string, m.text, true);
          view.cursors.forEach((cursor, i) => {
            const instant = cursor.peek();
            if (instant !== null) line(u, instant, inks[i] as string, i === 0 ? 'A' : 'B', false);
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
export function CursorTable({ view, curves, read, clock }: { view: PlotView; curves: readonly Curve[]; read: (curve: Curve, instant: number) => number | null; clock: (instant: number) => string }) {
  const [a, b] = [view.cursors[0].value, view.cursors[1].value];
  const title = (c: Curve) => `${c.name}, ${c.unit}`;
  const value = (c: Curve, instant: number | null) => (instant === null ? null : read(c, instant));
  return (
    <div class="scope-cursors">
      <div class="group" role="group" aria-label={t('Cursor that a click or the arrow keys place')}>
        {(['A', 'B'] as const).map((name, i) => (
          <button key={name} type="button" class="button small" aria-pressed={view.active.value === i} onClick={() => (view.active.value = i as 0 | 1)}>
            {name}
          </button>
        ))}
        <button type="button" class="button small" onClick={() => view.cursors.forEach((c) => (c.value = null))} disabled={a === null && b === null}>
          {t('None')}
        </button>
      </div>
      {a === null && b === null ? (
        <span class="where">{t('Click into the plot to place cursor {n}.', { n: view.active.value === 0 ? 'A' : 'B' })}</span>
      ) : (
        <div class="scroll">
          <table class="cursor-table">
            <thead>
              <tr>
                <th scope="col">{t('Cursor')}</th>
                <th scope="col">{t('Time')}</th>
                {curves.map((c) => (
                  <th key={c.id} scope="col">
                    {title(c)}
                  </th>
                ))}
              </tr>
            </thead>
            <tbody>
              {[a, b].map((instant, i) => (
                <tr key={i}>
                  <th scope="row">{i === 0 ? 'A' : 'B'}</th>
                  <td class="mono" data-label={t('Time')}>
                    {instant === null ? '–' : clock(instant)}
                  </td>
                  {curves.map((c) => (
                    <td key={c.id} class="mono" data-label={title(c)}>
                      {formatNumber(value(c, instant), 3)}
                    </td>
                  ))}
                </tr>
              ))}
              {a !== null && b !== null && (
                <tr>
                  <th scope="row">B − A</th>
                  <td class="mono" data-label={t('Time')}>
                    {formatNumber(b - a, 3)} s
                  </td>
                  {curves.map((c) => {
                    const [p, q] = [value(c, a), value(c, b)];
                    return (
                      <td key={c.id} class="mono" data-label={title(c)}>
                        {formatNumber(p === null || q === null ? null : q - p, 3)}
                      </td>
                    );
                  })}
                </tr>
              )}
            </tbody>
          </table>
        </div>
      )}
    </div>
  );
}

/** Closer, further, left, right, all: what a drag and the keys do, for a finger. */
export function PlotButtons({ view }: { view: PlotView }) {
  const [r, w] = [view.range.value, view.whole.value];
  const all = r[1] - r[0] >= w[1] - w[0] - 1e-9;
  return (
    <div class="group" role="group" aria-label={t('Part of time')}>
      <button type="button" class="button small" onClick={() => view.pan(-0.5)} disabled={r[0] <= w[0]} aria-label={t('Earlier')} title={t('Earlier (Page up)')}>
        ←
      </button>
      <button type="button" class="button small" onClick={() => view.zoom(0.5)} title={t('Closer (+); or drag over a part of the plot')}>
        {t('Closer')}
      </button>
      <button type="button" class="button small" onClick={() => view.zoom(2)} disabled={all} title={t('Further (-)')}>
        {t('Further')}
      </button>
      <button type="button" class="button small" onClick={() => view.all()} disabled={all} title={t('All of it (0, or a double click)')}>
        {t('All')}
      </button>
      <button type="button" class="button small" onClick={() => view.pan(0.5)} disabled={r[1] >= w[1]} aria-label={t('Later')} title={t('Later (Page down)')}>
        →
      </button>
    </div>
  );
}
