// Transfer: parameters out of and into the page as CSV or JSON, and the comparison of two sets of values. In: parameters, text. Out: text, or
// rows that were checked, each with its fault. Pure. Values are checked as if they were typed; nothing is changed to make it fit.
import { t } from '../language';
import type { AxisParameter, MaybeValue, Value } from '../api/types';
import { localFigures } from './number';
import { fileText, readValue, sameValue } from './parameter';
import { csvOf, pointed, rowsOf, separatorOf } from './table-text';

export interface Wanted {
  /** Line of the file, or place in the list, from 1. */
  line: number;
  id: string;
  value: Value | null;
  fault: string;
  /** The last known value is this one already. */
  same: boolean;
}

const known = (list: readonly AxisParameter[]) => list.filter((p) => p.value !== null);

export function csvOfParameters(list: readonly AxisParameter[]): string {
  return csvOf([['parameter', 'name', 'value', 'unit', 'default', 'stored', 'at'], ...known(list).map((p) => [p.id, p.name, fileText(p.value), p.unit ?? '', fileText(p.default), fileText(p.stored), p.at ?? ''])]);
}

export function jsonOfParameters(axis: string, list: readonly AxisParameter[]): string {
  const parameters = known(list).map(({ id, name, value, unit, default: fallback, stored, at }) => ({ parameter: id, name, value, unit, default: fallback, stored, at }));
  return `${JSON.stringify({ axis, parameters }, null, 2)}\n`;
}

/** Reads CSV (columns `parameter` or `id`, and `value`), or JSON (that list, or an object of values by parameter). */
export function readTransfer(text: string, list: readonly AxisParameter[]): { rows: Wanted[]; problem: string } {
  const whole = text.trim();
  if (whole === '') return { rows: [], problem: '' };
  const pairs = whole.startsWith('{') || whole.startsWith('[') ? pairsOfJson(whole) : pairsOfCsv(whole);
  if (typeof pairs === 'string') return { rows: [], problem: pairs };
  const separator = separatorOf(whole);
  const byId = new Map(list.map((p) => [p.id, p]));
  const byName = new Map(list.map((p) => [p.name, p]));
  const seen = new Map<string, number>();
  const rows = pairs.map(({ line, id: given, text: typed }): Wanted => {
    const p = byId.get(given) ?? byName.get(given);
    const id = p?.id ?? given;
    const row: Wanted = { line, id, value: null, fault: '', same: false };
    const before = seen.get(id);
    seen.set(id, line);
    if (!p) row.fault = t('This axis has no parameter {given}.', { given });
    else if (before !== undefined) row.fault = t('Line {before} has {id} too.', { before, id });
    else if (p.access === 'R') row.fault = t('{id} can only be read.', { id });
    else {
      const read = readValue(p.type === 'text' || p.type === 'bytes' ? typed : localFigures(pointed(typed, separator)), p);
      if (read.good) Object.assign(row, { value: read.value, same: p.value !== null && p.quality === 'good' && sameValue(p.value, read.value) });
      else row.fault = read.why;
    }
    return row;
  });
  return { rows, problem: '' };
}

interface Pair {
  line: number;
  id: string;
  text: string;
}

function pairsOfCsv(text: string): Pair[] | string {
  const { rows, tooMany } = rowsOf(text);
  if (tooMany) return t('There are more than 5000 rows.');
  const heads = rows[0]?.cells.map((c) => c.toLowerCase()) ?? [];
  const id = heads.findIndex((h) => h === 'parameter' || h === 'id');
  const value = heads.indexOf('value');
  if (id < 0 || value < 0) return t('The first line must name the columns: parameter, value.');
  return rows.slice(1).map((r) => ({ line: r.line, id: r.cells[id] ?? '', text: r.cells[value] ?? '' }));
}

function pairsOfJson(text: string): Pair[] | string {
  let document: unknown;
  try {
    document = JSON.parse(text);
  } catch (error) {
    return t('This is not JSON: {why}', { why: error instanceof Error ? error.message : t('it cannot be read') });
  }
  const inner = isObject(document) && 'parameters' in document ? document.parameters : document;
  if (Array.isArray(inner)) {
    return inner.map((x, i) => ({ line: i + 1, id: isObject(x) ? String(x.parameter ?? x.id ?? '') : '', text: isObject(x) ? textOf(x.value) : '' }));
  }
  if (isObject(inner)) return Object.entries(inner).map(([id, value], i) => ({ line: i + 1, id, text: textOf(value) }));
  return t('A list of {form} is expected, or an object of values by parameter.', { form: '{"parameter", "value"}' });
}
const isObject = (x: unknown): x is Record<string, unknown> => typeof x === 'object' && x !== null && !Array.isArray(x);
const textOf = (v: unknown): string => (typeof v === 'boolean' ? (v ? '1' : '0') : typeof v === 'number' || typeof v === 'string' ? String(v) : '');

export interface Compared {
  id: string;
  name: string;
  unit: string | null;
  mine: MaybeValue;
  other: MaybeValue;
  same: boolean;
  /** false: the other side does not tell its value. */
  known?: boolean;
  writable: boolean;
}

/** The values of one axis beside others; what one side does not know is not compared, and said to be so. */
export function compareWith(list: readonly AxisParameter[], other: (p: AxisParameter) => MaybeValue): Compared[] {
  return list.flatMap((p) => {
    const o = other(p);
    const known = p.value !== null && o !== null;
    const whole = p.count !== null && p.count > 0 && !/\]$/.test(p.id); // an array as such has no value
    if (whole || (p.value === null && o === null)) return [];
    return [{ id: p.id, name: p.name, unit: p.unit, mine: p.value, other: o, same: known && sameValue(p.value, o), known, writable: p.access !== 'R' }];
  });
}

/** "3 of 20 values that both sides know differ; 5 cannot be compared." */
export function comparedText(rows: readonly Compared[], of: number): string {
  const both = rows.filter((r) => r.known !== false);
  const differ = both.filter((r) => !r.same).length;
  const open = Math.max(of, rows.length) - both.length;
  if (both.length === 0) return t('None of the {of} values can be compared: no value is known by both sides.', { of });
  return open === 0 ? t('{differ} of {n} values differ.', { differ, n: both.length }) : open === 1 ? t('{differ} of {n} values differ; 1 of {of} cannot be compared, because one side does not know it.', { differ, n: both.length, of: Math.max(of, rows.length) }) : t('{differ} of {n} values differ; {open} of {of} cannot be compared, because one side does not know them.', { differ, n: both.length, open, of: Math.max(of, rows.length) });
}

export type Marked = 'all' | 'changed' | 'unsaved' | 'written' | 'writable';
export const marks: readonly { id: Marked; text: string }[] = [
  { id: 'all', text: t('all parameters') },
  { id: 'changed', text: t('changed from default') },
  { id: 'unsaved', text: t('live differs from stored') },
  { id: 'written', text: t('written through the gateway') },
  { id: 'writable', text: t('can be written') },
];
export const isChanged = (p: AxisParameter): boolean => p.value !== null && p.default !== null && !sameValue(p.value, p.default);
export const isApart = (p: AxisParameter): boolean => p.value !== null && p.stored !== null && !sameValue(p.value, p.stored);
export function isMarked(p: AxisParameter, mark: Marked): boolean {
  switch (mark) {
    case 'all': return true;
    case 'changed': return isChanged(p);
    case 'unsaved': return isApart(p);
    case 'written': return p.written_at !== null;
    case 'writable': return p.access !== 'R';
  }
}

export const parametersText = (n: number): string => (n === 1 ? t('1 parameter') : t('{n} parameters', { n }));

/** Why a restore leaves something out, in the words of the form. The gateway names the parameter in its reason: that is said beside its id already. */
export function leftOutWhy(why: string): string {
  if (/include_live/.test(why)) return t('acts at once and is no setting; written with “Restore also what acts at once”');
  if (/include_addressing/.test(why)) return t('the drive is reached by it, so it is never written back from here');
  return why.replaceAll('_', ' ');
}

/** What a restore leaves out, by reason, most first. */
export function leftOut(skipped: readonly { parameter: string; why: string }[]): { why: string; parameters: string[] }[] {
  const by = new Map<string, string[]>();
  for (const s of skipped) by.set(leftOutWhy(s.why), [...(by.get(leftOutWhy(s.why)) ?? []), s.parameter]);
  return [...by].map(([why, parameters]) => ({ why, parameters })).sort((a, b) => b.parameters.length - a.parameters.length);
}
