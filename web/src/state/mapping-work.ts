// Mapping work: what is pressed, dragged and typed on the register map becomes what is chosen, what is carried, and a change of the book when it is put down. In: the
// book, the ground (one table of one unit), pointers and keys with the address that they are at. Out: signals. Nothing is sent before something is put
// down; nothing is changed where the ground is barred, and why is told.
import { computed, signal, type ReadonlySignal, type Signal } from '@preact/signals';
import type { Ghost } from '../components/mapping-row';
import type { MapHandle } from '../components/mapping-scroll';
import { t } from '../language';
import { tableOf, widthOf, type Mapping } from '../text/mapping';
import type { Block } from '../text/mapping-blocks';
import { blockAt, lastOf, nextSize } from '../text/mapping-geometry';
import { MapHand, type Carried, type Ground } from './mapping-carry';
import { followPointer } from './mapping-drag';
import type { MappingBook } from './mappings';
import { reportedOf, type Reported } from './reported';
import { toggledIn } from './toggled';

const empty: ReadonlySet<string> = new Set();
export const owned = (blocks: readonly Block[]): Mapping[] => blocks.flatMap((b) => (b.mapping ? [b.mapping] : []));
const firstOf = (own: readonly Mapping[]) => Math.min(...own.map((m) => m.address));

export interface WorkAround {
  handle: { readonly current: MapHandle | null };
  reported: Signal<Reported>;
  /** The axis that copies are for. */
  copyTo: () => string;
  /** Takes a free place into the form for a new one. */
  add: (ground: Ground, address: number, focus: boolean) => void;
  /** Something there is chosen by a click: it is brought into sight. */
  chosen: () => void;
}

export class MapWork {
  readonly hand: MapHand;
  readonly cursor: Signal<number>;
  readonly selected = signal(empty);
  readonly editing: Signal<{ of: Mapping; focus: boolean } | null> = signal(null);
  readonly lifted: ReadonlySignal<ReadonlySet<string>>;
  readonly ghost: ReadonlySignal<Ghost | null>;

  constructor(private readonly book: MappingBook, private readonly ground: Signal<Ground>, private readonly around: WorkAround) {
    const hand = (this.hand = new MapHand(book, ground));
    this.cursor = signal(ground.peek().blocks[0]?.address ?? 0);
    this.lifted = computed(() => {
      const w = hand.carry.value?.what;
      return w?.kind === 'move' ? new Set(w.own.map((m) => m.id)) : w?.kind === 'resize' ? new Set([w.own.id]) : empty;
    });
    this.ghost = computed(() => {
      const c = hand.carry.value;
      const fit = hand.fit.value;
      if (!c || c.at === null || !fit) return null;
      const { at, what } = c;
      const fits = fit.taken.length === 0 && !fit.beyond && ground.value.barred === '';
      const text = what.kind === 'new' ? what.point : what.kind === 'resize' ? what.own.point : what.own.length === 1 ? what.own[0]!.point : t('{n} mappings', { n: what.own.length });
      return { spans: c.shape.map((s) => ({ address: s.address + at, width: s.width })), fits, text: fits ? text : t('{what}: taken', { what: text }) };
    });
  }

  /** Another table is another map: nothing of the former one is chosen or carried there. Out: how to end it. */
  begin(): () => void {
    this.selected.value = empty;
    this.cursor.value = this.ground.peek().blocks[0]?.address ?? 0;
    return () => this.hand.putBack();
  }

  async remove(gone: readonly Mapping[]): Promise<void> {
    const { reported } = this.around;
    if (gone.length === 0 || this.ground.peek().barred) return;
    reported.value = { tone: 'busy', text: t('Removing …') };
    if (gone.some((m) => m.id === this.editing.peek()?.of.id)) this.editing.value = null;
    reported.value = reportedOf(await this.book.removeAll(gone));
  }

  /** By hand, at the first place where it fits. */
  pickUp(what: Carried, from = this.cursor.peek()): void {
    if (this.isBarred()) return;
    this.hand.pickAtFit(what, from);
    const at = this.hand.carry.peek()?.at ?? 0;
    this.cursor.value = at;
    this.around.handle.current?.show(at);
    this.around.handle.current?.focus();
  }
  /** For the axis that copies are for, from the place behind `last` on. */
  copyUp(own: readonly Mapping[], last: number): void {
    this.pickUp({ kind: 'copy', own, axis: this.around.copyTo() }, last + 1);
  }

  /** By a click, a finger or a screen reader. `more`: beside what is chosen. */
  click(address: number, b: Block | null, more: boolean): void {
    if (this.hand.carry.peek()?.by === 'hand') {
      this.hand.over(address);
      return void this.putDown();
    }
    this.cursor.value = address;
    this.choose(b, more);
    if (!b || !more) this.open(address, b, false);
    if (b) this.around.chosen();
  }

  readonly press = (e: PointerEvent, address: number, b: Block | null, onHandle: boolean): void => {
    const { hand } = this;
    const { shiftKey } = e;
    const copies = e.ctrlKey || e.metaKey;
    let grab = 0;
    const start = () => {
      const m = b?.mapping;
      if (!m || this.ground.peek().barred || hand.carry.peek()) return false;
      const own = this.groupOf(b);
      grab = address - firstOf(own);
      if (onHandle) this.grip(m);
      else hand.pick(copies ? { kind: 'copy', own, axis: this.around.copyTo() } : { kind: 'move', own }, 'pointer', firstOf(own));
      return true;
    };
    const over = (at: Hit) => {
      if (onHandle) at && hand.until(at.address);
      else hand.over(at === null ? null : at.gap ? at.address : Math.max(0, at.address - grab));
    };
    this.drag(e, start, over, () => this.click(address, b, shiftKey), onHandle);
  };
  readonly fromPalette = (e: PointerEvent, what: Carried): void => {
    const start = () => {
      if (this.isBarred()) return false;
      this.hand.pick(what, 'pointer');
      return true;
    };
    this.drag(e, start, (at) => this.hand.over(at?.address ?? null), () => this.pickUp(what), false);
  };

  /** A key that is not for walking; false: it is for nothing here. */
  readonly keyed = (e: Pick<KeyboardEvent, 'key' | 'ctrlKey' | 'metaKey'>, address: number, b: Block | null): boolean => {
    if (e.ctrlKey || e.metaKey) return false;
    const carries = this.hand.carry.peek() !== null;
    const free = carries ? null : b;
    switch (e.key) {
      case 'Enter':
        if (carries) void this.putDown();
        else {
          this.choose(b, false);
          this.open(address, b, true);
        }
        return true;
      case ' ':
        if (carries) void this.putDown();
        else if (b?.mapping) this.lift(address, b);
        return true;
      case 'Delete': case 'Backspace':
        if (free) void this.remove(this.groupOf(free));
        return true;
      case '+': case '=': case '-':
        if (free) void this.resize(free, e.key === '-' ? -1 : 1);
        return true;
      case 'c': case 'C':
        if (free?.mapping) this.copyUp(this.groupOf(free), lastOf(free));
        return true;
      default: return false;
    }
  };
  /** The keyboard has gone somewhere. */
  readonly walked = (address: number, withShift: boolean): void => {
    if (this.hand.carry.peek()) return this.hand.over(address);
    const b = blockAt(this.ground.peek().blocks, address);
    if (!withShift) this.choose(b, false);
    else if (b && !this.selected.peek().has(b.key)) this.choose(b, true);
  };

  /** Whether nothing may be changed here, which is told. */
  private isBarred(): boolean {
    const { barred } = this.ground.peek();
    if (barred) this.around.reported.value = { tone: 'refused', text: barred };
    return barred !== '';
  }
  /** What a press on this block takes: all that is chosen, if it is among them. */
  private groupOf(b: Block): Mapping[] {
    const chosen = this.selected.peek();
    return owned(chosen.has(b.key) ? this.ground.peek().blocks.filter((x) => chosen.has(x.key)) : [b]);
  }
  private choose(b: Block | null, more: boolean): void {
    this.selected.value = !b ? empty : more ? toggledIn(this.selected.peek(), b.key) : new Set([b.key]);
  }
  private open(address: number, b: Block | null, focus: boolean): void {
    if (b?.mapping) this.editing.value = { of: b.mapping, focus };
    else if (!b && !this.ground.peek().barred) {
      this.editing.value = null;
      this.around.add(this.ground.peek(), address, focus);
    }
  }
  private async putDown(): Promise<void> {
    const outcome = await this.hand.putDown();
    if (outcome) this.around.reported.value = reportedOf(outcome);
  }
  private lift(address: number, b: Block): void {
    const own = this.groupOf(b);
    if (!this.isBarred()) this.hand.pick({ kind: 'move', own }, 'hand', firstOf(own));
    this.cursor.value = this.hand.carry.peek()?.at ?? address;
  }
  private grip(m: Mapping): void {
    this.hand.pick({ kind: 'resize', own: m, width: widthOf(m.type, m.length) }, 'pointer', m.address);
  }
  private async resize(b: Block, way: 1 | -1): Promise<void> {
    const m = b.mapping;
    const { table, barred } = this.ground.peek();
    if (!m || tableOf(table).bits || barred) return;
    const to = nextSize(m, way);
    this.grip(m);
    this.hand.until(m.address + widthOf(to.type, to.length) - 1);
    await this.putDown();
  }
  private drag(e: PointerEvent, start: () => boolean, over: (at: Hit) => void, click: () => void, finger: boolean): void {
    const map = () => this.around.handle.current;
    followPointer(e, {
      finger,
      start,
      move: (x, y) => {
        map()?.nudge(y);
        over(map()?.hit(x, y) ?? null);
      },
      end: (dropped) => (dropped ? void this.putDown() : this.hand.putBack()),
      click,
    });
  }
}
type Hit = ReturnType<MapHandle['hit']>;
