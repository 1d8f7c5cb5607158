// Parameter transfer: all known values out as CSV or JSON, and in again: each row is checked first, nothing is sent while one is wrong, then they are
// written one by one. In: the HTTP door, a file or pasted text. Out: files; writes. At the first refusal the rest is held back and said so.
import { t } from '../language';
import { useBarred, Why } from './gate';
import { useSignal } from '@preact/signals';
import { useEffect, useMemo, useRef } from 'preact/hooks';
import { asProblem } from '../api/problem';
import type { AxisParameter } from '../api/types';
import { useGateway } from '../gateway';
import { emptied, persisted } from '../state/persisted';
import { quiet, refusal, type Reported } from '../state/reported';
import { editText, steppedText, unitText, valueText } from '../text/parameter';
import { csvOfParameters, jsonOfParameters, parametersText, readTransfer } from '../text/transfer';
import { Tell } from './form';
import { saveText } from './save';
import { Section } from './section';

const largest = 2_000_000;

export function ParameterTransfer({ axis }: { axis: string }) {
  const { client, store } = useGateway();
  const no = useBarred('engineer');
  const text = persisted(`transfer.${axis}`);
  const list = useSignal<AxisParameter[]>([]);
  const reported = useSignal<Reported>(quiet);
  const sending = useRef<{ stop: boolean } | null>(null);
  const busy = useSignal(false);
  const epoch = store.connection.value.epoch;
  const load = () => client.parameters(axis).then((l) => (list.value = l));
  useEffect(() => {
    if (epoch > 0) load().catch(() => undefined);
    return () => {
      if (sending.current) sending.current.stop = true;
    };
  }, [axis, epoch]);
  const read = useMemo(() => readTransfer(text.value, list.value), [text.value, list.value]);
  const bad = read.rows.filter((r) => r.fault !== '').length;
  const wanted = read.rows.filter((r) => r.fault === '' && !r.same);
  const byId = new Map(list.value.map((p) => [p.id, p]));

  const save = async (kind: 'csv' | 'json') => {
    try {
      const all = await load();
      const known = all.filter((p) => p.value !== null).length;
      if (kind === 'csv') saveText(`${axis}-parameters.csv`, 'text/csv', csvOfParameters(all));
      else saveText(`${axis}-parameters.json`, 'application/json', jsonOfParameters(axis, all));
      reported.value = { tone: known === 0 ? 'refused' : 'good', text: known < all.length ? t('{known} of {n} values are known and in the file. “Read all” above asks the drive for the others.', { known, n: all.length }) : t('{known} of {n} values are known and in the file.', { known, n: all.length }) };
    } catch (error) {
      reported.value = refusal(error);
    }
  };
  const take = async (file: File | undefined) => {
    if (!file) return;
    if (file.size > largest) {
      reported.value = { tone: 'refused', text: t('{name} has {size} bytes; at most {largest} are read.', { name: file.name, size: file.size, largest }) };
      return;
    }
    text.value = await file.text();
  };
  const send = async () => {
    const run: { stop: boolean } = { stop: false };
    sending.current = run;
    busy.value = true;
    const sent = text.peek();
    let done = 0;
    for (const row of wanted) {
      if (run.stop) break;
      reported.value = { tone: 'busy', text: t('Writing {id}: {done} of {n} …', { id: row.id, done: done + 1, n: wanted.length }) };
      try {
        await client.writeParameter(axis, row.id, row.value!);
        done += 1;
      } catch (error) {
        reported.value = { tone: 'refused', text: t('{id}: {text}. {done} were written before it; {left} behind it were not sent.', { id: row.id, text: asProblem(error).text, done, left: wanted.length - done - 1 }) };
        run.stop = true;
      }
    }
    if (done === wanted.length) {
      emptied(text, sent);
      reported.value = { tone: 'good', text: t('{done} written.', { done: parametersText(done) }) };
    } else if (reported.peek().tone === 'busy') reported.value = { tone: 'refused', text: t('Ended: {done} of {n} were written.', { done, n: wanted.length }) };
    busy.value = false;
    sending.current = null;
    await load().catch(() => undefined);
  };
  return (
    <Section
      title={t('Export and import')}
      class="transfer"
      beside={
        <>
          <button type="button" class="button" onClick={() => void save('csv')}>
            {t('Export CSV')}
          </button>
          <button type="button" class="button" onClick={() => void save('json')}>
            {t('Export JSON')}
          </button>
        </>
      }
    >
      <div class="card form">
        <Why need="engineer" what={t('Writing what is imported')} />
        <label class="where" for="transfer-text">
          {t('CSV with the columns parameter and value, or JSON as it is exported')}
        </label>
        <textarea id="transfer-text" class="mono" rows={4} spellcheck={false} value={text.value} onInput={(e) => (text.value = e.currentTarget.value)} />
        <div class="form-foot">
          <label class="button">
            <input type="file" class="visually-hidden" accept=".csv,.tsv,.json,.txt,text/csv,application/json" onChange={(e) => void take(e.currentTarget.files?.[0])} />
            {t('Choose a file')}
          </label>
          {busy.value ? (
            <button type="button" class="button" onClick={() => sending.current && (sending.current.stop = true)}>
              {t('End after this one')}
            </button>
          ) : (
            <button type="button" class="button primary" disabled={wanted.length === 0 || bad > 0} {...no} onClick={() => void send()}>
              {wanted.length === 1 ? t('Write 1 value to the drive') : t('Write {n} values to the drive', { n: wanted.length })}
            </button>
          )}
          <Tell reported={reported.value} field="transfer-told" />
        </div>
        {(read.problem || read.rows.length > 0) && (
          <p class={`form-told${read.problem || bad > 0 ? ' is-fault' : ''}`} role="status" data-field="transfer-count">
            {read.problem || (bad > 0 ? t('{bad} of {n} rows must be mended before anything is sent.', { bad, n: read.rows.length }) : t('{n} will be written; {same} are so already.', { n: wanted.length, same: read.rows.length - wanted.length }))}
          </p>
        )}
        {read.rows.length > 0 && (
          <ul class="differences" aria-label={t('What would be written')}>
            {read.rows.filter((r) => !r.same).slice(0, 300).map((r) => (
              <li key={r.line} data-line={r.line}>
                <span class="mono">{r.id}</span>{' '}
                {r.fault ? <span class="fault-text">{r.fault}</span> : <span class="mono">{valueText(byId.get(r.id)?.value ?? null, byId.get(r.id) ?? { allowed: null })} → {editText(r.value)} {unitText(byId.get(r.id)?.unit ?? null)} {steppedText(r.value, byId.get(r.id)?.unit ?? null)}</span>}
              </li>
            ))}
          </ul>
        )}
      </div>
    </Section>
  );
}
