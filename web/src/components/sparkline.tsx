// Sparkline: the position of the last 30 s, on a canvas. In: the axis' history. Out: a line; a gap where nothing was known.
// Drawn at most ten times a second, once a second where motion is to be reduced, and not at all while it is off the screen.
import { t } from '../language';
import { useEffect, useRef } from 'preact/hooks';
import { useGateway } from '../gateway';
import { dark } from '../state/theme';

const window_ms = 30_000;

export function Sparkline({ axis }: { axis: string }) {
  const { store } = useGateway();
  const canvas = useRef<HTMLCanvasElement>(null);

  useEffect(() => {
    const c = canvas.current;
    const g = c?.getContext?.('2d');
    if (!c || !g) return;
    let seen = true;
    let color = '';
    let width = 0;
    let height = 0;
    const measure = () => {
      const ratio = globalThis.devicePixelRatio || 1;
      width = c.clientWidth;
      height = c.clientHeight;
      c.width = Math.round(width * ratio);
      c.height = Math.round(height * ratio);
      g.setTransform(ratio, 0, 0, ratio, 0, 0);
      draw();
    };
    const draw = () => {
      if (!seen || document.hidden || width === 0) return;
      color = getComputedStyle(c).color;
      g.clearRect(0, 0, width, height);
      const now = Date.now() + store.clockOffset_ms;
      const history = store.history(axis).since(now - window_ms);
      if (history.at.length === 0) return;
      let low = Infinity;
      let high = -Infinity;
      for (const p of history.position) {
        if (p === null) continue;
        low = Math.min(low, p);
        high = Math.max(high, p);
      }
      if (low > high) return;
      const flat = high - low < 1e-9;
      const pad = 3;
      const x = (t: number) => width - ((now - t * 1000) / window_ms) * width;
      const y = (p: number) => (flat ? height / 2 : pad + (1 - (p - low) / (high - low)) * (height - 2 * pad));
      g.strokeStyle = color;
      g.lineWidth = 1.5;
      g.lineJoin = 'round';
      g.beginPath();
      let pen = false;
      let lastY = 0;
      for (let i = 0; i < history.at.length; i += 1) {
        const p = history.position[i];
        if (p === null || p === undefined) {
          pen = false;
          continue;
        }
        const px = x(history.at[i] as number);
        lastY = y(p);
        if (pen) g.lineTo(px, lastY);
        else g.moveTo(px, lastY);
        pen = true;
      }
      // The newest value holds until now, as long as it is live.
      const entry = store.axis(axis)?.peek();
      if (pen && entry && store.trustOf(entry) === 'live') g.lineTo(width, lastY);
      g.stroke();
    };
    measure();
    const slow = globalThis.matchMedia?.('(prefers-reduced-motion: reduce)').matches;
    const timer = setInterval(draw, slow ? 1000 : 100);
    const sizes = new ResizeObserver(measure);
    sizes.observe(c);
    const sight = new IntersectionObserver((all) => (seen = all.at(-1)?.isIntersecting ?? true));
    sight.observe(c);
    const themed = dark.subscribe(() => requestAnimationFrame(draw));
    return () => {
      clearInterval(timer);
      sizes.disconnect();
      sight.disconnect();
      themed();
    };
  }, [axis, store]);

  return <canvas ref={canvas} class="sparkline" role="img" aria-label={t('Position of {axis} over the last 30 seconds', { axis })} />;
}
