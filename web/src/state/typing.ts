// Typing: whether a text is being typed just now. In: input, Enter and the way of the keyboard. Out: a signal for the stop, whose key first takes
// back what is being typed. A text that was sent by Enter, or that only stands in a field, is not being typed. Never looks at what is typed.
import { signal } from '@preact/signals';

type TextField = HTMLInputElement | HTMLTextAreaElement;
const others = new Set(['checkbox', 'radio', 'range', 'file', 'button', 'submit', 'reset', 'color', 'image', 'hidden']);
const isText = (t: unknown): t is TextField => t instanceof HTMLTextAreaElement || (t instanceof HTMLInputElement && !others.has(t.type));

/** The field in which somebody types; null: nobody does. */
export const typing = signal<TextField | null>(null);

export function watchTyping(at: EventTarget = document): () => void {
  const end = new AbortController();
  const on = (kind: string, f: (e: Event) => void) => at.addEventListener(kind, f, { capture: true, signal: end.signal });
  on('input', (e) => {
    const field = e.target;
    if (isText(field) && field === field.ownerDocument.activeElement) typing.value = field.value === '' ? null : field;
  });
  on('keydown', (e) => {
    if ((e as KeyboardEvent).key === 'Enter' && e.target instanceof HTMLInputElement) typing.value = null;
  });
  on('focusout', () => void (typing.value = null));
  return () => end.abort();
}

/** How to put back what somebody carries over a map; null: nothing is carried. As with typing, the first Escape puts it back, the next one stops. */
export const held = signal<(() => void) | null>(null);

/** Takes back what is being typed or carried; false: nothing is. */
export function emptyTyped(): boolean {
  const putBack = held.peek();
  if (putBack) {
    held.value = null;
    putBack();
    return true;
  }
  const field = typing.peek();
  typing.value = null;
  if (!field?.isConnected || field.value === '' || field.readOnly || field.disabled) return false;
  // As a person would have emptied it: whoever keeps its text hears of it.
  field.value = '';
  field.dispatchEvent(new Event('input', { bubbles: true }));
  return true;
}
