// Mappings: the register map of every unit, with live values, a palette to drag from and a panel to change in; a table to paste, templates, and what an
// HMI sees. In: the HTTP door, the axis stream. Out: a page. Of the registers only those in sight are read, once a second.
import { signal, useSignal, type Signal } from '@preact/signals';
import { useMemo, useRef } from 'preact/hooks';
import { MappingDoor } from '../api/mappings';
import type { Profiles as ProfileList } from '../api/profiles';
import { Assemblies } from '../components/assemblies';
import { notOffered, quiet, type Reported, reportedOf } from '../components/form';
import { Gate, useBarred, Why } from '../components/gate';
import { Icon } from '../components/icon';
import { Empty } from '../components/lines';
import { useLoaded } from '../components/loaded';
import { MappingDialog } from '../components/mapping-dialog';
import { addAt } from '../components/mapping-form';
import { MappingHmi } from '../components/mapping-hmi';
import { ListLinks, PrintedOnPaper } from '../components/mapping-list';
import type { MapHandle } from '../components/mapping-map';
import { MappingPaste } from '../components/mapping-paste';
import { MappingTemplates } from '../components/mapping-templates';
import { MappingUnit } from '../components/mapping-unit';
import { MappingWorkspace } from '../components/mapping-workspace';
import { Profiles } from '../components/profiles';
import { Section } from '../components/section';
import { useGateway } from '../gateway';
import { midSentence, t } from '../language';
import { addressBase, countFrom } from '../state/address-base';
import { usePolled } from '../state/mapping-poll';
import { MappingBook } from '../state/mappings';
import { persisted } from '../state/persisted';
import type { Received } from '../state/register-look';
import { readAddress } from '../text/address';
import { tables, type Known, type Table } from '../text/mapping';
import { blocksOf, type Block } from '../text/mapping-blocks';
import type { ParameterShape } from '../text/mapping-type';
import { isStandard } from '../text/register-map';

const unitShown = persisted('mappings.unit', '2');
const tableShown = persisted('mappings.table', 'holding_registers');
const mode = persisted('mappings.mode', 'map');
const paletteAxis = persisted('mappings.palette_axis');
const goTo = persisted('mappings.go_to');
const noBlocks: readonly Block[] = [];

export function MappingsPage() {
  const { client, store } = useGateway();
  const door = useMemo(() => new MappingDoor(client), [client]);
  const book = useMemo(() => new MappingBook(door), [door]);
  const reported = useSignal<Reported>(quiet);
  const received: Signal<ReadonlyMap<string, Received>> = useMemo(() => signal(new Map()), []);
  const registers = useSignal('');
  const parameters: Signal<ReadonlyMap<string, ReadonlyMap<string, ParameterShape>>> = useMemo(() => signal(new Map()), []);
  const listed = useSignal<ProfileList | null>(null);
  const seen = useSignal(noBlocks);
  const dialog = useSignal<'' | 'paste' | 'template'>('');
  const open = useSignal<readonly number[]>([]);
  const handle = useRef<MapHandle | null>(null);
  const no = useBarred('engineer');
  const revision = store.siteRevision.value;

  const why = useLoaded(() => book.load(), [book, revision]);

  const unit = Number(unitShown.value);
  const table = tableShown.value as Table;
  const base = addressBase();
  const rows = book.rows.value;
  const profiles = listed.value?.profiles ?? [];
  const units = [...new Set([1, ...rows.map((m) => m.unit), ...profiles.map((p) => p.unit), unit])].sort((a, b) => a - b);
  const mapped = useMemo(() => new Set(rows.map((m) => m.unit)), [rows]);
  // By name and number alone: an axis that moves draws its cells, not the map.
  const axisNames = store.axisNames.value;
  const blocks = useMemo(() => {
    const axes = axisNames.flatMap((n) => store.axis(n)?.peek().data ?? []);
    return blocksOf(unit, table, rows, axes, listed.value?.profiles, listed.value?.languages);
  }, [unit, table, rows, axisNames, listed.value]);
  const ofProfile = profiles.some((p) => p.unit === unit);
  const fixed = isStandard(unit) ? t('Unit 1 is the standard map: it is not changed.') : ofProfile ? t('Unit {unit} speaks the registers of its profile: they are not changed.', { unit }) : '';

  usePolled({
    door,
    seen: mode.value === 'map' ? seen.value : noBlocks,
    received,
    asks: () => store.connected.peek(),
    epoch: store.connection.value.epoch,
    offered: (yes) => (registers.value = yes ? '' : notOffered(t('a look at its registers: parameters show no live value here'))),
  });

  const asked = useMemo(() => new Set<string>(), []);
  const known: Known = {
    base,
    axes: axisNames,
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
    reported.value = { tone: 'busy', text: t('Undoing …') };
    reported.value = reportedOf(await book.undo());
  };
  const show = () => {
    const place = readAddress(goTo.peek(), table, base);
    if (!place.good) return void (reported.value = { tone: 'refused', text: place.why });
    reported.value = quiet;
    if (place.table !== table) tableShown.value = place.table;
    open.value = [...open.peek().slice(-19), place.address];
    requestAnimationFrame(() => requestAnimationFrame(() => handle.current?.show(place.address)));
  };
  const last = book.changes.value.at(-1);
  const count = store.connected.value ? t('{n} of at most 4096.', { n: rows.length }) : t('{n} of at most 4096, as last known.', { n: rows.length });
  return (
    <main
      class="page mappings-page"
      onKeyDown={(e) => {
        const types = e.target instanceof HTMLElement && /^(INPUT|TEXTAREA|SELECT)$/.test(e.target.tagName);
        if (e.key.toLowerCase() === 'z' && (e.ctrlKey || e.metaKey) && !e.shiftKey && !types && last && !no.disabled) {
          e.preventDefault();
          void undo();
        }
      }}
    >
      <h1 tabIndex={-1}>{t('Mappings')}</h1>
      <p class="where">
        {(why === '' || rows.length > 0) && `${count} `}
        {t('Mapping revision')} <span class="mono" data-field="hash">{book.hash.value || t('not told here by this gateway')}</span>
        {'; '}
        {t('registers 18 and 19 of each axis show it. Unit 1 is the standard map and not changed here.')}
      </p>
      <Section
        title={t('Register map')}
        class="register-grid"
        beside={
          <>
            <div class="group" role="group" aria-label={t('View')}>
              <button type="button" class="button" aria-pressed={mode.value === 'map'} onClick={() => (mode.value = 'map')}>
                {t('Map')}
              </button>
              <button type="button" class="button" aria-pressed={mode.value === 'hmi'} onClick={() => (mode.value = 'hmi')}>
                {t('What the HMI sees')}
              </button>
            </div>
            {mode.value === 'map' && (
              <label class="select">
                <span>{t('Unit ID')}</span>
                <select value={unitShown.value} onChange={(e) => (unitShown.value = e.currentTarget.value)}>
                  {units.map((u) => (
                    <option key={u} value={String(u)}>
                      {u}
                    </option>
                  ))}
                </select>
              </label>
            )}
            <label class="select" title={t('How register addresses are written everywhere on this page; tables and files count from 0')}>
              <span>{t('Addresses')}</span>
              <select value={base} onChange={(e) => countFrom(e.currentTarget.value === '1' ? '1' : '0')}>
                <option value="0">{t('from 0')}</option>
                <option value="1">{t('from 1 (40001)')}</option>
              </select>
            </label>
            {mode.value === 'map' && (
              <>
                {fixed === '' && <MappingUnit door={door} unit={unit} revision={revision} />}
                <div class="group tables" role="group" aria-label={t('Table')}>
                  {tables.map((x) => (
                    <button key={x.id} type="button" class="button" aria-pressed={table === x.id} title={x.name} onClick={() => (tableShown.value = x.id)}>
                      {x.short} <span class="where">{rows.filter((m) => m.unit === unit && m.table === x.id).length}</span>
                    </button>
                  ))}
                </div>
                <form
                  class="map-go"
                  onSubmit={(e) => {
                    e.preventDefault();
                    show();
                  }}
                >
                  <label class="select">
                    <span>{t('Go to')}</span>
                    <input type="text" class="search" inputMode="decimal" value={goTo.value} onInput={(e) => (goTo.value = e.currentTarget.value)} />
                  </label>
                </form>
                <button type="button" class="button" {...no} onClick={() => addAt(isStandard(unit) ? 2 : unit, table, null, true)}>
                  <Icon name="plus" size={14} /> {t('Add a mapping')}
                </button>
                <button type="button" class="button" aria-expanded={dialog.value === 'template'} {...no} onClick={() => (dialog.value = dialog.peek() === 'template' ? '' : 'template')}>
                  {t('Add a template')}
                </button>
                <button type="button" class="button" aria-expanded={dialog.value === 'paste'} {...no} onClick={() => (dialog.value = dialog.peek() === 'paste' ? '' : 'paste')}>
                  {t('Paste or import')}
                </button>
                <button type="button" class="button" disabled={!last} title={last ? t('{what} (Ctrl Z)', { what: last.text }) : t('Nothing was changed by this page yet')} {...no} onClick={() => void undo()}>
                  {last ? t('Undo: {what}', { what: midSentence(last.text) }) : t('Undo')}
                </button>
              </>
            )}
          </>
        }
      >
        <Why need="engineer" what={t('Changing the mappings')} />
        {mode.value === 'hmi' ? (
          <MappingHmi door={door} rows={rows} points={known.points} />
        ) : why ? (
          <Empty text={why} />
        ) : (
          <>
            {fixed !== '' && <p class="where">{fixed}</p>}
            {blocks.length === 0 && <Empty text={rows.length === 0 ? t('Nothing is mapped yet. Drag a point into a free place, add an entry by the form, or paste a table.') : t('Unit {unit} has nothing in this table.', { unit })} />}
            <MappingWorkspace book={book} known={known} blocks={blocks} unit={unit} table={table} base={base} open={open.value} received={received} reported={reported} seen={(b) => (seen.value = b)} handle={handle} paletteAxis={paletteAxis} fixed={fixed} />
          </>
        )}
        {registers.value !== '' && <p class="where">{registers.value}</p>}
        <ListLinks door={door} />
      </Section>
      {dialog.value === 'template' && (
        <MappingDialog title={t('Template: the standard map of an axis')} onClose={() => (dialog.value = '')}>
          <Gate need="engineer">
            <MappingTemplates book={book} door={door} />
          </Gate>
        </MappingDialog>
      )}
      {dialog.value === 'paste' && (
        <MappingDialog title={t('Paste or import a table')} onClose={() => (dialog.value = '')}>
          <Gate need="engineer">
            <MappingPaste book={book} known={{ ...known, base: '0' }} />
          </Gate>
        </MappingDialog>
      )}
      <Profiles listed={listed} mapped={mapped} revision={revision} />
      <Assemblies revision={revision} />
      <PrintedOnPaper rows={rows} known={known} hash={book.hash.value} />
    </main>
  );
}
