// Mapping row: one row of the register map: what stands at each of its places, or how much is free there; and what is carried, where it would lie. In: the pieces of the
// row. Out: cells of an ARIA grid. Drawn again only when something of its own has changed.
import type { ReadonlySignal } from '@preact/signals';
import { t } from '../language';
import { addressText, spanText } from '../text/address';
import { kindOf, type Block } from '../text/mapping-blocks';
import { cellsOf, lastOf, piecesOf, rowAt, type MapRow, type Piece, type Span } from '../text/mapping-geometry';
import type { MapProps } from './mapping-map';
import { rowHeight_px } from './mapping-scroll';
import { memo } from './memo';

export interface Ghost {
  spans: readonly Span[];
  fits: boolean;
  text: string;
}
export interface RowContext extends Pick<MapProps, 'table' | 'base' | 'selected' | 'lifted' | 'draw' | 'gapText' | 'freeWord' | 'canResize'> {
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
export const Row = memo(RowView, (a, b) => a.row.first === b.row.first && a.row.kind === b.row.kind && a.index === b.index && a.perRow === b.perRow && a.pieces === b.pieces && a.cursor === b.cursor && a.context === b.context && (a.row.kind === 'row' || (b.row.kind === 'gap' && a.row.last === b.row.last)));

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
export function GhostView({ ghost, rows, perRow }: { ghost: ReadonlySignal<Ghost | null>; rows: readonly MapRow[]; perRow: number }) {
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
