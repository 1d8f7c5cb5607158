// Parameters of one axis: the table, its search and filters, reading and writing. In: REST. Out: rows of parameter-row.tsx.
// What is on the screen is read again, one value at a time, unless that is switched off; after a command first what was read before it. A value that
// comes changes the text of its cell alone: no row moves, comes or goes by it. Reading all goes one by one and can be ended; a slow drive is not
// flooded. What was typed stays until the drive took it. At most 100 rows are drawn at once; more on demand.
import { t } from '../language';
import { effect, signal, useSignal, type Signal } from '@preact/signals';
import { useEffect, useMemo, useRef } from 'preact/hooks';
import { asProblem } from '../api/problem';
import { useGateway } from '../gateway';
import { capital } from '../state/commander';
import { persisted } from '../state/persisted';
import { dueNext, pauseAfter } from '../state/reread';
import { readValue, sameValue, searchRank, valueText } from '../text/parameter';
import { isMarked, marks, type Marked } from '../text/transfer';
import { Why } from './gate';
import { Empty } from './lines';
import { receivedAt, useOnScreen } from './parameter-live';
import { isLongArray, newRow, ParameterRow, type Row } from './parameter-row';
import { Section } from './section';
import { refusal } from './reported';

const rowsAtOnce = 100;
const idle_ms = 400;
/** Whether what is on the screen is read again. */
const keep = persisted('parameters.keep', 'yes', 'browser');

export function Parameters({ axis }: { axis: string }) {
  const { client, store } = useGateway();
  const rows: Signal<Row[]> = useMemo(() => signal([]), [axis]);
  const loaded = useSignal<'waiting' | 'there' | string>('waiting');
  const search = useSignal('');
  const group = useSignal('');
  const mark = useSignal<Marked>('all');
  const most = useSignal(rowsAtOnce);
  /** How often the filter was asked again. */
  const asked = useSignal(0);
  const progress = useSignal<{ done: number; of: number } | null>(null);
  const reading = useRef<AbortController | null>(null);
  const epoch = store.connection.value.epoch;
  const since: Signal<number> = useMemo(() => signal(0), [axis]);
  const table = useRef<HTMLTableSectionElement>(null);

  const load = async (signalOfEnd: AbortSignal) => {
    try {
      const list = await client.parameters(axis, {}, signalOfEnd);
      const before = new Map(rows.peek().map((r) => [r.data.peek().id, r]));
      rows.value = list.map((p) => {
        const known = before.get(p.id);
        if (known) known.data.value = p;
        return known ?? newRow(p);
      });
      loaded.value = 'there';
    } catch (error) {
      if (!signalOfEnd.aborted && rows.peek().length === 0) loaded.value = asProblem(error).text;
    }
  };

  useEffect(() => {
    if (epoch === 0) return;
    const end = new AbortController();
    void load(end.signal);
    return () => end.abort();
  }, [axis, epoch]);
  useEffect(() => () => reading.current?.abort(), [axis]);
  useEffect(() => {
    if (epoch !== 0) since.value = store.gatewayNow_ms();
  }, [axis, epoch]);
  useEffect(() => store.onEvent((e) => void (e.axis === axis && e.kind === 'command' && (since.value = store.gatewayNow_ms()))), [axis]);
  // A command's end changes values as its beginning does: power, motion, who answers.
  useEffect(() => {
    let before: string | undefined;
    return effect(() => {
      const a = store.axis(axis)?.value.data;
      const now = a && `${a.state} ${a.moving} ${a.referenced} ${a.presence}`;
      if (now !== undefined && before !== undefined && now !== before) since.value = store.gatewayNow_ms();
      before = now;
    });
  }, [axis]);
  // Somebody else wrote: look again at what is known.
  useEffect(
    () =>
      store.onEvent((e) => {
        if (e.axis !== axis || !e.parameter) return;
        // The parameter itself, and those whose unit and range hang on it.
        const touched = rows.peek().filter((r) => r.data.peek().id === e.parameter || r.data.peek().alternate?.parameter === e.parameter);
        for (const row of touched) void client.parameter(axis, row.data.peek().id, { cached: true }).then((p) => (row.data.value = p), () => undefined);
      }),
    [axis],
  );

  const groups = [...new Set(rows.value.map((r) => r.data.peek().group))].filter(Boolean);
  // What a filter shows is settled when it is set: a value that comes later takes no row away and brings none.
  const matching = useMemo(
    () =>
      rows.value
        .map((row) => ({ row, rank: searchRank(row.data.peek(), search.value) }))
        .filter(({ row, rank }) => rank !== null && (group.value === '' || row.data.peek().group === group.value) && isMarked(row.data.peek(), mark.value))
        .sort((x, y) => (x.rank ?? 0) - (y.rank ?? 0)) // stable: equals keep the order of the manual
        .map(({ row }) => row),
    [rows.value, search.value, group.value, mark.value, asked.value],
  );
  const shown = useMemo(() => matching.slice(0, most.value), [matching, most.value]);
  const onScreen = useOnScreen(table, shown);

  useEffect(() => {
    if (keep.value !== 'yes') return;
    const end = new AbortController();
    let timer: ReturnType<typeof setTimeout>;
    const turn = async () => {
      const now_ms = store.gatewayNow_ms();
      const away = document.hidden || !store.connected.peek() || reading.current !== null || store.axis(axis)?.peek().data.online !== true;
      const wanted = away ? [] : rows.peek().filter((r) => onScreen.has(r.data.peek().id) && r.data.peek().access !== 'W' && !isLongArray(r.data.peek()) && r.note.peek().tone !== 'busy');
      const next = dueNext(wanted.map((row) => ({ row, at_ms: receivedAt(row.data.peek()), refused_ms: row.refused_ms })), now_ms, since.peek());
      const began = performance.now();
      if (next) await reread(next.row, end.signal);
      if (!end.signal.aborted) timer = setTimeout(() => void turn(), next ? pauseAfter(performance.now() - began) : idle_ms);
    };
    timer = setTimeout(() => void turn(), idle_ms);
    return () => {
      end.abort();
      clearTimeout(timer);
    };
  }, [axis, keep.value]);

  const readAll = async () => {
    const end = (reading.current = new AbortController());
    const wanted = matching.filter((r) => r.data.peek().access !== 'W' && !isLongArray(r.data.peek()));
    progress.value = { done: 0, of: wanted.length };
    for (const [i, row] of wanted.entries()) {
      if (end.signal.aborted) break;
      await read(row, end.signal);
      progress.value = { done: i + 1, of: wanted.length };
    }
    progress.value = null;
    reading.current = null;
  };

  const read = async (row: Row, end?: AbortSignal) => {
    const id = row.data.peek().id;
    row.note.value = { tone: 'busy', text: t('Reading …') };
    row.refused_ms = null;
    try {
      const p = await client.parameter(axis, id, {}, end);
      row.data.value = p;
      row.note.value = p.quality === 'stale' ? { tone: 'refused', text: capital(p.text || 'stale') } : { tone: 'none', text: '' };
    } catch (error) {
      row.note.value = end?.aborted ? { tone: 'none', text: '' } : refusal(error);
    }
  };

  /** Without being asked: an answer is shown, a refusal leaves what is there, and its age tells the rest. */
  const reread = async (row: Row, end: AbortSignal) => {
    try {
      const p = await client.parameter(axis, row.data.peek().id, {}, end);
      row.refused_ms = p.quality === 'good' ? null : store.gatewayNow_ms();
      row.data.value = p;
    } catch {
      row.refused_ms = store.gatewayNow_ms();
    }
  };

  const write = async (row: Row) => {
    const p = row.data.peek();
    const sent = row.typed.peek();
    const value = readValue(sent ?? '', p);
    if (!value.good) {
      row.note.value = { tone: 'refused', text: value.why };
      return;
    }
    if (p.addressing && row.asked.peek() !== sent) {
      row.asked.value = sent;
      row.note.value = { tone: 'none', text: '' };
      return;
    }
    row.asked.value = null;
    row.note.value = { tone: 'busy', text: t('Writing …') };
    try {
      const answer = await client.writeParameter(axis, p.id, value.value);
      row.data.value = { ...row.data.peek(), value: answer.value, quality: 'good' };
      row.note.value = { tone: 'good', text: sameValue(answer.value, value.value) ? t('Written.') : t('Written; the drive took {value}.', { value: valueText(answer.value, p) }) };
      if (row.typed.peek() === sent) row.typed.value = null; // what was typed since then stays
      const now = await client.parameter(axis, p.id, { cached: true });
      row.data.value = now;
    } catch (error) {
      if (row.note.peek().tone === 'good') return; // it was written; only the look afterwards failed
      row.note.value = refusal(error);
    }
  };

  const open = async (row: Row) => {
    const p = row.data.peek();
    const known = rows.peek().filter((r) => r.data.peek().id.startsWith(`${p.id}[`));
    row.note.value = { tone: 'busy', text: t('Listing …') };
    try {
      const list = await client.parameters(axis, { array: p.id, first: (p.first ?? 0) + known.length });
      const at = rows.peek().indexOf(row) + known.length + 1;
      rows.value = rows.peek().toSpliced(at, 0, ...list.map(newRow));
      row.note.value = { tone: 'none', text: t('{n} of {count} elements are listed below.', { n: known.length + list.length, count: p.count ?? 0 }) };
    } catch (error) {
      row.note.value = refusal(error);
    }
  };

  return (
    <Section
      title={t('Parameters')}
      class="parameters"
      beside={
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
          {progress.value ? (
            <button type="button" class="button" onClick={() => reading.current?.abort()}>
              {t('Reading {done} of {of}: end', { done: progress.value.done, of: progress.value.of })}
            </button>
          ) : (
            <button type="button" class="button" onClick={() => void readAll()} disabled={matching.length === 0}>
              {matching.length === rows.value.length ? t('Read all') : t('Read shown')}
            </button>
          )}
        </>
      }
    >
      <Why need="engineer" what={t('Writing a parameter')} />
      {loaded.value === 'waiting' ? (
        <Empty text={t('Waiting for the list.')} />
      ) : loaded.value !== 'there' ? (
        <Empty text={capital(loaded.value)} />
      ) : matching.length === 0 ? (
        <Empty text={rows.value.length === 0 ? t('This family has no parameters.') : t('No parameter matches.')} />
      ) : (
        <div class="card table-scroll" tabIndex={0} role="region" aria-label={t('Parameters of {name}', { name: axis })}>
          <table class="table">
            <thead>
              <tr>
                <th scope="col">{t('Parameter')}</th>
                <th scope="col" class="num">{t('Live')}</th>
                <th scope="col" class="num">{t('Stored')}</th>
                <th scope="col" class="num">{t('Default')}</th>
                <th scope="col">{t('Range')}</th>
                <th scope="col">{t('New value')}</th>
                <th scope="col">{t('Last written')}</th>
              </tr>
            </thead>
            <tbody ref={table}>
              {shown.map((r) => (
                <ParameterRow key={r.data.peek().id} axis={axis} row={r} since={since} read={read} write={write} open={open} />
              ))}
            </tbody>
          </table>
          {mark.value !== 'all' && <Elsewise rows={rows.value} shown={matching} mark={mark.value} again={() => (asked.value += 1)} within={(r) => searchRank(r.data.peek(), search.value) !== null && (group.value === '' || r.data.peek().group === group.value)} />}
          {matching.length > shown.length && (
            <button type="button" class="button more" onClick={() => (most.value += rowsAtOnce)}>
              {t('Show more ({n} are not shown)', { n: matching.length - shown.length })}
            </button>
          )}
        </div>
      )}
    </Section>
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
