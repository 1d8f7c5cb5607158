// What is wrong now, in words, each with the place where it can be mended; why an axis is offline, from its own drive and its own alarms.
// In: documents of the gateway. Out: words and links. Never a reason that belongs to another axis, drive or line.
import { t } from '../language';
import type { Alarm, Axis, Drive, Line } from '../api/types';
import { axisPath, linePath } from '../router';
import type { Word } from './axis';

export interface ErrorEntry {
  key: string;
  word: Word;
  about: string;
  text: string;
  path: string;
  /** The axes that cannot be commanded because of it. */
  axes: string[];
}

const newest = (alarms: readonly Alarm[]): Alarm | undefined => alarms.filter((a) => a.active).sort((a, b) => b.since.localeCompare(a.since))[0];

/** Of a drive that is silent what the gateway says of it; of one that answers, the axis' own alarm, then the drive's. */
export function offlineReason(axis: Pick<Axis, 'name' | 'drive' | 'error'>, drive: Drive | undefined, alarms: readonly Alarm[]): string {
  if (!drive) return t('nobody answers');
  if (!drive.status.online) return drive.status.text || t('nobody answers');
  const own = newest(alarms.filter((a) => a.axis === axis.name)) ?? newest(alarms.filter((a) => a.axis === null && a.drive === axis.drive));
  if (own?.text) return own.text;
  if (axis.error.code !== 0) return t('error {code}: {n}', { code: axis.error.code, n: axis.error.text || t('the drive says no more') });
  return t('the drive answers, this axis does not');
}

/** Faults first, then lines, drives, axes that do not answer, and at the end what waits to be acknowledged. Nothing: all is well. */
export function errorsNow(axes: Axis[], lines: Line[], drives: Drive[], unacknowledged: number, alarms: readonly Alarm[] = []): ErrorEntry[] {
  const out: ErrorEntry[] = [];
  const put = (key: string, text: string, icon: Word['icon'], tone: Word['tone'], about: string, long: string, path: string, of: string[] = []) =>
    out.push({ key, word: { text, icon, tone, long }, about, text: long, path, axes: of });
  for (const a of axes) if (a.fault) put(`axis ${a.name}`, t('Fault'), 'bell', 'fault', a.name, t('Fault {code}: {n}', { code: a.error.code, n: a.error.text || t('the drive says no more') }), axisPath(a.name));
  const reported = new Set<string>();
  const offline = (of: (a: Axis) => boolean): string[] => {
    const names = axes.filter((a) => !a.online && of(a) && !reported.has(a.name)).map((a) => a.name);
    for (const n of names) reported.add(n);
    return names;
  };
  const down = new Set<string>();
  for (const l of lines) {
    if (l.status.state !== 'down' && l.status.state !== 'bus_off') continue;
    down.add(l.name);
    put(`line ${l.name}`, l.status.state === 'down' ? t('Line down') : t('Bus off'), 'unplugged', 'fault', l.name, l.status.text || t('it cannot be opened'), linePath(l.name), offline((a) => a.line === l.name));
  }
  for (const d of drives) {
    // A drive of a line that is down is told with its line.
    if (d.status.presence !== 'offline' || down.has(d.line)) continue;
    put(`drive ${d.name}`, t('Drive offline'), 'unplugged', 'warning', d.name, d.status.text || t('nobody answers'), linePath(d.line), offline((a) => a.drive === d.name));
  }
  const byDrive = new Map(drives.map((d) => [d.name, d]));
  const groups = new Map<string, { drive: string; line: string; why: string; names: string[] }>();
  for (const a of axes) {
    if (a.online || reported.has(a.name)) continue;
    const why = offlineReason(a, byDrive.get(a.drive), alarms);
    const group = groups.get(`${a.drive}\n${why}`) ?? { drive: a.drive, line: a.line, why, names: [] };
    group.names.push(a.name);
    groups.set(`${a.drive}\n${why}`, group);
  }
  for (const g of groups.values()) {
    const [first = '', ...more] = g.names;
    if (more.length === 0) put(`offline ${first}`, t('Axis offline'), 'unplugged', 'warning', first, g.why, axisPath(first));
    else put(`offline ${g.drive} ${first}`, t('{n} axes offline', { n: g.names.length }), 'unplugged', 'warning', g.drive, g.why, linePath(g.line), g.names);
  }
  if (unacknowledged > 0) put('alarms', t('Alarms'), 'list', 'warning', '', unacknowledged === 1 ? t('1 alarm is not acknowledged') : t('{unacknowledged} alarms are not acknowledged', { unacknowledged }), '/events');
  return out;
}
