// What stands in the register map: mappings, the standard map as the gateway has it, the language of a profile; what is read at once, and named bits.
import { readFileSync } from 'node:fs';
import { expect, it } from 'vitest';
import { bitsOf, blocksOf, readsOf } from '../src/text/mapping-blocks';
import type { Mapping } from '../src/text/mapping';
import { standardRegisters } from '../src/text/register-map';

const m = (id: string, address: number, more: Partial<Mapping> = {}): Mapping => ({ id, unit: 2, table: 'holding_registers', address, axis: 'feeder', point: 'position', type: 'i32', word_order: 'high_first', scale: 1, offset: 0, access: 'R', ...more });
const axes = [{ name: 'feeder', number: 1 }, { name: 'lift', number: 3 }];

it('the standard map of the page is the gateway’s, register by register', () => {
  const read = (name: string) => readFileSync(`${import.meta.dirname}/../../gateway/registers/${name}`, 'utf8');
  const offsets = new Map([...read('register_map.hpp').matchAll(/(\w+) = (\d+)[,;]/g)].map((x) => [x[1]!, Number(x[2])]));
  const rows = [...read('register_map.cpp').matchAll(/RegisterRow\{reg::(\w+), (\w+), (\w+), "([^"]*)", "([^"]*)"\}/g)];
  expect(rows.length).toBeGreaterThan(25);
  expect(standardRegisters).toEqual(rows.map(([, reg, type, writable, point, name]) => ({ offset: offsets.get(reg!), type, writable: writable === 'true', point, name })));
});

it('a unit has what is mapped in it; unit 1 has 64 registers of each axis, by its number, and its bits by name', () => {
  expect(blocksOf(2, 'holding_registers', [m('a', 4), m('b', 0, { unit: 3 }), m('c', 0, { table: 'coils', type: 'bool' })], axes).map((b) => [b.key, b.address, b.width])).toEqual([['a', 4, 2]]);
  const standard = blocksOf(1, 'holding_registers', [], axes);
  expect(standard).toHaveLength(2 * standardRegisters.length);
  expect(standard.find((b) => b.axis === 'lift' && b.point === 'controlword')).toMatchObject({ address: 128 + 32, width: 1, access: 'RW', type: 'u16' });
  expect(standard.some((b) => b.mapping)).toBe(false);
  expect(blocksOf(1, 'input_registers', [], axes).every((b) => b.access === 'R')).toBe(true);
  const bits = blocksOf(1, 'coils', [], axes);
  expect(bits.find((b) => b.address === 128 + 6)).toMatchObject({ axis: 'lift', name: 'fault', type: 'bool' });
  expect(bits.find((b) => b.address === 128 + 16 + 3)).toMatchObject({ axis: 'lift', name: 'Fault' });
});

it('a unit with a profile has its language, for as many axes as it has', () => {
  const register = (address: number, axis: number, tables = ['holding_registers', 'input_registers']) => ({ address, tables, name: `R${address}`, type: 'i32', access: 'RW', axis, description: '' });
  const language = { language: 'x', title: 'X', axes: 2, registers: [register(0, 1), register(10, 2), register(20, 0), register(30, 1, ['input_registers'])] };
  const blocks = blocksOf(30, 'holding_registers', [], axes, [{ unit: 30, language: 'x', axes: [{ axis: 'lift' }] }] as never, [language] as never);
  expect(blocks.map((b) => [b.address, b.name, b.axis])).toEqual([[0, 'R0', 'lift'], [20, 'R20', 'lift']]);
});

it('what is beside each other is read at once, at most 125 places; over unused places only where they can be read', () => {
  const blocks = (list: Mapping[]) => blocksOf(2, 'holding_registers', list, axes);
  const published = (reads: ReturnType<typeof readsOf>) => reads.map((r) => r.map((b) => b.key).join(''));
  expect(published(readsOf(blocks([m('c', 8), m('b', 2), m('a', 0)]), false))).toEqual(['ab', 'c']);
  expect(published(readsOf(blocks([m('c', 8), m('b', 2), m('a', 0)]), true))).toEqual(['abc']);
  expect(published(readsOf(blocks([m('a', 0), m('b', 124)]), true))).toEqual(['a', 'b']);
  expect(readsOf(blocks(Array.from({ length: 70 }, (_, i) => m(`m${i}`, i * 2))), false).map((r) => r.length)).toEqual([62, 8]);
});

it('words of bits have their names; other words are numbers', () => {
  expect(bitsOf('statusword', 0x0208).filter((b) => b.on).map((b) => b.name)).toEqual(['Fault', 'Remote']);
  expect(bitsOf('flags', 0b101).filter((b) => b.on).map((b) => b.name)).toEqual(['online', 'stale']);
  expect(bitsOf('error_code', 7)).toEqual([]);
});
