// Parameters of one axis: live, stored and default value, range, who wrote last; read from the drive, write with a check before.
// In: REST. Out: a table. What is on the screen is read again, one value at a time, unless that is switched off; each value tells its age, and
// grey ones are old. Reading all goes one by one and can be ended; a slow drive is not flooded. What was typed stays until the drive took it.
// At most 100 rows are drawn at once; more on demand.
import { useBarred, Why } from './gate';
import { signal, useSignal, type Signal } from '@preact/signals';
import { useEffect, useId, useMemo, useRef } from 'preact/hooks';
import { asProblem } from '../api/problem';
import type { AxisParameter } from '../api/types';
import { useGateway } from '../gateway';
import { capital } from '../state/commander';
import { kept } from '../state/kept';
import { dueNext, pauseAfter } from '../state/reread';
import { isApart, isChanged, isMarked, marks, type Marked } from '../words/transfer';
import { addressingWords, editText, fieldLines, fieldValue, rangeText, readValue, sameValue, searchRank, steppedText, unitWords, valueText, withField } from '../words/parameter';
import { Ask } from './ask';
import { Icon } from './icon';
import { Empty } from './lines';
import { memo } from './memo';
import { Written } from './parameter-history';
import { Age, heardAt, LiveValue, useOnScreen, type Since } from './parameter-live';
import { Section } from './section';

const rowsAtOnce = 100;
const idle_ms = 400;
/** Whether what is on the screen is read again. */
const keep = kept('parameters.keep', 'no', 'browser');

interface Row {
  data: Signal<AxisParameter>;
  note: Signal<{ tone: 'none' | 'busy' | 'good' | 'refused'; text: string }>;
  /** What is typed; null: the field shows nothing of its own. */
  typed: Signal<string | null>;
  /** The value that was asked about before it is written: the drive is reached by this parameter. */
  asked: Signal<string | null>;
  /** When reading it without being asked was last refused, by the gateway's clock. */
  refused_ms: number | null;
}

const isLongArray = (p: AxisParameter) => p.count !== null && p.count > 0 && !/\]$/.test(p.id);

export function Parameters({ axis }: { axis: string }) {
  const { client, store } = useGateway();
  const rows: Signal<Row[]> = useMemo(() => signal([]), [axis]);
  const loaded = useSignal<'waiting' | 'there' | string>('waiting');
  const search = useSignal('');
  const group = useSignal('');
  const mark = useSignal<Marked>('all');
  const most = useSignal(rowsAtOnce);
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
      if (!signalOfEnd.aborted && rows.peek().length === 0) loaded.value = asProblem(error).words;
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
  const onScreen = useOnScreen(table);
  useEffect(() => {
    if (keep.value !== 'yes') return;
    const end = new AbortController();
    let timer: ReturnType<typeof setTimeout>;
    const turn = async () => {
      const now_ms = store.gatewayNow_ms();
      const away = document.hidden || !store.connected.peek() || reading.current !== null || store.axis(axis)?.peek().data.online !== true;
      const wanted = away ? [] : rows.peek().filter((r) => onScreen.has(r.data.peek().id) && r.data.peek().access !== 'W' && !isLongArray(r.data.peek()) && r.note.peek().tone !== 'busy');
      const next = dueNext(wanted.map((row) => ({ row, at_ms: heardAt(row.data.peek()), refused_ms: row.refused_ms })), now_ms, since.peek());
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
  const matching = rows.value
    .map((row) => ({ row, rank: searchRank(row.data.peek(), search.value) }))
    .filter(({ row, rank }) => {
      const p = row.data.peek();
      if (rank === null || (group.value && p.group !== group.value)) return false;
      return mark.value === 'all' || isMarked(row.data.value, mark.value);
    })
    .sort((x, y) => (x.rank ?? 0) - (y.rank ?? 0)) // stable: equals keep the order of the manual
    .map(({ row }) => row);
  const shown = matching.slice(0, most.value);

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
    row.note.value = { tone: 'busy', text: 'Reading …' };
    row.refused_ms = null;
    try {
      const p = await client.parameter(axis, id, {}, end);
      row.data.value = p;
      row.note.value = p.quality === 'stale' ? { tone: 'refused', text: capital(p.text || 'stale') } : { tone: 'none', text: '' };
    } catch (error) {
      row.note.value = end?.aborted ? { tone: 'none', text: '' } : { tone: 'refused', text: capital(asProblem(error).words) };
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
    row.note.value = { tone: 'busy', text: 'Writing …' };
    try {
      const answer = await client.writeParameter(axis, p.id, value.value);
      row.data.value = { ...row.data.peek(), value: answer.value, quality: 'good' };
      row.note.value = { tone: 'good', text: sameValue(answer.value, value.value) ? 'Written.' : `Written; the drive took ${valueText(answer.value, p)}.` };
      if (row.typed.peek() === sent) row.typed.value = null; // what was typed since then stays
      const now = await client.parameter(axis, p.id, { cached: true });
      row.data.value = now;
    } catch (error) {
      if (row.note.peek().tone === 'good') return; // it was written; only the look afterwards failed
      row.note.value = { tone: 'refused', text: capital(asProblem(error).words) };
    }
  };

  const open = async (row: Row) => {
    const p = row.data.peek();
    const known = rows.peek().filter((r) => r.data.peek().id.startsWith(`${p.id}[`));
    row.note.value = { tone: 'busy', text: 'Listing …' };
    try {
      const list = await client.parameters(axis, { array: p.id, first: (p.first ?? 0) + known.length });
      const at = rows.peek().indexOf(row) + known.length + 1;
      rows.value = rows.peek().toSpliced(at, 0, ...list.map(newRow));
      row.note.value = { tone: 'none', text: `${known.length + list.length} of ${p.count} elements are listed below.` };
    } catch (error) {
      row.note.value = { tone: 'refused', text: capital(asProblem(error).words) };
    }
  };

  return (
    <Section
      title="Parameters"
      class="parameters"
      beside={
        <>
          <input class="search" type="search" placeholder="Search" aria-label="Search parameters" value={search.value} onInput={(e) => (search.value = e.currentTarget.value)} />
          {groups.length > 1 && (
            <label class="select">
              <span class="visually-hidden">Group</span>
              <select value={group.value} onChange={(e) => (group.value = e.currentTarget.value)}>
                <option value="">all groups</option>
                {groups.map((g) => (
                  <option key={g} value={g}>
                    {g.replaceAll('_', ' ')}
                  </option>
                ))}
              </select>
            </label>
          )}
          <label class="select">
            <span class="visually-hidden">Show</span>
            <select value={mark.value} onChange={(e) => (mark.value = e.currentTarget.value as Marked)}>
              {marks.map((m) => (
                <option key={m.id} value={m.id}>
                  {m.text}
                </option>
              ))}
            </select>
          </label>
          <label class="check" title="What is on the screen is read again, one value at a time; at most a quarter of the line's time is taken">
            <input type="checkbox" checked={keep.value === 'yes'} onChange={(e) => (keep.value = e.currentTarget.checked ? 'yes' : 'no')} /> Keep reading
          </label>
          {progress.value ? (
            <button type="button" class="button" onClick={() => reading.current?.abort()}>
              Reading {progress.value.done} of {progress.value.of}: end
            </button>
          ) : (
            <button type="button" class="button" onClick={() => void readAll()} disabled={matching.length === 0}>
              Read {matching.length === rows.value.length ? 'all' : 'shown'}
            </button>
          )}
        </>
      }
    >
      <Why need="engineer" what="Writing a parameter" />
      {loaded.value === 'waiting' ? (
        <Empty text="Waiting for the list." />
      ) : loaded.value !== 'there' ? (
        <Empty text={capital(loaded.value)} />
      ) : matching.length === 0 ? (
        <Empty text={rows.value.length === 0 ? 'This family has no parameters.' : 'No parameter matches.'} />
      ) : (
        <div class="card table-scroll" tabIndex={0} role="region" aria-label="Parameters">
          <table class="table">
            <thead>
              <tr>
                <th scope="col">Parameter</th>
                <th scope="col" class="num">Live</th>
                <th scope="col" class="num">Stored</th>
                <th scope="col" class="num">Default</th>
                <th scope="col">Range</th>
                <th scope="col">New value</th>
                <th scope="col">Last written</th>
              </tr>
            </thead>
            <tbody ref={table}>
              {shown.map((r) => (
                <ParameterRow key={r.data.peek().id} axis={axis} row={r} since={since} read={read} write={write} open={open} />
              ))}
            </tbody>
          </table>
          {matching.length > shown.length && (
            <button type="button" class="button more" onClick={() => (most.value += rowsAtOnce)}>
              Show more ({matching.length - shown.length} are not shown)
            </button>
          )}
        </div>
      )}
    </Section>
  );
}

const newRow = (p: AxisParameter): Row => ({ data: signal(p), note: signal({ tone: 'none', text: '' }), typed: signal(null), asked: signal(null), refused_ms: null });

interface RowProps {
  axis: string;
  row: Row;
  since: Since;
  read: (row: Row) => void;
  write: (row: Row) => void;
  open: (row: Row) => void;
}

function RowView({ axis, row, since, read, write, open }: RowProps) {
  const note = useId();
  const p = row.data.value;
  const n = row.note.value;
  const differs = isChanged(p);
  const apart = isApart(p);
  const long = isLongArray(p);
  return (
    <tr data-parameter={p.id} class={p.quality === 'good' ? '' : 'is-not-good'}>
      <th scope="row" title={p.description}>
        <span class="both">
          <span class="mono id">{p.id}</span>
          <span class="name">{p.name.replaceAll('_', ' ')}</span>
        </span>
      </th>
      <td class="num" data-label="Live" data-field="live">
        {long ? (
          <span class="where">{p.count} elements</span>
        ) : (
          <>
            <LiveValue p={p} since={since} differs={differs} />{' '}
            <span class="unit">{p.value !== null && !p.allowed ? `${unitWords(p.unit)} ${steppedText(p.value, p.unit)}`.trim() : ''}</span>
            {differs && <span class="flag changed" title="Not the default of the family"> changed</span>}
            {p.quality === 'stale' && <span class="flag"> stale</span>}
            <Age p={p} />
            {p.quality === 'unknown' && <span class="visually-hidden"> not read yet</span>}
            {fieldLines(p.value, p).map((line) => (
              <span key={line} class="part">
                {line}
              </span>
            ))}
          </>
        )}
      </td>
      <td class="num mono" data-label="Stored">
        {valueText(p.stored, p)}
        {apart && <span class="flag" title="The drive has another value than the one written last"> differs</span>}
      </td>
      <td class="num mono" data-label="Default">{valueText(p.default, p)}</td>
      <td class="range" data-label="Range">
        <span class="mono">{rangeText(p)}</span> <span class="unit">{unitWords(p.unit)}</span>
      </td>
      <td class="edit" data-label="New value">
        <div class="edit-row">
          {long ? (
            <button type="button" class="button small" onClick={() => open(row)}>
              List elements
            </button>
          ) : (
            <>
              {p.access !== 'R' && <Editor row={row} describedBy={note} write={() => write(row)} />}
              {p.access !== 'W' && (
                <button type="button" class="button small quiet square" aria-label={`Read ${p.id} from the drive`} title="Read from the drive" onClick={() => read(row)}>
                  <Icon name="refresh" size={14} />
                </button>
              )}
              {p.access === 'R' && <span class="where">read only</span>}
            </>
          )}
        </div>
        {row.asked.value !== null && (
          <Ask
            field="addressing-question"
            words={addressingWords(axis, p, row.asked.value)}
            yes={`Write ${p.id}`}
            onNo={() => (row.asked.value = null)}
            onYes={() => {
              row.typed.value = row.asked.peek();
              write(row);
            }}
          />
        )}
        <p class={`row-note result-${n.tone}`} id={note} role="status">
          {n.text || typedText(row.typed.value, p)}
        </p>
      </td>
      <td class="written" data-label="Last written">
        <Written axis={axis} p={p} />
      </td>
    </tr>
  );
}
/** What is typed for a unit that is counted in steps, as a quantity: the field itself takes the drive's own number. */
function typedText(typed: string | null, p: AxisParameter): string {
  const value = typed === null || typed.trim() === '' || p.allowed ? null : readValue(typed, p);
  const text = value?.good ? steppedText(value.value, p.unit) : '';
  return text && `${typed?.trim()} ${unitWords(p.unit)} ${text}`;
}

const ParameterRow = memo(RowView, (a, b) => a.row === b.row);

function Editor({ row, describedBy, write }: { row: Row; describedBy: string; write: () => void }) {
  const no = useBarred('engineer');
  const p = row.data.value;
  const wrong = row.note.value.tone === 'refused' && row.typed.value !== null;
  const text = row.typed.value ?? '';
  const parts = p.access === 'RW' && p.fields?.every((f) => f.allowed) ? p.fields : null;
  const choices = p.type === 'bool' ? [{ value: 0, meaning: 'off' }, { value: 1, meaning: 'on' }] : p.allowed && p.allowed.length > 0 ? p.allowed : null;
  return (
    <>
      {parts && parts.length > 0 && p.alternate === null ? (
        <span class="parts">
          {parts.map((f) => {
            const whole = typeof p.value === 'number' && text === '' ? p.value : Number(text || 0);
            return (
              <label key={f.name}>
                <span>{f.name.replaceAll('_', ' ')}</span>
                <select
                  aria-label={`New ${f.name.replaceAll('_', ' ')} of ${p.id}`}
                  aria-describedby={describedBy}
                  value={String(fieldValue(whole, f))}
                  onChange={(e) => (row.typed.value = String(withField(whole, f, Number(e.currentTarget.value))))}
                >
                  {f.allowed?.map((c) => (
                    <option key={c.value} value={String(c.value)}>
                      {c.value} {c.meaning}
                    </option>
                  ))}
                </select>
              </label>
            );
          })}
        </span>
      ) : choices ? (
        <select aria-label={`New value of ${p.id}`} aria-describedby={describedBy} value={text} onChange={(e) => (row.typed.value = e.currentTarget.value)}>
          <option value="" disabled>
            choose
          </option>
          {choices.map((c) => (
            <option key={c.value} value={String(c.value)}>
              {c.value} {c.meaning}
            </option>
          ))}
        </select>
      ) : (
        <input
          type="text"
          class={wrong ? 'is-wrong' : ''}
          inputMode={p.type === 'text' || p.type === 'bytes' ? 'text' : 'decimal'}
          autocomplete="off"
          spellcheck={false}
          aria-label={`New value of ${p.id}`}
          aria-describedby={describedBy}
          aria-invalid={wrong || undefined}
          placeholder={editText(p.value)}
          value={text}
          onInput={(e) => (row.typed.value = e.currentTarget.value)}
          onKeyDown={(e) => {
            if (e.key === 'Enter' && !e.repeat && !no.disabled) write();
          }}
        />
      )}
      <button type="button" class="button small" aria-label={`Write ${p.id}`} {...no} onClick={write}>
        Write
      </button>
    </>
  );
}
