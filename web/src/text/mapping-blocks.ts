// Blocks of the register map: what stands in one table of a unit, whoever put it there: mappings of the site, the standard map, a profile's language.
// In: mappings, axes, profiles. Out: blocks with their place, type, access and name, and what the bits of a word mean. Pure.
import type { Language, Profile } from '../api/profiles';
import type { Axis } from '../api/types';
import { controlBits, statusBits } from './axis';
import { widthOf, type Mapping, type RegisterType, type Table } from './mapping';
import type { Placed } from './mapping-geometry';
import { flagNames, isStandard, standardBits, standardRegisters } from './register-map';

export interface Block extends Placed {
  unit: number;
  table: Table;
  type: RegisterType;
  length?: number;
  access: Mapping['access'];
  axis: string;
  /** The point of the axis; empty: it has none (parameter channel, a language's own register). */
  point: string;
  /** What is written in the cell. */
  name: string;
  /** Only an entry of the site can be changed. */
  mapping?: Mapping;
}

type Numbered = Pick<Axis, 'name' | 'number'>;
const perAxis = 64;

export function blocksOf(unit: number, table: Table, rows: readonly Mapping[], axes: readonly Numbered[], profiles: readonly Profile[] = [], languages: readonly Language[] = []): Block[] {
  if (isStandard(unit)) return axes.flatMap((a) => standardBlocks(unit, table, a));
  const own = rows.filter((m) => m.unit === unit && m.table === table).map(
    (m): Block => ({ key: m.id, unit, table, address: m.address, width: widthOf(m.type, m.length), type: m.type, ...(m.length ? { length: m.length } : {}), access: m.access, axis: m.axis, point: m.point, name: m.point, mapping: m }),
  );
  const profile = profiles.find((p) => p.unit === unit);
  const language = profile && languages.find((l) => l.language === profile.language);
  if (!profile || !language) return own;
  return language.registers
    .filter((r) => (r.axis ?? 0) <= profile.axes.length && (r.tables as readonly string[]).includes(table))
    .map((r): Block => {
      const type = (r.type as RegisterType) ?? 'u16';
      return { key: `${unit}/${table}/${r.address}`, unit, table, address: r.address, width: widthOf(type), type, access: r.access, axis: profile.axes[Math.max(1, r.axis ?? 1) - 1]?.axis ?? '', point: '', name: r.name };
    });
}

function standardBlocks(unit: number, table: Table, a: Numbered): Block[] {
  const begin = (a.number - 1) * perAxis;
  const key = (offset: number) => `${unit}/${table}/${begin + offset}`;
  if (table === 'coils' || table === 'discrete_inputs') {
    return standardBits.map((b): Block => ({ key: key(b.offset), unit, table, address: begin + b.offset, width: 1, type: 'bool', access: 'R', axis: a.name, point: b.point, name: b.name }));
  }
  return standardRegisters.map(
    (r): Block => ({ key: key(r.offset), unit, table, address: begin + r.offset, width: widthOf(r.type), type: r.type, access: r.writable && table === 'holding_registers' ? 'RW' : 'R', axis: a.name, point: r.point, name: r.point || r.name }),
  );
}

export interface NamedBit {
  bit: number;
  name: string;
  on: boolean;
}
/** The bits that have a name; empty: the value is a number and no set of bits. */
export function bitsOf(point: string, word: number): NamedBit[] {
  const names = point === 'statusword' ? statusBits : point === 'controlword' ? controlBits : point === 'flags' ? flagNames.map((name, bit) => ({ bit, name })) : [];
  return names.map((b) => ({ bit: b.bit, name: b.name, on: ((word >> b.bit) & 1) === 1 }));
}
/** By its kind a cell has its colour; the type stands in it as a word, too. */
export const kindOf = (type: RegisterType): 'bit' | 'whole' | 'real' | 'text' => (type === 'bool' ? 'bit' : type === 'f32' || type === 'f64' ? 'real' : type === 'string' ? 'text' : 'whole');

/** What is read with one request each: places without a gap, or, where gaps can be read (`loose`), all within so many. */
export function readsOf(blocks: readonly Block[], loose: boolean, most = 125): Block[][] {
  const reads: Block[][] = [];
  let end = -1;
  for (const b of [...blocks].sort((x, y) => x.address - y.address)) {
    const last = reads.at(-1);
    if (last && (b.address === end || (loose && b.address > end)) && b.address + b.width - last[0]!.address <= most) last.push(b);
    else reads.push([b]);
    end = b.address + b.width;
  }
  return reads;
}
