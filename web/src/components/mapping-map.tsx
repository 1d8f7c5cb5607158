// Register map: rows of registers, with what stands in each. In: the blocks of one table, how a cell is drawn, where the keyboard is. Out: an ARIA grid
// with one place for the Tab key; clicks, presses and keys are told with the address that they are at. Draws the rows in sight and a few more, so that
// 65536 places cost no more than a screen; each row again only when something of its own has changed. Knows nothing of changing anything.
import { batch, useSignal, type ReadonlySignal, type Signal } from '@preact/signals';
import type { ComponentChildren } from 'preact';
import { useEffect, useId, useLayoutEffect, useMemo, useRef } from 'preact/hooks';
import { t } from '../language';
import { addressText, spanText, type Base } from '../text/address';
import type { Table } from '../text/mapping';
import { kindOf, type Block } from '../text/mapping-blocks';
import { cellsOf, lastOf, overlapping, piecesOf, rowAt, rowsOf, stepTo, type MapRow, type Piece, type Span, type Way } from '../text/mapping-geometry';
import { memo } from './memo';

export const rowHeight_px = 78;
const beyond = 3; // rows drawn out of sight, above and below

export interface Ghost {
  spans: readonly Span[];
  fits: boolean;
  text: string;
}
/** For whoever drags over it. */
export interface MapHandle {
  /** The address under a point of the screen; `gap`: of a folded row. null: beside the map. */
  hit: (x: number, y: number) => { address: number; gap: boolean } | null;
  /** At its edge the map scrolls under what is dragged. */
  nudge: (y: number) => void;
  show: (address: number) => void;
  focus: () => void;
}

export interface MapProps {
  label: string;
  table: Table;
  base: Base;
  blocks: readonly Block[];
  /** Addresses whose rows are drawn though nothing stands there. */
  open: readonly number[];
  cursor: Signal<number>;
  selected: ReadonlySignal<ReadonlySet<string>>;
  lifted: ReadonlySignal<ReadonlySet<string>>;
  ghost: ReadonlySignal<Ghost | null>;
  draw: (b: Block) => ComponentChildren;
  /** What a run of places without anything is, and what one of them is. */
  gapText: (place: string, count: number) => string;
  freeWord: string;
  canResize: (b: Block) => boolean;
  handle: { current: MapHandle | null };
  press: (e: PointerEvent, address: number, block: Block | null, onHandle: boolean) => void;
  /** Pressed without a pointer: by a screen reader. */
  activate: (address: number, block: Block | null) => void;
  /** A key that is not for walking; true: it was for something. */
  keyed: (e: KeyboardEvent, address: number, block: Block | null) => boolean;
  /** The keyboard has gone somewhere. */
  walked: (address: number, withShift: boolean) => void;
  /** Something is carried: it is carried place by place. */
  loose: () => boolean;
  seen: (blocks: readonly Block[]) => void;
}

interface RowContext extends Pick<MapProps, 'table' | 'base' | 'selected' | 'lifted' | 'draw' | 'gapText' | 'freeWord' | 'canResize'> {
  id: string;
  conflicts: ReadonlySet<string>;
}
interface RowProps {
  row: MapRow;
  index: number;
  perRow: number;
  pieces: readonly Piece<Block>[];
  cursor: number;
  context: RowContext;
}
const none: readonly Piece<Block>[] = [];

export function RegisterMap(p: MapProps) {
  const id = useId();
  const scroller = useRef<HTMLDivElement>(null);
  const content = useRef<HTMLDivElement>(null);
  const perRowNow = useSignal(8);
  const view = useSignal({ first: 0, rows: 10 });
  const perRow = perRowNow.value;
  const rows = useMemo(() => rowsOf(p.blocks, perRow, p.open), [p.blocks, perRow, p.open]);
  const pieces = useMemo(() => piecesOf(p.blocks, perRow), [p.blocks, perRow]);
  const conflicts = useMemo(() => overlapping(p.blocks), [p.blocks]);
  const context = useMemo<RowContext>(() => ({ id, conflicts, table: p.table, base: p.base, selected: p.selected, lifted: p.lifted, draw: p.draw, gapText: p.gapText, freeWord: p.freeWord, canResize: p.canResize }), [id, conflicts, p.table, p.base, p.selected, p.lifted, p.draw, p.gapText, p.freeWord, p.canResize]);
  const now = useRef({ rows, perRow, blocks: p.blocks });
  now.current = { rows, perRow, blocks: p.blocks };
  const blockAt = (address: number) => p.blocks.find((b) => b.address <= address && lastOf(b) >= address) ?? null;

  useLayoutEffect(() => {
    const box = scroller.current;
    if (!box) return;
    const measure = () => {
      const width = box.clientWidth;
      batch(() => {
        perRowNow.value = width > 0 && width < 520 ? 4 : 8;
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
    p.handle.current = {
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
      p.handle.current = null;
    };
  }, []);

  const shown = view.value;
  const first = Math.max(0, Math.min(shown.first, rows.length - 1));
  const last = Math.min(rows.length, first + shown.rows);
  useEffect(() => {
    const seen = new Set<Block>();
    for (const row of rows.slice(first, last)) for (const piece of pieces.get(row.first / perRow) ?? none) if (row.kind === 'row') seen.add(piece.of);
    p.seen([...seen]);
  }, [rows, pieces, first, last, perRow]);

  const cursor = p.cursor.value;
  const cursorRow = rowAt(rows, cursor);
  const cellAt = (address: number): number => {
    const row = rows[rowAt(rows, address)]!;
    if (row.kind === 'gap') return row.first;
    return (pieces.get(row.first / perRow) ?? none).find((x) => x.first <= address && x.first + x.width > address)?.first ?? address;
  };
  const key = (e: KeyboardEvent) => {
    if (e.altKey || (e.target as HTMLElement).closest('a, button, input, select')) return;
    const at = p.cursor.peek();
    const ways: Record<string, Way> = { Home: e.ctrlKey ? 'First' : 'Home', End: e.ctrlKey ? 'Last' : 'End' };
    const way = ways[e.key] ?? (/^(Arrow(Left|Right|Up|Down)|Page(Up|Down))$/.test(e.key) ? (e.key as Way) : undefined);
    if (way === undefined ? p.keyed(e, at, blockAt(at)) : !e.metaKey) {
      e.preventDefault();
      if (way === undefined) return;
      const next = stepTo(rows, p.blocks, perRow, at, way, p.loose());
      p.cursor.value = next;
      p.handle.current?.show(next);
      p.walked(next, e.shiftKey);
    }
  };
  const addressOf = (e: Event): number | null => {
    const cell = (e.target as HTMLElement).closest<HTMLElement>('[data-place]');
    return cell ? Number(cell.dataset.place) : null;
  };
  return (
    <div
      ref={scroller}
      class="card register-map"
      role="grid"
      tabIndex={0}
      aria-label={p.label}
      aria-rowcount={rows.length}
      aria-colcount={perRow + 1}
      aria-multiselectable="true"
      aria-activedescendant={cursorRow >= first && cursorRow < last ? `${id}-${cellAt(cursor)}` : undefined}
      data-per-row={perRow}
      onKeyDown={key}
      onPointerDown={(e) => {
        const at = addressOf(e);
        if (at === null || (e.target as HTMLElement).closest('a')) return;
        const under = p.handle.current?.hit(e.clientX, e.clientY)?.address ?? at;
        p.press(e, under, blockAt(under), (e.target as HTMLElement).closest('.map-handle') !== null);
      }}
      onClick={(e) => {
        const at = e.detail === 0 ? addressOf(e) : null;
        if (at !== null) p.activate(at, blockAt(at));
      }}
    >
      <div ref={content} class="map-content" role="presentation" style={{ height: `${rows.length * rowHeight_px}px` }}>
        {rows.slice(first, last).map((row, i) => (
          <Row key={row.first} row={row} index={first + i} perRow={perRow} pieces={row.kind === 'row' ? (pieces.get(row.first / perRow) ?? none) : none} cursor={first + i === cursorRow ? cellAt(cursor) : -1} context={context} />
        ))}
        <GhostView ghost={p.ghost} rows={rows} perRow={perRow} />
      </div>
    </div>
  );
}

function RowView({ row, index, perRow, pieces, cursor, context: c }: RowProps) {
  const head = (
    <div role="rowheader" aria-colindex={1} class="map-head mono">
      {addressText(c.table, row.first, c.base)}
    </div>
  );
  const place = { top: `${index * rowHeight_px}px` };
  if (row.kind === 'gap') {
    return (
      <div role="row" aria-rowindex={index + 1} class="map-row" style={place} data-columns={perRow}>
        {head}
        <div role="gridcell" id={`${c.id}-${row.first}`} aria-colindex={2} aria-colspan={perRow} class={`map-gap${cursor === row.first ? ' is-cursor' : ''}`} data-place={row.first} data-gap={row.last - row.first + 1}>
          {c.gapText(spanText(c.table, row.first, row.last, c.base), row.last - row.first + 1)}
        </div>
      </div>
    );
  }
  return (
    <div role="row" aria-rowindex={index + 1} class="map-row" style={place} data-columns={perRow}>
      {head}
      {cellsOf(pieces, row.first, perRow).map((cell) =>
        cell.kind === 'free' ? (
          <div key={cell.first} role="gridcell" id={`${c.id}-${cell.first}`} aria-colindex={cell.first - row.first + 2} class={`map-free${cursor === cell.first ? ' is-cursor' : ''}`} data-place={cell.first} style={{ gridColumn: `${cell.first - row.first + 2}` }}>
            <span class="mono">{addressText(c.table, cell.first, c.base)}</span> <span class="visually-hidden">{c.freeWord}</span>
          </div>
        ) : (
          <PieceView key={`${cell.of.key}/${cell.first}`} piece={cell} column={cell.first - row.first + 2} isCursor={cursor === cell.first} context={c} />
        ),
      )}
    </div>
  );
}
const Row = memo(RowView, (a, b) => a.row.first === b.row.first && a.row.kind === b.row.kind && a.index === b.index && a.perRow === b.perRow && a.pieces === b.pieces && a.cursor === b.cursor && a.context === b.context && (a.row.kind === 'row' || (b.row.kind === 'gap' && a.row.last === b.row.last)));

function PieceView({ piece, column, isCursor, context: c }: { piece: Piece<Block>; column: number; isCursor: boolean; context: RowContext }) {
  const b = piece.of;
  const on = c.selected.value.has(b.key);
  const marks = [
    `kind-${kindOf(b.type)}`,
    isCursor && 'is-cursor',
    on && 'is-selected',
    !b.mapping && 'is-fixed',
    b.access !== 'R' && 'is-written',
    c.lifted.value.has(b.key) && 'is-lifted',
    c.conflicts.has(b.key) && 'is-conflict',
    !piece.head && 'is-rest',
    !piece.tail && 'goes-on',
  ].filter(Boolean);
  const place = spanText(b.table, b.address, lastOf(b), c.base);
  return (
    <div
      role="gridcell"
      id={`${c.id}-${piece.first}`}
      aria-colindex={column}
      aria-colspan={piece.width}
      aria-selected={on}
      class={`map-cell ${marks.join(' ')}`}
      data-place={piece.first}
      data-block={piece.head ? b.key : undefined}
      data-mapping={piece.head ? b.mapping?.id : undefined}
      style={{ gridColumn: `${column} / span ${piece.width}` }}
    >
      {piece.head ? (
        <>
          <span class="visually-hidden">{place}: </span>
          {c.draw(b)}
          {c.conflicts.has(b.key) && <span class="flag">{t('lies upon another')}</span>}
        </>
      ) : (
        <span class="map-name mono">… {b.name}</span>
      )}
      {piece.tail && c.canResize(b) && <span class="map-handle" aria-hidden="true" />}
    </div>
  );
}

/** What is carried, where it would lie. */
function GhostView({ ghost, rows, perRow }: { ghost: ReadonlySignal<Ghost | null>; rows: readonly MapRow[]; perRow: number }) {
  const g = ghost.value;
  if (!g) return null;
  const parts = [...piecesOf(g.spans, perRow).values()].flat();
  return (
    <div class="map-ghosts" aria-hidden="true">
      {parts.map((x, i) => {
        const r = rowAt(rows, x.first);
        const row = rows[r]!;
        const column = row.kind === 'gap' ? 0 : x.first - row.first;
        return (
          <div key={x.first} class={`map-ghost${g.fits ? '' : ' is-taken'}`} style={{ top: `${r * rowHeight_px}px`, '--column': String(column), '--wide': String(x.width), '--columns': String(perRow) }}>
            {i === 0 ? g.text : ''}
          </div>
        );
      })}
    </div>
  );
}
