// Description drop: where EDS and DCF files are dropped, or chosen by the keyboard, several at once; and how each of them went. In: the shelf.
// Out: files on their way to the gateway. A file that is dropped beside the place does not take the page away.
import { useSignal } from '@preact/signals';
import { useEffect, useId } from 'preact/hooks';
import type { DescriptionEntry } from '../api/descriptions';
import { useGateway } from '../gateway';
import { gatewayText, t } from '../language';
import { descriptionPath } from '../router';
import { descriptionsOf, type Sent } from '../state/descriptions';
import { Icon } from './icon';
import { marked } from './marked';

/** A browser opens a file that is dropped anywhere else, instead of the page. */
function useNoOpening(): void {
  useEffect(() => {
    const stay = (e: DragEvent) => e.preventDefault();
    addEventListener('dragover', stay);
    addEventListener('drop', stay);
    return () => {
      removeEventListener('dragover', stay);
      removeEventListener('drop', stay);
    };
  }, []);
}

export function DescriptionDrop({ text, onStored }: { text: string; onStored?: (stored: DescriptionEntry[]) => void }) {
  const { client, session } = useGateway();
  const { shelf } = descriptionsOf(client);
  const over = useSignal(false);
  const hint = useId();
  const why = session.mayNot('engineer', t('Storing a description'));
  const barred = why !== '' || shelf.busy.value;
  useNoOpening();
  const take = async (files: FileList | null | undefined) => {
    over.value = false;
    if (barred || !files || files.length === 0) return;
    const stored = await shelf.add([...files]);
    if (stored.length > 0) onStored?.(stored);
  };
  return (
    <div class="description-drop">
      <div
        class={`drop-place${over.value ? ' is-over' : ''}${barred ? ' is-barred' : ''}`}
        data-field="drop"
        onDragOver={(e) => {
          e.preventDefault();
          over.value = !barred;
        }}
        onDragLeave={() => (over.value = false)}
        onDrop={(e) => {
          e.preventDefault();
          void take(e.dataTransfer?.files);
        }}
      >
        <Icon name="plus" />
        <span id={hint}>{why || text}</span>
        <label class="button">
          <input
            type="file"
            class="visually-hidden"
            multiple
            accept=".eds,.dcf"
            disabled={barred}
            aria-describedby={hint}
            onChange={(e) => {
              const input = e.currentTarget;
              void take(input.files).then(() => (input.value = ''));
            }}
          />
          {t('Choose files')}
        </label>
      </div>
      <ul class="drop-sent" aria-label={t('Files that were sent')} role="status">
        {shelf.sent.value.map((s, i) => (
          <SentFile key={`${i} ${s.file}`} sent={s} />
        ))}
      </ul>
    </div>
  );
}

function SentFile({ sent: s }: { sent: Sent }) {
  return (
    <li class={`result-${s.tone}`} data-sent={s.file} data-tone={s.tone}>
      {s.name ? <a href={descriptionPath(s.name)}>{s.name}</a> : <span class="mono">{s.file}</span>} {marked(s.text)}
      {s.faults.length > 0 && (
        <ul {...gatewayText}>
          {s.faults.slice(0, 20).map((f, i) => (
            <li key={i}>{f}</li>
          ))}
        </ul>
      )}
      {s.faults.length > 20 && <p class="where">{t('and {n} more', { n: s.faults.length - 20 })}</p>}
    </li>
  );
}
