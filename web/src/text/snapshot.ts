// A snapshot in words: when, of what drives, by whom; and why one of another family is of no use here. In: documents. Out: text, choices. Pure.
import { t } from '../language';
import type { Snapshot } from '../api/snapshots';
import { clockTime } from './time';

const titled = (family: string, titles: ReadonlyMap<string, string>): string => (titles.has(family) ? `${titles.get(family)} (${family})` : family);

/** "21:03:11 · UIROBOT UIM342 (uim342) · 58 values · by anna · stored values · as delivered". */
export function snapshotText(s: Snapshot, titles: ReadonlyMap<string, string>): string {
  const count = s.values ?? (typeof s.parameters === 'number' ? s.parameters : undefined);
  return [
    s.at ? clockTime(s.at) : '',
    s.family ? titled(s.family, titles) : s.family === null ? t('family not known: taken by an older program') : '',
    count === undefined ? '' : count === 1 ? t('1 value') : t('{count} values', { count }),
    s.who ? t('by {who}', { who: s.who }) : '',
    s.from === 'stored' ? t('stored values') : '',
    s.comment ?? '',
  ].filter(Boolean).join(' · ');
}

const foreign = (s: Snapshot, family: string) => Boolean(s.family && family && s.family !== family);

/** Why it can be neither compared nor restored here; empty: it can, as far as the page knows. */
export const foreignText = (s: Snapshot, family: string, titles: ReadonlyMap<string, string>): string =>
  foreign(s, family) ? t('Taken of {n}; the drive is {family} now, so it is neither compared nor restored.', { n: titled(s.family ?? '', titles), family: titled(family, titles) }) : '';

export interface Offer {
  value: string;
  text: string;
  disabled?: boolean;
}
export const snapshotChoice = (s: Snapshot, value: string, family: string): Offer =>
  foreign(s, family) ? { value, text: t('snapshot {name}: of {family}, not comparable', { name: s.name, family: s.family ?? '' }), disabled: true } : { value, text: t('snapshot {name}', { name: s.name }) };
/** Another family can be chosen, to be told why it cannot be compared. `said`: the name as it is shown. */
export const axisChoice = (name: string, theirs: string, family: string, published = name): Offer =>
  theirs !== family ? { value: `axis:${name}`, text: t('axis {published}: {theirs}, not comparable', { published, theirs }) } : { value: `axis:${name}`, text: t('axis {published}, values known now', { published }) };
/** Why two axes are not compared. */
export const differentFamilies = (axis: string, family: string, other: string, theirs: string, titles: ReadonlyMap<string, string>): string =>
  t('The families differ: {other} is {theirs}, {axis} is {family}. Their parameters are not the same ones, so they cannot be compared.', { other, theirs: titled(theirs, titles), axis, family: titled(family, titles) });
