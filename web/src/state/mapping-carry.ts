// What is carried over the register map: a point from the palette, an entry that is moved or made wider, a block that is copied to another axis.
// In: what was picked up, and over which address it is. Out: whether it fits there, in words; a change of the book when it is put down.
// Nothing is sent before it is put down, and nothing at all where it does not fit; the Escape key puts it back first, before it stops anything.
import { computed, signal, type ReadonlySignal, type Signal } from '@preact/signals';
import { t } from '../language';
import { spanText, type Base } from '../text/address';
import { placeText, tableOf, widthOf, type Mapping, type MappingSpec, type RegisterType, type Table } from '../text/mapping';
import type { Block } from '../text/mapping-blocks';
import { firstFit, fitOf, lastOf, resized, shapeOf, type Fit, type Span } from '../text/mapping-geometry';
import type { MappingBook, Outcome } from './mappings';
import { held } from './typing';

export type Carried =
  | { kind: 'new'; axis: string; point: string; type: RegisterType; length?: number }
  | { kind: 'move'; own: readonly Mapping[] }
  | { kind: 'copy'; own: readonly Mapping[]; axis: string }
  | { kind: 'resize'; own: Mapping; width: number };

export interface Carry {
  what: Carried;
  /** By a pressed pointer, or picked up by a key or a click and put down by the next one. */
  by: 'pointer' | 'hand';
  shape: readonly Span[];
  /** Of its first register; null: it is over nothing. */
  at: number | null;
}
export interface Ground {
  unit: number;
  table: Table;
  blocks: readonly Block[];
  base: Base;
  /** Why nothing can be put here; empty: it can. */
  barred: string;
}

const widthIn = (table: Table, type: RegisterType, length?: number) => (tableOf(table).bits ? 1 : widthOf(type, length));

export class MapHand {
  readonly carry: Signal<Carry | null> = signal(null);
  readonly fit: ReadonlySignal<Fit<Block> | null>;

  constructor(private readonly book: MappingBook, readonly ground: Signal<Ground>) {
    this.fit = computed(() => {
      const c = this.carry.value;
      return c && c.at !== null ? fitOf(this.ground.value.blocks, c.shape, c.at, this.lifted(c)) : null;
    });
  }

  /** What is not in its own way. */
  private lifted(c: Carry): ReadonlySet<string> {
    return c.what.kind === 'move' ? new Set(c.what.own.map((m) => m.id)) : c.what.kind === 'resize' ? new Set([c.what.own.id]) : new Set();
  }

  pick(what: Carried, by: Carry['by'], at: number | null = null): void {
    const { table } = this.ground.peek();
    const spans: Span[] = what.kind === 'new' ? [{ address: 0, width: widthIn(table, what.type, what.length) }] : what.kind === 'resize' ? [{ address: 0, width: what.width }] : what.own.map((m) => ({ address: m.address, width: widthIn(m.table, m.type, m.length) }));
    this.carry.value = { what, by, shape: shapeOf(spans), at };
    held.value = () => this.putBack();
  }
  /** The first place from `from` on where it fits, else `from`: where a key begins. */
  pickAtFit(what: Carried, from: number): void {
    this.pick(what, 'hand', from);
    const c = this.carry.peek()!;
    const free = firstFit(this.ground.peek().blocks, c.shape, from, this.lifted(c)) ?? firstFit(this.ground.peek().blocks, c.shape, 0, this.lifted(c));
    if (free !== null) this.over(free);
  }

  over(at: number | null): void {
    const c = this.carry.peek();
    if (c && c.what.kind !== 'resize' && c.at !== at) this.carry.value = { ...c, at };
  }
  /** The resized entry would end with this address. */
  until(last: number): void {
    const c = this.carry.peek();
    if (c?.what.kind !== 'resize') return;
    const { own } = c.what;
    const to = resized(own, last - own.address + 1);
    const width = widthOf(to.type, to.length);
    if (width !== c.what.width) this.carry.value = { ...c, what: { ...c.what, width }, shape: [{ address: 0, width }], at: own.address };
  }
  putBack(): void {
    this.carry.value = null;
    held.value = null;
  }

  /** "position of feeder over 4–5: free", "… taken by m1 (velocity of feeder, 4–5)". */
  text(): string {
    const c = this.carry.value;
    if (!c) return '';
    const what = carriedText(c.what);
    if (c.at === null) return t('{what}: put it on a free place', { what });
    const { table, base, barred } = this.ground.value;
    if (barred) return barred;
    const place = spanText(table, c.at, c.at + Math.max(...c.shape.map(lastOf)), base);
    const fit = this.fit.value;
    if (!fit || (fit.taken.length === 0 && !fit.beyond)) return t('{what} at {place}: free', { what, place });
    if (fit.taken.length === 0) return t('{what} at {place}: ends behind the last address', { what, place });
    const next = c.what.kind === 'resize' ? null : firstFit(this.ground.value.blocks, c.shape, c.at, this.lifted(c));
    const other = takenText(fit.taken, base);
    return next === null ? t('{what} at {place}: taken by {other}', { what, place, other }) : t('{what} at {place}: taken by {other}. Next free place: {free}', { what, place, other, free: spanText(table, next, next, base) });
  }

  /** null: it is over nothing, and is put back. */
  async putDown(): Promise<Outcome | null> {
    const c = this.carry.peek();
    const { unit, table, barred } = this.ground.peek();
    if (!c) return null;
    const text = this.text();
    const fit = this.fit.peek();
    const stays = c.what.kind === 'move' && c.at === Math.min(...c.what.own.map((m) => m.address));
    const same = c.what.kind === 'resize' && c.what.width === widthOf(c.what.own.type, c.what.own.length);
    if (c.at === null || stays || same) {
      this.putBack();
      return null;
    }
    if (barred || !fit || fit.taken.length > 0 || fit.beyond) {
      // By hand it stays there, to be carried on.
      if (c.by === 'pointer') this.putBack();
      return { good: false, text };
    }
    const at = c.at;
    this.putBack();
    switch (c.what.kind) {
      case 'new': {
        const { axis, point, type, length } = c.what;
        return this.book.add({ unit, table, address: at, axis, point, type: tableOf(table).bits ? 'bool' : type, ...(length ? { length } : {}) });
      }
      case 'resize': {
        const { own, width } = c.what;
        return this.book.replace(own.id, { ...specOf(own), ...resized(own, width) }, own, t('Resized {id}', { id: own.id }));
      }
      case 'move': {
        const from = Math.min(...c.what.own.map((m) => m.address));
        const [one] = c.what.own;
        if (one && c.what.own.length === 1) return this.book.replace(one.id, { ...specOf(one), address: at }, one, t('Moved {id}', { id: one.id }));
        return this.book.place(c.what.own.map((m) => ({ ...m, address: m.address - from + at })), t('Moved {n} mappings', { n: c.what.own.length }), c.what.own);
      }
      case 'copy': {
        const { own, axis } = c.what;
        const from = Math.min(...own.map((m) => m.address));
        return this.book.place(own.map((m) => ({ ...specOf(m), axis, unit, table, address: m.address - from + at })), own.length === 1 ? t('Copied {id} to {axis}', { id: own[0]!.id, axis }) : t('Copied {n} mappings to {axis}', { n: own.length, axis }));
      }
    }
  }
}

const specOf = ({ id: _, ...spec }: Mapping): MappingSpec => spec;
const carriedText = (w: Carried): string =>
  w.kind === 'new' ? t('{point} of {axis}', { point: w.point, axis: w.axis })
  : w.kind === 'resize' ? t('{id} as {type}', { id: w.own.id, type: resized(w.own, w.width).type })
  : w.kind === 'copy' ? (w.own.length === 1 ? t('Copy of {id} for {axis}', { id: w.own[0]!.id, axis: w.axis }) : t('Copy of {n} mappings for {axis}', { n: w.own.length, axis: w.axis }))
  : w.own.length === 1 ? t('{id}, {point} of {axis}', { id: w.own[0]!.id, point: w.own[0]!.point, axis: w.own[0]!.axis })
  : t('{n} mappings', { n: w.own.length });
export function takenText(taken: readonly Block[], base: Base): string {
  const first = taken.slice(0, 3).map((b) => t('{id} ({point} of {axis}, {place})', { id: b.mapping?.id ?? b.name, point: b.name, axis: b.axis, place: placeText(b, base) })).join(', ');
  return taken.length > 3 ? t('{list} and {n} more', { list: first, n: taken.length - 3 }) : first;
}
