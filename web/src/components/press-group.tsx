// Press group: buttons side by side, of which some are pressed: points, axes, spans of time, tables. In: what each is called and whether it is on. Out: which
// was pressed. Never keeps what is on.
import type { ComponentChildren } from 'preact';

export interface Pressable<V> {
  value: V;
  text: ComponentChildren;
  on: boolean;
  title?: string;
  class?: string;
  disabled?: boolean;
}

interface PressGroupProps<V> {
  label: string;
  class?: string;
  /** What each button looks like. */
  look?: string;
  of: readonly Pressable<V>[];
  press: (value: V) => void;
  /** Further buttons, behind these. */
  children?: ComponentChildren;
}

export function PressGroup<V extends string | number>({ label, class: more = '', look = 'small', of, press, children }: PressGroupProps<V>) {
  return (
    <div class={`group ${more}`} role="group" aria-label={label}>
      {of.map((b) => (
        <button key={b.value} type="button" class={`button ${look} ${b.class ?? ''}`} aria-pressed={b.on} title={b.title} disabled={b.disabled} onClick={() => press(b.value)}>
          {b.text}
        </button>
      ))}
      {children}
    </div>
  );
}
