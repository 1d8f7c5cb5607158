// Mapping facts: what is said beside the fields while a mapping is typed: whether its place is free, what is before and behind it, which type is its point's own. In:
// texts, the mappings that there are, what is known of points. Out: places, words. Pure.
import { t } from '../language';
import { addressText, doubtText, otherText, readAddress, spanText, type Base } from './address';
import { conflictsOf, isBits, neighbourText, nextFree, placeText, signWarning, widthOf, type Known, type Mapping, type Texts } from './mapping';
import { checkTexts, type Checked } from './mapping-check';
import { naturalType } from './mapping-type';

export interface MappingFacts extends Checked {
  bits: boolean;
  width: number;
  /** The first free place, or the next one behind what is taken; null: there is none. As it is typed, and where. */
  free: string | null;
  /** By whom the place is taken. */
  taken: string | undefined;
  natural: string | null;
  addressHint: string;
  typeHint: string | undefined;
  warning: string;
}

/** `ownId`: of the entry that is changed. */
export function mappingFacts(texts: Texts, rows: readonly Mapping[], known: Known, base: Base, ownId: string | undefined): MappingFacts {
  const { spec, faults } = checkTexts(texts, known);
  const { unit, table, type } = { unit: Number(texts.unit), table: texts.table as Mapping['table'], type: texts.type as Mapping['type'] };
  const length = Number(texts.length);
  const bits = isBits(texts.table);
  const width = widthOf(type || 'i32', length || 16);
  const at = readAddress(texts.address, table, base);
  const place = { unit, table, address: at.good ? at.address : 0, type, ...(length ? { length } : {}) };
  const sure = !faults.unit && !faults.table && !faults.type;
  const placed = texts.address.trim() !== '' && !faults.address && sure;
  const conflicts = placed ? conflictsOf(place, rows, ownId) : [];
  const free = sure ? nextFree(rows.filter((m) => m.id !== ownId), unit, table, width, conflicts.length > 0 ? place.address : 0) : null;
  const natural = naturalType(texts.axis, texts.point, known);
  return {
    spec,
    faults,
    bits,
    width,
    free: free === null ? null : addressText(table, free, base),
    taken: takenBy(conflicts, base),
    natural,
    addressHint: placed ? t('{doubt} {place} is {other}. Free: {neighbours}.', { doubt: doubtText(texts.address, base), place: spanText(table, place.address, place.address + width - 1, base), other: otherText(table, place.address, base), neighbours: neighbourText(place, rows, ownId) }).trim() : t('counted from {base}', { base }),
    typeHint: !natural || bits ? undefined : natural === texts.type ? t('the point’s own type') : t('the point’s own type is {type}', { type: natural }),
    warning: signWarning({ point: texts.point.trim(), type: texts.type, offset: Number(texts.offset) || 0 }, known.points),
  };
}

function takenBy(conflicts: readonly Mapping[], base: Base): string | undefined {
  if (conflicts.length === 0) return undefined;
  const list = conflicts.slice(0, 3).map((c) => t('{id} ({point} of {axis}, {place})', { id: c.id, point: c.point, axis: c.axis, place: placeText(c, base) })).join(', ');
  return conflicts.length > 3 ? t('Taken by {list} and {n} more.', { list, n: conflicts.length - 3 }) : t('Taken by {list}.', { list });
}
