// Plot: curves over time with two cursors; the one plot of the page (uPlot draws). In: curves, columns on one time axis, the part of time that
// is seen. Out: a canvas; cursors by click and arrow keys; where it may be zoomed, by a drag, by + and -, by keys, and by a double click back.
// Never asks for data: who owns it draws again when there are more. A browser that forbids canvases shows no plot.
import { useEffect, useRef } from 'preact/hooks';
import uPlot from 'uplot';
import 'uplot/dist/uPlot.min.css';
import { PlotView } from '../state/plot-view';
import { dark } from '../state/theme';
import { optionsFor, type Drawing } from './plot-options';

export interface PlotProps extends Drawing {
  label: string;
  /** Asked for each picture; sets view.range itself where time runs. */
  data: () => uPlot.AlignedData;
  /** Time runs: drawn anew 20 times a second. */
  live?: boolean;
  /** Something to draw has changed. */
  version?: unknown;
  class?: string;
}

/** Kept as long as who shows the plot. */
export function usePlotView<V extends PlotView>(make: () => V): V {
  const view = useRef<V | null>(null);
  return (view.current ??= make());
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
    takePointer(plot, latest);
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

  return <div class={`scope-plot ${p.class ?? ''}`} ref={box} role="application" tabIndex={0} aria-label={p.label} onKeyDown={(e) => v.keyed(e, p.zoomable === true) && e.preventDefault()} />;
}

/** A click places a cursor, with Shift the second one; a drag, the wheel with Ctrl and a double click zoom. The listeners end with the plot. */
function takePointer(plot: uPlot, latest: { current: PlotProps }): void {
  const v = latest.current.view;
  const timeAt = (x: number) => plot.posToVal(x - plot.over.getBoundingClientRect().left, 'x');
  const place = (at: number, second: boolean) => {
    if (second) v.active.value = 1;
    v.put(timeAt(at));
  };
  plot.over.addEventListener('pointerdown', (e) => {
    if (e.button !== 0) return;
    const { clientX: begun, shiftKey } = e;
    if (!latest.current.zoomable) return place(begun, shiftKey);
    const end = (u: PointerEvent) => void (Math.abs(u.clientX - begun) <= 4 && place(begun, shiftKey)); // else a drag: it zooms
    plot.over.addEventListener('pointerup', end, { once: true });
  });
  plot.over.addEventListener(
    'wheel',
    (e) => {
      if (!latest.current.zoomable || !(e.ctrlKey || e.metaKey)) return; // a bare wheel scrolls the page
      e.preventDefault();
      v.zoom(e.deltaY > 0 ? 1.25 : 0.8, timeAt(e.clientX));
    },
    { passive: false },
  );
  plot.over.addEventListener('dblclick', () => latest.current.zoomable && v.all());
}
