// Mapping workspace: palette, register map and panel as one: what is pressed, dragged and typed on the map becomes what is carried, and a change of the
// book when it is put down. In: the book, the blocks of one table. Out: the three parts side by side. Nothing is sent before something is put down;
// every change can be undone.
import { signal, type ReadonlySignal, type Signal } from '@preact/signals';
import { useEffect, useMemo, useRef } from 'preact/hooks';
import { useGateway } from '../gateway';
import { t } from '../language';
import type { Ground } from '../state/mapping-carry';
import { forgetDraft, isUntouched, type Drafts } from '../state/mapping-drafts';
import { MapWork, owned } from '../state/mapping-work';
import type { MappingBook } from '../state/mappings';
import type { Received } from '../state/register-look';
import type { Reported } from '../state/reported';
import type { Base } from '../text/address';
import { sameMapping, tableOf, type Known, type Table } from '../text/mapping';
import type { Block } from '../text/mapping-blocks';
import { lastOf } from '../text/mapping-geometry';
import { isStandard } from '../text/register-map';
import { Tell } from './form';
import { Gate, useBarred } from './gate';
import { BlockCell } from './mapping-cell';
import { addAt, MappingForm } from './mapping-form';
import { RegisterMap } from './mapping-map';
import type { MapHandle } from './mapping-scroll';
import { MappingPalette } from './mapping-palette';
import { MappingPanel } from './mapping-panel';

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

export function MappingWorkspace({ book, known, blocks, unit, table, base, open, received, reported, seen, handle, paletteAxis, fixed }: WorkspaceProps) {
  const { store } = useGateway();
  const no = useBarred('engineer');
  const here: Ground = { unit, table, blocks, base, barred: no.disabled ? (no.title ?? t('This is not changed here.')) : fixed };
  const ground = useMemo(() => signal(here), []);
  ground.value = here;
  const axes = store.axisNames.value;
  const copyTo = axes.includes(paletteAxis.value) ? paletteAxis.value : (axes[0] ?? '');
  const copies = useRef(copyTo);
  copies.current = copyTo;
  const work = useMemo(() => new MapWork(book, ground, { handle, reported, copyTo: () => copies.current, add: ({ unit, table }, address, focus) => addAt(unit, table, address, focus), chosen: showPanel }), [book, ground]);
  const { hand, editing, selected } = work;
  useEffect(() => work.begin(), [unit, table, work]);

  // What was moved, undone or changed by somebody else: its form follows, unless something was typed in it.
  const drafts: Drafts = useMemo(() => new Map(), []);
  const rows = book.rows.value;
  useEffect(() => {
    const e = editing.peek();
    const now = e && rows.find((m) => m.id === e.of.id);
    if (!e || sameMapping(now, e.of) || !isUntouched(drafts.get(e.of.id), e.of)) return;
    forgetDraft(e.of, drafts);
    editing.value = now ? { of: now, focus: false } : null;
  }, [rows]);

  const chosen = blocks.filter((b) => selected.value.has(b.key));
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
        <MappingPalette known={known} table={table} axis={paletteAxis} press={work.fromPalette} pick={(what) => work.pickUp(what)} />
        <RegisterMap
          label={t('{table} of unit {unit}', { table: tableOf(table).name, unit })}
          table={table}
          base={base}
          blocks={blocks}
          open={open}
          cursor={work.cursor}
          selected={selected}
          lifted={work.lifted}
          ghost={work.ghost}
          draw={draw}
          gapText={isStandard(unit) ? unusedText : freeText}
          freeWord={isStandard(unit) ? t('not used') : t('free')}
          canResize={canResize}
          handle={handle}
          press={work.press}
          activate={(address, b) => work.click(address, b, false)}
          keyed={work.keyed}
          walked={work.walked}
          loose={() => hand.carry.peek() !== null}
          seen={seen}
        />
        <MappingPanel
          chosen={chosen}
          received={received}
          points={known.points}
          copyTo={copyTo}
          remove={() => void work.remove(owned(chosen))}
          move={() => work.pickUp({ kind: 'move', own: owned(chosen) }, Math.min(...owned(chosen).map((m) => m.address)))}
          copy={() => work.copyUp(owned(chosen), Math.max(...chosen.map(lastOf)))}
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
/** On a narrow screen the panel lies below the map. */
const showPanel = () => void (innerWidth < 900 && document.querySelector('.map-panel')?.scrollIntoView({ block: 'nearest' }));
const freeText = (place: string, n: number) => t('{place} free ({n})', { place, n });
const unusedText = (place: string, n: number) => t('{place} not used ({n})', { place, n });
