// Ask: a question before what cannot be taken back: one sentence, and two answers. In: the sentence and what yes does. Out: the answer.
// The keyboard goes to the answer that changes nothing, so that a second Enter is no yes. Never answers by itself.
import { useEffect, useRef } from 'preact/hooks';
import { t } from '../language';

/** Before something that is kept is deleted. */
export const AskDelete = ({ name, onYes, onNo }: { name: string; onYes: () => void; onNo: () => void }) => <Ask field="delete" text={t('Delete {name}? It cannot be brought back.', { name })} yes={t('Delete')} onYes={onYes} onNo={onNo} />;

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
