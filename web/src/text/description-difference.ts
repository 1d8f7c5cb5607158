// The difference of two descriptions: objects that one of them has alone, and members in which an object of both differs. In: two lists of objects.
// Out: rows in order of index and subindex. Pure. Names and lines of the file are no difference: makers write the same object in many words.
import { t } from '../language';
import type { DescriptionObject } from '../api/descriptions';

export const members = ['type', 'access', 'mappable', 'low', 'high', 'default', 'configured'] as const;
export type Member = (typeof members)[number];
export type Side = 'first' | 'second' | 'both';

export interface ObjectDifference {
  object: string;
  name: string;
  /** Which file has it. */
  side: Side;
  /** Of an object of both files: the members that differ. */
  differing: { member: Member; first: string | null; second: string | null }[];
}

export const memberNames: Record<Member, string> = {
  type: t('type'),
  access: t('access'),
  mappable: t('can be in a PDO'),
  low: t('lowest value'),
  high: t('highest value'),
  default: t('default'),
  configured: t('value of the DCF'),
};

/** Index and subindex as one number: "1018h:01" stands behind "1018h" and before "1019h". */
const placeOf = (object: string): number => {
  const [index = '', sub = '0'] = object.split(':');
  return parseInt(index, 16) * 256 + parseInt(sub, 16);
};

const shown = (o: DescriptionObject, member: Member): string | null => (member === 'mappable' ? (o.mappable ? t('yes') : t('no')) : o[member]);

/** "$NODEID + 384" is one value, however it is spaced; numbers come in one form from the gateway. */
const same = (a: string | null, b: string | null): boolean => a === b || (a !== null && b !== null && a.replace(/\s+/g, '') === b.replace(/\s+/g, ''));

export function differenceOfObjects(first: readonly DescriptionObject[], second: readonly DescriptionObject[]): ObjectDifference[] {
  const others = new Map(second.map((o) => [o.object, o]));
  const rows: ObjectDifference[] = [];
  for (const a of first) {
    const b = others.get(a.object);
    others.delete(a.object);
    if (!b) rows.push({ object: a.object, name: a.name ?? a.of ?? '', side: 'first', differing: [] });
    else {
      const differing = members.flatMap((member) => {
        const [x, y] = [shown(a, member), shown(b, member)];
        return same(x, y) ? [] : [{ member, first: x, second: y }];
      });
      if (differing.length > 0) rows.push({ object: a.object, name: a.name ?? a.of ?? '', side: 'both', differing });
    }
  }
  for (const b of others.values()) rows.push({ object: b.object, name: b.name ?? b.of ?? '', side: 'second', differing: [] });
  return rows.sort((a, b) => placeOf(a.object) - placeOf(b.object));
}

export const sidesOf = (rows: readonly ObjectDifference[]): Record<Side, number> => ({
  first: rows.filter((r) => r.side === 'first').length,
  second: rows.filter((r) => r.side === 'second').length,
  both: rows.filter((r) => r.side === 'both').length,
});

/** "12 objects differ; 3 only in a.eds; 1 only in b.eds." */
export function differenceText(rows: readonly ObjectDifference[], first: string, second: string): string {
  if (rows.length === 0) return t('{first} and {second} have the same objects with the same types, limits and values.', { first, second });
  const n = sidesOf(rows);
  return t('{both} objects of both files differ; {a} are only in {first}, {b} only in {second}.', { both: n.both, a: n.first, first, b: n.second, second });
}
