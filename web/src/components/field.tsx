// Field: a number that a person types, with its unit. In: a signal that keeps the text. Out: the text; the reader of it parses.
// Enter does what the button beside it does. What was typed stays, whatever becomes of the command.
import type { Signal } from '@preact/signals';
import { useId } from 'preact/hooks';
import { t } from '../language';

export interface FieldProps {
  label: string;
  /** What a screen reader hears, where the label beside the field is short: "Target of feeder". */
  longLabel?: string;
  unit: string;
  text: Signal<string>;
  invalid?: boolean;
  describedBy?: string;
  placeholder?: string;
  onEnter?: () => void;
}

export function Field({ label, longLabel, unit, text, invalid: refused, describedBy, placeholder, onEnter }: FieldProps) {
  const id = useId();
  return (
    <div class="field">
      <label for={id}>{label}</label>
      <span class={`field-box${refused ? ' is-wrong' : ''}`}>
        <input
          id={id}
          type="text"
          inputMode="decimal"
          autocomplete="off"
          spellcheck={false}
          value={text.value}
          placeholder={placeholder}
          title={placeholder === t('as is') ? t('Empty: as the drive has it') : undefined}
          aria-label={longLabel}
          aria-invalid={refused || undefined}
          aria-describedby={describedBy}
          onInput={(e) => (text.value = e.currentTarget.value)}
          onKeyDown={(e) => {
            if (e.key === 'Enter' && onEnter && !e.repeat) {
              e.preventDefault();
              onEnter();
            }
          }}
        />
        <span class="unit" aria-hidden="true" title={unit}>
          {unit}
        </span>
      </span>
    </div>
  );
}
