// Alarms and events in words: state, subject, how long a shelf lasts, the filter of the events and the files of them.
// In: documents of the gateway. Out: words. Never asks anything.
import { t } from '../language';
import type { Alarm, GatewayEvent, Recording } from '../api/types';
import type { Word } from './axis';
import { csvOf } from './table-text';

export function alarmWord(alarm: Pick<Alarm, 'state' | 'severity'>): Word {
  const tone = alarm.severity === 'alarm' ? 'fault' : 'warning';
  switch (alarm.state) {
    case 'unacknowledged_active': return { text: t('Active, not acknowledged'), icon: 'bell', tone, long: t('It is wrong now, and nobody has acknowledged it') };
    case 'acknowledged_active': return { text: t('Active, acknowledged'), icon: 'triangle', tone: 'warning', long: t('It is wrong now, and somebody knows') };
    case 'unacknowledged_cleared': return { text: t('Cleared, not acknowledged'), icon: 'circle-dashed', tone: 'neutral', long: t('It is over, but nobody has acknowledged it') };
    case 'shelved': return { text: t('Shelved'), icon: 'shelf', tone: 'muted', long: t('Put aside for a time') };
    case 'normal': return { text: t('Normal'), icon: 'check', tone: 'good', long: t('Over and acknowledged') };
  }
}

export const subjectOf = (a: Pick<Alarm, 'axis' | 'drive' | 'line'>): string => a.axis ?? a.drive ?? a.line ?? 'gateway';
export const canAcknowledge = (a: Alarm): boolean => !a.acknowledged && a.state !== 'shelved';

/** The newest recording that shows this instant and can be trusted. */
export function recordingOf(list: readonly Recording[], at: string): string | null {
  const ms = Date.parse(at);
  const covers = (r: Recording) => !r.fault && r.from !== null && r.to !== null && Date.parse(r.from) <= ms && ms <= Date.parse(r.to);
  return list.filter(covers).sort((a, b) => (b.at ?? '').localeCompare(a.at ?? ''))[0]?.name ?? null;
}

export const shelfTimes = [
  { value: '600', text: t('10 minutes') },
  { value: '3600', text: t('1 hour') },
  { value: '28800', text: t('8 hours') },
  { value: '86400', text: t('1 day') },
] as const;

/** The gateway's sentences often begin with what they are about; beside its name that is said once. */
export function withoutSubject(text: string, about: string): string {
  if (about === '') return text;
  for (const begin of ['drive ', 'axis ', 'line ', '']) if (text.startsWith(`${begin}${about} `)) return text.slice(begin.length + about.length + 1);
  return text;
}

export interface EventFilter {
  least: string;
  axis: string;
  kind: string;
  text: string;
}
const rank: Record<string, number> = { info: 0, warning: 1, alarm: 2 };

export function passes(e: GatewayEvent, f: EventFilter): boolean {
  if ((rank[e.severity] ?? 0) < (rank[f.least] ?? 0)) return false;
  if (f.axis !== '' && e.axis !== f.axis) return false;
  if (f.kind !== '' && e.kind !== f.kind) return false;
  const wanted = f.text.trim().toLowerCase();
  return wanted === '' || [e.text, e.kind, e.axis, e.drive, e.line, e.who, e.parameter].some((s) => s?.toLowerCase().includes(wanted));
}

/** What the gateway can filter by itself; the text is looked for here, in what it answers. */
export const asked = (f: EventFilter): { severity?: string; axis: string; kind: string } => ({ ...(f.least !== 'info' && f.least !== '' ? { severity: f.least } : {}), axis: f.axis, kind: f.kind });

/** Newest first, each once, at most so many: what the gateway had and what has come since. */
export function gathered(had: readonly GatewayEvent[], since: readonly GatewayEvent[], f: EventFilter, most: number): GatewayEvent[] {
  const byId = new Map<number, GatewayEvent>();
  for (const e of [...had, ...since]) if (passes(e, f)) byId.set(e.id, e);
  return [...byId.values()].sort((a, b) => b.id - a.id).slice(0, most);
}

const eventColumns = ['id', 'at', 'severity', 'kind', 'axis', 'drive', 'line', 'code', 'text', 'who', 'door', 'parameter', 'old', 'new'] as const;
/** Exactly these events as a file, oldest first, in the form in which the gateway writes them. */
export function eventFile(events: readonly GatewayEvent[], format: 'csv' | 'text'): string {
  const rows = [...events].sort((a, b) => a.id - b.id);
  if (format === 'csv') return csvOf([eventColumns, ...rows.map((e) => eventColumns.map((c) => (c === 'code' && !e.code ? '' : String(e[c] ?? ''))))]);
  return rows
    .map((e) => {
      const change = e.parameter ? ` [${e.parameter}: ${e.old ?? ''} -> ${e.new ?? ''}]` : '';
      const line = `${e.at} ${e.severity.padEnd(7)} ${e.kind.padEnd(12)} ${(e.axis ?? e.drive ?? e.line ?? '-').padEnd(16)} ${e.text}${change}${e.code ? ` (code ${e.code})` : ''}${e.who ? ` by ${e.who}` : ''}`;
      return `${line.replace(/[\u0000-\u001f\u007f]/g, ' ')}\n`;
    })
    .join('');
}
