// The register map in words: what is not mapped in a span, and what the bits of the standard map are. In: mappings, axes, addresses. Out: text. Pure.
// The standard map (units 0, 1 and 255): axis n has registers and bits from (n - 1) * 64 on; bits 0 to 15 are its flags, 16 to 31 its status word.
import type { Axis } from '../api/types';
import { statusBits } from './axis';
import { endOf, type Mapping, type Table } from './mapping';

const perAxis = 64;
export const isStandard = (unit: number): boolean => unit === 0 || unit === 1 || unit === 255;
const functions: Record<number, string> = {
  1: 'read coils', 2: 'read discrete inputs', 3: 'read holding registers', 4: 'read input registers', 5: 'write a coil', 6: 'write a register', 8: 'diagnostics',
  15: 'write coils', 16: 'write registers', 17: 'report server id', 22: 'mask write', 23: 'read and write', 43: 'identification',
};
export const functionWords = (list: readonly number[]): string => list.map((n) => (functions[n] ? `${n} ${functions[n]}` : String(n))).join(', ') || 'all that the door knows';

const flags = ['online', 'simulated', 'stale', 'referenced', 'moving', 'target reached', 'fault', 'warning'];

/** "4, 10–12": the places of a span that nothing answers for; empty: all are mapped. */
export function notMapped(span: { unit: number; table: Table; address: number; count: number }, rows: readonly Mapping[], axes: readonly Pick<Axis, 'number'>[]): string {
  const numbers = new Set(axes.map((a) => a.number));
  const own = rows.filter((m) => m.unit === span.unit && m.table === span.table);
  const mapped = (at: number) => (isStandard(span.unit) ? numbers.has(Math.floor(at / perAxis) + 1) : own.some((m) => m.address <= at && endOf(m) >= at));
  const gaps: [number, number][] = [];
  for (let at = span.address; at < Math.min(span.address + span.count, 65536); at += 1) {
    if (mapped(at)) continue;
    const last = gaps.at(-1);
    if (last && last[1] === at - 1) last[1] = at;
    else gaps.push([at, at]);
  }
  return gaps.map(([a, b]) => (a === b ? `${a}` : `${a}–${b}`)).join(', ');
}

/** The axis that a bit of the standard map is of; empty: none. */
export const bitAxis = (address: number, axes: readonly Pick<Axis, 'name' | 'number'>[]): string => axes.find((a) => a.number === Math.floor(address / perAxis) + 1)?.name ?? '';

/** "feeder: moving"; "feeder: status word, bit 3, Fault". Empty: no axis is there. */
export function bitName(address: number, axes: readonly Pick<Axis, 'name' | 'number'>[]): string {
  const axis = axes.find((a) => a.number === Math.floor(address / perAxis) + 1);
  if (!axis) return '';
  const k = address % perAxis;
  if (k < 16) return `${axis.name}: ${flags[k] ? `flag ${flags[k]}` : 'no flag'}`;
  if (k < 32) return `${axis.name}: status word, bit ${k - 16}, ${statusBits[k - 16]?.name ?? ''}`;
  return `${axis.name}: not used`;
}

/** From where the door lets clients in: what is allowed, as far as the address that it listens at is reached from there. */
export function allowedWords(allow: readonly string[], bind: string): string {
  const here = /^(127\.|\[::1\]|::1$|localhost)/.test(bind);
  if (here) return `this machine alone: the door listens at ${bind}`;
  return allow.join(', ') || 'everywhere';
}
