// A parameter in words: its range, its value, and what a person typed for it. In: the parameter as the gateway describes it.
// Out: text, or a value of the right type, or why it is none, with the range. Never changes a value to make it fit.
import type { AxisParameter, MaybeValue, Value } from '../api/types';
import { t, theirs } from '../language';
import { formatExact, formatNumber, parseNumber, typedNumber } from './number';

type Described = Pick<AxisParameter, 'type' | 'min' | 'max' | 'unit' | 'allowed'> & Partial<Pick<AxisParameter, 'fields' | 'meanings'>>;
type Field = NonNullable<AxisParameter['fields']>[number];

const limits: Record<string, readonly [number, number]> = {
  u8: [0, 255],
  i8: [-128, 127],
  u16: [0, 65535],
  i16: [-32768, 32767],
  i24: [-8388608, 8388607],
  u32: [0, 4294967295],
  i32: [-2147483648, 2147483647],
};

/** The narrower of the manual's range and the type's; null where there is none. */
export function rangeOf(p: Described): { min: number | null; max: number | null } {
  const [low, high] = limits[p.type] ?? [null, null];
  return {
    min: p.min !== null && (low === null || p.min > low) ? p.min : low,
    max: p.max !== null && (high === null || p.max < high) ? p.max : high,
  };
}

/** A unit that is counted in steps, such as "0.1 A"; null: it is none. */
export function steppedUnit(unit: string | null): { step: number; decimals: number; unit: string } | null {
  const m = /^(\d+(?:\.(\d+))?)\s+(\S.*)$/.exec(unit ?? '');
  if (!m || Number(m[1]) === 1 || Number(m[1]) === 0) return null;
  return { step: Number(m[1]), decimals: m[2]?.length ?? 0, unit: m[3] as string };
}

/** "pulse/s^2" as people write it; of steps: "× 0.1 A", so that no number before it reads as a quantity. */
export const unitText = (unit: string | null): string => `${steppedUnit(unit) ? '× ' : ''}${(unit ?? '').replace(/\^2\b/g, '²').replace(/\^3\b/g, '³').replace(/^deg C$/, '°C')}`;

/** "= 1.0 A": what a count of steps comes to; empty where the unit is an ordinary one. The value itself stays the drive's own number everywhere. */
export function steppedText(value: MaybeValue, unit: string | null): string {
  const s = steppedUnit(unit);
  return s && typeof value === 'number' && Number.isFinite(value) ? `= ${formatNumber(value * s.step, s.decimals)} ${unitText(s.unit)}` : '';
}

export function rangeText(p: Described): string {
  if (p.allowed && p.allowed.length > 0) {
    const values = p.allowed.map((a) => formatExact(a.value));
    return values.length > 6 ? `${values.slice(0, 6).join(', ')}, …` : values.join(', ');
  }
  if (p.type === 'bool') return '0, 1';
  if (p.type === 'text') return 'text';
  if (p.type === 'bytes') return t('hex pairs');
  const { min, max } = rangeOf(p);
  if (min === null && max === null) return p.type.startsWith('f') ? t('number') : t('whole number');
  if (min === null) return t('up to {n}', { n: formatExact(max as number) });
  if (max === null) return t('from {n}', { n: formatExact(min) });
  return `${formatExact(min)} … ${formatExact(max)}`;
}

/** What some bits of a number hold. */
export const fieldValue = (value: number, f: Pick<Field, 'low_bit' | 'bits'>): number => Math.floor(value / 2 ** f.low_bit) % 2 ** f.bits;

/** The number with other bits in one of its fields. */
export const withField = (value: number, f: Pick<Field, 'low_bit' | 'bits'>, bits: number): number => value + (bits - fieldValue(value, f)) * 2 ** f.low_bit;

/** A number whose bits mean something by themselves, a line for each part: "falling edge action: origin, then stop". */
export function fieldLines(value: MaybeValue, p: Partial<Pick<Described, 'fields'>>): string[] {
  if (!p.fields || typeof value !== 'number' || !Number.isInteger(value) || value < 0) return [];
  return p.fields.map((f) => {
    const bits = fieldValue(value, f);
    return `${f.name.replaceAll('_', ' ')}: ${f.allowed?.find((a) => a.value === bits)?.meaning ?? formatExact(bits)}`;
  });
}

/** What is wrong with a part of the number, with the values that it can have; null: nothing. */
export function wrongField(value: number, p: Partial<Pick<Described, 'fields'>>): string | null {
  for (const f of p.fields ?? []) {
    const bits = fieldValue(value, f);
    if (f.allowed && !f.allowed.some((a) => a.value === bits)) {
      return t('{value} has {bits} as {part}. Allowed: {allowed}.', { value: formatExact(value), bits: formatExact(bits), part: f.name.replaceAll('_', ' '), allowed: f.allowed.map((a) => `${a.value} (${a.meaning})`).join(', ') });
    }
  }
  return null;
}

export function valueText(value: MaybeValue, p: Pick<Described, 'allowed'> & Partial<Pick<Described, 'meanings'>>): string {
  if (value === null) return '–';
  if (typeof value === 'boolean') return value ? 'on' : 'off';
  if (typeof value === 'string') return value === '' ? '(empty)' : value;
  const meaning = p.allowed?.find((a) => a.value === value)?.meaning ?? p.meanings?.find((m) => value >= m.from && value <= m.through)?.meaning;
  if (!meaning) return formatExact(value);
  // "17 bits" says the 17 already, "500 kbit/s" does not say the code 5. Between code and meaning stands a sign: "2 500 kbit/s" reads as 2500.
  const published = meaning.startsWith(String(value)) && !/^[\d.,]/.test(meaning.slice(String(value).length));
  return published ? meaning : `${formatExact(value)} = ${meaning}`;
}

/** The longest text that a value with meanings can have, for the room of its cell; empty: a number, which takes one line. */
export function longestText(p: Pick<Described, 'allowed' | 'type'> & Partial<Pick<Described, 'meanings'>>): string {
  const codes = [...(p.allowed ?? []).map((a) => a.value), ...(p.meanings ?? []).map((m) => m.through)];
  const texts = codes.filter((c) => typeof c === 'number').map((c) => valueText(c, p));
  return texts.reduce((a, b) => (b.length > a.length ? b : a), '');
}

/** How well a parameter answers a search: 0 its own id, then the beginning of it, id, name, description; null: not at all. */
export function searchRank(p: Pick<AxisParameter, 'id' | 'name' | 'description'>, text: string): number | null {
  const id = p.id.toLowerCase();
  const name = p.name.toLowerCase().replaceAll('_', ' ');
  const t = text.trim().toLowerCase();
  if (t === '') return 0;
  if (id === t) return 0;
  if (id.startsWith(t)) return 1;
  if (id.includes(t)) return 2;
  if (name.includes(t) || p.name.toLowerCase().includes(t)) return 3;
  return p.description.toLowerCase().includes(t) ? 4 : null;
}

/** What a field shows when it is opened for writing: a number as the reader types it. */
export const editText = (value: MaybeValue): string => (typeof value === 'number' ? typedNumber(value) : fileText(value));
/** What stands in a file: a number with a point, whatever the page speaks. */
export function fileText(value: MaybeValue): string {
  if (value === null) return '';
  if (typeof value === 'boolean') return value ? '1' : '0';
  return String(value);
}

export type Read = { good: true; value: Value } | { good: false; why: string };

export function readValue(text: string, p: Described): Read {
  const unit = p.unit ? ` ${unitText(p.unit)}` : '';
  if (p.type === 'text') return { good: true, value: text };
  if (p.type === 'bytes') {
    const bytes = text.replace(/\s/g, '');
    return /^([0-9a-f]{2})*$/i.test(bytes) ? { good: true, value: bytes.toUpperCase() } : { good: false, why: t('Write bytes as pairs of hex digits, such as 0A FF.') };
  }
  if (p.type === 'bool') {
    const typed = text.trim().toLowerCase();
    if (['1', 'on', 'true', 'yes'].includes(typed)) return { good: true, value: true };
    if (['0', 'off', 'false', 'no'].includes(typed)) return { good: true, value: false };
    return { good: false, why: t('Write 1 (on) or 0 (off).') };
  }
  const parsed = parseNumber(text);
  if (!parsed.good) return parsed;
  const { value } = parsed;
  const shown = formatExact(value);
  if (!p.type.startsWith('f') && !Number.isInteger(value)) return { good: false, why: t('{shown} is not a whole number. Range: {range}.', { shown, range: rangeText(p) + unit }) };
  if (p.allowed && p.allowed.length > 0 && !p.allowed.some((a) => a.value === value)) return { good: false, why: t('{shown} is not allowed. Allowed: {range}.', { shown, range: rangeText(p) }) };
  const { min, max } = rangeOf(p);
  if ((min !== null && value < min) || (max !== null && value > max)) return { good: false, why: t('{shown} is outside the range {range}.', { shown, range: rangeText(p) + unit }) };
  const error = wrongField(value, p);
  return error ? { good: false, why: error } : { good: true, value };
}

/** The same value? Numbers of f32 parameters come back rounded. */
export function sameValue(a: MaybeValue, b: MaybeValue): boolean {
  if (typeof a === 'number' && typeof b === 'number') return a === b || Math.abs(a - b) <= 1e-6 * Math.max(Math.abs(a), Math.abs(b));
  if (typeof a === 'boolean' && typeof b === 'number') return Number(a) === b;
  if (typeof a === 'number' && typeof b === 'boolean') return a === Number(b);
  return a === b;
}

/** What is asked before a value is written by which the drive is reached: its address, name or group, the speed or form of its line. */
export const addressingText = (axis: string, p: Pick<AxisParameter, 'id' | 'name' | 'value' | 'allowed'>, sent: string): string =>
  t('The drive of {axis} is reached by {id} ({name}): {now} and will be {next}. The gateway may not find the drive again before the site says the same. Write it?', { axis, id: p.id, name: p.name.replaceAll('_', ' '), now: p.value === null ? t('what it is now is not known') : t('it is {value} now', { value: valueText(p.value, p) }), next: sent.trim() });

/** What a parameter is, from the catalogue: what the manual says, what its values mean, and what writing it does besides. */
export function helpText(p: Pick<AxisParameter, 'description' | 'allowed' | 'addressing' | 'live' | 'access'>): string {
  const meanings = (p.allowed ?? []).filter((a) => a.meaning && a.meaning !== String(a.value)).map((a) => t('{value} is {meaning}', { value: a.value, meaning: theirs(a.meaning) }));
  return [
    theirs(p.description.replaceAll('_', ' ')),
    meanings.length > 0 ? `${meanings.join('; ')}.` : '',
    p.access === 'R' ? t('It can only be read.') : p.access === 'W' ? t('It can only be written.') : '',
    p.addressing ? t('The drive is reached by it: written, the drive may not be found again before the site says the same.') : '',
    p.live && p.access !== 'R' ? t('It acts at once instead of configuring.') : '',
  ]
    .filter(Boolean)
    .map((x) => (/[.;!?]$/.test(x) ? x : `${x}.`))
    .join(' ');
}
