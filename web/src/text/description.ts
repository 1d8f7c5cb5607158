// Descriptions in words: which name a file gets, what it is of, whom it was made for, which of its objects are shown, what a drive of it would be.
// In: documents of /descriptions, text. Out: text, rows, the fields of a drive. Pure.
import { t } from '../language';
import type { DescriptionEntry, DescriptionObject } from '../api/descriptions';
import type { Families } from './options';
import { freeName, type Entry, type Site, type Texts } from './site';
import { sizeText } from './site-files';

/** Bytes of one file that the gateway takes. */
export const largestFile = 1 << 20;

/** The name under which a file is stored: letters, digits, - _ and . , at most 64, with its ending in small letters. '': it is no EDS or DCF by its name. */
export function storedName(file: string): string {
  const found = /^(.*)\.(eds|dcf)$/i.exec(file.trim());
  if (!found) return '';
  const name = (found[1] ?? '').replace(/[^A-Za-z0-9_.-]+/g, '-').replace(/^[.-]+/, '').slice(0, 60);
  return `${name || 'drive'}.${(found[2] ?? '').toLowerCase()}`;
}

/** "Example Motion SD-400, order code SD-400-24". What the file does not say is left out. */
export function deviceText(d: DescriptionEntry): string {
  const device = [d.vendor, d.product].filter(Boolean).join(' ');
  return [device || t('no maker is named'), d.order_code && d.order_code !== d.product ? t('order code {code}', { code: d.order_code }) : ''].filter(Boolean).join(', ');
}

/** "120 objects, 305 entries, 37 KiB". */
export const extentText = (d: DescriptionEntry): string => t('{objects} objects, {entries} entries, {size}', { objects: d.objects, entries: d.entries, size: sizeText(d.bytes) });

/** Which device a DCF was made for; '' for a file that names none. */
export function commissioningText(d: DescriptionEntry): string {
  const c = d.commissioning;
  if (!c) return '';
  const parts = [c.node === null ? '' : t('node {node}', { node: c.node }), c.node_name ? t('called {name}', { name: c.node_name }) : '', c.bit_rate_kbit === null ? '' : t('{kbit} kbit/s', { kbit: c.bit_rate_kbit })].filter(Boolean);
  return parts.length === 0 ? '' : t('Made for: {parts}.', { parts: parts.join(', ') });
}

export const usersText = (drives: readonly string[]): string =>
  drives.length === 0 ? t('No drive uses it.') : drives.length === 1 ? t('Used by drive {name}.', { name: drives[0] ?? '' }) : t('Used by drives {names}.', { names: drives.join(', ') });

export type Kind = 'all' | 'writable' | 'mappable' | 'configured' | 'maker' | 'profile';
export const kinds: readonly { value: Kind; text: string }[] = [
  { value: 'all', text: t('all objects') },
  { value: 'writable', text: t('can be written') },
  { value: 'mappable', text: t('can be in a PDO') },
  { value: 'configured', text: t('with a value of the DCF') },
  { value: 'maker', text: t('of the maker (2000h to 5FFFh)') },
  { value: 'profile', text: t('of the profile (6000h and above)') },
];
export const indexOf = (object: string): number => parseInt(object, 16);

function isOfKind(o: DescriptionObject, kind: Kind): boolean {
  switch (kind) {
    case 'all': return true;
    case 'writable': return o.access !== 'ro' && o.access !== 'const';
    case 'mappable': return o.mappable;
    case 'configured': return o.configured !== null;
    case 'maker': return indexOf(o.object) >= 0x2000 && indexOf(o.object) < 0x6000;
    case 'profile': return indexOf(o.object) >= 0x6000;
  }
}

export const objectName = (o: Pick<DescriptionObject, 'of' | 'name'>): string => [o.of, o.name].filter(Boolean).join(' · ');

/** Each word of the text is in the number, the name or the type. */
export function matchingObjects(list: readonly DescriptionObject[], text: string, kind: Kind): DescriptionObject[] {
  const words = text.toLowerCase().split(/\s+/).filter(Boolean);
  return list.filter((o) => isOfKind(o, kind) && words.every((w) => `${o.object} ${objectName(o)} ${o.type}`.toLowerCase().includes(w)));
}

/** "1 to 5000", "from 1", "up to 5000"; '' where the file has no limit. */
export function limitsText(o: Pick<DescriptionObject, 'low' | 'high'>): string {
  if (o.low !== null && o.high !== null) return t('{low} to {high}', { low: o.low, high: o.high });
  return o.low !== null ? t('from {n}', { n: o.low }) : o.high !== null ? t('up to {n}', { n: o.high }) : '';
}

/** What the form of a drive needs of a file; kept while the wizard is on its way there. */
export type Chosen = Pick<DescriptionEntry, 'name' | 'product' | 'commissioning'>;
export const chosenOf = ({ name, product, commissioning }: DescriptionEntry): Chosen => ({ name, product, commissioning });

/** A family whose drives may name a description: that of the line if it does, else the first one; '' if the gateway has none. */
export function describedFamily(line: Entry | undefined, families: Families): string {
  const taking = [...families.values()].filter((f) => f.takes_description).map((f) => f.name);
  return taking.find((n) => n === line?.family) ?? taking.find((n) => n === 'cia402') ?? taking[0] ?? '';
}

/** The fields of a drive that is made from a file: its family where the line has another one, its node number, a name that is free. */
export function driveOf(d: Chosen, line: Entry | undefined, site: Site, families: Families): Texts {
  const family = describedFamily(line, families);
  const wish = d.commissioning?.node_name || d.product || d.name.replace(/\.\w+$/, '');
  const node = d.commissioning?.node ?? null;
  return {
    name: freeName(site.drives, wish.trim().toLowerCase().replace(/[^a-z0-9_.-]+/g, '-') || 'drive'),
    description: d.name,
    family: line?.family === family ? '' : family,
    ...(node === null ? {} : { address: String(node) }),
  };
}

/** What is said when the file was made for another bit rate than that of its line; '' when it fits, or when one of them is not known. */
export function rateText(d: Chosen, line: Entry | undefined): string {
  const [kbit, own] = [d.commissioning?.bit_rate_kbit, Number(line?.bitrate ?? 0)];
  return kbit && own > 0 && own !== kbit * 1000 ? t('{name} was made for {kbit} kbit/s; line {line} has {own} kbit/s. The drive must have the bit rate of its line.', { name: d.name, kbit, line: line?.name ?? '', own: own / 1000 }) : '';
}
