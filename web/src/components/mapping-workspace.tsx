// Mapping workspace: palette, register map and panel as one: what is pressed, dragged and typed on the map becomes what is carried, and a change of the
// book when it is put down. In: the book, the blocks of one table. Out: the three parts side by side. Nothing is sent before something is put down;
// every change can be undone.
import { computed, signal, useSignal, type ReadonlySignal, type Signal } from '@preact/signals';
import { useEffect, useMemo, useRef } from 'preact/hooks';
import type { MappingBook } from '../state/mappings';
import { followPointer } from '../state/mapping-drag';
import { MapHand, type Carried, type Ground } from '../state/mapping-carry';
import type { Received } from '../state/register-look';
import { useGateway } from '../gateway';
import { t } from '../language';
import type { Base } from '../text/address';
import { sameMapping, tableOf, widthOf, type Known, type Mapping, type Table } from '../text/mapping';
import type { Block } from '../text/mapping-blocks';
import { lastOf, nextSize } from '../text/mapping-geometry';
import { isStandard } from '../text/register-map';
import { Tell, reportedOf, type Reported } from './form';
import { BlockCell } from './mapping-cell';
import { addAt, isUntouched, MappingForm, type Draft } from './mapping-form';
import { RegisterMap, type Ghost, type MapHandle } from './mapping-map';
import { MappingPalette } from './mapping-palette';
import { MappingPanel } from './mapping-panel';
import { Gate, useBarred } from './gate';

export interface WorkspaceProps {
  book: MappingBook;
  known: Known;
  blocks: readonly Block[];
  unit: number;
  table: Table;
  base: Base;
  /** Addresses that are shown though nothing stands there. */
  open: readonly number[];
  received: ReadonlySignal<ReadonlyMap<string, Received>>;
  reported: Signal<Reported>;
  seen: (blocks: readonly Block[]) => void;
  handle: { current: MapHandle | null };
  paletteAxis: Signal<string>;
  /** Why the unit as a whole takes no mappings; empty: it does. */
  fixed: string;
}
const empty: ReadonlySet<string> = new Set();

export function MappingWorkspace({ book, known, blocks, unit, table, base, open, received, reported, seen, handle, paletteAxis, fixed }: WorkspaceProps) {
  const { store } = useGateway();
  const no = useBarred('engineer');
  const ground = useMemo(() => signal<Ground>({ unit, table, blocks, base, barred: fixed }), []);
  ground.value = { unit, table, blocks, base, barred: no.disabled ? (no.title ?? t('This is not changed here.')) : fixed };
  const hand = useMemo(() => new MapHand(book, ground), [book, ground]);
  const cursor = useSignal(blocks[0]?.address ?? 0);
  const selected = useMemo(() => signal<ReadonlySet<string>>(empty), []);
  const editing = useSignal<{ of: Mapping; focus: boolean } | null>(null);
  const last = useRef({ blocks, unit, table });
  last.current = { blocks, unit, table };
  const axes = store.axisNames.value;
  const copyTo = axes.includes(paletteAxis.value) ? paletteAxis.value : (axes[0] ?? '');
  // Another table is another map: nothing of the former one is chosen or carried there.
  useEffect(() => {
    selected.value = empty;
    cursor.value = last.current.blocks[0]?.address ?? 0;
    return () => hand.putBack();
  }, [unit, table, hand]);

  // What was moved, undone or changed by somebody else: its form follows, unless something was typed in it.
  const drafts = useMemo(() => new Map<string, Draft>(), []);
  const rows = book.rows.value;
  useEffect(() => {
    const e = editing.peek();
    const now = e && rows.find((m) => m.id === e.of.id);
    if (!e || sameMapping(now, e.of) || !isUntouched(drafts.get(e.of.id), e.of)) return;
    drafts.delete(e.of.id);
    editing.value = now ? { of: now, focus: false } : null;
  }, [rows]);

  const lifted = useMemo(() => computed((): ReadonlySet<string> => {
    const w = hand.carry.value?.what;
    return w?.kind === 'move' ? new Set(w.own.map((m) => m.id)) : w?.kind === 'resize' ? new Set([w.own.id]) : empty;
  }), [hand]);
  const ghost = useMemo(() => computed((): Ghost | null => {
    const c = hand.carry.value;
    const fit = hand.fit.value;
    if (!c || c.at === null || !fit) return null;
    const at = c.at;
    const fits = fit.taken.length === 0 && !fit.beyond && ground.value.barred === '';
    const text = c.what.kind === 'new' ? c.what.point : c.what.kind === 'resize' ? c.what.own.point : c.what.own.length === 1 ? c.what.own[0]!.point : t('{n} mappings', { n: c.what.own.length });
    return { spans: c.shape.map((s) => ({ address: s.address + at, width: s.width })), fits, text: fits ? text : t('{what}: taken', { what: text }) };
  }), [hand]);

  const chosen = blocks.filter((b) => selected.value.has(b.key));
  const owned = (all: readonly Block[]): Mapping[] => all.flatMap((b) => (b.mapping ? [b.mapping] : []));
  /** What a press on this block takes: all that is chosen, if it is among them. */
  const groupOf = (b: Block): Mapping[] => (selected.peek().has(b.key) ? owned(last.current.blocks.filter((x) => selected.peek().has(x.key))) : owned([b]));
  const putDown = async () => {
    const outcome = await hand.putDown();
    if (outcome) reported.value = reportedOf(outcome);
  };
  const remove = async (gone: readonly Mapping[]) => {
    if (gone.length === 0 || no.disabled) return;
    reported.value = { tone: 'busy', text: t('Removing …') };
    if (gone.some((m) => m.id === editing.peek()?.of.id)) editing.value = null;
    reported.value = reportedOf(await book.removeAll(gone));
  };
  const pickUp = (what: Carried, from = cursor.peek()) => {
    if (ground.peek().barred) return void (reported.value = { tone: 'refused', text: ground.peek().barred });
    hand.pickAtFit(what, from);
    const at = hand.carry.peek()?.at ?? 0;
    cursor.value = at;
    handle.current?.show(at);
    handle.current?.focus();
  };
  const choose = (b: Block | null, add: boolean) => {
    if (!b) return void (selected.value = empty);
    const next = new Set(add ? selected.peek() : []);
    if (add && next.has(b.key)) next.delete(b.key);
    else next.add(b.key);
    selected.value = next;
  };
  const click = (address: number, b: Block | null, add: boolean) => {
    if (hand.carry.peek()?.by === 'hand') {
      hand.over(address);
      return void putDown();
    }
    cursor.value = address;
    choose(b, add);
    if (b?.mapping && !add) editing.value = { of: b.mapping, focus: false };
    if (!b && !no.disabled && !fixed) {
      editing.value = null;
      addAt(unit, table, address, false);
    }
    if (b && innerWidth < 900) document.querySelector('.map-panel')?.scrollIntoView({ block: 'nearest' });
  };
  const enter = (address: number, b: Block | null) => {
    if (hand.carry.peek()) return void putDown();
    choose(b, false);
    if (b?.mapping) editing.value = { of: b.mapping, focus: true };
    else if (!b && !no.disabled && !fixed) {
      editing.value = null;
      addAt(unit, table, address, true);
    }
  };
  const press = (e: PointerEvent, address: number, b: Block | null, onHandle: boolean) => {
    const copies = e.ctrlKey || e.metaKey;
    const adds = e.shiftKey;
    let grab = 0;
    followPointer(e, {
      finger: onHandle,
      start: () => {
        const m = b?.mapping;
        if (!m || ground.peek().barred || hand.carry.peek()) return false;
        const own = groupOf(b);
        grab = address - Math.min(...own.map((x) => x.address));
        if (onHandle) hand.pick({ kind: 'resize', own: m, width: widthOf(m.type, m.length) }, 'pointer', m.address);
        else hand.pick(copies ? { kind: 'copy', own, axis: copyTo } : { kind: 'move', own }, 'pointer', Math.min(...own.map((x) => x.address)));
        return true;
      },
      move: (x, y) => {
        handle.current?.nudge(y);
        const at = handle.current?.hit(x, y) ?? null;
        if (onHandle) at && hand.until(at.address);
        else hand.over(at === null ? null : at.gap ? at.address : Math.max(0, at.address - grab));
      },
      end: (dropped) => (dropped ? void putDown() : hand.putBack()),
      click: () => click(address, b, adds),
    });
  };
  const fromPalette = (e: PointerEvent, what: Carried) => {
    followPointer(e, {
      start: () => {
        if (ground.peek().barred) reported.value = { tone: 'refused', text: ground.peek().barred };
        else hand.pick(what, 'pointer');
        return ground.peek().barred === '';
      },
      move: (x, y) => {
        handle.current?.nudge(y);
        hand.over(handle.current?.hit(x, y)?.address ?? null);
      },
      end: (dropped) => (dropped ? void putDown() : hand.putBack()),
      click: () => pickUp(what),
    });
  };
  const resize = async (b: Block, way: 1 | -1) => {
    const m = b.mapping;
    if (!m || tableOf(table).bits || ground.peek().barred) return;
    const to = nextSize(m, way);
    hand.pick({ kind: 'resize', own: m, width: widthOf(m.type, m.length) }, 'pointer', m.address);
    hand.until(m.address + widthOf(to.type, to.length) - 1);
    await putDown();
  };
  const keyed = (e: KeyboardEvent, address: number, b: Block | null): boolean => {
    const carries = hand.carry.peek() !== null;
    if (e.ctrlKey || e.metaKey) return false;
    switch (e.key) {
      case 'Enter':
        enter(address, b);
        return true;
      case ' ':
        if (carries) void putDown();
        else if (b?.mapping) {
          const own = groupOf(b);
          if (ground.peek().barred) reported.value = { tone: 'refused', text: ground.peek().barred };
          else hand.pick({ kind: 'move', own }, 'hand', Math.min(...own.map((m) => m.address)));
          cursor.value = hand.carry.peek()?.at ?? address;
        }
        return true;
      case 'Delete': case 'Backspace':
        if (!carries && b) void remove(groupOf(b));
        return true;
      case '+': case '=':
        if (!carries && b) void resize(b, 1);
        return true;
      case '-':
        if (!carries && b) void resize(b, -1);
        return true;
      case 'c': case 'C':
        if (!carries && b?.mapping) pickUp({ kind: 'copy', own: groupOf(b), axis: copyTo }, lastOf(b) + 1);
        return true;
      default: return false;
    }
  };
  const walked = (address: number, withShift: boolean) => {
    if (hand.carry.peek()) return hand.over(address);
    const b = last.current.blocks.find((x) => x.address <= address && lastOf(x) >= address) ?? null;
    if (!withShift) choose(b, false);
    else if (b && !selected.peek().has(b.key)) choose(b, true);
  };
  const draw = useMemo(() => (b: Block) => <BlockCell block={b} received={received} points={known.points} />, [received, known.points]);
  const canResize = useMemo(() => (b: Block) => b.mapping !== undefined && !tableOf(b.table).bits && b.type !== 'bool', []);
  const carryText = hand.text();
  return (
    <>
      <p class="where with-keys" id="map-keys">
        {t('Arrow keys walk, Enter opens the form, Space picks up and puts down, + and − make wider and narrower, C copies, Delete removes, Shift chooses several, Escape puts back.')}
      </p>
      <Tell reported={carryText ? { tone: hand.fit.value && (hand.fit.value.taken.length > 0 || hand.fit.value.beyond) ? 'refused' : 'busy', text: carryText } : reported.value} field="grid-told" />
      <div
        class={`map-workspace${hand.carry.value ? ' is-carrying' : ''}`}
        onPointerMove={(e) => {
          if (e.pointerType === 'mouse' && hand.carry.peek()?.by === 'hand') {
            const at = handle.current?.hit(e.clientX, e.clientY);
            if (at) hand.over(at.address);
          }
        }}
      >
        <MappingPalette known={known} table={table} axis={paletteAxis} press={fromPalette} pick={(what) => pickUp(what)} />
        <RegisterMap
          label={t('{table} of unit {unit}', { table: tableOf(table).name, unit })}
          table={table}
          base={base}
          blocks={blocks}
          open={open}
          cursor={cursor}
          selected={selected}
          lifted={lifted}
          ghost={ghost}
          draw={draw}
          gapText={isStandard(unit) ? unusedText : freeText}
          freeWord={isStandard(unit) ? t('not used') : t('free')}
          canResize={canResize}
          handle={handle}
          press={press}
          activate={(address, b) => click(address, b, false)}
          keyed={keyed}
          walked={walked}
          loose={() => hand.carry.peek() !== null}
          seen={seen}
        />
        <MappingPanel
          chosen={chosen}
          received={received}
          points={known.points}
          copyTo={copyTo}
          remove={() => void remove(owned(chosen))}
          move={() => pickUp({ kind: 'move', own: owned(chosen) }, Math.min(...owned(chosen).map((m) => m.address)))}
          copy={() => pickUp({ kind: 'copy', own: owned(chosen), axis: copyTo }, Math.max(...chosen.map(lastOf)) + 1)}
          whole={(axis) => (selected.value = new Set(blocks.filter((b) => b.axis === axis && b.mapping).map((b) => b.key)))}
        >
          <Gate need="engineer">
            <MappingForm book={book} known={known} editing={editing.value?.of ?? null} focus={editing.value?.focus ?? false} drafts={drafts} done={() => (editing.value = null)} />
          </Gate>
        </MappingPanel>
      </div>
    </>
  );
}
const freeText = (place: string, n: number) => t('{place} free ({n})', { place, n });
const unusedText = (place: string, n: number) => t('{place} not used ({n})', { place, n });
