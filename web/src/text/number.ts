// Numbers: from what people type, and back to what people read. In: text, numbers, the resolution of an axis. Out: numbers, text.
// Never guesses: "1,5" may be one and a half or fifteen, so it is refused in words.

export type Parsed = { good: true; value: number } | { good: false; why: string };

export function parseNumber(text: string): Parsed {
  const t = text.trim().replace(/[\u2212\u2013]/g, '-').replace(/[\s\u202f\u00a0_]/g, '');
  if (t === '') return { good: false, why: 'Type a number.' };
  if (t.includes(',')) return { good: false, why: 'Write the decimal sign as a point: 1.5' };
  if (/^[+-]?0x[0-9a-f]+$/i.test(t)) {
    const sign = t.startsWith('-') ? -1 : 1;
    return { good: true, value: sign * Number(t.replace(/^[+-]/, '')) };
  }
  if (!/^[+-]?(\d+\.?\d*|\.\d+)(e[+-]?\d+)?$/i.test(t)) return { good: false, why: `“${text.trim()}” is not a number.` };
  const value = Number(t);
  return Number.isFinite(value) ? { good: true, value } : { good: false, why: 'This number is too large.' };
}

/** A quantity with a unit: as parseNumber, but "0x10" is no distance that anybody means. */
export function parseQuantity(text: string): Parsed {
  if (/^\s*[+\-\u2212\u2013]?0x/i.test(text)) return { good: false, why: `“${text.trim()}” is a hexadecimal number: write a quantity in decimal.` };
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
  return sign + grouped + (fraction === undefined ? '' : `.${fraction}`);
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
  return String(value).replace('-', '\u2212');
}
