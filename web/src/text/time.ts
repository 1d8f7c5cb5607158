// Times in words. In: milliseconds, RFC 3339. Out: short text in the reader's own time zone, dates as the language writes them. Never a time without
// its meaning. Units stay the SI's in every language; English writes dates by ISO 8601, which nobody reads the wrong way round.
import { language } from '../language';

/** "4 s", "3 min", "2 h", "5 d". */
export function duration(ms: number): string {
  const s = Math.max(0, ms) / 1000;
  if (s < 1) return '< 1 s';
  if (s < 90) return `${Math.round(s)} s`;
  if (s < 90 * 60) return `${Math.round(s / 60)} min`;
  if (s < 36 * 3600) return `${Math.round(s / 3600)} h`;
  return `${Math.round(s / 86400)} d`;
}

const pad = (n: number) => String(n).padStart(2, '0');
const days = { de: new Intl.DateTimeFormat('de-DE', { dateStyle: 'medium' }), zh: new Intl.DateTimeFormat('zh-CN', { dateStyle: 'medium' }) };
const isoDay = (d: Date): string => `${d.getFullYear()}-${pad(d.getMonth() + 1)}-${pad(d.getDate())}`;

/** "2026-01-02", "02.01.2026", "2026年1月2日". */
export function day(d: Date): string {
  const l = language();
  return l === 'en' ? isoDay(d) : days[l].format(d);
}

/** "2026-01-02 14:03:27", today as well: for what is printed and kept. */
export const dateTime = (iso: string): string => clockTime(iso, new Date(0));

/** "14:03:27" today, "2026-01-02 14:03:27" on other days; local time. */
export function clockTime(iso: string, now = new Date()): string {
  const d = new Date(iso);
  if (Number.isNaN(d.getTime())) return iso;
  const time = `${pad(d.getHours())}:${pad(d.getMinutes())}:${pad(d.getSeconds())}`;
  return d.toDateString() === now.toDateString() ? time : `${day(d)} ${time}`;
}
