// Times in words. In: milliseconds, RFC 3339. Out: short text in the reader's own time zone. Never a time without its meaning.

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

/** "2026-01-02 14:03:27", today as well: for what is printed and kept. */
export const dateTime = (iso: string): string => clockTime(iso, new Date(0));

/** "14:03:27" today, "2026-01-02 14:03:27" on other days; local time. */
export function clockTime(iso: string, now = new Date()): string {
  const d = new Date(iso);
  if (Number.isNaN(d.getTime())) return iso;
  const time = `${pad(d.getHours())}:${pad(d.getMinutes())}:${pad(d.getSeconds())}`;
  const sameDay = d.toDateString() === now.toDateString();
  return sameDay ? time : `${d.getFullYear()}-${pad(d.getMonth() + 1)}-${pad(d.getDate())} ${time}`;
}
