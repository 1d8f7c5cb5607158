// Mappings: the registers of one's own: a grid with live values, adding, changing, templates, tables, lists, and what an HMI sees. In: the HTTP
// door, the axis stream. Out: a page. Registers of the shown table are read once a second where the gateway offers it; at most 8 spans a second.
import { signal, useSignal, type Signal } from '@preact/signals';
import { useEffect, useMemo } from 'preact/hooks';
import { MappingDoor } from '../api/mappings';
import { asProblem } from '../api/problem';
import { Assemblies } from '../components/assemblies';
import { notOffered, quiet, Tell, toldOf, type Told } from '../components/form';
import { Gate, useBarred, Why } from '../components/gate';
import { HmiView } from '../components/hmi-view';
import { Empty } from '../components/lines';
import { useLoaded } from '../components/loaded';
import { addAt, MappingForm } from '../components/mapping-form';
import { MappingGrid } from '../components/mapping-grid';
import { ListLinks, PrintedList } from '../components/mapping-list';
import { MappingPaste } from '../components/mapping-paste';
import { MappingUnit } from '../components/mapping-unit';
import { MappingTemplates } from '../components/mapping-templates';
import { Profiles } from '../components/profiles';
import { Section } from '../components/section';
import { useGateway } from '../gateway';
import { addressBase, countFrom } from '../state/address-base';
import { persisted } from '../state/persisted';
import { MappingBook, uncapital } from '../state/mappings';
import { lookAt, type Heard } from '../state/register-look';
import type { ParameterShape } from '../text/mapping-type';
import { spansOf, tables, type Known, type Mapping, type Table } from '../text/mapping';

const unitShown = persisted('mappings.unit', '2');
const tableShown = persisted('mappings.table', 'holding_registers');
const poll_ms = 1000;
const spansAtOnce = 8;

export function MappingsPage() {
  const { client, store } = useGateway();
  const door = useMemo(() => new MappingDoor(client), [client]);
  const book = useMemo(() => new MappingBook(door), [door]);
  const editing = useSignal<Mapping | null>(null);
  const told = useSignal<Told>(quiet);
  const heard: Signal<ReadonlyMap<string, Heard>> = useMemo(() => signal(new Map()), []);
  const registers = useSignal<'asking' | 'there' | string>('asking');
  const parameters: Signal<ReadonlyMap<string, ReadonlyMap<string, ParameterShape>>> = useMemo(() => signal(new Map()), []);
  const no = useBarred('engineer');
  const epoch = store.connection.value.epoch;
  const revision = store.siteRevision.value;

  const why = useLoaded(() => book.load(), [book, revision]);

  const unit = Number(unitShown.value);
  const table = tableShown.value as Table;
  const rows = book.rows.value;
  const units = [...new Set([...rows.map((m) => m.unit), unit])].sort((a, b) => a - b);
  const mapped = useMemo(() => new Set(rows.map((m) => m.unit)), [rows]);
  const shown = useMemo(() => rows.filter((m) => m.unit === unit && m.table === table), [rows, unit, table]);

  useEffect(() => {
    if (shown.length === 0 || epoch === 0) return;
    const end = new AbortController();
    let timer: ReturnType<typeof setTimeout>;
    let turn = 0;
    const spans = spansOf(shown);
    const again = async () => {
      let offered = true;
      if (!document.hidden && store.connected.peek()) {
        const next = new Map(heard.peek());
        for (let i = 0; i < Math.min(spans.length, spansAtOnce) && offered && !end.signal.aborted; i += 1) {
          const s = spans[(turn + i) % spans.length]!;
          const own = shown.filter((m) => m.address >= s.address && m.address < s.address + s.count);
          try {
            await lookAt(door, own, next, end.signal);
            registers.value = 'there';
          } catch (error) {
            if (end.signal.aborted) return;
            const p = asProblem(error);
            offered = !(p.status === 404 || p.status === 405 || p.status === 501);
            if (!offered) registers.value = notOffered('a look at its registers: parameters show no live value here');
            for (const m of own) next.set(m.id, { words: null, value: undefined, text: offered ? p.words : '' });
          }
        }
        turn += spansAtOnce;
        heard.value = next;
      }
      if (offered && !end.signal.aborted) timer = setTimeout(() => void again(), poll_ms);
    };
    void again();
    return () => {
      end.abort();
      clearTimeout(timer);
    };
  }, [shown, epoch]);

  const asked = useMemo(() => new Set<string>(), []);
  const base = addressBase();
  const known: Known = {
    base,
    axes: store.axisNames.value,
    points: book.points.value,
    parameters: (axis) => {
      if (axis && !asked.has(axis) && store.axisNames.peek().includes(axis)) {
        asked.add(axis);
        client.parameters(axis).then(
          (list) => (parameters.value = new Map([...parameters.peek(), [axis, new Map(list.flatMap((p) => [p.id, p.name].map((k) => [k, p] as const)))]])),
          () => asked.delete(axis),
        );
      }
      const own = parameters.value.get(axis);
      return own ? [...own.keys()] : null;
    },
    parameter: (axis, id) => parameters.value.get(axis)?.get(id) ?? null,
  };

  const undo = async () => {
    told.value = { tone: 'busy', text: 'Undoing …' };
    told.value = toldOf(await book.undo());
  };
  const remove = async (m: Mapping) => {
    told.value = { tone: 'busy', text: `Removing ${m.id} …` };
    if (editing.peek()?.id === m.id) editing.value = null;
    told.value = toldOf(await book.remove(m.id));
  };
  const last = book.changes.value.at(-1);
  return (
    <main
      class="page mappings-page"
      onKeyDown={(e) => {
        const typing = e.target instanceof HTMLElement && /^(INPUT|TEXTAREA|SELECT)$/.test(e.target.tagName);
        if (e.key.toLowerCase() === 'z' && (e.ctrlKey || e.metaKey) && !e.shiftKey && !typing && last && !no.disabled) {
          e.preventDefault();
          void undo();
        }
      }}
    >
      <h1 tabIndex={-1}>Mappings</h1>
      <p class="where">
        {(why === '' || rows.length > 0) && `${rows.length} of at most 4096${store.connected.value ? '' : ', as last known'}. `}Mapping revision <span class="mono" data-field="hash">{book.hash.value || 'not told here by this gateway'}</span>; registers 18 and 19 of each axis show it. Unit 1 is the{' '}
        standard map and not changed here.
      </p>
      <Section
        title="Register grid"
        class="register-grid"
        beside={
          <>
            <label class="select">
              <span>Unit ID</span>
              <select value={unitShown.value} onChange={(e) => (unitShown.value = e.currentTarget.value)}>
                {units.map((u) => (
                  <option key={u} value={String(u)}>
                    {u}
                  </option>
                ))}
              </select>
            </label>
            <label class="select" title="How register addresses are written everywhere on this page; tables and files count from 0">
              <span>Addresses</span>
              <select value={base} onChange={(e) => countFrom(e.currentTarget.value === '1' ? '1' : '0')}>
                <option value="0">from 0</option>
                <option value="1">from 1 (40001)</option>
              </select>
            </label>
            <MappingUnit door={door} unit={unit} revision={revision} />
            <div class="group tables" role="group" aria-label="Table">
              {tables.map((t) => (
                <button key={t.id} type="button" class="button" aria-pressed={table === t.id} title={t.name} onClick={() => (tableShown.value = t.id)}>
                  {t.short} <span class="where">{rows.filter((m) => m.unit === unit && m.table === t.id).length}</span>
                </button>
              ))}
            </div>
            <button type="button" class="button" disabled={!last} title={last ? `${last.words} (Ctrl Z)` : 'Nothing was changed by this page yet'} {...no} onClick={() => void undo()}>
              Undo{last ? `: ${uncapital(last.words)}` : ''}
            </button>
          </>
        }
      >
        <Why need="engineer" what="Changing the mappings" />
        <Tell told={told.value} field="grid-told" />
        {why ? (
          <Empty text={why} />
        ) : (
          <MappingGrid
            rows={rows}
            unit={unit}
            table={table}
            heard={heard}
            edit={(m) => (editing.value = m)}
            remove={(m) => void remove(m)}
            addAt={(u, t, a) => {
              editing.value = null;
              addAt(u, t, a);
            }}
          />
        )}
        {registers.value !== 'there' && registers.value !== 'asking' && <p class="where">{registers.value}</p>}
        <ListLinks door={door} />
      </Section>
      <Gate need="engineer">
        <MappingForm book={book} known={known} editing={editing.value} done={() => (editing.value = null)} />
        <MappingTemplates book={book} door={door} />
        <MappingPaste book={book} known={{ ...known, base: '0' }} />
      </Gate>
      <Profiles mapped={mapped} revision={revision} />
      <Assemblies revision={revision} />
      <HmiView door={door} rows={rows} />
      <PrintedList rows={rows} known={known} hash={book.hash.value} />
    </main>
  );
}
