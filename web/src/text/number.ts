// Numbers: from what people type, and back to what people read, with the decimal sign of their language. In: text, numbers, the resolution of an axis.
// Out: numbers, text. Never guesses: "1,5" is one and a half in German and refused in English; "1.234" may be either in German, so it is refused in words.
// Documents of the API, files and machine values keep the point.
import { language, t } from '../language';

export type Parsed = { good: true; value: number } | { good: false; why: string };

/** What stands between the whole and its parts in the reader's language. */
export const decimalSign = (): ',' | '.' => (language() === 'de' ? ',' : '.');
/** A number that a field begins with: short, ungrouped, as it can be typed. */
export const typedNumber = (value: number): string => String(value).replace('.', decimalSign());
/** Figures with a point, as toFixed() makes them, with the reader's decimal sign. */
export const localFigures = (figures: string): string => figures.replace('.', decimalSign());

/** As it is typed by an input method for Chinese: figures and signs of full width. */
const narrow = (text: string): string => text.replace(/[\uff01-\uff5e]/g, (c) => String.fromCharCode(c.charCodeAt(0) - 0xfee0));

/** The number with a point and without groups, or why it cannot be told which number is meant. */
function pointOf(s: string): string | { why: string } {
  if (decimalSign() === '.') return s.includes(',') ? { why: t('Write the decimal sign as a point: 1.5') } : s;
  const points = s.split('.').length - 1, commas = s.split(',').length - 1;
  if (commas > 1) return { why: t('“{text}” is not a number.', { text: s }) };
  const grouped = /^[+-]?[1-9]\d{0,2}(\.\d{3})+(,\d*)?$/.test(s);
  if (commas === 1) return points > 0 && !grouped ? { why: t('“{text}” is not a number.', { text: s }) } : s.replaceAll('.', '').replace(',', '.');
  if (points > 1) return grouped ? s.replaceAll('.', '') : { why: t('“{text}” is not a number.', { text: s }) };
  return grouped ? { why: t('“{text}” may be {whole} or {parts}: write it without a point, or with a comma.', { text: s, whole: s.replace('.', ''), parts: s.replace('.', ',') }) } : s;
}

export function parseNumber(text: string): Parsed {
  const typed = narrow(text).trim().replace(/[\u2212\u2013]/g, '-').replace(/[\s\u202f\u00a0_]/g, '');
  if (typed === '') return { good: false, why: t('Type a number.') };
  const s = pointOf(typed);
  if (typeof s !== 'string') return { good: false, why: s.why };
  if (/^[+-]?0x[0-9a-f]+$/i.test(s)) {
    const sign = s.startsWith('-') ? -1 : 1;
    return { good: true, value: sign * Number(s.replace(/^[+-]/, '')) };
  }
  if (!/^[+-]?(\d+\.?\d*|\.\d+)(e[+-]?\d+)?$/i.test(s)) return { good: false, why: t('“{text}” is not a number.', { text: text.trim() }) };
  const value = Number(s);
  return Number.isFinite(value) ? { good: true, value } : { good: false, why: t('This number is too large.') };
}

/** A quantity with a unit: as parseNumber, but "0x10" is no distance that anybody means. */
export function parseQuantity(text: string): Parsed {
  if (/^\s*[+\-\u2212\u2013]?0x/i.test(text)) return { good: false, why: t('“{text}” is a hexadecimal number: write a quantity in decimal.', { text: text.trim() }) };
  return parseNumber(text);
}

/** Places after the point that the resolution of the axis is worth: 0 to 3. */
export function decimalsOf(increments_per_unit: number): number {
  if (!(increments_per_unit > 0) || increments_per_unit <= 1) return 0;
  return Math.min(3, Math.max(0, Math.ceil(Math.log10(increments_per_unit))));
}

/** Fixed places, a narrow space between thousands, a true minus sign; "–" for what is not known. */
export function formatNumber(value: number | null | undefined, decimals: number): string {
  if (value === null || value === undefined || !Number.isFinite(value)) return '–';
  const fixed = Math.abs(value).toFixed(decimals);
  const sign = value < 0 && Number(fixed) !== 0 ? '\u2212' : ''; // no minus before a zero
  const [whole = '', fraction] = fixed.split('.');
  const grouped = whole.length > 4 ? whole.replace(/\B(?=(\d{3})+$)/g, '\u202f') : whole;
  return sign + grouped + (fraction === undefined ? '' : decimalSign() + fraction);
}

/** Labels of a scale: as many places as its steps need to be told apart, however small they are. */
export function tickLabels(at: readonly number[]): string[] {
  const step = at.length > 1 ? Math.abs((at[1] as number) - (at[0] as number)) : 1;
  let decimals = step > 0 ? Math.max(0, -Math.floor(Math.log10(step) + 1e-9)) : 0;
  // 0.25 needs one place more than its size says.
  if (step > 0 && Math.abs(step * 10 ** decimals - Math.round(step * 10 ** decimals)) > 1e-6) decimals += 1;
  return at.map((v) => formatNumber(v, Math.min(12, decimals)));
}

/** As short as it can be said exactly: for ranges, defaults, parameter values. */
export function formatExact(value: number): string {
  if (Number.isInteger(value) && Math.abs(value) < 1e15) return formatNumber(value, 0);
  return localFigures(String(value)).replace('-', '\u2212');
}
