// Persisted: what people typed or chose, by a name. In: text. Out: a signal that survives a change of page and a reload.
// Typed text lives in the session of the tab; choices (theme, density) in the browser. Works without storage too, then for the visit.
import { signal, type Signal } from '@preact/signals';

const known = new Map<string, Signal<string>>();

export function persisted(name: string, first = '', where: 'session' | 'browser' = 'session'): Signal<string> {
  const key = `axisgate.${name}`;
  let s = known.get(key);
  if (s) return s;
  const storage = storageOf(where);
  let value = first;
  try {
    value = storage?.getItem(key) ?? first;
  } catch {
    // Forbidden storage: this visit only.
  }
  s = signal(value);
  s.subscribe((v) => {
    try {
      if (v === first) storage?.removeItem(key);
      else storage?.setItem(key, v);
    } catch {
      // Full or forbidden.
    }
  });
  known.set(key, s);
  return s;
}

/** Empties a field whose text was sent and taken; what was typed in it since then stays. */
export function emptied(field: Signal<string>, sent: string, next = ''): void {
  if (field.peek() === sent) field.value = next;
}

function storageOf(where: 'session' | 'browser'): Storage | undefined {
  try {
    return where === 'session' ? globalThis.sessionStorage : globalThis.localStorage;
  } catch {
    return undefined;
  }
}
