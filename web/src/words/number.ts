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

/** As short as it can be said exactly: for ranges, defaults, parameter values. */
export function formatExact(value: number): string {
  if (Number.isInteger(value) && Math.abs(value) < 1e15) return formatNumber(value, 0);
  return String(value).replace('-', '\u2212');
}
