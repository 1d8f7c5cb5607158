// Assemblies in words: what is typed becomes an entry or faults by field; bytes in words. All pure.
import { expect, test } from 'vitest';
import type { Assembly } from '../src/api/assemblies';
import { assemblyText, bytesText, draftOf, emptyAssembly, readAssembly } from '../src/text/assembly';

const shown: Assembly = {
  instance: 300,
  direction: 'output',
  unit: 40,
  table: 'holding_registers',
  address: 2,
  registers: 6,
  byte_order: 'registers',
  bytes: 12,
  name: 'press from the originator',
  comment: 'press',
  axes: ['feeder'],
  partner: null,
  of_profile: false,
  values: [],
};

test('what is typed becomes an entry', () => {
  expect(readAssembly({ ...emptyAssembly, instance: '300', unit: '40', registers: '6', comment: ' press ' })).toEqual({
    instance: 300,
    entry: { direction: 'input', unit: 40, table: 'holding_registers', address: 0, registers: 6, byte_order: 'little_endian', comment: 'press' },
  });
});

test('faults stand at their fields', () => {
  const read = readAssembly({ ...emptyAssembly, instance: '0', unit: '1', address: 'x', registers: '251', direction: 'output', table: 'input_registers', comment: 'ä'.repeat(33) });
  expect('faults' in read && Object.keys(read.faults).sort()).toEqual(['address', 'comment', 'instance', 'registers', 'table', 'unit']);
});

test('an entry goes into the form and comes back as it was', () => {
  const read = readAssembly(draftOf(shown));
  expect(read).toEqual({ instance: 300, entry: { direction: 'output', unit: 40, table: 'holding_registers', address: 2, registers: 6, byte_order: 'registers', comment: 'press' } });
});

test('bytes in words', () => {
  expect(assemblyText(shown)).toBe('12 bytes from the originator: unit 40, register 2 to 7, in the order of registers');
  expect(bytesText(4, 4)).toBe('4 to 7');
  expect(bytesText(4, 1)).toBe('4');
});
