// Parameters of one axis: the table, its search and filters, reading and writing. In: state/parameter-table.ts. Out: rows of parameter-row.tsx.
// What is on the screen is read again, one value at a time, unless that is switched off; after a command first what was read before it. A value that
// comes changes the text of its cell alone: no row moves, comes or goes by it. At most 100 rows are drawn at once; more on demand.
import { effect, useSignal, type Signal } from '@preact/signals';
import { useEffect, useMemo, useRef } from 'preact/hooks';
import { useGateway } from '../gateway';
import { t } from '../language';
import { isSought, matching, ParameterTable, type Row } from '../state/parameter-table';
import { persisted } from '../state/persisted';
import { useRepeated } from '../state/repeated';
import { pauseAfter } from '../state/reread';
import { isMarked, marks, type Marked } from '../text/transfer';
import { Why } from './gate';
import { Empty } from './lines';
import { useOnScreen } from './parameter-live';
import { ParameterRow } from './parameter-row';
import { Section } from './section';
import { TableHead } from './table-head';

const rowsAtOnce = 100;
const idle_ms = 400;
/** Whether what is on the screen is read again. */
const keep = persisted('parameters.keep', 'yes', 'browser');

export function Parameters({ axis }: { axis: string }) {
  const { client, store } = useGateway();
  const table = useMemo(() => new ParameterTable(client, axis, () => store.gatewayNow_ms()), [client, axis, store]);
  const search = useSignal('');
  const group = useSignal('');
  const mark = useSignal<Marked>('all');
  const most = useSignal(rowsAtOnce);
  /** How often the filter was asked again. */
  const asked = useSignal(0);
  const body = useRef<HTMLTableSectionElement>(null);
  useLife(table, axis);

  const rows = table.rows.value;
  const filter = { search: search.value, group: group.value };
  // What a filter shows is settled when it is set: a value that comes later takes no row away and brings none.
  const fitting = useMemo(() => matching(rows, filter, mark.value), [rows, search.value, group.value, mark.value, asked.value]);
  const shown = useMemo(() => fitting.slice(0, most.value), [fitting, most.value]);
  const onScreen = useOnScreen(body, shown);
  const reread = async (end: AbortSignal) => {
    if (!store.connected.peek() || store.axis(axis)?.peek().data.online !== true) return;
    const began = performance.now();
    return (await table.rereadDue(onScreen, end)) ? pauseAfter(performance.now() - began) : undefined;
  };
  useRepeated(reread, idle_ms, keep.value === 'yes', [table]);

  const loaded = table.loaded.value;
  return (
    <Section title={t('Parameters')} class="parameters" beside={<Tools table={table} fitting={fitting} search={search} group={group} mark={mark} />}>
      <Why need="engineer" what={t('Writing a parameter')} />
      {loaded !== 'there' ? (
        <Empty text={loaded === 'waiting' ? t('Waiting for the list.') : loaded} />
      ) : fitting.length === 0 ? (
        <Empty text={rows.length === 0 ? t('This family has no parameters.') : t('No parameter matches.')} />
      ) : (
        <div class="card table-scroll" tabIndex={0} role="region" aria-label={t('Parameters of {name}', { name: axis })}>
          <table class="table">
            <TableHead of={[t('Parameter'), t('Live'), t('Stored'), t('Default'), t('Range'), t('New value'), t('Last written')]} figures={[1, 2, 3]} />
            <tbody ref={body}>
              {shown.map((r) => (
                <ParameterRow key={r.data.peek().id} axis={axis} row={r} table={table} />
              ))}
            </tbody>
          </table>
          {mark.value !== 'all' && <Elsewise rows={rows} shown={fitting} mark={mark.value} again={() => (asked.value += 1)} within={(r) => isSought(r, filter)} />}
          {fitting.length > shown.length && (
            <button type="button" class="button more" onClick={() => (most.value += rowsAtOnce)}>
              {t('Show more ({n} are not shown)', { n: fitting.length - shown.length })}
            </button>
          )}
        </div>
      )}
    </Section>
  );
}

/** Listed with each connection; old after a command's beginning and its end: power, motion, who answers; and looked at again where anybody wrote. */
function useLife(table: ParameterTable, axis: string): void {
  const { store } = useGateway();
  const epoch = store.connection.value.epoch;
  useEffect(() => {
    if (epoch === 0) return;
    const end = new AbortController();
    void table.load(end.signal);
    table.age();
    return () => end.abort();
  }, [table, epoch]);
  useEffect(() => () => table.endReading(), [table]);
  useEffect(() => store.onEvent((e) => table.heard(e)), [table]);
  useEffect(() => {
    let before: string | undefined;
    return effect(() => {
      const a = store.axis(axis)?.value.data;
      const now = a && `${a.state} ${a.moving} ${a.referenced} ${a.presence}`;
      if (now !== undefined && before !== undefined && now !== before) table.age();
      before = now;
    });
  }, [table]);
}

/** Beside the title: what is looked for, and reading all of it. */
function Tools({ table, fitting, search, group, mark }: { table: ParameterTable; fitting: readonly Row[]; search: Signal<string>; group: Signal<string>; mark: Signal<Marked> }) {
  const rows = table.rows.value;
  const progress = table.progress.value;
  const groups = [...new Set(rows.map((r) => r.data.peek().group))].filter(Boolean);
  return (
    <>
      <input class="search" type="search" placeholder={t('Search')} aria-label={t('Search parameters')} value={search.value} onInput={(e) => (search.value = e.currentTarget.value)} />
      {groups.length > 1 && (
        <label class="select">
          <span class="visually-hidden">{t('Group')}</span>
          <select value={group.value} onChange={(e) => (group.value = e.currentTarget.value)}>
            <option value="">{t('all groups')}</option>
            {groups.map((g) => (
              <option key={g} value={g}>
                {g.replaceAll('_', ' ')}
              </option>
            ))}
          </select>
        </label>
      )}
      <label class="select">
        <span class="visually-hidden">{t('Show')}</span>
        <select value={mark.value} onChange={(e) => (mark.value = e.currentTarget.value as Marked)}>
          {marks.map((m) => (
            <option key={m.id} value={m.id}>
              {m.text}
            </option>
          ))}
        </select>
      </label>
      <label class="check" title={t('What is on the screen is read again, one value at a time; at most a quarter of the line\'s time is taken')}>
        <input type="checkbox" checked={keep.value === 'yes'} onChange={(e) => (keep.value = e.currentTarget.checked ? 'yes' : 'no')} />{' '}{t('Keep reading')}
      </label>
      {progress ? (
        <button type="button" class="button" onClick={() => table.endReading()}>
          {t('Reading {done} of {of}: end', { done: progress.done, of: progress.of })}
        </button>
      ) : (
        <button type="button" class="button" onClick={() => void table.readAll(fitting)} disabled={fitting.length === 0}>
          {fitting.length === rows.length ? t('Read all') : t('Read shown')}
        </button>
      )}
    </>
  );
}

/** Values that came since a filter was set may fit it otherwise: said, and done on demand. */
function Elsewise({ rows, shown, mark, within, again }: { rows: Row[]; shown: Row[]; mark: Marked; within: (row: Row) => boolean; again: () => void }) {
  const fits = new Set(rows.filter((r) => isMarked(r.data.value, mark) && within(r)));
  const gone = shown.filter((r) => !fits.has(r)).length;
  const come = fits.size - (shown.length - gone);
  if (gone === 0 && come === 0) return null;
  return (
    <button type="button" class="button more" onClick={again}>
      {t('Filter again ({changes})', { changes: [come === 1 ? t('1 more fits now') : come > 0 && t('{n} more fit now', { n: come }), gone > 0 && t('{n} no longer', { n: gone })].filter(Boolean).join(', ') })}
    </button>
  );
}
