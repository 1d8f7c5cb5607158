// Site files in words: how large something is, and what a restore that waits will bring. In: documents. Out: text. Pure.
import type { Pending } from '../api/site';
import { clockTime } from './time';

export const sizeWords = (bytes: number): string => (bytes < 1024 ? `${bytes} bytes` : bytes < 1024 * 1024 ? `${Math.round(bytes / 1024)} KiB` : `${(bytes / 1024 / 1024).toFixed(1)} MiB`);

/** "Laid down 21:03:11 by anna 127.0.0.1, 312 KiB. It brings site revision 7; structure 5 of the database." What is not told is left out. */
export function pendingWords(p: Pending): string {
  const laid = [p.at ? `Laid down ${clockTime(p.at)}` : 'Laid down', p.who ? ` by ${p.who}` : '', p.bytes === null ? '' : `, ${sizeWords(p.bytes)}`].join('');
  const brings = [p.site_revision === null ? '' : `site revision ${p.site_revision} with it`, p.version === null ? '' : `a database of structure ${p.version}`].filter(Boolean);
  return `${laid}.${brings.length > 0 ? ` It brings ${brings.join(', and ')}.` : ''} Site, mappings, parameters, snapshots, recipes, events, users and tokens of now go with that start.`;
}
