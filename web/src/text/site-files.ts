// Site files in words: how large something is, and what a restore that waits will bring. In: documents. Out: text. Pure.
import { t } from '../language';
import type { Pending } from '../api/site';
import { localFigures } from './number';
import { clockTime } from './time';

export const sizeText = (bytes: number): string => (bytes < 1024 ? t('{bytes} bytes', { bytes }) : bytes < 1024 * 1024 ? `${Math.round(bytes / 1024)} KiB` : `${localFigures((bytes / 1024 / 1024).toFixed(1))} MiB`);

/** "Laid down 21:03:11 by anna 127.0.0.1, 312 KiB. It brings site revision 7; structure 5 of the database." What is not told is left out. */
export function pendingText(p: Pending): string {
  const at = p.at ? clockTime(p.at) : '';
  const laid = at ? (p.who ? t('Laid down {at} by {who}', { at, who: p.who }) : t('Laid down {at}', { at })) : p.who ? t('Laid down by {who}', { who: p.who }) : t('Laid down');
  const revision = p.site_revision === null ? '' : t('site revision {site_revision} with it', { site_revision: p.site_revision });
  const structure = p.version === null ? '' : t('a database of structure {version}', { version: p.version });
  return [
    p.bytes === null ? t('{laid}.', { laid }) : t('{laid}, {size}.', { laid, size: sizeText(p.bytes) }),
    revision && structure ? t('It brings {revision}, and {structure}.', { revision, structure }) : revision || structure ? t('It brings {list}.', { list: revision || structure }) : '',
    t('Site, mappings, parameters, snapshots, recipes, events, users and tokens of now go with that start.'),
  ].filter(Boolean).join(' ');
}
