// HMI answer: what a decoded value of the Modbus door is of, in which unit, and how it is written. In: the answer, mappings, axes, points. Out: words. Pure.
import type { Axis } from '../api/types';
import { t } from '../language';
import { pointUnit, type Mapping, type MappingPoint } from './mapping';
import { formatExact, parseNumber } from './number';

export interface Source {
  axis: string;
  point: string;
}
/** The axis and the point that a decoded value is of: by its mapping, or by the name that the standard map gives it. */
export function sourceOf(d: { name?: string; mapping?: string }, rows: readonly Mapping[], axes: readonly Axis[]): Source | null {
  const m = d.mapping === undefined ? undefined : rows.find((r) => r.id === d.mapping);
  if (m) return { axis: m.axis, point: m.point };
  const axis = axes.filter((x) => d.name?.startsWith(`${x.name}.`)).sort((x, y) => y.name.length - x.name.length)[0];
  return axis && d.name ? { axis: axis.name, point: d.name.slice(axis.name.length + 1) } : null;
}

/** In words: a bare number beside "position" could be anything. */
export function decodedUnit(reported: string | null | undefined, source: Source | null, axes: readonly Axis[], points: readonly MappingPoint[]): string {
  const text = reported || (source ? pointUnit(axes.find((x) => x.name === source.axis) ?? { unit: '' }, source.point, points) : '');
  return text.replace(/^inc\b/, t('increments'));
}

/** A value as an HMI may show it. */
export function valueShown(v: number | bigint | boolean | string | null): string {
  if (v === null) return '–';
  if (typeof v === 'boolean') return v ? t('on') : t('off');
  if (typeof v === 'bigint') return String(v).replace('-', '\u2212');
  if (typeof v === 'string') return v === '' ? t('(empty)') : v;
  if (!Number.isFinite(v)) return String(v);
  return formatExact(Number.isInteger(v) ? v : Number(v.toPrecision(7)));
}

/** A whole number within bounds; null: it is none. */
export function wholeWithin(text: string, min: number, max: number): number | null {
  const p = parseNumber(text);
  return p.good && Number.isInteger(p.value) && p.value >= min && p.value <= max ? p.value : null;
}
