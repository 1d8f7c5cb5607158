// Hand: the outside conditions of a simulated drive, as switches and numbers: power, stall, limits, inputs, injected errors.
// In: what the twin offers, asked again every 2 s while shown. Out: changes of one condition at a time. Only where a twin answers.
import { useSignal } from '@preact/signals';
import { useEffect, useId } from 'preact/hooks';
import { asProblem } from '../api/problem';
import type { HandItem, Value } from '../api/types';
import { useGateway } from '../gateway';
import { capital } from '../state/commander';
import { editText } from '../words/parameter';
import { parseNumber } from '../words/number';
import { Empty } from './lines';

const period_ms = 2_000;
const words = (name: string) => capital(name.replaceAll('_', ' '));

export function Hand({ drive }: { drive: string }) {
  const { client, store } = useGateway();
  const items = useSignal<HandItem[] | null>(null);
  const note = useSignal({ tone: 'none', text: '' });
  const simulated = store.drive(drive)?.value.data.status.simulated ?? false;
  const connected = store.connected.value;

  useEffect(() => {
    if (!simulated || !connected) return;
    const end = new AbortController();
    let timer: ReturnType<typeof setTimeout>;
    const look = async () => {
      try {
        if (!document.hidden) items.value = await client.hand(drive, end.signal);
      } catch (error) {
        if (!end.signal.aborted && items.peek() === null) note.value = { tone: 'refused', text: capital(asProblem(error).words) };
      }
      if (!end.signal.aborted) timer = setTimeout(() => void look(), period_ms);
    };
    void look();
    return () => {
      end.abort();
      clearTimeout(timer);
    };
  }, [drive, simulated, connected]);

  /** Why it was refused; empty: it was not. */
  const set = async (name: string, value: Value): Promise<string> => {
    note.value = { tone: 'busy', text: `${words(name)} …` };
    try {
      const now = await client.setHand(drive, { [name]: value });
      if (items.peek()) items.value = items.peek()!.map((i) => ({ ...i, value: now[i.name] ?? i.value }));
      note.value = { tone: 'good', text: `${words(name)}: set to ${editText(now[name] ?? value)}` };
      return '';
    } catch (error) {
      const why = capital(asProblem(error).words);
      note.value = { tone: 'refused', text: `${words(name)}: refused. ${why}` };
      return why;
    }
  };

  if (!simulated) return <Empty text="This drive is not simulated now: there is nothing to take in hand." />;
  if (items.value === null) return <Empty text={note.value.text || 'Waiting for the twin.'} />;
  return (
    <div class="hand card">
      <ul>
        {items.value.map((i) => (
          <HandRow key={i.name} item={i} set={set} />
        ))}
      </ul>
      <p class={`result result-${note.value.tone}`} role="status">
        {note.value.text}
      </p>
    </div>
  );
}

function HandRow({ item, set }: { item: HandItem; set: (name: string, value: Value) => Promise<string> }) {
  const typed = useSignal<string | null>(null);
  const wrong = useSignal('');
  const label = words(item.name);
  const why = useId();
  const send = async () => {
    const text = typed.peek();
    if (text === null) return;
    let value: Value = text;
    if (typeof item.value !== 'string') {
      const parsed = parseNumber(text);
      wrong.value = parsed.good ? '' : parsed.why;
      if (!parsed.good) return;
      value = parsed.value;
    }
    const refused = await set(item.name, value);
    wrong.value = refused;
    // What was refused stays, to be mended; so does what was typed meanwhile.
    if (!refused && typed.peek() === text) typed.value = null;
  };
  return (
    <li data-hand={item.name}>
      <span class="hand-name">
        {label}
        {item.description && (
          <details class="hand-more">
            <summary>
              {item.writable && typeof item.value !== 'boolean' ? 'What may be entered' : 'What it is'}
              <span class="visually-hidden">: {label}</span>
            </summary>
            <span class="where">{item.description}</span>
          </details>
        )}
      </span>
      {typeof item.value === 'boolean' ? (
        <button type="button" class="switch" role="switch" aria-checked={item.value} aria-label={label} disabled={!item.writable} onClick={() => void set(item.name, !item.value).then((w) => (wrong.value = w))}>
          <span class="switch-thumb" aria-hidden="true" />
          <span class="switch-text">{item.value ? 'on' : 'off'}</span>
        </button>
      ) : item.writable ? (
        <span class="hand-number">
          <input
            type="text"
            inputMode="decimal"
            autocomplete="off"
            aria-label={label}
            class={wrong.value ? 'is-wrong' : ''}
            aria-invalid={wrong.value ? true : undefined}
            aria-describedby={wrong.value ? why : undefined}
            value={typed.value ?? editText(item.value)}
            onInput={(e) => (typed.value = e.currentTarget.value)}
            onKeyDown={(e) => {
              if (e.key === 'Enter' && !e.repeat) void send();
            }}
          />
          <button type="button" class="button small" aria-label={`Set ${label} of the twin`} onClick={() => void send()} disabled={typed.value === null}>
            Set
          </button>
        </span>
      ) : (
        <span class="mono">{editText(item.value)}</span>
      )}
      {wrong.value && (
        <span class="hand-wrong" id={why} role="alert" data-field="hand-wrong">
          {wrong.value}
        </span>
      )}
    </li>
  );
}
