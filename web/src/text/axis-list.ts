// A list of axes: in which order, under which headings. In: axes as they are now, what is asked for. Out: names. Pure.
// An order by a live value is that of the moment it was asked for: rows that change places under the hand are no help.
import type { Axis } from '../api/types';

export const sortKeys = ['number', 'name', 'position', 'velocity', 'state'] as const;
export type SortKey = (typeof sortKeys)[number];
export interface Order {
  by: SortKey;
  down: boolean;
}
export const asConfigured: Order = { by: 'number', down: false };

/** What needs a person first: faults, then what is not there, what moves, what has power, the rest. */
const rank = (a: Axis): number => (a.fault ? 0 : !a.online ? 1 : a.moving ? 2 : a.state === 'operation_enabled' ? 3 : 4);
const collator = new Intl.Collator('en', { numeric: true, sensitivity: 'base' });
const least = (v: number | null): number => v ?? -Infinity;

function compare(a: Axis, b: Axis, by: SortKey): number {
  switch (by) {
    case 'number': return a.number - b.number;
    case 'name': return collator.compare(a.name, b.name);
    case 'position': return least(a.position) - least(b.position) || 0;
    case 'velocity': return Math.abs(least(a.velocity)) - Math.abs(least(b.velocity)) || 0;
    case 'state': return rank(a) - rank(b);
  }
}

export const sorted = (axes: readonly Axis[], order: Order): string[] =>
  [...axes].sort((a, b) => (order.down ? -1 : 1) * compare(a, b, order.by) || a.number - b.number || collator.compare(a.name, b.name)).map((a) => a.name);

/** The next order when a heading is pressed: up, down, and as the site has it again. */
export const pressed = (now: Order, by: SortKey): Order => (now.by !== by ? { by, down: by === 'velocity' } : now.down === (by === 'velocity') ? { by, down: !now.down } : asConfigured);

/** By machine part, in the order in which the parts come first; what belongs to none is last. One list without a heading where no axis has one. */
export function grouped(names: readonly string[], groupOf: (name: string) => string): { group: string; names: string[] }[] {
  const by = new Map<string, string[]>();
  for (const n of names) by.set(groupOf(n), [...(by.get(groupOf(n)) ?? []), n]);
  const rest = by.get('') ?? [];
  by.delete('');
  return [...[...by].map(([group, list]) => ({ group, names: list })), ...(rest.length > 0 ? [{ group: '', names: rest }] : [])];
}
