// Typed: a text field whose text is taken when it is left or Enter is pressed. In: the text in force. Out: what was typed, once.
// While it is typed in, nothing that is drawn anew around it touches the text; left alone, it shows what is in force again.
import { useSignal } from '@preact/signals';

export interface TypedProps {
  value: string;
  onDone: (text: string) => void;
  'aria-label': string;
  'aria-invalid'?: boolean | undefined;
  class?: string;
  placeholder?: string | undefined;
  spellcheck?: boolean;
  inputMode?: 'decimal' | 'text';
  list?: string | undefined;
}

export function Typed({ value, onDone, list, ...rest }: TypedProps) {
  const typed = useSignal<string | null>(null);
  return (
    <input
      {...rest}
      type="text"
      autocomplete="off"
      list={list}
      value={typed.value ?? value}
      onInput={(e) => (typed.value = e.currentTarget.value)}
      onChange={(e) => {
        const text = e.currentTarget.value;
        typed.value = null;
        onDone(text);
      }}
      onBlur={() => (typed.value = null)}
    />
  );
}
