// Site files in words: how large something is, and what a restore that waits will bring. In: documents. Out: text. Pure.
import { t } from '../language';
import type { Pending } from '../api/site';
import { clockTime } from './time';

export const sizeWords = (bytes: number): string => (bytes < 1024 ? t('{bytes} bytes', { bytes }) : bytes < 1024 * 1024 ? `${Math.round(bytes / 1024)} KiB` : `${(bytes / 1024 / 1024).toFixed(1)} MiB`);

/** "Laid down 21:03:11 by anna 127.0.0.1, 312 KiB. It brings site revision 7; structure 5 of the database." What is not told is left out. */
export function pendingWords(p: Pending): string {
  const laid = [p.at ? t('Laid down {at}', { at: clockTime(p.at) }) : t('Laid down'), p.who ? t(' by {who}', { who: p.who }) : '', p.bytes === null ? '' : `, ${sizeWords(p.bytes)}`].join('');
  const brings = [p.site_revision === null ? '' : t('site revision {site_revision} with it', { site_revision: p.site_revision }), p.version === null ? '' : t('a database of structure {version}', { version: p.version })].filter(Boolean);
  return t('{laid}.{value} Site, mappings, parameters, snapshots, recipes, events, users and tokens of now go with that start.', { laid, value: brings.length > 0 ? t(' It brings {list}.', { list: brings.join(', and ') }) : '' });
}
