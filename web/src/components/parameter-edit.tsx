// Parameter edit: the field for a new value of a parameter, with its parts or its choices, the buttons that write and read it, and how that went. In: a row of the
// table. Out: what is typed, in the row; requests by the table. What has the keyboard is not drawn anew by a value that comes.
import { useSignal } from '@preact/signals';
import { useId, useRef } from 'preact/hooks';
import type { AxisParameter } from '../api/types';
import { gatewayText, t } from '../language';
import { isLongArray, type ParameterTable, type Row } from '../state/parameter-table';
import { addressingText, editText, fieldValue, readValue, steppedText, unitText, withField } from '../text/parameter';
import { Ask } from './ask';
import { useBarred } from './gate';
import { Icon } from './icon';
import { marked } from './marked';

export function EditCell({ axis, row, table }: { axis: string; row: Row; table: ParameterTable }) {
  const note = useId();
  const p = row.data.peek();
  const n = row.note.value;
  return (
    <td class="edit" data-label={t('New value')}>
      <div class="edit-row">
        {isLongArray(p) ? (
          <button type="button" class="button small" onClick={() => void table.open(row)}>
            {t('List elements')}
          </button>
        ) : (
          <>
            {p.access !== 'R' && <Editor row={row} describedBy={note} write={() => void table.write(row)} />}
            {p.access !== 'W' && (
              <button type="button" class="button small quiet square" aria-label={t('Read {id} from the drive', { id: p.id })} title={t('Read from the drive')} onClick={() => void table.read(row)}>
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
            void table.write(row);
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
