// Mapping grid: one table of one unit, with free places between the entries and what each register says now. In: the book, axes, registers.
// Out: a table; on a narrow screen one card per entry. Values come from the axis stream where the point is a field of the axis, else from the
// Modbus door's own answers, once a second; what is not live is said to be so. Draws at most 400 rows at once.
import { useSignal, type ReadonlySignal } from '@preact/signals';
import { useGateway } from '../gateway';
import { addressBase } from '../state/address-base';
import { gridOf, placeText, pointUnit, pointValue, tableOf, type Mapping, type Table } from '../text/mapping';
import { addressText, otherText, spanText } from '../text/address';
import { formatExact } from '../text/number';
import type { Heard } from '../state/register-look';
import { useBarred } from './gate';
import { Icon } from './icon';
import { Empty } from './lines';
import { memo } from './memo';
import { AxisName } from './name';

const rowsAtOnce = 400;


export interface GridProps {
  rows: readonly Mapping[];
  unit: number;
  table: Table;
  heard: ReadonlySignal<ReadonlyMap<string, Heard>>;
  edit: (m: Mapping) => void;
  remove: (m: Mapping) => void;
  addAt: (unit: number, table: Table, address: number) => void;
}

export function MappingGrid({ rows, unit, table, heard, edit, remove, addAt }: GridProps) {
  const most = useSignal(rowsAtOnce);
  const no = useBarred('engineer');
  const base = addressBase();
  const grid = gridOf(rows, unit, table);
  if (grid.length === 0) return <Empty text={rows.length === 0 ? 'Nothing is mapped yet. Add an entry below, or paste a table.' : `Unit ${unit} has no ${tableOf(table).name.toLowerCase()}.`} />;
  return (
    <>
      <div class="card table-scroll" tabIndex={0} role="region" aria-label={`${tableOf(table).name} of unit ${unit}`}>
        <table class="table register-table">
          <thead>
            <tr>
              <th scope="col">Address</th>
              <th scope="col">Point</th>
              <th scope="col">Type</th>
              <th scope="col">Scaling</th>
              <th scope="col">Access</th>
              <th scope="col" class="num">Value</th>
              <th scope="col" class="num">In the register</th>
              <th scope="col">Comment</th>
              <th scope="col"><span class="visually-hidden">Change</span></th>
            </tr>
          </thead>
          <tbody>
            {grid.slice(0, most.value).map((r) =>
              r.kind === 'gap' ? (
                <tr key={`gap-${r.first}`} class="gap">
                  <td colSpan={9}>
                    <span class="mono">{spanText(table, r.first, r.last, base)}</span> free ({r.last - r.first + 1}){' '}
                    <button type="button" class="button small quiet" {...no} onClick={() => addAt(unit, table, r.first)}>
                      <Icon name="plus" size={14} /> Add at {addressText(table, r.first, base)}
                    </button>
                  </td>
                </tr>
              ) : (
                <GridRow key={r.mapping.id} mapping={r.mapping} heard={heard} edit={edit} remove={remove} />
              ),
            )}
          </tbody>
        </table>
      </div>
      {grid.length > most.value && (
        <button type="button" class="button more" onClick={() => (most.value += rowsAtOnce)}>
          Show more ({grid.length - most.value} are not shown)
        </button>
      )}
    </>
  );
}

interface RowProps {
  mapping: Mapping;
  heard: ReadonlySignal<ReadonlyMap<string, Heard>>;
  edit: (m: Mapping) => void;
  remove: (m: Mapping) => void;
}

function RowView({ mapping: m, heard, edit, remove }: RowProps) {
  const no = useBarred('engineer');
  const base = addressBase();
  return (
    <tr data-mapping={m.id}>
      <th scope="row">
        <span class="mono id">{placeText(m, base)}</span> <span class="where mono" title={otherText(m.table, m.address, base)}>{addressText(m.table, m.address, base === '0' ? '1' : '0')}</span>
      </th>
      <td data-label="Point" class="point">
        <AxisName name={m.axis} /> <span class="mono">{m.point}</span> <span class="where">{m.id}</span>
      </td>
      <td data-label="Type">
        <span class="mono">{m.type}</span>
        {m.type === 'string' ? <span class="where"> {m.length ?? 16} registers</span> : m.word_order === 'low_first' ? <span class="where"> low first</span> : null}
      </td>
      <td data-label="Scaling" class="mono">{scaleText(m)}</td>
      <td data-label="Access">{{ R: 'read', W: 'write', RW: 'read, write' }[m.access]}</td>
      <LiveCells m={m} heard={heard} />
      <td data-label="Comment" class={`comment${m.comment ? '' : ' is-empty'}`}>{m.comment ?? ''}</td>
      <td class="row-buttons">
        <button type="button" class="button small quiet square" aria-label={`Change ${m.id}`} title="Change" {...no} onClick={() => edit(m)}>
          <Icon name="pencil" size={14} />
        </button>
        <button type="button" class="button small quiet square" aria-label={`Remove ${m.id}`} title="Remove; can be undone" {...no} onClick={() => remove(m)}>
          <Icon name="bin" size={14} />
        </button>
      </td>
    </tr>
  );
}
const GridRow = memo(RowView, (a, b) => a.mapping === b.mapping);

export function scaleText(m: Pick<Mapping, 'scale' | 'offset'>): string {
  const scale = m.scale === 1 ? '' : `× ${formatExact(m.scale)}`;
  const offset = m.offset === 0 ? '' : `${m.offset < 0 ? '−' : '+'} ${formatExact(Math.abs(m.offset))}`;
  return [scale, offset].filter(Boolean).join(' ') || '1 : 1';
}

const valueWords = (v: number | string | boolean): string => (typeof v === 'number' ? formatExact(Number.isInteger(v) ? v : Number(v.toPrecision(7))) : typeof v === 'boolean' ? (v ? 'on' : 'off') : v);
/** What the Modbus door itself has said, and nothing that is reckoned from elsewhere. */
function InRegister({ m, h }: { m: Mapping; h: Heard | undefined }) {
  if (h?.words) return <span class="mono">{tableOf(m.table).bits ? h.words.join(' ') : hexWords(h.words)}</span>;
  return h?.text ? <span class="flag">{h.text}</span> : <span class="where">{m.access === 'W' ? 'written only' : 'not read yet'}</span>;
}

export const hexWords = (words: readonly number[]): string => words.map((w) => w.toString(16).toUpperCase().padStart(4, '0')).join(' ');

function LiveCells({ m, heard }: { m: Mapping; heard: ReadonlySignal<ReadonlyMap<string, Heard>> }) {
  const { store } = useGateway();
  const entry = store.axis(m.axis)?.value;
  const axis = entry?.data;
  const trust = entry ? store.trustOf(entry) : 'offline';
  const fromAxis = axis ? pointValue(axis, m.point) : undefined;
  const h = heard.value.get(m.id);
  // What nobody says is not known, whatever stands in the register for it.
  const value = fromAxis === undefined ? h?.value : fromAxis;
  const live = fromAxis === undefined ? h !== undefined && store.connected.value && h.text === '' : trust === 'live';
  const unit = axis ? pointUnit(axis, m.point) : '';
  const known = value !== null && value !== undefined;
  return (
    <>
      <td class="num" data-label="Value" data-field="value" data-live={live}>
        {known ? (
          <span class={live ? '' : 'is-old-value'}>
            <span class="mono">{valueWords(value)}</span> <span class="unit">{unit}</span>
            {!live && <span class="flag"> {trust === 'live' ? 'not live' : trust}</span>}
          </span>
        ) : (
          <span class="where">not known</span>
        )}
      </td>
      <td class="num raw" data-label="In the register" data-field="in-register">
        <InRegister m={m} h={h} />
      </td>
    </>
  );
}
