// Toggled: one of a list or of a set, taken out if it is there, else put in. In: the list or set, the one. Out: another list or set. Pure.
export const toggled = <T>(list: readonly T[], one: T): T[] => (list.includes(one) ? list.filter((x) => x !== one) : [...list, one]);

export function toggledIn<T>(set: ReadonlySet<T>, one: T): Set<T> {
  const next = new Set(set);
  if (!next.delete(one)) next.add(one);
  return next;
}
