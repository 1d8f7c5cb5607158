// Mapping check: what is typed for a mapping, as a specification, or why not, field by field. In: texts, what is known of axes and points. Out: a specification, faults
// per field. Pure. Empty optional fields are left to the gateway, which checks all of it again.
import { midSentence, t } from '../language';
import { readAddress } from './address';
import { tableOf, tables, types, widthOf, type Field, type Known, type Mapping, type MappingSpec, type RegisterType, type Table, type Texts } from './mapping';
import { parseNumber } from './number';

export type Checked = { spec: MappingSpec | null; faults: Partial<Record<Field, string>> };
type Typed = Partial<Texts>;
/** The first fault of a field is the one that is told. */
type Tell = (f: Field, why: string) => void;

const otherNames: Record<string, Table> = {
  coil: 'coils', discrete: 'discrete_inputs', discrete_input: 'discrete_inputs', holding: 'holding_registers',
  holding_register: 'holding_registers', input: 'input_registers', input_register: 'input_registers',
};

function whole(text: string, say: { none: string; range: string }, min: number, max: number): { value: number; why: string } {
  const p = parseNumber(text);
  if (!p.good) return { value: 0, why: text.trim() === '' ? say.none : p.why };
  if (!Number.isInteger(p.value) || p.value < min || p.value > max) return { value: 0, why: say.range };
  return { value: p.value, why: '' };
}
const trimmed = (typed: Typed, f: Field): string => (typed[f] ?? '').trim();

export function checkTexts(typed: Typed, known: Known): Checked {
  const faults: Checked['faults'] = {};
  const fault: Tell = (f, why) => void (faults[f] ??= why);
  const { unit, table, address } = readPlace(typed, known, fault);
  const { axis, point } = readSource(typed, known, fault);
  const kind = table ? tableOf(table) : null;
  const type = readType(typed, kind, fault);
  const order = oneOf(typed, 'word_order', ['high_first', 'low_first'], t('high_first or low_first.'), fault);
  const scale = readNumber(typed, 'scale', 1, fault);
  if (scale === 0) fault('scale', t('The scale must not be 0.'));
  const offset = readNumber(typed, 'offset', 0, fault);
  const access = readAccess(typed, kind, known.points.find((p) => p.point === point)?.access === 'R' ? point : null, fault);
  const length = type === 'string' ? readLength(typed, fault) : undefined;
  if (address !== null && address + widthOf(type, length) > 65536) fault('address', t('The value would end beyond address 65535.'));
  const overflow = oneOf(typed, 'on_overflow', ['mark', 'clamp'], t('mark or clamp.'), fault);
  const comment = trimmed(typed, 'comment');
  if (comment.length > 256) fault('comment', t('At most 256 characters.'));
  if (Object.keys(faults).length > 0 || !table || address === null) return { spec: null, faults };
  const spec: MappingSpec = { unit, table, address, axis, point, type, word_order: order as Mapping['word_order'], scale, offset };
  if (access) spec.access = access as Mapping['access'];
  if (length !== undefined) spec.length = length;
  if (overflow === 'clamp') spec.on_overflow = overflow;
  if (comment) spec.comment = comment;
  return { spec, faults };
}

/** Where it stands. `table`, `address`: nothing if they cannot be read. */
function readPlace(typed: Typed, known: Known, fault: Tell): { unit: number; table: Table | undefined; address: number | null } {
  const unit = whole(typed.unit ?? '', { none: t('Type the Modbus unit.'), range: t('The Modbus unit is a whole number from 2 to 254.') }, 2, 254);
  if (unit.why) fault('unit', unit.why);
  const given = (typed.table || 'holding_registers').toLowerCase();
  const table = otherNames[given] ?? tables.find((x) => x.id === given)?.id;
  if (!table) fault('table', t('“{text}” is no table: {list}.', { text: typed.table ?? '', list: tables.map((x) => x.id).join(', ') }));
  const address = readAddress(typed.address ?? '', table ?? 'holding_registers', known.base ?? '0');
  if (!address.good) fault('address', address.why);
  else if (table && address.table !== table) fault('address', t('{text} is one of the {other}, and the table is {table}.', { text: trimmed(typed, 'address'), other: midSentence(tableOf(address.table).name), table: midSentence(tableOf(table).name) }));
  return { unit: unit.value, table, address: address.good ? address.address : null };
}

/** What stands there: "feeder.position" without an axis of its own names both. */
function readSource(typed: Typed, known: Known, fault: Tell): { axis: string; point: string } {
  let axis = trimmed(typed, 'axis');
  let point = trimmed(typed, 'point');
  const owner = axis === '' ? known.axes.find((a) => point.startsWith(`${a}.`)) : undefined;
  if (owner) [axis, point] = [owner, point.slice(owner.length + 1)];
  if (axis === '') fault('axis', t('Choose an axis.'));
  else if (!known.axes.includes(axis)) fault('axis', t('There is no axis {axis}.', { axis }));
  if (point === '') fault('point', t('Choose a point or a parameter.'));
  else if (known.points.length > 0 && !known.points.some((p) => p.point === point)) {
    const parameters = known.parameters(axis);
    if (parameters && !parameters.includes(point) && !parameters.includes(point.replace(/\[\d+\]$/, ''))) fault('point', t('{axis} has neither a point nor a parameter {point}.', { axis, point }));
  }
  return { axis, point };
}

type Kind = ReturnType<typeof tableOf> | null;

function readType(typed: Typed, kind: Kind, fault: Tell): RegisterType {
  const text = trimmed(typed, 'type').toLowerCase().replace(/^boolean$/, 'bool');
  if (text !== '' && !types.includes(text as RegisterType)) fault('type', t('“{text}” is no type: {list}.', { text: typed.type ?? '', list: types.join(', ') }));
  const type = (text || (kind?.bits ? 'bool' : 'i32')) as RegisterType;
  if (kind?.bits && type !== 'bool') fault('type', t('{table} hold bits: the type is bool.', { table: kind.name }));
  return type;
}

/** The first of the words where nothing is typed. */
function oneOf(typed: Typed, f: Field, words: readonly string[], why: string, fault: Tell): string {
  const text = trimmed(typed, f) || words[0]!;
  if (!words.includes(text)) fault(f, why);
  return text;
}

function readNumber(typed: Typed, f: 'scale' | 'offset', otherwise: number, fault: Tell): number {
  if (trimmed(typed, f) === '') return otherwise;
  const p = parseNumber(typed[f] as string);
  if (!p.good) fault(f, p.why);
  return p.good ? p.value : otherwise;
}

/** `readOnly`: the point, where it is one that is never written. */
function readAccess(typed: Typed, kind: Kind, readOnly: string | null, fault: Tell): string {
  const access = trimmed(typed, 'access').toUpperCase();
  if (access !== '' && !['R', 'W', 'RW'].includes(access)) fault('access', t('R, W or RW.'));
  const what = kind && !kind.writable ? kind.name : readOnly;
  if (access.includes('W') && what !== null) fault('access', t('{what} can only be read.', { what }));
  return access;
}

function readLength(typed: Typed, fault: Tell): number | undefined {
  if (trimmed(typed, 'length') === '') return undefined;
  const n = whole(typed.length as string, { none: t('Type the length.'), range: t('The length is a whole number from 1 to 64.') }, 1, 64);
  if (!n.why) return n.value;
  fault('length', n.why);
  return undefined;
}
