// Persisted: what people typed or chose, by a name. In: text. Out: a signal that survives a change of page and a reload.
// Typed text lives in the session of the tab; choices (theme, density) in the browser. Works without storage too, then for the visit.
import { signal, type Signal } from '@preact/signals';
import { keep, kept, type Where } from './kept';

const known = new Map<string, Signal<string>>();

export function persisted(name: string, first = '', where: Where = 'session'): Signal<string> {
  let s = known.get(name);
  if (s) return s;
  s = signal(kept(name, first, where));
  s.subscribe((v) => keep(name, v, first, where));
  known.set(name, s);
  return s;
}

/** Empties a field whose text was sent and taken; what was typed in it since then stays. */
export function emptied(field: Signal<string>, sent: string, next = ''): void {
  if (field.peek() === sent) field.value = next;
}
