// The register map in words: the standard map's registers and bits, and what is not mapped in a span. In: mappings, axes, addresses. Out: text. Pure.
// The standard map (units 0, 1 and 255): axis n has registers and bits from (n - 1) * 64 on; bits 0 to 15 are its flags, 16 to 31 its status word.
import type { Axis } from '../api/types';
import { t } from '../language';
import { statusBits } from './axis';
import { endOf, type Mapping, type RegisterType, type Table } from './mapping';

const perAxis = 64;
export const isStandard = (unit: number): boolean => unit === 0 || unit === 1 || unit === 255;
const functions: Record<number, string> = {
  1: t('read coils'), 2: t('read discrete inputs'), 3: t('read holding registers'), 4: t('read input registers'), 5: t('write a coil'), 6: t('write a register'), 8: t('diagnostics'),
  15: t('write coils'), 16: t('write registers'), 17: t('report server id'), 22: t('mask write'), 23: t('read and write'), 43: t('identification'),
};
export const functionText = (list: readonly number[]): string => list.map((n) => (functions[n] ? `${n} ${functions[n]}` : String(n))).join(', ') || t('all that the door knows');

export const flagNames: readonly string[] = [t('online'), t('simulated'), t('stale'), t('referenced'), t('moving'), t('target reached'), t('fault'), t('warning')];
const flagPoints = ['online', 'simulated', 'stale', 'referenced', 'moving', 'target_reached', 'fault', 'warning'];

/** One value of the standard map; offsets that are not here read 0 and cannot be written. */
export interface StandardRegister {
  offset: number;
  type: RegisterType;
  writable: boolean;
  /** As it is mapped and shown; empty: the parameter channel's. */
  point: string;
  name: string;
}
const row = (offset: number, type: RegisterType, point: string, name: string, writable = false): StandardRegister => ({ offset, type, writable, point, name });
/** The 64 registers of an axis, as gateway/registers/register_map has them; a test holds the two together. */
export const standardRegisters: readonly StandardRegister[] = [
  row(0, 'u16', 'statusword', t('statusword')),
  row(1, 'i16', 'mode_display', t('modes of operation display')),
  row(2, 'i32', 'position', t('position actual value')),
  row(4, 'i32', 'velocity', t('velocity actual value')),
  row(6, 'i32', 'position_demand', t('position demand value')),
  row(8, 'u16', 'error_code', t('error code')),
  row(9, 'u16', 'flags', t('flags')),
  row(10, 'u32', 'native_status', t('drive\'s own status')),
  row(12, 'u32', 'age_ms', t('age of the data, ms')),
  row(14, 'u16', 'heartbeat', t('heartbeat')),
  row(15, 'u16', 'family', t('family number')),
  row(16, 'u16', 'setpoints_accepted', t('set-points accepted')),
  row(17, 'u16', 'authority', t('command authority')),
  row(18, 'u32', 'mapping_revision', t('revision of the mapping')),
  row(20, 'u16', 'refusal_reason', t('reason of the last refusal')),
  row(21, 'u16', 'refusals', t('refusals')),
  row(22, 'u16', 'fail_safe_cause', t('cause of the last fail-safe action')),
  row(23, 'u16', 'stop_latch', t('stop latch')),
  row(32, 'u16', 'controlword', t('controlword'), true),
  row(33, 'i16', 'mode', t('modes of operation'), true),
  row(34, 'i32', 'target_position', t('target position'), true),
  row(36, 'u32', 'profile_velocity', t('profile velocity'), true),
  row(38, 'u32', 'profile_acceleration', t('profile acceleration'), true),
  row(40, 'u32', 'profile_deceleration', t('profile deceleration'), true),
  row(42, 'i32', 'target_velocity', t('target velocity'), true),
  row(44, 'i16', 'homing_method', t('homing method'), true),
  row(48, 'u32', '', t('parameter channel: selector'), true),
  row(50, 'u16', '', t('parameter channel: request'), true),
  row(51, 'u16', '', t('parameter channel: state')),
  row(52, 'i32', '', t('parameter channel: value'), true),
  row(54, 'u16', '', t('parameter channel: error')),
];
/** The 64 bits of an axis that mean something: flags, then the status word. `point`: where the axis itself says it. */
export const standardBits: readonly { offset: number; point: string; name: string }[] = [
  ...flagPoints.map((point, offset) => ({ offset, point, name: flagNames[offset]! })),
  ...statusBits.map((b) => ({ offset: 16 + b.bit, point: '', name: b.name })),
];

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
  if (k < 16) return flagNames[k] ? t('{axis}: flag {name}', { axis: axis.name, name: flagNames[k] }) : t('{axis}: no flag', { axis: axis.name });
  if (k < 32) return t('{axis}: status word, bit {bit}, {name}', { axis: axis.name, bit: k - 16, name: statusBits[k - 16]?.name ?? '' });
  return t('{axis}: not used', { axis: axis.name });
}

/** From where the door lets clients in: what is allowed, as far as the address that it listens at is reached from there. */
export function allowedText(allow: readonly string[], bind: string): string {
  const here = /^(127\.|\[::1\]|::1$|localhost)/.test(bind);
  if (here) return t('this machine alone: the door listens at {bind}', { bind });
  return allow.join(', ') || t('everywhere');
}
