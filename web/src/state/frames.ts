// Frames: which of the recorded frames are shown, and one of them byte by byte. In: frames as the stream tells them. Out: values.
// At most `mostFrames` are kept; the oldest give way.
import type { components } from '../api/schema';
import { t } from '../language';

export type Frame = components['schemas']['Frame'];
export const mostFrames = 2000;

export interface FrameFilter {
  /** Words that must all be there, in the bytes, the text or the reading; `-word`: must not be there. */
  text: string;
  direction: 'both' | 'to' | 'from';
}

/** After a reconnection the newest ones come once more: what is known already is left out. */
export function joined(earlier: Frame[], news: Frame[]): Frame[] {
  const last = earlier.at(-1)?.sequence ?? -1;
  return [...earlier, ...news.filter((f) => f.sequence > last)].slice(-mostFrames);
}

export function matches(f: Frame, filter: FrameFilter): boolean {
  if (filter.direction !== 'both' && f.to_drive !== (filter.direction === 'to')) return false;
  const texts = filter.text.toLowerCase().split(/\s+/).filter(Boolean);
  if (texts.length === 0) return true;
  const all = `${f.text} ${f.data} ${f.decoded.join(' ')} ${f.simulated ? t('simulated') : t('cable')} ${f.kind}`.toLowerCase();
  return texts.every((w) => (w.length > 1 && w.startsWith('-') ? !all.includes(w.slice(1)) : all.includes(w)));
}

export interface ByteRow {
  at: number;
  hex: string;
  decimal: number;
  bits: string;
  /** Printable ASCII, the name of a control character, or nothing. */
  letter: string;
}

const controls = ['NUL', 'SOH', 'STX', 'ETX', 'EOT', 'ENQ', 'ACK', 'BEL', 'BS', 'HT', 'LF', 'VT', 'FF', 'CR', 'SO', 'SI', 'DLE', 'DC1', 'DC2', 'DC3', 'DC4', 'NAK', 'SYN', 'ETB', 'CAN', 'EM', 'SUB', 'ESC', 'FS', 'GS', 'RS', 'US'];

export function bytesOf(data: string): ByteRow[] {
  const rows: ByteRow[] = [];
  for (let i = 0; i + 1 < data.length; i += 2) {
    const n = parseInt(data.slice(i, i + 2), 16);
    const letter = n < 32 ? (controls[n] ?? '') : n < 127 ? String.fromCharCode(n) : n === 127 ? 'DEL' : '';
    rows.push({ at: i / 2, hex: data.slice(i, i + 2), decimal: n, bits: n.toString(2).padStart(8, '0'), letter });
  }
  return rows;
}

/** "04280095 (extended, 29 bits)" */
export function idText(f: Frame): string {
  if (f.id === null) return '';
  const digits = f.extended ? 8 : 3;
  const values = { id: f.id.toString(16).toUpperCase().padStart(digits, '0'), n: f.id };
  if (f.remote) return f.extended ? t('{id} (extended, 29 bits, remote), decimal {n}', values) : t('{id} (standard, 11 bits, remote), decimal {n}', values);
  return f.extended ? t('{id} (extended, 29 bits), decimal {n}', values) : t('{id} (standard, 11 bits), decimal {n}', values);
}
