// Assembly texts: what a person types into the form of an EtherNet/IP assembly, as an entry of the site, or what is wrong with it; its bytes in
// words. In: texts. Out: an entry, or faults by field. Pure. Which instances are taken for axes is the gateway's to say.
import type { Assembly, AssemblyEntry } from '../api/assemblies';
import { t } from '../language';
import { parseNumber } from './number';

export interface AssemblyDraft {
  instance: string;
  direction: string;
  unit: string;
  table: string;
  address: string;
  registers: string;
  order: string;
  comment: string;
}
export type AssemblyFaults = Partial<Record<keyof AssemblyDraft, string>>;
export const emptyAssembly: AssemblyDraft = { instance: '', direction: 'input', unit: '', table: 'holding_registers', address: '0', registers: '', order: 'little_endian', comment: '' };

const whole = (text: string, low: number, high: number): number | null => {
  const p = parseNumber(text);
  return p.good && Number.isInteger(p.value) && p.value >= low && p.value <= high ? p.value : null;
};

/** Addresses count from 0, as in files: an assembly is a range and no register number of a manual. */
export function readAssembly(d: AssemblyDraft): { instance: number; entry: AssemblyEntry } | { faults: AssemblyFaults } {
  const faults: AssemblyFaults = {};
  const instance = whole(d.instance, 1, 65535);
  if (instance === null) faults.instance = t('A whole number from 1 to 65535; 200 to 1000 are free of axes.');
  const unit = whole(d.unit, 2, 254);
  if (unit === null) faults.unit = t('A whole number from 2 to 254: a unit with mappings or a profile.');
  const address = whole(d.address, 0, 65535);
  if (address === null) faults.address = t('A whole number from 0 to 65535.');
  const registers = whole(d.registers, 1, 250);
  if (registers === null) faults.registers = t('A whole number from 1 to 250.');
  if (d.direction === 'output' && d.table !== 'holding_registers') faults.table = t('Input registers can only be read.');
  if (new TextEncoder().encode(d.comment).length > 64) faults.comment = t('At most 64 bytes.');
  if (Object.keys(faults).length > 0 || instance === null || unit === null || address === null || registers === null) return { faults };
  const entry: AssemblyEntry = {
    direction: d.direction as AssemblyEntry['direction'],
    unit,
    table: d.table as NonNullable<AssemblyEntry['table']>,
    address,
    registers,
    byte_order: d.order as NonNullable<AssemblyEntry['byte_order']>,
  };
  if (d.comment.trim() !== '') entry.comment = d.comment.trim();
  return { instance, entry };
}

export const draftOf = (a: Assembly): AssemblyDraft => ({
  instance: String(a.instance),
  direction: a.direction,
  unit: String(a.unit),
  table: a.table,
  address: String(a.address),
  registers: String(a.registers),
  order: a.byte_order,
  comment: a.comment ?? '',
});

/** "Instance 300, 24 bytes to the originator: unit 40, from register 0". */
export function assemblyText(a: Assembly): string {
  const table = a.table === 'input_registers' ? t('input register') : t('register');
  const order = a.byte_order === 'registers' ? t(', in the order of registers') : '';
  const values = { n: a.bytes, unit: a.unit, table, first: a.address, last: a.address + a.registers - 1, order };
  return a.direction === 'input' ? t('{n} bytes to the originator: unit {unit}, {table} {first} to {last}{order}', values) : t('{n} bytes from the originator: unit {unit}, {table} {first} to {last}{order}', values);
}

/** "4 to 7", or "4". */
export const bytesText = (offset: number, bytes: number): string => (bytes === 1 ? String(offset) : t('{first} to {last}', { first: offset, last: offset + bytes - 1 }));
