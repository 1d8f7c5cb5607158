// A mapping in words and numbers: how many registers it takes, whom it collides with, what is free, what a person typed for it.
// In: mappings, text, points. Out: specifications, faults per field, live values. Pure. The gateway checks all of it again.
import type { components } from '../api/schema';
import type { Axis } from '../api/types';
import { midSentence, t } from '../language';
import { readAddress, spanText, type Base } from './address';
import { parseNumber, typedNumber } from './number';

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
export const tableOf = (id: Table) => tables.find((x) => x.id === id) ?? tables[0]!;
export const types: readonly RegisterType[] = ['bool', 'u16', 'i16', 'u32', 'i32', 'f32', 'u64', 'i64', 'f64', 'string'];

const otherNames: Record<string, Table> = {
  coil: 'coils', discrete: 'discrete_inputs', discrete_input: 'discrete_inputs', holding: 'holding_registers',
  holding_register: 'holding_registers', input: 'input_registers', input_register: 'input_registers',
};

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

export type Checked = { spec: MappingSpec | null; faults: Partial<Record<Field, string>> };

function whole(text: string, say: { none: string; range: string }, min: number, max: number): { value: number; why: string } {
  const p = parseNumber(text);
  if (!p.good) return { value: 0, why: text.trim() === '' ? say.none : p.why };
  if (!Number.isInteger(p.value) || p.value < min || p.value > max) return { value: 0, why: say.range };
  return { value: p.value, why: '' };
}

/** From what was typed to a specification, or why not, field by field. Empty optional fields are left to the gateway. */
export function checkTexts(typed: Partial<Texts>, known: Known): Checked {
  const faults: Checked['faults'] = {};
  const fault = (f: Field, why: string) => (faults[f] ??= why);
  const unit = whole(typed.unit ?? '', { none: t('Type the Modbus unit.'), range: t('The Modbus unit is a whole number from 2 to 254.') }, 2, 254);
  if (unit.why) fault('unit', unit.why);
  const given = (typed.table || 'holding_registers').toLowerCase();
  const table = otherNames[given] ?? (tables.find((x) => x.id === given)?.id as Table | undefined);
  if (!table) fault('table', t('“{text}” is no table: {list}.', { text: typed.table ?? '', list: tables.map((x) => x.id).join(', ') }));
  const address = readAddress(typed.address ?? '', table ?? 'holding_registers', known.base ?? '0');
  if (!address.good) fault('address', address.why);
  else if (table && address.table !== table) fault('address', t('{text} is one of the {other}, and the table is {table}.', { text: typed.address?.trim() ?? '', other: midSentence(tableOf(address.table).name), table: midSentence(tableOf(table).name) }));

  let axis = typed.axis?.trim() ?? '';
  let point = typed.point?.trim() ?? '';
  if (axis === '' && point.includes('.')) {
    const owner = known.axes.find((a) => point.startsWith(`${a}.`));
    if (owner) [axis, point] = [owner, point.slice(owner.length + 1)];
  }
  if (axis === '') fault('axis', t('Choose an axis.'));
  else if (!known.axes.includes(axis)) fault('axis', t('There is no axis {axis}.', { axis }));
  if (point === '') fault('point', t('Choose a point or a parameter.'));
  const simple = known.points.find((p) => p.point === point);
  const parameters = known.parameters(axis);
  if (point !== '' && !simple && known.points.length > 0 && parameters && !parameters.includes(point) && !parameters.includes(point.replace(/\[\d+\]$/, ''))) {
    fault('point', t('{axis} has neither a point nor a parameter {point}.', { axis, point }));
  }

  const kind = table ? tableOf(table) : null;
  const typeText = (typed.type ?? '').trim().toLowerCase().replace(/^boolean$/, 'bool');
  if (typeText !== '' && !types.includes(typeText as RegisterType)) fault('type', t('“{text}” is no type: {list}.', { text: typed.type ?? '', list: types.join(', ') }));
  const type = (typeText || (kind?.bits ? 'bool' : 'i32')) as RegisterType;
  if (kind?.bits && type !== 'bool') fault('type', t('{table} hold bits: the type is bool.', { table: kind.name }));
  const order = (typed.word_order ?? '').trim() || 'high_first';
  if (order !== 'high_first' && order !== 'low_first') fault('word_order', t('high_first or low_first.'));
  const number = (f: 'scale' | 'offset', fallback: number) => {
    if ((typed[f] ?? '').trim() === '') return fallback;
    const p = parseNumber(typed[f] as string);
    if (!p.good) fault(f, p.why);
    return p.good ? p.value : fallback;
  };
  const scale = number('scale', 1);
  if (scale === 0) fault('scale', t('The scale must not be 0.'));
  const offset = number('offset', 0);
  const access = (typed.access ?? '').trim().toUpperCase();
  if (access !== '' && !['R', 'W', 'RW'].includes(access)) fault('access', t('R, W or RW.'));
  if (access.includes('W') && kind && !kind.writable) fault('access', t('{what} can only be read.', { what: kind.name }));
  else if (access.includes('W') && simple?.access === 'R') fault('access', t('{what} can only be read.', { what: point }));
  let length: number | undefined;
  if (type === 'string' && (typed.length ?? '').trim() !== '') {
    const n = whole(typed.length as string, { none: t('Type the length.'), range: t('The length is a whole number from 1 to 64.') }, 1, 64);
    if (n.why) fault('length', n.why);
    else length = n.value;
  }
  if (address.good && address.address + widthOf(type, length) > 65536) fault('address', t('The value would end beyond address 65535.'));
  const overflow = (typed.on_overflow ?? '').trim() || 'mark';
  if (overflow !== 'mark' && overflow !== 'clamp') fault('on_overflow', t('mark or clamp.'));
  const comment = typed.comment?.trim() ?? '';
  if (comment.length > 256) fault('comment', t('At most 256 characters.'));
  if (Object.keys(faults).length > 0 || !table || !address.good) return { spec: null, faults };
  const spec: MappingSpec = { unit: unit.value, table, address: address.address, axis, point, type, word_order: order as Mapping['word_order'], scale, offset };
  if (access) spec.access = access as Mapping['access'];
  if (length !== undefined) spec.length = length;
  if (overflow === 'clamp') spec.on_overflow = overflow;
  if (comment) spec.comment = comment;
  return { spec, faults };
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
