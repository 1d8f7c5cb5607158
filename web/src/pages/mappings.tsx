// Mappings: the register map of every unit, with live values, a palette to drag from and a panel to change in; a table to paste, templates, and what an
// HMI sees. In: the HTTP door, the axis stream. Out: a page. Of the registers only those in sight are read, once a second.
import { signal, useSignal, type Signal } from '@preact/signals';
import { useMemo, useRef } from 'preact/hooks';
import { MappingDoor } from '../api/mappings';
import type { Profiles as ProfileList } from '../api/profiles';
import { Assemblies } from '../components/assemblies';
import { notOffered } from '../components/form';
import { Gate, useBarred, Why } from '../components/gate';
import { Empty } from '../components/lines';
import { useLoaded } from '../components/loaded';
import { MappingDialog } from '../components/mapping-dialog';
import { MappingHmi } from '../components/mapping-hmi';
import { ListLinks, PrintedOnPaper } from '../components/mapping-list';
import { MappingPaste } from '../components/mapping-paste';
import type { MapHandle } from '../components/mapping-scroll';
import { MappingTemplates } from '../components/mapping-templates';
import { MappingTools, type Dialog } from '../components/mapping-tools';
import { MappingWorkspace } from '../components/mapping-workspace';
import { Profiles } from '../components/profiles';
import { Section } from '../components/section';
import { useDoor, useGateway } from '../gateway';
import { t } from '../language';
import { addressBase } from '../state/address-base';
import { useKnown } from '../state/mapping-known';
import { usePolled } from '../state/mapping-poll';
import { MappingBook } from '../state/mappings';
import { persisted } from '../state/persisted';
import type { Received } from '../state/register-look';
import { quiet, reportedOf, type Reported } from '../state/reported';
import { readAddress } from '../text/address';
import type { Table } from '../text/mapping';
import { blocksOf, type Block } from '../text/mapping-blocks';
import { isStandard } from '../text/register-map';

const unitShown = persisted('mappings.unit', '2');
const tableShown = persisted('mappings.table', 'holding_registers');
const mode = persisted('mappings.mode', 'map');
const paletteAxis = persisted('mappings.palette_axis');
const noBlocks: readonly Block[] = [];

export function MappingsPage() {
  const { store } = useGateway();
  const door = useDoor(MappingDoor);
  const book = useMemo(() => new MappingBook(door), [door]);
  const reported = useSignal<Reported>(quiet);
  const received: Signal<ReadonlyMap<string, Received>> = useMemo(() => signal(new Map()), []);
  const registers = useSignal('');
  const listed = useSignal<ProfileList | null>(null);
  const seen = useSignal(noBlocks);
  const dialog = useSignal<Dialog>('');
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

  const known = useKnown(book, base);

  const undo = async () => {
    reported.value = { tone: 'busy', text: t('Undoing …') };
    reported.value = reportedOf(await book.undo());
  };
  const show = (address: string) => {
    const place = readAddress(address, table, base);
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
          <MappingTools door={door} book={book} revision={revision} view={{ mode, unit: unitShown, table: tableShown, dialog }} units={units} fixed={fixed} show={show} undo={() => void undo()} />
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
