// A mapping in words and numbers: how many registers it takes, whom it collides with, what is free, what its register shows.
// In: mappings, points. Out: places, words, live values. Pure. The gateway checks all of it again.
import type { components } from '../api/schema';
import type { Axis } from '../api/types';
import { t } from '../language';
import { spanText, type Base } from './address';
import { typedNumber } from './number';

type Schemas = components['schemas'];
export type Mapping = Schemas['Mapping'];
export type MappingSpec = Schemas['MappingSpec'];
export type MappingPoint = Schemas['MappingPoint'];
export type Table = Mapping['table'];
export type RegisterType = Mapping['type'];

export const tables: readonly { id: Table; name: string; short: string; digit: string; bits: boolean; writable: boolean }[] = [
  { id: 'holding_registers', name: t('Holding registers'), short: t('Holding'), digit: '4', bits: false, writable: true },
  { id: 'input_registers', name: t('Input registers'), short: t('Input'), digit: '3', bits: false, writable: false },
  { id: 'coils', name: t('Coils'), short: t('Coils'), digit: '0', bits: true, writable: true },
  { id: 'discrete_inputs', name: t('Discrete inputs'), short: t('Discrete'), digit: '1', bits: true, writable: false },
];
export const isBits = (table: string): boolean => table === 'coils' || table === 'discrete_inputs';
export const tableOf = (id: Table) => tables.find((x) => x.id === id) ?? tables[0]!;
/** For a choice. */
export const tableChoices = tables.map((x) => ({ value: x.id, text: x.name }));
export const orderChoices = [{ value: 'high_first', text: t('high word first') }, { value: 'low_first', text: t('low word first') }];
export const types: readonly RegisterType[] = ['bool', 'u16', 'i16', 'u32', 'i32', 'f32', 'u64', 'i64', 'f64', 'string'];

/** Registers (or bits) that a type takes. */
export function widthOf(type: RegisterType, length = 16): number {
  switch (type) {
    case 'bool': case 'u16': case 'i16': return 1;
    case 'u32': case 'i32': case 'f32': return 2;
    case 'u64': case 'i64': case 'f64': return 4;
    case 'string': return length;
  }
}
export const endOf = (m: Pick<Mapping, 'address' | 'type' | 'length'>): number => m.address + widthOf(m.type, m.length) - 1;

/** The number that many HMI and PLC editors show for the same place: 40001 is holding register 0. Six digits beyond 9999. */
export const oneBased = (table: Table, address: number): string => tableOf(table).digit + String(address + 1).padStart(address < 9999 ? 4 : 5, '0');

export const placeText = (m: Pick<Mapping, 'table' | 'address' | 'type' | 'length'>, base: Base = '0'): string => spanText(m.table, m.address, endOf(m), base);

/** The mappings that have a place in common with this one, itself (by id) left out. */
export function conflictsOf(m: Pick<Mapping, 'unit' | 'table' | 'address' | 'type' | 'length'>, all: readonly Mapping[], ownId = ''): Mapping[] {
  return all.filter((o) => o.id !== ownId && o.unit === m.unit && o.table === m.table && o.address <= endOf(m) && endOf(o) >= m.address);
}

/** First address from `from` on with so many free places; null: there is none. */
export function nextFree(all: readonly Mapping[], unit: number, table: Table, width: number, from = 0): number | null {
  let at = from;
  for (const m of all.filter((o) => o.unit === unit && o.table === table).sort((a, b) => a.address - b.address)) {
    if (endOf(m) < at) continue;
    if (m.address - at >= width) return at;
    at = endOf(m) + 1;
  }
  return at + width <= 65536 ? at : null;
}

/** First multiple of `width` with so many free places in every table of the unit: blocks of axes lie side by side as in unit 1. */
export function freeBlock(all: readonly Mapping[], unit: number, width: number): number | null {
  const own = all.filter((o) => o.unit === unit);
  for (let at = 0; at + width <= 65536; at += width) if (!own.some((o) => o.address < at + width && endOf(o) >= at)) return at;
  return null;
}

/** What lies before and behind a place: "follows on m1; 4 free up to m2". */
export function neighbourText(m: Pick<Mapping, 'unit' | 'table' | 'address' | 'type' | 'length'>, all: readonly Mapping[], ownId = ''): string {
  const own = all.filter((o) => o.id !== ownId && o.unit === m.unit && o.table === m.table);
  const before = own.filter((o) => endOf(o) < m.address).sort((a, b) => endOf(b) - endOf(a))[0];
  const behind = own.filter((o) => o.address > endOf(m)).sort((a, b) => a.address - b.address)[0];
    const room = before ? m.address - endOf(before) - 1 : 0;
  const rest = behind ? behind.address - endOf(m) - 1 : 0;
  const first = !before ? t('nothing before it') : room === 0 ? t('follows {id} without a gap', { id: before.id }) : room === 1 ? t('1 place free after {id}', { id: before.id }) : t('{n} places free after {id}', { n: room, id: before.id });
  const last = !behind ? t('nothing behind it') : rest === 0 ? t('{id} follows without a gap', { id: behind.id }) : rest === 1 ? t('1 place free up to {id}', { id: behind.id }) : t('{n} places free up to {id}', { n: rest, id: behind.id });
  return t('{before}; {behind}', { before: first, behind: last });
}

export const fields = ['unit', 'table', 'address', 'axis', 'point', 'type', 'word_order', 'scale', 'offset', 'access', 'length', 'comment', 'on_overflow'] as const;
export type Field = (typeof fields)[number];
export type Texts = Record<Field, string>;
export const columns = ['id', ...fields] as const;
/** As people are told of them; in tables and files they keep their names. */
export const columnText: Readonly<Record<(typeof columns)[number], string>> = {
  id: t('id'), unit: t('unit'), table: t('table'), address: t('address'), axis: t('axis'), point: t('point'), type: t('type'), word_order: t('word order'), scale: t('scale'),
  offset: t('offset'), access: t('access'), length: t('length'), comment: t('comment'), on_overflow: t('on overflow'),
};
export const emptyTexts: Texts = { unit: '2', table: 'holding_registers', address: '', axis: '', point: '', type: 'i32', word_order: 'high_first', scale: '1', offset: '0', access: '', length: '', on_overflow: 'mark', comment: '' };

export function textsOf(m: Mapping): Texts {
  return {
    unit: String(m.unit), table: m.table, address: String(m.address), axis: m.axis, point: m.point, type: m.type, word_order: m.word_order,
    scale: typedNumber(m.scale), offset: typedNumber(m.offset), access: m.access, length: m.length ? String(m.length) : '', on_overflow: m.on_overflow ?? 'mark', comment: m.comment ?? '',
  };
}

export interface Known {
  /** How addresses are written; from 0 where nothing is said, as in tables and files. */
  base?: Base;
  axes: readonly string[];
  points: readonly MappingPoint[];
  /** Ids and names of the parameters of an axis; null where they are not known. */
  parameters: (axis: string) => readonly string[] | null;
  /** Type and unit of a parameter by its id or name; null where they are not known. */
  parameter?: (axis: string, id: string) => { type: Schemas['AxisParameter']['type']; unit: string | null } | null;
}

/** The cells of one mapping in the order of `columns`, as the gateway writes them. */
export function cellsOf(m: Partial<Mapping>): string[] {
  return columns.map((c) => {
    const v = m[c];
    return v === undefined || v === null ? '' : String(v);
  });
}

export const sameMapping = (a: Mapping | undefined | null, b: Mapping | undefined | null): boolean =>
  a === b || (!!a && !!b && cellsOf(a).every((c, i) => c === cellsOf(b)[i]));

/** What differs between two states of one mapping: "address 4 → 6, scale 1 → 0.1". */
export function differenceText(before: Mapping | null | undefined, after: Mapping | null | undefined): string {
  if (!before) return after ? t('added') : t('not there');
  if (!after) return t('removed');
  const a = cellsOf(before);
  const b = cellsOf(after);
  const parts = columns.flatMap((c, i) => (a[i] === b[i] ? [] : [t('{what} {before} → {after}', { what: columnText[c], before: a[i] || t('empty'), after: b[i] || t('empty') })]));
  return parts.join(', ') || t('the same');
}

const doors = ['none', 'modbus', 'ethernet_ip', 'http', 'dds', 'internal'];
type Points = readonly MappingPoint[];
const pointOf = (points: Points, name: string): MappingPoint | undefined => points.find((p) => p.point === name);

/** The point's value from the axis document; undefined: the document does not have it (a parameter, a set-point register). */
export function pointValue(axis: Axis, name: string, points: Points): number | boolean | null | undefined {
  switch (name) {
    case 'error_code': return axis.error.code;
    case 'authority': return Math.max(0, doors.indexOf(axis.authority));
    case 'flags':
      return [axis.online, axis.simulated, axis.stale, axis.referenced, axis.moving, axis.target_reached, axis.fault, axis.warning].reduce((n, b, i) => n | (b ? 1 << i : 0), 0);
    default: {
      const member = pointOf(points, name)?.member;
      return member ? (axis[member as keyof Axis] as number | boolean | null | undefined) : undefined;
    }
  }
}

export function pointUnit(axis: Pick<Axis, 'unit'>, name: string, points: Points): string {
  const unit = pointOf(points, name)?.unit ?? '';
  const own = axis.unit || 'inc';
  return unit === 'unit' ? own : unit === 'unit/s' ? `${own}/s` : unit.replace('increments', 'inc').replace('^2', '²');
}

/** What stands in the register for a value of the point: value * scale + offset, cut to the type as the gateway cuts it. */
export function registerValue(value: number | boolean, m: Pick<Mapping, 'type' | 'scale' | 'offset'>): number {
  const n = Number(value) * m.scale + m.offset;
  return m.type === 'f32' ? Math.fround(n) : m.type === 'f64' ? n : m.type === 'bool' ? Number(n !== 0) : Math.round(n);
}

const signedOf: Partial<Record<RegisterType, RegisterType>> = { u16: 'i16', u32: 'i32', u64: 'i64' };
/** What to think of before a point that can be negative goes into a type that cannot; empty: nothing. An offset may be meant to lift it. */
export function signWarning(m: { point: string; type: string; offset: number }, points: Points): string {
  const own = pointOf(points, m.point)?.type ?? '';
  const better = signedOf[m.type as RegisterType];
  return better && m.offset <= 0 && /^[if]/.test(own) ? t('{point} can be negative, and {type} holds no negative value: reading it then is an exception. {better} holds it.', { point: m.point, type: m.type, better }) : '';
}

/** Reads raw words as a type, as an HMI does. */
export function decodeText(words: readonly number[], type: RegisterType, order: Mapping['word_order']): number | bigint | boolean | string | null {
  const width = widthOf(type, words.length);
  if (words.length < width) return null;
  const used = words.slice(0, width);
  if (type === 'string') {
    const bytes = used.flatMap((w) => [w >> 8, w & 0xff]);
    const end = bytes.indexOf(0);
    return new TextDecoder().decode(new Uint8Array(end < 0 ? bytes : bytes.slice(0, end)));
  }
  const view = new DataView(new ArrayBuffer(8));
  (order === 'low_first' ? [...used].reverse() : used).forEach((w, i) => view.setUint16(i * 2, w & 0xffff));
  switch (type) {
    case 'bool': return view.getUint16(0) !== 0;
    case 'u16': return view.getUint16(0);
    case 'i16': return view.getInt16(0);
    case 'u32': return view.getUint32(0);
    case 'i32': return view.getInt32(0);
    case 'f32': return view.getFloat32(0);
    case 'u64': return view.getBigUint64(0);
    case 'i64': return view.getBigInt64(0);
    case 'f64': return view.getFloat64(0);
  }
}
