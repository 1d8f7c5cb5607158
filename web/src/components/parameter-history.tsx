// Parameter history: who wrote it last, and on demand all writes that are kept: when, who, through which door, from what to what.
// In: the parameter. Out: the cell of the table. At most 20 writes are asked for.
import { t } from '../language';
import { marked } from './marked';
import { useSignal } from '@preact/signals';
import { asProblem } from '../api/problem';
import type { AxisParameter } from '../api/types';
import { useGateway } from '../gateway';
import { capital } from '../state/commander';
import { valueText } from '../text/parameter';
import { clockTime } from '../text/time';

const most = 20;

export function Written({ axis, p }: { axis: string; p: AxisParameter }) {
  const { client } = useGateway();
  const open = useSignal(false);
  const history = useSignal<AxisParameter['history'] | null>(null);
  const why = useSignal('');
  const toggle = async () => {
    open.value = !open.value;
    if (!open.value) return;
    history.value = null;
    why.value = '';
    try {
      history.value = (await client.parameter(axis, p.id, { cached: true, history: most })).history ?? [];
    } catch (error) {
      why.value = capital(asProblem(error).text);
    }
  };
  if (!p.written_at) return <span class="where">{t('never here')}</span>;
  return (
    <>
      <time dateTime={p.written_at}>{clockTime(p.written_at)}</time> <span class="where">{byWhom(p.written_by, p.written_through)}</span>{' '}
      <button type="button" class="link-button" aria-expanded={open.value} aria-label={t('History of {id}', { id: p.id })} onClick={() => void toggle()}>
        {t('History')}
      </button>
      {open.value && (
        <ol class="history" aria-label={t('Writes of {id}, newest first', { id: p.id })}>
          {why.value && <li class="fault-text">{marked(why.value)}</li>}
          {history.value === null && !why.value && <li class="where">{t('Asking …')}</li>}
          {history.value?.length === 0 && <li class="where">{t('No write is kept.')}</li>}
          {history.value?.map((h) => (
            <li key={h.written_at}>
              <time dateTime={h.written_at}>{clockTime(h.written_at)}</time>{' '}
              <span class="mono">
                {valueText(h.previous, p)} → {valueText(h.value, p)}
              </span>{' '}
              <span class="where">{byWhom(h.written_by, h.written_through)}</span>
            </li>
          ))}
        </ol>
      )}
    </>
  );
}

const byWhom = (who: string | null, door: string | null): string => `${who ?? t('not said by whom')}${door ? ` (${door})` : ''}`;
