// Mapping scroll: which rows of the register map are in sight, how many registers a row has room for, and which place is under a point of the screen. In: the elements
// of the map, its rows. Out: signals; a handle for whoever drags over it.
import { batch, useSignal, type Signal } from '@preact/signals';
import { useLayoutEffect, useRef } from 'preact/hooks';
import { rowAt, type MapRow } from '../text/mapping-geometry';

export const rowHeight_px = 78;
const beyond = 3; // rows drawn out of sight, above and below

/** For whoever drags over it. */
export interface MapHandle {
  /** The address under a point of the screen; `gap`: of a folded row. null: beside the map. */
  hit: (x: number, y: number) => { address: number; gap: boolean } | null;
  /** At its edge the map scrolls under what is dragged. */
  nudge: (y: number) => void;
  show: (address: number) => void;
  focus: () => void;
}

interface Scrolled {
  scroller: { current: HTMLDivElement | null };
  content: { current: HTMLDivElement | null };
  perRow: Signal<number>;
  /** The rows that are drawn. */
  view: Signal<{ first: number; rows: number }>;
  /** To be told with each picture. */
  now: { current: { rows: readonly MapRow[]; perRow: number } };
}

export function useScrolled(handle: { current: MapHandle | null }): Scrolled {
  const scroller = useRef<HTMLDivElement>(null);
  const content = useRef<HTMLDivElement>(null);
  const perRow = useSignal(8);
  const view = useSignal({ first: 0, rows: 10 });
  const now = useRef<Scrolled['now']['current']>({ rows: [], perRow: 8 });
  useLayoutEffect(() => {
    const box = scroller.current;
    if (!box) return;
    const measure = () => {
      const width = box.clientWidth;
      batch(() => {
        perRow.value = width > 0 && width < 520 ? 4 : 8;
        look();
      });
    };
    const look = () => {
      const first = Math.max(0, Math.floor(box.scrollTop / rowHeight_px) - beyond);
      const count = Math.ceil((box.clientHeight || 640) / rowHeight_px) + 2 * beyond + 1;
      const v = view.peek();
      if (v.first !== first || v.rows !== count) view.value = { first, rows: count };
    };
    measure();
    const end = new AbortController();
    box.addEventListener('scroll', look, { passive: true, signal: end.signal });
    const watch = typeof ResizeObserver === 'undefined' ? null : new ResizeObserver(measure);
    watch?.observe(box);
    const hit: MapHandle['hit'] = (x, y) => {
      const c = content.current;
      const frame = box.getBoundingClientRect();
      if (!c || x < frame.left || x > frame.right || y < frame.top || y > frame.bottom) return null;
      const r = c.getBoundingClientRect();
      const head = c.querySelector<HTMLElement>('[role=rowheader]')?.offsetWidth ?? 0;
      const row = now.current.rows[Math.floor((y - r.top) / rowHeight_px)];
      const column = Math.floor(((x - r.left - head) / Math.max(1, r.width - head)) * now.current.perRow);
      if (!row || column >= now.current.perRow) return null;
      return row.kind === 'gap' ? { address: row.first, gap: true } : { address: row.first + Math.max(0, column), gap: false };
    };
    const show = (address: number) => {
      const top = rowAt(now.current.rows, address) * rowHeight_px;
      if (top < box.scrollTop) box.scrollTop = top;
      else if (top + rowHeight_px > box.scrollTop + box.clientHeight) box.scrollTop = top + rowHeight_px - box.clientHeight;
      look();
    };
    handle.current = {
      hit,
      show,
      focus: () => box.focus({ preventScroll: true }),
      nudge: (y) => {
        const frame = box.getBoundingClientRect();
        const edge = 28;
        if (y > frame.bottom - edge) box.scrollTop += 16;
        else if (y < frame.top + edge) box.scrollTop -= 16;
      },
    };
    return () => {
      end.abort();
      watch?.disconnect();
      handle.current = null;
    };
  }, []);
  return { scroller, content, perRow, view, now };
}
