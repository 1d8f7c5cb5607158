// What the registers say for each mapping: a span in one request; after an exception each mapping by itself, with its own words.
import { expect, it } from 'vitest';
import { lookAt, type Received } from '../src/state/register-look';
import type { Mapping } from '../src/text/mapping';

const m = (id: string, address: number): Mapping => ({ id, unit: 2, table: 'holding_registers', address, axis: 'feeder', point: 'position', type: 'i32', word_order: 'high_first', scale: 1, offset: 0, access: 'R' });
const rows = [m('a', 0), m('b', 2), m('c', 4), m('d', 6), m('e', 8)];
function door(bad: number[]) {
  const asked: string[] = [];
  return {
    asked,
    registers: async (at: { address: number; count: number }) => {
      asked.push(`${at.address}+${at.count}`);
      const exception = bad.some((b) => b >= at.address && b < at.address + at.count) ? { code: 4, text: `no value at ${at.address}` } : null;
      return { unit: 2, table: 'holding_registers' as const, address: at.address, words: exception ? [] : Array.from({ length: at.count }, (_, i) => at.address + i), exception, decoded: [] };
    },
  };
}
const look = async (bad: number[], most?: number) => {
  const d = door(bad);
  const received = new Map<string, Received>([['e', { words: [7, 7], value: undefined, text: '' }]]);
  await lookAt(d, rows, received, new AbortController().signal, most);
  return { received, asked: d.asked };
};

it('is one request where all is well', async () => {
  const { received: taken, asked } = await look([]);
  expect(asked).toEqual(['0+10']);
  expect(taken.get('c')?.words).toEqual([4, 5]);
});
it('after an exception is asked again, until each mapping has its own answer', async () => {
  const { received: taken } = await look([2, 6]);
  expect(taken.get('b')).toEqual({ words: null, value: undefined, text: 'exception 4: no value at 2' });
  expect(taken.get('d')?.text).toBe('exception 4: no value at 6');
  for (const [id, text] of [['a', [0, 1]], ['c', [4, 5]], ['e', [8, 9]]] as const) expect(taken.get(id)?.words).toEqual(text);
});
it('has a bound; what was not reached keeps what was said', async () => {
  const { received: taken, asked } = await look([0], 3);
  expect(asked).toHaveLength(3);
  expect(taken.get('e')?.words).toEqual([7, 7]);
});
