// What is carried over the register map: what is in its own way is not, what does not fit is not sent, Escape puts back, and each way down is one change.
import { signal, type Signal } from '@preact/signals';
import { beforeEach, expect, it, vi } from 'vitest';
import { MapHand, type Ground } from '../src/state/mapping-carry';
import type { MappingBook } from '../src/state/mappings';
import { emptyTyped, held } from '../src/state/typing';
import { blocksOf } from '../src/text/mapping-blocks';
import type { Mapping } from '../src/text/mapping';

const m = (id: string, address: number, more: Partial<Mapping> = {}): Mapping => ({ id, unit: 2, table: 'holding_registers', address, axis: 'feeder', point: 'position', type: 'i32', word_order: 'high_first', scale: 1, offset: 0, access: 'R', ...more });
const rows = [m('a', 0), m('b', 4), m('s', 20, { type: 'string', length: 4 })];
const good = async () => ({ good: true as const, text: 'done' });
const book = { add: vi.fn(good), replace: vi.fn(good), place: vi.fn(good) };
let hand: MapHand;
let ground: Signal<Ground>;
beforeEach(() => {
  for (const f of Object.values(book)) f.mockClear().mockImplementation(good);
  ground = signal<Ground>({ unit: 2, table: 'holding_registers', blocks: blocksOf(2, 'holding_registers', rows, []), base: '0', barred: '' });
  hand = new MapHand(book as unknown as MappingBook, ground);
});
const sent = () => Object.values(book).reduce((n, f) => n + f.mock.calls.length, 0);

it('a point lies free or is said to be taken, by whom, and where the next free place is', async () => {
  hand.pick({ kind: 'new', axis: 'lift', point: 'velocity', type: 'i32' }, 'hand', 1);
  expect(hand.text()).toBe('velocity of lift at 1–2: taken by a (position of feeder, 0–1). Next free place: 2');
  expect(await hand.putDown()).toMatchObject({ good: false });
  expect(hand.carry.value).not.toBeNull(); // still in the hand
  hand.over(2);
  expect(hand.text()).toBe('velocity of lift at 2–3: free');
  expect(await hand.putDown()).toMatchObject({ good: true });
  expect(book.add).toHaveBeenCalledWith({ unit: 2, table: 'holding_registers', address: 2, axis: 'lift', point: 'velocity', type: 'i32' });
  expect(hand.carry.value).toBeNull();
});

it('by a pointer what does not fit is put back, and nothing is sent', async () => {
  hand.pick({ kind: 'move', own: [rows[0]!] }, 'pointer', 0);
  hand.over(3);
  expect(await hand.putDown()).toMatchObject({ good: false, text: expect.stringContaining('taken by b') });
  expect([hand.carry.value, sent()]).toEqual([null, 0]);
  hand.pick({ kind: 'new', axis: 'lift', point: 'velocity', type: 'i32' }, 'pointer');
  expect(await hand.putDown()).toBeNull(); // beside the map
  hand.pick({ kind: 'new', axis: 'lift', point: 'velocity', type: 'i32' }, 'pointer', 65535);
  expect(await hand.putDown()).toMatchObject({ good: false, text: expect.stringContaining('ends behind the last address') });
  expect(sent()).toBe(0);
});

it('an entry is not in its own way, and one that stays is no change', async () => {
  hand.pick({ kind: 'move', own: [rows[0]!] }, 'pointer', 0);
  hand.over(1);
  expect(await hand.putDown()).toMatchObject({ good: true });
  expect(book.replace).toHaveBeenCalledWith('a', expect.objectContaining({ address: 1 }), rows[0], 'Moved a');
  hand.pick({ kind: 'move', own: [rows[0]!] }, 'pointer', 0);
  expect([await hand.putDown(), sent()]).toEqual([null, 1]);
});

it('several are moved as one, copied as one to another axis', async () => {
  hand.pick({ kind: 'move', own: [rows[0]!, rows[1]!] }, 'hand', 0);
  hand.over(2);
  await hand.putDown();
  expect(book.place).toHaveBeenLastCalledWith([expect.objectContaining({ id: 'a', address: 2 }), expect.objectContaining({ id: 'b', address: 6 })], 'Moved 2 mappings', [rows[0], rows[1]]);
  hand.pickAtFit({ kind: 'copy', own: [rows[0]!, rows[1]!], axis: 'lift' }, 0);
  expect(hand.carry.value?.at).toBe(2); // a copy's first part between a and b, its second behind b
  await hand.putDown();
  const copies = (book.place.mock.calls.at(-1) as unknown as [Mapping[]])[0];
  expect(copies.map((c) => [c.id, c.axis, c.address])).toEqual([[undefined, 'lift', 2], [undefined, 'lift', 6]]);
});

it('is made wider to the next type, or longer as a text, as far as it is free', async () => {
  hand.pick({ kind: 'resize', own: rows[0]!, width: 2 }, 'pointer', 0);
  hand.until(3);
  await hand.putDown();
  expect(book.replace).toHaveBeenLastCalledWith('a', expect.objectContaining({ type: 'i64', address: 0 }), rows[0], 'Resized a');
  hand.pick({ kind: 'resize', own: rows[2]!, width: 4 }, 'pointer', 20);
  hand.until(29);
  await hand.putDown();
  expect(book.replace).toHaveBeenLastCalledWith('s', expect.objectContaining({ type: 'string', length: 10 }), rows[2], 'Resized s');
  hand.pick({ kind: 'resize', own: rows[1]!, width: 2 }, 'pointer', 4);
  hand.until(5);
  expect(await hand.putDown()).toBeNull();
});

it('the first Escape puts back, and only then it stops', () => {
  hand.pick({ kind: 'move', own: [rows[0]!] }, 'hand', 0);
  expect(emptyTyped()).toBe(true);
  expect([hand.carry.value, held.value]).toEqual([null, null]);
  expect(emptyTyped()).toBe(false);
});

it('where nothing may be changed nothing is', async () => {
  ground.value = { ...ground.peek(), barred: 'Unit 1 is the standard map: it is not changed.' };
  hand.pick({ kind: 'new', axis: 'lift', point: 'velocity', type: 'i32' }, 'hand', 2);
  expect(hand.text()).toContain('it is not changed');
  expect(await hand.putDown()).toMatchObject({ good: false });
  expect(sent()).toBe(0);
});
