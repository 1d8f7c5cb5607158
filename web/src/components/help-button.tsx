// Help button: what a field or a control is, where there is no room to say it always: a press opens it, with a finger, a mouse or the keyboard, and
// shuts it again. In: whose help it is, the text. Out: a button and, while it is open, the text under it. Nothing where there is no text.
import { useSignal } from '@preact/signals';
import { marked } from './marked';
import type { ComponentChildren } from 'preact';
import { useId } from 'preact/hooks';
import { t } from '../language';

export function HelpButton({ of, children }: { of: string; children: ComponentChildren }) {
  const open = useSignal(false);
  const id = useId();
  if (children === undefined || children === null || children === '') return null;
  return (
    <>
      <button type="button" class="help-button" aria-label={t('Help: {what}', { what: of })} aria-expanded={open.value} aria-controls={id} onClick={() => (open.value = !open.value)}>
        ?
      </button>
      <span class="help-text" id={id} role="note" hidden={!open.value}>
        {typeof children === 'string' ? marked(children) : children}
      </span>
    </>
  );
}
