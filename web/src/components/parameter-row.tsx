// Parameter row: one parameter of an axis in the table: live, stored and default value, range, a field for a new one, who wrote last.
// In: the row's signals. Out: a row that keeps its height: each cell is drawn for itself, has room for the longest text that its value can have, and
// what has the keyboard is not drawn anew by a value that comes. Never asks the gateway: reading and writing are handed in.
import { gatewayText, t } from '../language';
import { marked } from './marked';
import { signal, useSignal, type Signal } from '@preact/signals';
import { useId, useRef } from 'preact/hooks';
import type { AxisParameter } from '../api/types';
import { addressingText, editText, fieldLines, fieldValue, helpText, longestText, rangeText, readValue, steppedText, unitText, valueText, withField } from '../text/parameter';
import { isApart, isChanged } from '../text/transfer';
import { Ask } from './ask';
import { useBarred } from './gate';
import { HelpButton } from './help-button';
import { Icon } from './icon';
import { memo } from './memo';
import { Written } from './parameter-history';
import { Age, LiveValue, type Since } from './parameter-live';

export interface Row {
  data: Signal<AxisParameter>;
  note: Signal<{ tone: 'none' | 'busy' | 'good' | 'refused'; text: string }>;
  /** What is typed; null: the field shows nothing of its own. */
  typed: Signal<string | null>;
  /** The value that was asked about before it is written: the drive is reached by this parameter. */
  asked: Signal<string | null>;
  /** When reading it without being asked was last refused, by the gateway's clock. */
  refused_ms: number | null;
}

export const newRow = (p: AxisParameter): Row => ({ data: signal(p), note: signal({ tone: 'none', text: '' }), typed: signal(null), asked: signal(null), refused_ms: null });
export const isLongArray = (p: AxisParameter) => p.count !== null && p.count > 0 && !/\]$/.test(p.id);

interface RowProps {
  axis: string;
  row: Row;
  since: Since;
  read: (row: Row) => void;
  write: (row: Row) => void;
  open: (row: Row) => void;
}

function RowView({ axis, row, since, read, write, open }: RowProps) {
  const p = row.data.peek(); // id, name and description never change
  return (
    <tr data-parameter={p.id}>
      <th scope="row">
        <span class="both">
          <span class="mono id">{p.id}</span>
          <span class="name">
            <span {...gatewayText}>{p.name.replaceAll('_', ' ')}</span> <HelpButton of={p.id}>{helpText(p)}</HelpButton>
          </span>
        </span>
      </th>
      <LiveCell row={row} since={since} />
      <StoredCell row={row} />
      <RangeCells row={row} />
      <EditCell axis={axis} row={row} read={read} write={write} open={open} />
      <WrittenCell axis={axis} row={row} />
    </tr>
  );
}
export const ParameterRow = memo(RowView, (a, b) => a.row === b.row);

function LiveCell({ row, since }: { row: Row; since: Since }) {
  const p = row.data.value;
  if (isLongArray(p)) {
    return (
      <td class="num" data-label={t('Live')} data-field="live">
        <span class="where">{t('{count} elements', { count: p.count ?? 0 })}</span>
      </td>
    );
  }
  const differs = isChanged(p);
  const longest = longestText(p);
  return (
    <td class={`num${p.quality === 'good' ? '' : ' is-not-good'}`} data-label={t('Live')} data-field="live">
      <span class={longest ? 'roomy' : 'one-line'} data-longest={longest || undefined}>
        <span>
          <LiveValue p={p} since={since} differs={differs} />{' '}
          <span class="unit">{p.value !== null && !p.allowed ? `${unitText(p.unit)} ${steppedText(p.value, p.unit)}`.trim() : ''}</span>
        </span>
      </span>
      <span class="one-line about">
        {differs && (
          <span class="flag changed" title={t('Not the default of the family')}>
            {t('changed')}{' '}
          </span>
        )}
        {p.quality === 'stale' && <span class="flag">{t('stale')}{' '}</span>}
        {p.at === null ? <span class="age">{t('not read yet')}</span> : <Age p={p} />}
      </span>
      {(p.fields ?? []).map((f, i) => (
        <span key={f.name} class="part roomy" data-longest={`${f.name.replaceAll('_', ' ')}: ${longestOf(f.allowed?.map((a) => a.meaning) ?? [])}`}>
          <span {...gatewayText}>{fieldLines(p.value, p)[i] ?? `${f.name.replaceAll('_', ' ')}: –`}</span>
        </span>
      ))}
    </td>
  );
}
const longestOf = (texts: readonly string[]): string => texts.reduce((a, b) => (b.length > a.length ? b : a), '');

function StoredCell({ row }: { row: Row }) {
  const p = row.data.value;
  return (
    <td class="num mono" data-label={t('Stored')}>
      {valueText(p.stored, p)}
      {isApart(p) && (
        <span class="flag" title={t('The drive has another value than the one written last')}>
          {' '}
          {t('differs')}
        </span>
      )}
    </td>
  );
}

function RangeCells({ row }: { row: Row }) {
  const p = row.data.value;
  return (
    <>
      <td class="num mono" data-label={t('Default')}>
        {valueText(p.default, p)}
      </td>
      <td class="range" data-label={t('Range')}>
        <span class="mono">{rangeText(p)}</span> <span class="unit">{unitText(p.unit)}</span>
      </td>
    </>
  );
}

function WrittenCell({ axis, row }: { axis: string; row: Row }) {
  return (
    <td class="written" data-label={t('Last written')}>
      <Written axis={axis} p={row.data.value} />
    </td>
  );
}

function EditCell({ axis, row, read, write, open }: Omit<RowProps, 'since'>) {
  const note = useId();
  const p = row.data.peek();
  const n = row.note.value;
  return (
    <td class="edit" data-label={t('New value')}>
      <div class="edit-row">
        {isLongArray(p) ? (
          <button type="button" class="button small" onClick={() => open(row)}>
            {t('List elements')}
          </button>
        ) : (
          <>
            {p.access !== 'R' && <Editor row={row} describedBy={note} write={() => write(row)} />}
            {p.access !== 'W' && (
              <button type="button" class="button small quiet square" aria-label={t('Read {id} from the drive', { id: p.id })} title={t('Read from the drive')} onClick={() => read(row)}>
                <Icon name="refresh" size={14} />
              </button>
            )}
            {p.access === 'R' && <span class="where">{t('read only')}</span>}
          </>
        )}
      </div>
      {row.asked.value !== null && (
        <Ask
          field="addressing-question"
          text={addressingText(axis, row.data.peek(), row.asked.value)}
          yes={t('Write {id}', { id: p.id })}
          onNo={() => (row.asked.value = null)}
          onYes={() => {
            row.typed.value = row.asked.peek();
            write(row);
          }}
        />
      )}
      <p class={`row-note result-${n.tone}`} id={note} role="status">
        {marked(n.text || typedText(row.typed.value, row.data.peek()))}
      </p>
    </td>
  );
}

/** What is typed for a unit that is counted in steps, as a quantity: the field itself takes the drive's own number. */
function typedText(typed: string | null, p: AxisParameter): string {
  const value = typed === null || typed.trim() === '' || p.allowed ? null : readValue(typed, p);
  const text = value?.good ? steppedText(value.value, p.unit) : '';
  return text && `${typed?.trim()} ${unitText(p.unit)} ${text}`;
}

function Editor({ row, describedBy, write }: { row: Row; describedBy: string; write: () => void }) {
  const no = useBarred('engineer');
  // While it has the keyboard it stays as it is: only what is typed changes it.
  const has = useSignal(false);
  const held = useRef(row.data.peek());
  if (!has.value) held.current = row.data.value;
  const p = held.current;
  const invalid = row.note.value.tone === 'refused' && row.typed.value !== null;
  const text = row.typed.value ?? '';
  const parts = p.access === 'RW' && p.fields?.every((f) => f.allowed) ? p.fields : null;
  const choices = p.type === 'bool' ? [{ value: 0, meaning: 'off' }, { value: 1, meaning: 'on' }] : p.allowed && p.allowed.length > 0 ? p.allowed : null;
  const keyboard = { onFocus: () => (has.value = true), onBlur: () => (has.value = false) };
  return (
    <>
      {parts && parts.length > 0 && p.alternate === null ? (
        <span class="parts">
          {parts.map((f) => {
            const whole = typeof p.value === 'number' && text === '' ? p.value : Number(text || 0);
            return (
              <label key={f.name}>
                <span {...gatewayText}>{f.name.replaceAll('_', ' ')}</span>
                <select
                  {...keyboard}
                  aria-label={t('New {part} of {id}', { part: f.name.replaceAll('_', ' '), id: p.id })}
                  aria-describedby={describedBy}
                  value={String(fieldValue(whole, f))}
                  onChange={(e) => (row.typed.value = String(withField(whole, f, Number(e.currentTarget.value))))}
                >
                  {f.allowed?.map((c) => (
                    <option key={c.value} value={String(c.value)} {...gatewayText}>
                      {c.value} {c.meaning}
                    </option>
                  ))}
                </select>
              </label>
            );
          })}
        </span>
      ) : choices ? (
        <select {...keyboard} aria-label={t('New value of {id}', { id: p.id })} aria-describedby={describedBy} value={text} onChange={(e) => (row.typed.value = e.currentTarget.value)}>
          <option value="" disabled>
            {t('choose')}
          </option>
          {choices.map((c) => (
            <option key={c.value} value={String(c.value)} {...gatewayText}>
              {c.value} {c.meaning}
            </option>
          ))}
        </select>
      ) : (
        <input
          {...keyboard}
          type="text"
          class={invalid ? 'is-wrong' : ''}
          inputMode={p.type === 'text' || p.type === 'bytes' ? 'text' : 'decimal'}
          autocomplete="off"
          spellcheck={false}
          aria-label={t('New value of {id}', { id: p.id })}
          aria-describedby={describedBy}
          aria-invalid={invalid || undefined}
          placeholder={editText(p.value)}
          value={text}
          onInput={(e) => (row.typed.value = e.currentTarget.value)}
          onKeyDown={(e) => {
            if (e.key === 'Enter' && !e.repeat && !no.disabled) write();
          }}
        />
      )}
      <button type="button" class="button small" aria-label={t('Write {id}', { id: p.id })} {...no} onClick={write}>
        {t('Write')}
      </button>
    </>
  );
}
