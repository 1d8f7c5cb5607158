// Ask: a question before what cannot be taken back: one sentence, and two answers. In: the sentence and what yes does. Out: the answer.
// The keyboard goes to the answer that changes nothing, so that a second Enter is no yes. Never answers by itself.
import { useSignal } from '@preact/signals';
import { useEffect, useRef } from 'preact/hooks';
import { t } from '../language';

/** Deletes what is kept under a name, after a question. */
export function DeleteButton({ name, class: look = 'quiet', no, onYes }: { name: string; class?: string; no?: object; onYes: () => void }) {
  const asked = useSignal(false);
  return (
    <>
      <button type="button" class={`button ${look}`} {...no} aria-expanded={asked.value} aria-label={t('Delete {name}', { name })} onClick={() => (asked.value = true)}>
        {t('Delete')}
      </button>
      {asked.value && (
        <Ask
          field="delete"
          text={t('Delete {name}? It cannot be brought back.', { name })}
          yes={t('Delete')}
          onNo={() => (asked.value = false)}
          onYes={() => {
            asked.value = false;
            onYes();
          }}
        />
      )}
    </>
  );
}

export function Ask({ text: shown, yes, field, onYes, onNo }: { text: string; yes: string; field: string; onYes: () => void; onNo: () => void }) {
  const no = useRef<HTMLButtonElement>(null);
  useEffect(() => no.current?.focus({ preventScroll: true }), []);
  return (
    <p class="form-foot ask" role="group" aria-label={shown} data-field={field}>
      <span>{shown}</span>
      <button type="button" class="button small" onClick={onYes}>
        {yes}
      </button>
      <button type="button" class="button small quiet" ref={no} onClick={onNo}>
        {t('Leave it')}
      </button>
    </p>
  );
}
