// Scope: position, target and velocity over time. In: the axis' trail. Out: two plots on one time axis, newest at the right.
// Follows the gateway's clock; holds still when paused; a gap stays a gap. Redrawn at most 20 times a second (once with reduced motion).
import { useEffect, useRef } from 'preact/hooks';
import { signal } from '@preact/signals';
import uPlot from 'uplot';
import 'uplot/dist/uPlot.min.css';
import { useGateway } from '../gateway';
import { kept } from '../state/kept';
import { dark } from '../state/theme';
import { formatNumber } from '../words/number';

const windows = [10, 30, 120] as const;
const chosen = kept('scope.window', '30', 'browser');

export function Scope({ axis, unit }: { axis: string; unit: string }) {
  const { store } = useGateway();
  const box = useRef<HTMLDivElement>(null);
  const paused = useRef(signal(false)).current;
  const isDark = dark.value; // a new theme makes a new plot

  useEffect(() => {
    const host = box.current;
    if (!host || !document.createElement('canvas').getContext('2d')) return; // a browser that forbids canvases shows no plot
    const color = (name: string) => {
      const probe = document.createElement('span');
      probe.style.color = `var(${name})`;
      host.append(probe);
      const c = getComputedStyle(probe).color;
      probe.remove();
      return c;
    };
    const font = '11px ' + getComputedStyle(host).fontFamily;
    const grid = { stroke: color('--line'), width: 1 };
    const axisStyle = { stroke: color('--text-3'), font, grid, ticks: { show: false } };
    const plot = new uPlot(
      {
        width: host.clientWidth || 600,
        height: host.clientHeight || 280,
        legend: { show: false },
        cursor: { drag: { x: false, y: false }, points: { show: false } },
        padding: [8, 4, 0, 4],
        scales: {
          x: { time: false },
          p: { range: (_u, low, high) => spread(low, high) },
          v: { range: (_u, low, high) => spread(low, high, true) },
        },
        series: [
          {},
          { scale: 'p', stroke: color('--series-3'), width: 1.25, dash: [4, 4], points: { show: false } },
          { scale: 'p', stroke: color('--series-1'), width: 2, points: { show: false } },
          { scale: 'v', stroke: color('--series-2'), width: 1.25, points: { show: false } },
        ],
        axes: [
          { ...axisStyle, size: 26, splits: (_u, _i, min, max) => Array.from({ length: 6 }, (_, i) => max - ((max - min) * (5 - i)) / 5), values: (u, at) => at.map((t) => secondsBefore(t, u.scales.x?.max ?? t)) },
          { ...axisStyle, scale: 'p', size: 64, space: 44, values: (_u, at) => ticks(at) },
          { ...axisStyle, scale: 'v', side: 1, size: 56, space: 44, grid: { show: false }, values: (_u, at) => ticks(at) },
        ],
      },
      [[], [], [], []],
      host,
    );
    const draw = () => {
      if (paused.peek() || document.hidden) return;
      const seconds = Number(chosen.peek()) || 30;
      const now_ms = Date.now() + store.clockOffset_ms;
      const t = store.trail(axis).since(now_ms - seconds * 1000);
      const entry = store.axis(axis)?.peek();
      if (entry && store.trustOf(entry) === 'live' && t.at.length > 0) {
        // The newest values hold until now.
        t.at.push(now_ms / 1000);
        for (const column of [t.position, t.velocity, t.target]) column.push(column.at(-1) ?? null);
      }
      plot.batch(() => {
        plot.setData([t.at, t.target, t.position, t.velocity], false);
        plot.setScale('x', { min: now_ms / 1000 - seconds, max: now_ms / 1000 });
      });
    };
    draw();
    const slow = globalThis.matchMedia?.('(prefers-reduced-motion: reduce)').matches;
    const timer = setInterval(() => requestAnimationFrame(draw), slow ? 1000 : 50);
    const sizes = new ResizeObserver(() => plot.setSize({ width: host.clientWidth, height: host.clientHeight }));
    sizes.observe(host);
    return () => {
      clearInterval(timer);
      sizes.disconnect();
      plot.destroy();
    };
  }, [axis, store, isDark]);

  return (
    <div class="scope card">
      <div class="scope-head">
        <ul class="legend" aria-hidden="true">
          <li class="key key-1">Position, {unit}</li>
          <li class="key key-3">Target, {unit}</li>
          <li class="key key-2">Velocity, {unit}/s</li>
        </ul>
        <div class="group" role="group" aria-label="Time shown">
          {windows.map((w) => (
            <button key={w} type="button" class="button small" aria-pressed={chosen.value === String(w)} onClick={() => (chosen.value = String(w))}>
              {w < 60 ? `${w} s` : `${w / 60} min`}
            </button>
          ))}
        </div>
        <button type="button" class="button small hold" aria-pressed={paused.value} onClick={() => (paused.value = !paused.value)}>
          {paused.value ? 'Held' : 'Hold'}
        </button>
      </div>
      <div class="scope-plot" ref={box} role="img" aria-label={`Position, target and velocity of ${axis} over the last ${chosen.value} seconds`} />
    </div>
  );
}

/** Room above and below; never a range of nothing; velocity always shows its zero. */
function spread(low: number | null, high: number | null, withZero = false): [number, number] {
  if (low === null || high === null || !Number.isFinite(low) || !Number.isFinite(high)) return [-1, 1];
  const a = withZero ? Math.min(low, 0) : low;
  const b = withZero ? Math.max(high, 0) : high;
  const room = Math.max((b - a) * 0.1, Math.abs(b) * 1e-3, 0.5);
  return [a - room, b + room];
}

const secondsBefore = (t: number, now: number): string => {
  const s = Math.round((t - now) * 10) / 10;
  return s === 0 ? 'now' : `${s < 0 ? '−' : ''}${Math.abs(Math.round(s))} s`;
};

const ticks = (at: number[]): string[] => {
  const step = at.length > 1 ? Math.abs((at[1] as number) - (at[0] as number)) : 1;
  let decimals = 0;
  while (decimals < 3 && Math.abs(step * 10 ** decimals - Math.round(step * 10 ** decimals)) > 1e-6) decimals += 1;
  return at.map((v) => formatNumber(v, decimals));
};
