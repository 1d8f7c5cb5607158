// Geometry of the register map: rows of registers, what lies in which cell, what fits where, whom a place collides with, and where the keyboard goes.
// In: spans of one table of one unit, how many registers a row has. Out: rows, cells, verdicts. Pure: knows neither mappings nor pixels.
// Bounds: addresses 0 to 65535; runs of free rows are folded into one, so a map has at most a few rows more than it has entries.
import type { RegisterType } from './mapping';
import { widthOf } from './mapping';

export const places = 65536;
/** This many free rows in a row are drawn as they are; more are folded. */
const unfolded = 2;

/** Registers (or bits) from `address` on. */
export interface Span {
  address: number;
  width: number;
}
export interface Placed extends Span {
  key: string;
}
export type MapRow = { kind: 'row'; first: number } | { kind: 'gap'; first: number; last: number };
export const lastOf = (s: Span): number => s.address + s.width - 1;
export const blockAt = <S extends Span>(spans: readonly S[], address: number): S | null => spans.find((s) => s.address <= address && lastOf(s) >= address) ?? null;

/** Every row that has something in it, the one behind it, the first one, and those of `open`; what lies between is folded. */
export function rowsOf(spans: readonly Span[], perRow: number, open: readonly number[] = []): MapRow[] {
  const most = places / perRow;
  const used = new Set<number>([0]);
  for (const s of spans) for (let r = Math.floor(s.address / perRow); r <= Math.floor(lastOf(s) / perRow) + 1 && r < most; r += 1) used.add(r);
  for (const address of open) for (let r = Math.floor(address / perRow), n = 0; n < 4 && r + n < most; n += 1) used.add(r + n);
  const rows: MapRow[] = [];
  let next = 0;
  for (const r of [...used].sort((a, b) => a - b).concat(most)) {
    if (r - next <= unfolded) for (; next < r; next += 1) rows.push({ kind: 'row', first: next * perRow });
    else rows.push({ kind: 'gap', first: next * perRow, last: r * perRow - 1 });
    if (r < most) rows.push({ kind: 'row', first: r * perRow });
    next = r + 1;
  }
  return rows;
}

/** The number of the row that shows an address. */
export function rowAt(rows: readonly MapRow[], address: number): number {
  let low = 0;
  let high = rows.length - 1;
  while (low < high) {
    const middle = (low + high + 1) >> 1;
    if (rows[middle]!.first <= address) low = middle;
    else high = middle - 1;
  }
  return low;
}

/** A part of a span that lies in one row; the first part is its head. */
export interface Piece<T> {
  of: T;
  first: number;
  width: number;
  head: boolean;
  tail: boolean;
}
export type Cell<T> = ({ kind: 'piece' } & Piece<T>) | { kind: 'free'; first: number };

/** Pieces by the number of their row, first / perRow. */
export function piecesOf<T extends Span>(spans: readonly T[], perRow: number): Map<number, Piece<T>[]> {
  const all = new Map<number, Piece<T>[]>();
  for (const of of spans) {
    const end = Math.min(lastOf(of), places - 1);
    for (let first = of.address; first <= end; ) {
      const row = Math.floor(first / perRow);
      const last = Math.min(end, (row + 1) * perRow - 1);
      const own = all.get(row);
      const piece = { of, first, width: last - first + 1, head: first === of.address, tail: last === end };
      if (own) own.push(piece);
      else all.set(row, [piece]);
      first = last + 1;
    }
  }
  return all;
}

/** The cells of a row from left to right: what lies there, and each free register. */
export function cellsOf<T>(pieces: readonly Piece<T>[], first: number, perRow: number): Cell<T>[] {
  const cells: Cell<T>[] = [];
  let next = first;
  for (const p of [...pieces].sort((a, b) => a.first - b.first)) {
    for (; next < p.first; next += 1) cells.push({ kind: 'free', first: next });
    cells.push({ kind: 'piece', ...p });
    next = Math.max(next, p.first + p.width);
  }
  for (; next < first + perRow; next += 1) cells.push({ kind: 'free', first: next });
  return cells;
}

const nobody: ReadonlySet<string> = new Set();
/** Who has a place in common with the span; `except`: what is being carried away from there. */
export function takenBy<T extends Placed>(all: readonly T[], span: Span, except = nobody): T[] {
  return all.filter((o) => !except.has(o.key) && o.address <= lastOf(span) && lastOf(o) >= span.address);
}

/** Those who lie upon another one. */
export function overlapping<T extends Placed>(all: readonly T[]): ReadonlySet<string> {
  const found = new Set<string>();
  let widest: T | undefined;
  for (const s of [...all].sort((a, b) => a.address - b.address)) {
    if (widest && lastOf(widest) >= s.address) {
      found.add(widest.key);
      found.add(s.key);
    }
    if (!widest || lastOf(s) > lastOf(widest)) widest = s;
  }
  return found;
}

/** A shape: spans beside each other, counted from the first of them. */
export function shapeOf(spans: readonly Span[]): Span[] {
  const from = Math.min(...spans.map((s) => s.address));
  return spans.map((s) => ({ address: s.address - from, width: s.width }));
}
export interface Fit<T> {
  taken: T[];
  /** It would end behind the last address. */
  beyond: boolean;
}
export function fitOf<T extends Placed>(all: readonly T[], shape: readonly Span[], at: number, except = nobody): Fit<T> {
  const taken = new Set<T>();
  for (const s of shape) for (const o of takenBy(all, { address: at + s.address, width: s.width }, except)) taken.add(o);
  return { taken: [...taken], beyond: at < 0 || shape.some((s) => at + lastOf(s) >= places) };
}

/** The first place from `from` on where the shape fits; null: there is none. */
export function firstFit<T extends Placed>(all: readonly T[], shape: readonly Span[], from = 0, except = nobody): number | null {
  const sorted = all.filter((o) => !except.has(o.key)).sort((a, b) => a.address - b.address);
  for (let at = from; ; ) {
    const { taken, beyond } = fitOf(sorted, shape, at);
    if (beyond) return null;
    if (taken.length === 0) return at;
    // Behind the nearest end of whoever is in the way nothing was left out.
    at = Math.max(at + 1, Math.min(...taken.map((o) => lastOf(o) + 1 - Math.max(...shape.filter((s) => at + s.address <= lastOf(o) && at + lastOf(s) >= o.address).map((s) => s.address)))));
  }
}

const ladders: readonly RegisterType[][] = [['u16', 'u32', 'u64'], ['i16', 'i32', 'i64'], ['f32', 'f64']];
/** The type of the same kind that fills so many registers, or the next smaller one; a text has any length from 1 to 64. */
export function resized(m: { type: RegisterType; length?: number | undefined }, width: number): { type: RegisterType; length?: number } {
  if (m.type === 'string') return { type: 'string', length: Math.max(1, Math.min(64, width)) };
  const ladder = ladders.find((l) => l.includes(m.type));
  if (!ladder) return { type: m.type };
  return { type: ladder.filter((type) => widthOf(type) <= width).at(-1) ?? ladder[0]! };
}
/** One step wider (1) or narrower (-1); the same where there is none. */
export function nextSize(m: { type: RegisterType; length?: number | undefined }, way: 1 | -1): { type: RegisterType; length?: number } {
  if (m.type === 'string') return resized(m, (m.length ?? 16) + way);
  const ladder = ladders.find((l) => l.includes(m.type));
  return { type: ladder?.[ladder.indexOf(m.type) + way] ?? m.type };
}

export type Way = 'ArrowLeft' | 'ArrowRight' | 'ArrowUp' | 'ArrowDown' | 'Home' | 'End' | 'PageUp' | 'PageDown' | 'First' | 'Last';
const rowsPerPage = 6;
/** Where the keyboard goes from `at`: over an entry or a folded gap in one step, over free places one by one. `loose`: one by one everywhere. */
export function stepTo<T extends Span>(rows: readonly MapRow[], spans: readonly T[], perRow: number, at: number, way: Way, loose = false): number {
  const r = rowAt(rows, at);
  const row = rows[r]!;
  const under = (a: number): Span => {
    const here = rows[rowAt(rows, a)]!;
    if (here.kind === 'gap') return { address: here.first, width: here.last - here.first + 1 };
    return (loose ? undefined : spans.find((s) => s.address <= a && lastOf(s) >= a)) ?? { address: a, width: 1 };
  };
  const column = row.kind === 'gap' ? 0 : at - row.first;
  const inRow = (n: number): number => {
    const there = rows[Math.max(0, Math.min(rows.length - 1, n))]!;
    return there.kind === 'gap' ? there.first : there.first + column;
  };
  switch (way) {
    case 'ArrowRight': {
      const next = lastOf(under(at)) + 1;
      return next >= places ? at : under(next).address;
    }
    case 'ArrowLeft': {
      const next = under(at).address - 1;
      return next < 0 ? at : under(next).address;
    }
    case 'ArrowUp': return inRow(r - 1);
    case 'ArrowDown': return inRow(r + 1);
    case 'PageUp': return inRow(r - rowsPerPage);
    case 'PageDown': return inRow(r + rowsPerPage);
    case 'Home': return row.first;
    case 'End': return row.kind === 'gap' ? row.first : row.first + perRow - 1;
    case 'First': return 0;
    case 'Last': {
      const last = spans.reduce((n, s) => Math.max(n, s.address), 0);
      return last;
    }
  }
}
