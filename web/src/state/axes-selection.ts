// Axes selection: which axes a command is meant for. In: names. Out: a signal for this visit; a reload selects nothing, so that nothing is commanded
// by a choice of yesterday.
import { signal } from '@preact/signals';

export const selection = signal<ReadonlySet<string>>(new Set());

export function select(names: readonly string[], yes: boolean): void {
  const next = new Set(selection.peek());
  for (const n of names) {
    if (yes) next.add(n);
    else next.delete(n);
  }
  selection.value = next;
}
/** Those that are selected and still there, in the order of the site. */
export const selectedOf = (all: readonly string[]): string[] => all.filter((n) => selection.value.has(n));
