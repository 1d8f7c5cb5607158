// Console: one line in the drive's own language, and its reply. In: what is typed (text or hex pairs). Out: a log, newest last.
// Keeps the last 200 exchanges of the visit; arrow up and down bring back what was sent. Never sends by itself.
import { gatewayText, t } from '../language';
import { signal, useSignal, type Signal } from '@preact/signals';
import { useEffect, useRef } from 'preact/hooks';
import { asProblem } from '../api/problem';
import { useGateway } from '../gateway';
import { capital } from '../state/commander';
import { persisted } from '../state/persisted';

interface Exchange {
  id: number;
  sent: string;
  reply: string;
  hex: string;
  took_ms: number | null;
  tone: 'busy' | 'good' | 'refused';
}
const most = 200;
const logs = new Map<string, Signal<Exchange[]>>();
const logOf = (drive: string): Signal<Exchange[]> => {
  let log = logs.get(drive);
  if (!log) logs.set(drive, (log = signal([])));
  return log;
};
let counter = 0;

export function Console({ drive }: { drive: string }) {
  const { client } = useGateway();
  const log = logOf(drive);
  const typed = persisted(`typed.native.${drive}`);
  const asHex = useSignal(false);
  const place = useRef(0);
  const view = useRef<HTMLDivElement>(null);
  const count = log.value.length;
  useEffect(() => {
    view.current?.scrollTo({ top: view.current.scrollHeight });
  }, [count, log.value.at(-1)?.tone]);

  const send = async () => {
    const text = typed.peek();
    if (text.trim() === '') return;
    const mine: Exchange = { id: (counter += 1), sent: text, reply: '…', hex: '', took_ms: null, tone: 'busy' };
    const put = (change: Partial<Exchange>) => {
      const next = { ...mine, ...change };
      const i = log.peek().findIndex((x) => x.id === mine.id);
      log.value = (i < 0 ? [...log.peek(), next] : log.peek().with(i, next)).slice(-most);
    };
    put({});
    place.current = 0;
    typed.value = '';
    try {
      const r = await client.native(drive, asHex.peek() ? { send_hex: text } : { send: text });
      put({ reply: r.reply === '' ? t('(no text)') : r.reply, hex: r.reply_hex, took_ms: r.took_ms, tone: 'good' });
    } catch (error) {
      put({ reply: capital(asProblem(error).text), tone: 'refused' });
      if (typed.peek() === '') typed.value = text; // what was typed stays when it was refused
    }
  };

  const recall = (step: 1 | -1) => {
    const sent = log.peek().map((x) => x.sent);
    const next = Math.min(sent.length, Math.max(0, place.current + step));
    place.current = next;
    typed.value = next === 0 ? '' : (sent.at(-next) ?? '');
  };

  return (
    <div class="console card">
      <div class="console-log" ref={view} tabIndex={0} role="log" aria-label={t('Exchanges with {drive}', { drive })}>
      <ol class="mono">
        {log.value.length === 0 && <li class="where">{t('Nothing has been sent yet. Type a line in the drive\'s own language.')}</li>}
        {log.value.map((x) => (
          <li key={x.id} class={`result-${x.tone}`}>
            <span class="sent">{x.sent}</span>
            <span class="reply" {...gatewayText} title={x.hex ? x.hex.replace(/(..)/g, '$1 ') : ''}>
              {x.reply}
            </span>
            <span class="took">{x.took_ms === null ? '' : t('{took_ms} ms', { took_ms: x.took_ms })}</span>
          </li>
        ))}
      </ol>
      </div>
      <form
        class="console-form"
        onSubmit={(e) => {
          e.preventDefault();
          void send();
        }}
      >
        <input
          type="text"
          class="mono"
          autocomplete="off"
          autocapitalize="off"
          spellcheck={false}
          aria-label={t('Line to send to {drive}', { drive })}
          placeholder={asHex.value ? '95 00' : t('a line to send')}
          value={typed.value}
          onInput={(e) => (typed.value = e.currentTarget.value)}
          onKeyDown={(e) => {
            if (e.key !== 'ArrowUp' && e.key !== 'ArrowDown') return;
            e.preventDefault();
            recall(e.key === 'ArrowUp' ? 1 : -1);
          }}
        />
        <button type="button" class="button" aria-pressed={asHex.value} onClick={() => (asHex.value = !asHex.value)}>
          {t('Hex')}
        </button>
        <button type="submit" class="button primary">
          {t('Send')}
        </button>
      </form>
    </div>
  );
}
