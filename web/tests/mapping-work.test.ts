// What is done on the register map by keys and clicks: what is chosen, opened, carried and put down; nothing where it is barred. And what is typed for a mapping.
import { signal, type Signal } from '@preact/signals';
import { beforeEach, describe, expect, it, vi } from 'vitest';
import { MapWork } from '../src/state/mapping-work';
import { adding, draftFor, forgetDraft, isUntouched, placeNew, readyForNext, textsIn, typeIn, type Drafts } from '../src/state/mapping-drafts';
import type { Ground } from '../src/state/mapping-carry';
import { decodedUnit, sourceOf, valueShown, wholeWithin } from '../src/text/hmi-answer';
import type { Known, Mapping } from '../src/text/mapping';
import { blocksOf } from '../src/text/mapping-blocks';
import { mappingFacts } from '../src/text/mapping-facts';
import { blockAt } from '../src/text/mapping-geometry';
import { points } from './fixtures';

const m = (id: string, address: number, more: Partial<Mapping> = {}): Mapping => ({ id, unit: 2, table: 'holding_registers', address, axis: 'feeder', point: 'position', type: 'i32', word_order: 'high_first', scale: 1, offset: 0, access: 'R', ...more });
const rows = [m('a', 0), m('b', 4), m('c', 8, { axis: 'lift' })];
const known: Known = { axes: ['feeder', 'lift'], points, parameters: () => [] };

describe('on the map', () => {
  const good = async () => ({ good: true as const, text: 'done' });
  const book = { add: vi.fn(good), replace: vi.fn(good), place: vi.fn(good), removeAll: vi.fn(good) };
  const map = { show: vi.fn(), focus: vi.fn(), hit: vi.fn(), nudge: vi.fn() };
  const add = vi.fn();
  const reported = signal<{ tone: 'none' | 'busy' | 'good' | 'refused'; text: string }>({ tone: 'none', text: '' });
  let ground: Signal<Ground>;
  let work: MapWork;
  const at = (address: number) => blockAt(ground.value.blocks, address);
  const key = (k: string, address: number, ctrlKey = false) => work.keyed({ key: k, ctrlKey, metaKey: false }, address, at(address));
  beforeEach(() => {
    vi.clearAllMocks();
    reported.value = { tone: 'none', text: '' };
    ground = signal<Ground>({ unit: 2, table: 'holding_registers', blocks: blocksOf(2, 'holding_registers', rows, []), base: '0', barred: '' });
    work = new MapWork(book as never, ground, { handle: { current: map as never }, reported, copyTo: () => 'lift', add, chosen: vi.fn() });
  });

  it('a click chooses and opens; with Shift it chooses more; a free place goes into the form', () => {
    work.click(1, at(1), false);
    expect([[...work.selected.value], work.editing.value?.of.id, work.cursor.value]).toEqual([['a'], 'a', 1]);
    work.click(4, at(4), true);
    expect([[...work.selected.value], work.editing.value?.of.id]).toEqual([['a', 'b'], 'a']);
    work.click(4, at(4), true);
    expect([...work.selected.value]).toEqual(['a']);
    work.click(20, null, false);
    expect([work.selected.value.size, work.editing.value, add.mock.calls[0]!.slice(1)]).toEqual([0, null, [20, false]]);
  });
  it('Enter opens with the keyboard, Space picks up all that is chosen and puts it down, C copies to the other axis', async () => {
    expect(key('Enter', 5)).toBe(true);
    expect(work.editing.value).toMatchObject({ of: { id: 'b' }, focus: true });
    work.walked(0, true);
    expect([...work.selected.value]).toEqual(['b', 'a']);
    key(' ', 0);
    expect([...work.lifted.value]).toEqual(['a', 'b']);
    work.walked(20, false);
    expect(work.ghost.value).toMatchObject({ fits: true, spans: [{ address: 20, width: 2 }, { address: 24, width: 2 }] });
    work.walked(8, false);
    expect(work.ghost.value).toMatchObject({ fits: false, text: '2 mappings: taken' });
    work.walked(20, false);
    key(' ', 20);
    await vi.waitFor(() => expect(reported.value).toEqual({ tone: 'good', text: 'Done' }));
    expect(book.place.mock.calls[0]![0 as never]).toMatchObject([{ id: 'a', address: 20 }, { id: 'b', address: 24 }]);
    key('c', 8);
    expect(work.hand.carry.value).toMatchObject({ what: { kind: 'copy', axis: 'lift' }, at: 10 });
    expect(map.show).toHaveBeenCalledWith(10);
    work.begin()();
    expect([work.hand.carry.value, work.selected.value.size, work.cursor.value]).toEqual([null, 0, 0]);
  });
  it('Delete removes, + makes wider; with Ctrl and for other keys nothing is done', async () => {
    work.editing.value = { of: rows[0]!, focus: false };
    key('Delete', 0);
    expect([book.removeAll.mock.calls, work.editing.value]).toEqual([[[[rows[0]]]], null]);
    key('+', 4);
    await vi.waitFor(() => expect(book.replace).toHaveBeenCalledTimes(1));
    expect(book.replace.mock.calls[0]![1 as never]).toMatchObject({ type: 'i64', address: 4 });
    expect([key('c', 0, true), key('x', 0)]).toEqual([false, false]);
  });
  it('where it is barred nothing is picked up, removed or added, and a press says why', () => {
    ground.value = { ...ground.value, barred: 'Only an engineer may.' };
    key(' ', 0);
    expect(reported.value).toEqual({ tone: 'refused', text: 'Only an engineer may.' });
    key('Delete', 0);
    key('c', 0);
    key('Enter', 20);
    expect([work.hand.carry.value, book.removeAll.mock.calls.length, add.mock.calls.length]).toEqual([null, 0, 0]);
    work.click(0, at(0), false);
    expect(work.editing.value?.of.id).toBe('a'); // looked at, it may be
  });
});

describe('what is typed', () => {
  let drafts: Drafts;
  beforeEach(() => {
    drafts = new Map();
    placeNew(2, 'holding_registers', null);
    adding.type.value = 'i32';
  });
  it('for an entry is kept by its entry, until it is left', () => {
    const { draft } = draftFor(rows[0]!, drafts, known);
    expect([isUntouched(draft, rows[0]!), isUntouched(undefined, rows[0]!)]).toEqual([true, true]);
    draft.comment.value = 'mine';
    expect([isUntouched(draft, rows[0]!), draftFor(rows[0]!, drafts, known).draft === draft, draftFor(rows[1]!, drafts, known).draft === draft]).toEqual([false, true, false]);
    forgetDraft(rows[0]!, drafts);
    expect(draftFor(rows[0]!, drafts, known).draft.comment.value).toBe('');
    expect([draftFor(rows[0]!, drafts, known).hand.value, draftFor(m('x', 30, { type: 'f64' }), drafts, known).hand.value]).toEqual(['', 'yes']);
  });
  it('as an address chooses its table, and a table of bits its type', () => {
    const { draft, hand } = draftFor(null, drafts, known);
    expect(draft).toBe(adding);
    typeIn(draft, hand, 'table', 'coils');
    expect(textsIn(draft)).toMatchObject({ table: 'coils', type: 'bool' });
    typeIn(draft, hand, 'table', 'input_registers');
    expect(textsIn(draft).type).toBe('u16');
    typeIn(draft, hand, 'type', 'f32');
    expect(hand.value).toBe('yes');
    placeNew(3, 'holding_registers', 7);
    expect(textsIn(draft)).toMatchObject({ unit: '3', table: 'holding_registers', address: '7' });
    draft.point.value = 'position';
    const sent = textsIn(draft);
    draft.comment.value = 'typed since';
    readyForNext(sent, hand, '9');
    expect([draft.address.value, draft.point.value, draft.comment.value, hand.value]).toEqual(['9', '', 'typed since', '']);
  });
  it('is judged beside its fields: taken by whom, where the next free place is, which type is its point’s own', () => {
    const facts = (change: object, own?: string) => mappingFacts({ ...textsIn(adding), unit: '2', axis: 'feeder', point: 'position', address: '4', ...change }, rows, known, '0', own);
    expect(facts({})).toMatchObject({ taken: 'Taken by b (position of feeder, 4–5).', free: '6' });
    expect(facts({}, 'b')).toMatchObject({ taken: undefined, free: '2' });
    expect(facts({ address: '' })).toMatchObject({ taken: undefined, free: '2', addressHint: 'counted from 0' });
    expect(facts({ unit: 'x' })).toMatchObject({ spec: null, free: null });
    expect(facts({ address: '20' })).toMatchObject({ taken: undefined, natural: 'i32', typeHint: 'the point’s own type', addressHint: expect.stringContaining('is 40021') });
    expect(facts({ type: 'u32' }).typeHint).toBe('the point’s own type is i32');
    expect(facts({ type: 'u32' }).warning).toContain('can be negative');
  });
});

describe('an answer of the Modbus door', () => {
  const axes = [{ name: 'a', unit: 'mm' }, { name: 'a.b', unit: '°' }] as never;
  it('is of a mapping, or of the axis with the longest name that fits', () => {
    expect(sourceOf({ mapping: 'c' }, rows, axes)).toEqual({ axis: 'lift', point: 'position' });
    expect(sourceOf({ name: 'a.b.position' }, rows, axes)).toEqual({ axis: 'a.b', point: 'position' });
    expect(sourceOf({ name: 'x.position' }, rows, axes)).toBeNull();
  });
  it('has its unit in words', () => {
    expect(decodedUnit('inc/s', null, axes, points)).toBe('increments/s');
    expect(decodedUnit(null, { axis: 'a', point: 'position_units' }, axes, points)).toBe('mm');
  });
  it('is written as an HMI may show it', () => expect([null, true, -5n, '', 'x', 0.1 + 0.2, NaN].map(valueShown)).toEqual(['–', 'on', '−5', '(empty)', 'x', '0.3', 'NaN']));
  it('is asked for whole numbers within bounds', () => expect(['1', '125', '0', '126', '1.5', 'x'].map((t) => wholeWithin(t, 1, 125))).toEqual([1, 125, null, null, null, null]));
});
