// Plot options: how uPlot draws the curves of a plot: its scales, its sides, and what lies over them (cursors, marks, levels). In: what is to be drawn, the
// element that it is drawn in. Out: options for uPlot. Colours are custom properties, read when a plot is made: a new theme makes a new plot.
import uPlot from 'uplot';
import { t } from '../language';
import { spread, within, type Range } from '../state/plot';
import type { PlotView } from '../state/plot-view';
import { tickLabels } from '../text/number';

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
export interface Drawing {
  curves: readonly Curve[];
  view: PlotView;
  /** Words at the time axis. */
  timeText: (instant: number, end: number, span: number) => string;
  /** May be zoomed and moved. */
  zoomable?: boolean;
  /** Instants with a word. */
  marks?: readonly Mark[];
  /** Values with a word, each on the scale of the curves that it belongs to. */
  levels?: readonly Level[];
}

export function optionsFor(host: HTMLElement, latest: { current: Drawing }): uPlot.Options {
  const { curves, view, zoomable } = latest.current;
  const color = (name: string) => colorOf(host, name);
  const grid = { stroke: color('--line'), width: 1 };
  const style = { stroke: color('--text-3'), font: '11px ' + getComputedStyle(host).fontFamily, grid, ticks: { show: false } };
  const scales = [...new Set(curves.map((c) => c.scale))].map((id) => ({ id, own: curves.filter((c) => c.scale === id) }));
  const stepped = uPlot.paths.stepped?.({ align: 1 });
  return {
    width: host.clientWidth || 600,
    height: host.clientHeight || 280,
    legend: { show: false },
    cursor: { drag: { x: zoomable === true, y: false, setScale: false, dist: 5 }, points: { show: false } },
    padding: [8, 4, 0, 4],
    scales: { x: { time: false }, ...Object.fromEntries(scales.map(({ id, own }) => [id, scaleFor(own)])) },
    series: [
      {},
      ...[...curves].reverse().map((c) => ({ scale: c.scale, label: `${c.name}, ${c.unit}`, stroke: color(c.color), width: c.width ?? 1.25, points: { show: false }, ...(c.dash ? { dash: c.dash } : {}), ...(c.stepped && stepped ? { paths: stepped } : {}) })),
    ],
    axes: [timeAxis(style, latest), ...scales.map(({ id, own }, n) => ({ ...style, ...sideFor(own), stroke: color(own[0]!.color), labelFont: style.font, scale: id, side: n === 0 ? 3 : 1, grid: n === 0 ? grid : { show: false } }))],
    hooks: {
      setSelect: [
        (u) => {
          if (u.select.width < 5) return;
          const picked: Range = [u.posToVal(u.select.left, 'x'), u.posToVal(u.select.left + u.select.width, 'x')];
          u.setSelect({ left: 0, top: 0, width: 0, height: 0 }, false);
          view.range.value = within(picked, view.whole.peek());
        },
      ],
      draw: [overlay(latest, color('--accent'), color('--text-2'))],
    },
  };
}

function colorOf(host: HTMLElement, name: string): string {
  const probe = document.createElement('span');
  probe.style.color = `var(${name})`;
  host.append(probe);
  const c = getComputedStyle(probe).color;
  probe.remove();
  return c;
}

function scaleFor(own: readonly Curve[]): uPlot.Scale {
  const least = Math.min(...own.map((c) => c.least ?? 0.5));
  return { range: (_u: uPlot, low: number | null, high: number | null) => spread(low, high, own.some((c) => c.withZero), least) };
}

/** The side says what it measures, in the colour of its line; of several on one side the most important one gives the colour. */
function sideFor(own: readonly Curve[]): uPlot.Axis {
  const names = [...new Set(own.map((c) => c.name))];
  return {
    label: `${names.length > 3 ? t('{n} curves', { n: names.length }) : names.join(', ')}, ${own[0]!.unit}`,
    labelSize: 16,
    labelGap: 0,
    size: wideEnough(),
    space: 44,
    values: (_u: uPlot, at: number[]) => tickLabels(at),
  };
}

function timeAxis(style: uPlot.Axis, latest: { current: Drawing }): uPlot.Axis {
  return {
    ...style,
    size: 26,
    splits: (u, _i, min, max) => {
      const parts = u.width < 500 ? 2 : 5; // on a phone more of them would lie upon each other
      return Array.from({ length: parts + 1 }, (_, i) => max - ((max - min) * (parts - i)) / parts);
    },
    values: (u, at) => at.map((instant) => latest.current.timeText(instant, u.scales.x?.max ?? instant, (u.scales.x?.max ?? instant) - (u.scales.x?.min ?? instant))),
  };
}

/** Levels, marks and cursors, over the curves. */
function overlay(latest: { current: Drawing }, first: string, second: string): (u: uPlot) => void {
  return (u) => {
    const { levels = [], marks = [], view } = latest.current;
    for (const l of levels) level(u, l, second);
    for (const m of marks) instantLine(u, m.at, second, m.text, true);
    view.cursors.forEach((cursor, i) => {
      const instant = cursor.peek();
      if (instant !== null) instantLine(u, instant, i === 0 ? first : second, i === 0 ? 'A' : 'B', false);
    });
  };
}

/** A line through the plot in one ink, and what is written beside it. */
function ruled(u: uPlot, ink: string, dash: readonly number[], from: readonly [number, number], to: readonly [number, number], write: (c: CanvasRenderingContext2D) => void): void {
  const c = u.ctx;
  c.save();
  c.strokeStyle = c.fillStyle = ink;
  c.lineWidth = devicePixelRatio;
  c.setLineDash(dash.map((x) => x * devicePixelRatio));
  c.beginPath();
  c.moveTo(...from);
  c.lineTo(...to);
  c.stroke();
  write(c);
  c.restore();
}
function level(u: uPlot, l: Level, ink: string): void {
  if (!u.scales[l.scale]) return;
  const { left, top, width, height } = u.bbox;
  const y = Math.round(u.valToPos(l.value, l.scale, true));
  if (!(y >= top && y <= top + height)) return;
  ruled(u, ink, [8, 4], [left, y], [left + width, y], (c) => {
    c.textAlign = 'right';
    c.fillText(l.text, left + width - 4 * devicePixelRatio, y - 5 * devicePixelRatio);
  });
}
function instantLine(u: uPlot, instant: number, ink: string, text: string, dashed: boolean): void {
  const { left, top, width, height } = u.bbox;
  const x = Math.round(u.valToPos(instant, 'x', true));
  if (x < left || x > left + width) return;
  ruled(u, ink, dashed ? [4, 4] : [], [x, top], [x, top + height], (c) => c.fillText(text, x + 3 * devicePixelRatio, top + (dashed ? 24 : 12) * devicePixelRatio));
}

/** As wide as the longest figure beside the plot; never narrower again, so that the plot does not jump with every digit. */
function wideEnough(): (u: uPlot, figures: string[] | null, axis: number, cycle: number) => number {
  let width = 32;
  return (_u, figures, _axis, cycle) => {
    if (cycle <= 1) width = Math.max(width, ...(figures ?? []).map((f) => f.length * 6.5 + 12));
    return width;
  };
}
