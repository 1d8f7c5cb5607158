// Hand: the outside conditions of a simulated drive, as switches and numbers: power, stall, limits, inputs, injected errors.
// In: what the twin offers, asked again every 2 s while shown; the axis whose page it is. Out: changes of one condition at a time. Only where a
// twin answers. What belongs to another axis than this one stands folded under that one's name, so that nobody takes the wrong one in hand.
import { gatewayText, t } from '../language';
import { marked } from './marked';
import { useSignal } from '@preact/signals';
import { useId } from 'preact/hooks';
import { asProblem } from '../api/problem';
import type { HandItem, Value } from '../api/types';
import { useGateway } from '../gateway';
import { capital } from '../state/commander';
import { useRepeated } from '../state/repeated';
import { refusal } from '../state/reported';
import { handGroups, handLabel, positionInUnit, type HandAxis, type HandGroup } from '../text/hand';
import { editText } from '../text/parameter';
import { parseNumber } from '../text/number';
import { Empty } from './lines';

const period_ms = 2_000;

/** `axis`: the one whose page it is; without it everything of the drive is shown, by axis. */
export function Hand({ drive, axis }: { drive: string; axis?: string }) {
  const { client, store } = useGateway();
  const items = useSignal<HandItem[] | null>(null);
  const note = useSignal({ tone: 'none', text: '' });
  const simulated = store.drive(drive)?.value.data.status.simulated ?? false;
  const connected = store.connected.value;

  const look = async (end: AbortSignal) => {
    try {
      items.value = await client.hand(drive, end);
    } catch (error) {
      if (!end.aborted && items.peek() === null) note.value = refusal(error);
    }
  };
  useRepeated(look, period_ms, simulated && connected, [drive]);

  const axes = (store.drive(drive)?.value.data.axes ?? []).flatMap((n): HandAxis[] => {
    const a = store.axis(n)?.peek().data; // name, channel and unit change only with the site
    return a ? [{ name: n, channel: a.channel, unit: a.unit, increments_per_unit: a.increments_per_unit }] : [];
  });
  const own = axis === undefined ? null : (axes.find((a) => a.name === axis)?.channel ?? 1);
  const whose = (name: string) => {
    const g = handGroups(items.peek() ?? [], axes, own).find((x) => x.items.some((i) => i.item.name === name));
    return g?.kind === 'axis' && axes.length > 1 ? `${g.title}: ` : '';
  };

  /** Why it was refused; empty: it was not. */
  const set = async (name: string, value: Value): Promise<string> => {
    note.value = { tone: 'busy', text: `${whose(name)}${handLabel(name)} …` };
    try {
      const now = await client.setHand(drive, { [name]: value });
      if (items.peek()) items.value = items.peek()!.map((i) => ({ ...i, value: now[i.name] ?? i.value }));
      note.value = { tone: 'good', text: t('{what}: set to {value}', { what: whose(name) + handLabel(name), value: typeof value === 'boolean' ? (value ? t('on') : t('off')) : editText(now[name] ?? value) }) };
      return '';
    } catch (error) {
      const why = capital(asProblem(error).text);
      note.value = { tone: 'refused', text: t('{what}: refused. {why}', { what: whose(name) + handLabel(name), why }) };
      return why;
    }
  };

  if (!simulated) return <Empty text={t('This drive is not simulated now: there is nothing to take in hand.')} />;
  if (items.value === null) return <Empty text={note.value.text || t('Waiting for the twin.')} />;
  const groups = handGroups(items.value, axes, own);
  return (
    <div class="hand card">
      {groups.map((g) => (
        <Group key={g.title} group={g} set={set} named={g.kind === 'axis' && (g.folded || own === null)} />
      ))}
      <p class={`result result-${note.value.tone}`} role="status">
        {marked(note.value.text)}
      </p>
    </div>
  );
}

type Set = (name: string, value: Value) => Promise<string>;

/** `named`: its fields are told apart from the same ones of another axis by the name of theirs. */
function Group({ group: g, set, named }: { group: HandGroup; set: Set; named: boolean }) {
  const list = (
    <ul aria-label={g.title ? t('Conditions: {title}', { title: g.title }) : undefined}>
      {g.items.map((i) => (
        <HandRow key={i.item.name} item={i.item} label={i.label} of={named ? g.title : ''} axis={g.axis} set={set} />
      ))}
    </ul>
  );
  if (g.title === '') return list;
  if (g.folded) {
    return (
      <details class="hand-group" data-hand-group={g.title}>
        <summary>{t('Another axis of this drive: {title}', { title: g.title })}</summary>
        {list}
      </details>
    );
  }
  return (
    <div class="hand-group" data-hand-group={g.title}>
      <p class="hand-head">{g.title}</p>
      {list}
    </div>
  );
}

interface RowProps {
  item: HandItem;
  label: string;
  /** The axis that it belongs to, where it has to be said; else empty. */
  of: string;
  axis: HandAxis | null;
  set: Set;
}

function HandRow({ item, label: short, of, axis, set }: RowProps) {
  const typed = useSignal<string | null>(null);
  const error = useSignal('');
  const label = of ? `${short}, ${of}` : short;
  const isPosition = /(^|\.)position$/.test(item.name);
  const typedNumber = typed.value === null ? null : parseNumber(typed.value);
  const inUnit = isPosition ? positionInUnit(typedNumber === null ? item.value : typedNumber.good ? typedNumber.value : null, axis) : '';
  const why = useId();
  const send = async () => {
    const text = typed.peek();
    if (text === null) return;
    let value: Value = text;
    if (typeof item.value !== 'string') {
      const parsed = parseNumber(text);
      error.value = parsed.good ? '' : parsed.why;
      if (!parsed.good) return;
      value = parsed.value;
    }
    const refused = await set(item.name, value);
    error.value = refused;
    // What was refused stays, to be mended; so does what was typed meanwhile.
    if (!refused && typed.peek() === text) typed.value = null;
  };
  return (
    <li data-hand={item.name}>
      <span class="hand-name">
        {short}
        {isPosition && <span class="where">{t(', increments')}</span>}
        {item.description && (
          <details class="hand-more">
            <summary>
              {item.writable && typeof item.value !== 'boolean' ? t('What may be entered') : t('What it is')}
              <span class="visually-hidden">: {label}</span>
            </summary>
            <span class="where" {...gatewayText}>{item.description}</span>
          </details>
        )}
      </span>
      {typeof item.value === 'boolean' ? (
        <button type="button" class="switch" role="switch" aria-checked={item.value} aria-label={label} disabled={!item.writable} onClick={() => void set(item.name, !item.value).then((w) => (error.value = w))}>
          <span class="switch-thumb" aria-hidden="true" />
          <span class="switch-text">{item.value ? t('on') : t('off')}</span>
        </button>
      ) : item.writable ? (
        <span class="hand-number">
          <input
            type="text"
            inputMode="decimal"
            autocomplete="off"
            aria-label={label}
            class={error.value ? 'is-wrong' : ''}
            aria-invalid={error.value ? true : undefined}
            aria-describedby={error.value ? why : undefined}
            value={typed.value ?? editText(item.value)}
            onInput={(e) => (typed.value = e.currentTarget.value)}
            onKeyDown={(e) => {
              if (e.key === 'Enter' && !e.repeat) void send();
            }}
          />
          <button type="button" class="button small" aria-label={t('Set {label} of the twin', { label })} onClick={() => void send()} disabled={typed.value === null}>
            {t('Set')}
          </button>
          {inUnit && (
            <span class="hand-unit" data-field="hand-unit">
              {inUnit}
            </span>
          )}
        </span>
      ) : (
        <span class="mono">{editText(item.value)}</span>
      )}
      {error.value && (
        <span class="hand-wrong" id={why} role="alert" data-field="hand-wrong">
          {marked(error.value)}
        </span>
      )}
    </li>
  );
}
