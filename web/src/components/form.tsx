// Form: labelled fields with their fault in words beneath, and a line that tells how it went. In: text and why it is wrong. Out: what is typed.
// The fault is bound to its field for screen readers; what was typed is never changed here.
import type { ComponentChildren } from 'preact';
import { marked } from './marked';
import { useId } from 'preact/hooks';
import { t } from '../language';
import type { Reported } from '../state/reported';

interface Common {
  label: string;
  fault?: string | undefined;
  hint?: ComponentChildren;
  class?: string;
}

export interface TextFieldProps extends Common {
  value: string;
  onText: (text: string) => void;
  onLeave?: () => void;
  placeholder?: string;
  number?: boolean;
  disabled?: boolean;
  /** Offers while typing. */
  offers?: readonly { value: string; text?: string; lang?: 'en' }[];
  mono?: boolean;
  password?: boolean;
  /** What a password manager may fill in. */
  fill?: string;
}

export function TextField(p: TextFieldProps) {
  const id = useId();
  const reported = Boolean(p.fault) || p.hint !== undefined;
  return (
    <div class={`form-field ${p.class ?? ''}`}>
      <label for={id}>{p.label}</label>
      <input
        id={id}
        type={(p.password ? 'password' : 'text') as 'text'}
        class={`${p.fault ? 'is-wrong' : ''}${p.mono ? ' mono' : ''}`}
        inputMode={p.number ? 'decimal' : 'text'}
        autocomplete={(p.fill ?? 'off') as 'off'}
        autocapitalize="off"
        spellcheck={false}
        value={p.value}
        placeholder={p.placeholder}
        disabled={p.disabled}
        list={p.offers ? `${id}-offers` : undefined}
        aria-invalid={p.fault ? true : undefined}
        aria-describedby={reported ? `${id}-told` : undefined}
        onInput={(e) => p.onText(e.currentTarget.value)}
        onBlur={p.onLeave}
      />
      {p.offers && (
        <datalist id={`${id}-offers`}>
          {p.offers.map((o) => (
            <option key={o.value} value={o.value} lang={o.lang}>
              {o.text}
            </option>
          ))}
        </datalist>
      )}
      <FieldNote id={`${id}-told`} fault={p.fault} hint={p.hint} />
    </div>
  );
}

export interface ChoiceProps extends Common {
  value: string;
  onChoice: (value: string) => void;
  choices: readonly { value: string; text: string; disabled?: boolean; lang?: 'en' }[];
  disabled?: boolean;
}

/** How much room the longest choice needs, in columns of a form: a Chinese character is as wide as two letters. */
export function choiceRoom(choices: readonly { text: string }[]): '' | 'takes-some' | 'takes-two' | 'takes-row' {
  const figures = Math.max(0, ...choices.map((c) => [...c.text].reduce((n, char) => n + (char >= '\u2e80' ? 2 : 1), 0)));
  return figures > 34 ? 'takes-row' : figures > 18 ? 'takes-two' : figures > 11 ? 'takes-some' : '';
}

export function Choice(p: ChoiceProps) {
  const id = useId();
  const reported = Boolean(p.fault) || p.hint !== undefined;
  const room = choiceRoom(p.choices);
  const known = p.choices.some((c) => c.value === p.value);
  return (
    <div class={`form-field ${room} ${p.class ?? ''}`}>
      <label for={id}>{p.label}</label>
      <select id={id} class={p.fault ? 'is-wrong' : ''} value={p.value} disabled={p.disabled} aria-invalid={p.fault ? true : undefined} aria-describedby={reported ? `${id}-told` : undefined} onChange={(e) => p.onChoice(e.currentTarget.value)}>
        {!known && <option value={p.value}>{p.value || t('choose')}</option>}
        {p.choices.map((c) => (
          <option key={c.value} value={c.value} disabled={c.disabled} lang={c.lang}>
            {c.text}
          </option>
        ))}
      </select>
      {room === 'takes-row' && (
        <p class="form-told choice-whole" aria-hidden="true">
          {p.choices.find((c) => c.value === p.value)?.text}
        </p>
      )}
      <FieldNote id={`${id}-told`} fault={p.fault} hint={p.hint} />
    </div>
  );
}

export function Switch(p: Common & { on: boolean; onSwitch: (on: boolean) => void }) {
  const id = useId();
  return (
    <div class="form-field">
      <label class="check">
        <input type="checkbox" checked={p.on} aria-describedby={`${id}-told`} onChange={(e) => p.onSwitch(e.currentTarget.checked)} /> {p.label}
      </label>
      <FieldNote id={`${id}-told`} fault={p.fault} hint={p.hint} />
    </div>
  );
}

function FieldNote({ id, fault, hint }: { id: string; fault: string | undefined; hint: ComponentChildren }) {
  if (fault) {
    return (
      <p class="form-told is-fault" id={id}>
        {marked(fault)}
      </p>
    );
  }
  return hint === undefined ? null : (
    <p class="form-told" id={id}>
      {typeof hint === 'string' ? marked(hint) : hint}
    </p>
  );
}

/** How it went, spoken when it changes. Keeps its place. */
export function Tell({ reported, field }: { reported: Reported; field?: string }) {
  return (
    <p class={`tell result-${reported.tone}`} role="status" data-field={field}>
      {marked(reported.text)}
    </p>
  );
}

/** What a gateway that is older than the page does not do. */
export const notOffered = (what: string): string => t('This gateway does not offer {what}.', { what });
