// The commissioning report in words: what of an axis' parameters is other than its default or its snapshot, and how much could be compared.
// In: parameters, a snapshot. Out: rows, sentences. Pure.
import { t } from '../language';
import type { AxisParameter, MaybeValue } from '../api/types';

export interface SnapshotValues {
  n: number;
  name: string;
  at: string;
  who: string | null;
  parameters: { parameter: string; value: MaybeValue }[];
}
export interface ReportRow {
  id: string;
  name: string;
  unit: string;
  now: MaybeValue;
  otherwise: MaybeValue;
  /** undefined: the snapshot does not hold it. */
  snapshot: MaybeValue | undefined;
}
export interface ParameterReport {
  rows: ReportRow[];
  known: number;
  unknown: number;
  againstSnapshot: number;
}

const same = (a: MaybeValue, b: MaybeValue): boolean => a === b || (typeof a === 'number' && typeof b === 'number' && Math.abs(a - b) <= 1e-9 * Math.max(1, Math.abs(a)));

/** What is known now, beside its default and the snapshot: rows that differ from either. What nobody has read is counted, not guessed. */
export function parameterReport(list: readonly AxisParameter[], snapshot: SnapshotValues | null): ParameterReport {
  const stored = new Map(snapshot?.parameters.map((p) => [p.parameter, p.value]) ?? []);
  const out: ParameterReport = { rows: [], known: 0, unknown: 0, againstSnapshot: 0 };
  for (const p of list) {
    if (p.access === 'W' || p.count) continue;
    const now = p.value ?? p.stored;
    if (now === null) {
      out.unknown += 1;
      continue;
    }
    out.known += 1;
    const inSnapshot = stored.get(p.id);
    if (stored.has(p.id)) out.againstSnapshot += 1;
    const fallback = (p as { default?: MaybeValue }).default ?? null;
    const writable = p.access.includes('W');
    if ((writable && fallback !== null && !same(now, fallback)) || (stored.has(p.id) && !same(now, inSnapshot ?? null))) {
      out.rows.push({ id: p.id, name: p.name ?? '', unit: p.unit ?? '', now, otherwise: fallback, snapshot: inSnapshot });
    }
  }
  return out;
}

export const comparedSentence = (r: ParameterReport, s: SnapshotValues | null): string =>
  t('{known} values known, {n}; {n2}. {n3}', { known: r.known, n: r.unknown === 0 ? t('all of them read') : t('{unknown} not read and not compared', { unknown: r.unknown }), n2: s ? t('{againstSnapshot} beside snapshot {n}, {name}', { againstSnapshot: r.againstSnapshot, n: s.n, name: s.name }) : t('no snapshot was taken'), n3: r.rows.length === 0 ? t('Nothing differs.') : t('{n} differ:', { n: r.rows.length }) });
