// Register map: rows of registers, with what stands in each. In: the blocks of one table, how a cell is drawn, where the keyboard is. Out: an ARIA grid
// with one place for the Tab key; clicks, presses and keys are told with the address that they are at. Draws the rows in sight and a few more, so that
// 65536 places cost no more than a screen. Knows nothing of changing anything.
import type { ReadonlySignal, Signal } from '@preact/signals';
import type { ComponentChildren } from 'preact';
import { useEffect, useId, useMemo } from 'preact/hooks';
import type { Base } from '../text/address';
import type { Table } from '../text/mapping';
import type { Block } from '../text/mapping-blocks';
import { blockAt, overlapping, piecesOf, rowAt, rowsOf, stepTo, type Piece, type Way } from '../text/mapping-geometry';
import { GhostView, Row, type Ghost, type RowContext } from './mapping-row';
import { rowHeight_px, useScrolled, type MapHandle } from './mapping-scroll';

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

const none: readonly Piece<Block>[] = [];

export function RegisterMap(p: MapProps) {
  const id = useId();
  const { scroller, content, perRow: room, view, now } = useScrolled(p.handle);
  const perRow = room.value;
  const rows = useMemo(() => rowsOf(p.blocks, perRow, p.open), [p.blocks, perRow, p.open]);
  const pieces = useMemo(() => piecesOf(p.blocks, perRow), [p.blocks, perRow]);
  const conflicts = useMemo(() => overlapping(p.blocks), [p.blocks]);
  const context = useMemo<RowContext>(() => ({ id, conflicts, table: p.table, base: p.base, selected: p.selected, lifted: p.lifted, draw: p.draw, gapText: p.gapText, freeWord: p.freeWord, canResize: p.canResize }), [id, conflicts, p.table, p.base, p.selected, p.lifted, p.draw, p.gapText, p.freeWord, p.canResize]);
  now.current = { rows, perRow };
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
    if (way === undefined ? p.keyed(e, at, blockAt(p.blocks, at)) : !e.metaKey) {
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
        p.press(e, under, blockAt(p.blocks, under), (e.target as HTMLElement).closest('.map-handle') !== null);
      }}
      onClick={(e) => {
        const at = e.detail === 0 ? addressOf(e) : null;
        if (at !== null) p.activate(at, blockAt(p.blocks, at));
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
