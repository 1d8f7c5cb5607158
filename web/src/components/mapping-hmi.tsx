// What the HMI sees: the register map with each register by itself, as the Modbus door answers a read of this unit: hex, a number, the value that begins
// there, and what it is of. In: unit, table, address, count, word order. Out: a form and the map; an exception in words, with the places that
// nothing answers for. Follows once a second when it is asked to. Never writes.
import { computed, signal, useSignal } from '@preact/signals';
import { marked } from './marked';
import { useEffect, useMemo, useRef } from 'preact/hooks';
import type { MappingDoor, Registers } from '../api/mappings';
import { asProblem } from '../api/problem';
import type { Axis } from '../api/types';
import { useGateway } from '../gateway';
import { midSentence, t } from '../language';
import { addressBase, addressField } from '../state/address-base';
import { persisted } from '../state/persisted';
import { addressText, otherText, readAddress } from '../text/address';
import { decodeText, pointUnit, tableOf, tables, types, widthOf, type Mapping, type MappingPoint, type RegisterType, type Table } from '../text/mapping';
import type { Block } from '../text/mapping-blocks';
import { formatExact, parseNumber } from '../text/number';
import { bitAxis, bitName, isStandard, notMapped } from '../text/register-map';
import { Choice, notOffered, TextField } from './form';
import { RegisterMap, type MapHandle } from './mapping-map';
import { SimulatedMark } from './name';

const unit = persisted('hmi.unit', '1');
const table = persisted('hmi.table', 'holding_registers');
const address = addressField(persisted('hmi.address'), () => table.peek() as Table);
const count = persisted('hmi.count', '16');
const as = persisted('hmi.as', 'i32');
const order = persisted('hmi.order', 'high_first');
const following = signal(false);
const period_ms = 1000;
const nobody = computed(() => new Set<string>());
const nothing = computed(() => null);

const within = (text: string, min: number, max: number): number | null => {
  const p = parseNumber(text);
  return p.good && Number.isInteger(p.value) && p.value >= min && p.value <= max ? p.value : null;
};

export function MappingHmi({ door, rows, points }: { door: MappingDoor; rows: readonly Mapping[]; points: readonly MappingPoint[] }) {
  const { store } = useGateway();
  const answer = useSignal<Registers | null>(null);
  const why = useSignal('');
  const waiting = useSignal(false);
  /** What the answer that is shown was asked with. */
  const answerTo = useSignal('');
  const base = addressBase();
  // Nothing typed: from the first register on.
  const place = readAddress(address.value.trim() === '' ? base : address.value, table.value as Table, base);
  const at = { unit: within(unit.value, 0, 255), address: place.good ? place.address : null, count: within(count.value, 1, 125) };

  const choose = (text: string) => {
    address.value = text;
    const now = readAddress(text, table.peek() as Table, base);
    if (now.good) table.value = now.table;
  };

  const asked = `${unit.value.trim()}/${table.value}/${address.value.trim()}/${count.value.trim()}`;
  const look = async (end?: AbortSignal) => {
    if (at.unit === null || at.address === null || at.count === null) {
      // Nothing stands below fields that it does not belong to.
      answer.value = null;
      why.value = t('Mend the fields that are marked; nothing was asked.');
      return;
    }
    waiting.value = true;
    try {
      answer.value = await door.registers({ unit: at.unit, table: table.value as Table, address: at.address, count: at.count }, end);
      answerTo.value = asked;
      why.value = '';
    } catch (error) {
      if (end?.aborted) return;
      const p = asProblem(error);
      why.value = p.status === 404 || p.status === 501 ? notOffered(t('a look at its registers')) : p.text;
      answer.value = null;
      following.value = false;
    } finally {
      waiting.value = false;
    }
  };
  useEffect(() => {
    if (!following.value) return;
    const end = new AbortController();
    let timer: ReturnType<typeof setTimeout>;
    const again = async () => {
      if (!document.hidden) await look(end.signal);
      if (!end.signal.aborted) timer = setTimeout(() => void again(), period_ms);
    };
    void again();
    return () => {
      end.abort();
      clearTimeout(timer);
    };
  }, [following.value, unit.value, table.value, address.value, count.value]);

  const a = answer.value;
  const axes = store.axisNames.value.flatMap((n) => store.axis(n)?.peek().data ?? []);
  const gaps = a?.exception && at.unit !== null && at.address !== null && at.count !== null ? notMapped({ unit: at.unit, table: table.value as Table, address: at.address, count: at.count }, rows, axes) : '';
  const refused = a?.exception ? (gaps ? t('The Modbus door answers exception {code}: {text}. Not mapped: {places}.', { code: a.exception.code, text: a.exception.text, places: gaps }) : t('The Modbus door answers exception {code}: {text}.', { code: a.exception.code, text: a.exception.text })) : '';
  const former = answerTo.value !== asked;
  return (
    <div class="hmi">
      <form
        class="card form"
        noValidate
        aria-label={t('Read registers')}
        onSubmit={(e) => {
          e.preventDefault();
          void look();
        }}
      >
        <div class="form-grid">
          <TextField label={t('Unit ID')} number value={unit.value} onText={(text) => (unit.value = text)} fault={at.unit === null ? t('A whole number from 0 to 255.') : undefined} hint={t('1 is the standard map')} />
          <Choice label={t('Table')} value={table.value} onChoice={(text) => (table.value = text)} choices={tables.map((x) => ({ value: x.id, text: x.name }))} />
          <TextField label={t('Address')} number value={address.value} placeholder={addressText(table.value as Table, 0, base)} onText={choose} fault={place.good ? undefined : place.why} hint={at.address === null ? undefined : t('{address} is {other}', { address: addressText(table.value as Table, at.address, base), other: otherText(table.value as Table, at.address, base) })} />
          <TextField label={t('Count')} number value={count.value} onText={(text) => (count.value = text)} fault={at.count === null ? t('A whole number from 1 to 125.') : undefined} />
          {!tableOf(table.value as Table).bits && (
            <>
              <Choice label={t('Read as')} value={as.value} onChoice={(text) => (as.value = text)} choices={types.filter((x) => x !== 'bool').map((x) => ({ value: x, text: x }))} />
              <Choice label={t('Word order')} value={order.value} onChoice={(text) => (order.value = text)} choices={[{ value: 'high_first', text: t('high word first') }, { value: 'low_first', text: t('low word first') }]} />
            </>
          )}
        </div>
        <div class="form-foot">
          <button type="submit" class="button primary">
            {t('Look')}
          </button>
          <button type="button" class="button" aria-pressed={following.value} onClick={() => (following.value = !following.value)}>
            {following.value ? t('Following each second') : t('Follow')}
          </button>
          <p class={`tell result-${why.value ? 'refused' : 'none'}`} role="status" data-field="hmi-told">
            {marked(why.value || refused || (waiting.value && !a ? t('Asking …') : ''))}
          </p>
        </div>
        {a && !a.exception && former && (
          <p class="form-told" role="status" data-field="hmi-former">
            {t('This is the former answer: unit {unit}, {table} from {address} on. Press Look for what the fields say now.', { unit: a.unit, table: midSentence(tableOf(a.table).name), address: addressText(a.table, a.address, base) })}
          </p>
        )}
      </form>
      {a && !a.exception && <AnswerMap a={a} axes={axes} rows={rows} points={points} former={former} />}
    </div>
  );
}

/** The axis and the point that a decoded value is of: by its mapping, or by the name that the standard map gives it. */
function sourceOf(d: { name?: string; mapping?: string }, rows: readonly Mapping[], axes: readonly Axis[]): { axis: string; point: string } | null {
  const m = d.mapping === undefined ? undefined : rows.find((r) => r.id === d.mapping);
  if (m) return { axis: m.axis, point: m.point };
  const axis = axes.filter((x) => d.name?.startsWith(`${x.name}.`)).sort((x, y) => y.name.length - x.name.length)[0];
  return axis && d.name ? { axis: axis.name, point: d.name.slice(axis.name.length + 1) } : null;
}

/** In words: a bare number beside "position" could be anything. */
function decodedUnit(reported: string | null | undefined, source: { axis: string; point: string } | null, axes: readonly Axis[], points: readonly MappingPoint[]): string {
  const text = reported || (source ? pointUnit(axes.find((x) => x.name === source.axis) ?? { unit: '' }, source.point, points) : '');
  return text.replace(/^inc\b/, t('increments'));
}

type Decoded = NonNullable<Registers['decoded']>[number];

/** Each register of the answer as a cell of the map. */
function AnswerMap({ a, axes, rows, points, former }: { a: Registers; axes: readonly Axis[]; rows: readonly Mapping[]; points: readonly MappingPoint[]; former: boolean }) {
  const base = addressBase();
  const handle = useRef<MapHandle | null>(null);
  const cursor = useSignal(a.address);
  const raw = useMemo(() => a.words ?? (a.bits ?? []).map(Number), [a]);
  const bits = a.words === undefined;
  const type = as.value as RegisterType;
  const wordOrder = order.value as Mapping['word_order'];
  // By the place alone: a new answer of the same registers draws the cells, not the map.
  const blocks = useMemo(() => raw.map((_, i): Block => ({ key: `hmi/${a.address + i}`, unit: a.unit, table: a.table, address: a.address + i, width: 1, type: bits ? 'bool' : 'u16', access: 'R', axis: '', point: '', name: '' })), [a.unit, a.table, a.address, raw.length, bits]);
  const open = useMemo(() => [], []);
  const draw = useMemo(() => {
    const named = new Map((a.decoded ?? []).map((d) => [d.address, d]));
    return (b: Block) => {
      const i = b.address - a.address;
      const w = raw[i] ?? 0;
      const d = named.get(b.address);
      const read = bits ? null : decodeText(type === 'string' ? raw.slice(i) : raw.slice(i, i + widthOf(type)), type, wordOrder);
      return (
        <>
          <span class="map-name mono">{addressText(a.table, b.address, base)} {bits ? '' : w.toString(16).toUpperCase().padStart(4, '0')}</span>
          <span class="map-value mono" title={bits ? undefined : t('u16; as {type}: {value}', { type, value: shown(read) })}>{bits ? w : `${w} · ${shown(read)}`}</span>
          {d ? <What d={d} rows={rows} axes={axes} points={points} /> : <BitWhat a={a} bits={bits} at={b.address} axes={axes} />}
        </>
      );
    };
  }, [a, raw, bits, type, wordOrder, base, rows, points, axes.map((x) => x.name).join()]);
  return (
    <div class={`hmi-map${former ? ' is-old' : ''}`}>
      <RegisterMap
        label={former ? t('The former answer of the Modbus door') : t('Registers as the Modbus door answers them')}
        table={a.table}
        base={base}
        blocks={blocks}
        open={open}
        cursor={cursor}
        selected={nobody}
        lifted={nobody}
        ghost={nothing}
        draw={draw}
        gapText={notAsked}
        freeWord={t('not asked')}
        canResize={never}
        handle={handle}
        press={(_, at) => (cursor.value = at)}
        activate={(at) => (cursor.value = at)}
        keyed={never}
        walked={nop}
        loose={never}
        seen={nop}
      />
    </div>
  );
}
const notAsked = (place: string) => t('{place} not asked', { place });
const never = () => false;
const nop = () => undefined;

function What({ d, rows, axes, points }: { d: Decoded; rows: readonly Mapping[]; axes: readonly Axis[]; points: readonly MappingPoint[] }) {
  const source = sourceOf(d, rows, axes);
  return (
    <>
      <span class="map-axis" title={d.name ?? d.mapping}>
        {d.name ?? d.mapping} {source && <SimulatedMark of={source.axis} />}
      </span>
      <span class="map-foot">
        <span class="mono">{shown(d.value)}</span> <span class="unit">{decodedUnit(d.unit, source, axes, points)}</span> {d.text === shown(d.value) || d.text === String(d.value) ? '' : d.text} <span class="map-type mono">{d.type}</span>
      </span>
    </>
  );
}
function BitWhat({ a, bits, at, axes }: { a: Registers; bits: boolean; at: number; axes: readonly Axis[] }) {
  if (!bits || !isStandard(a.unit)) return null;
  const axis = bitAxis(at, axes);
  return (
    <span class="map-axis" title={bitName(at, axes)}>
      {bitName(at, axes) || '–'} {axis && <SimulatedMark of={axis} />}
    </span>
  );
}

function shown(v: number | bigint | boolean | string | null): string {
  if (v === null) return '–';
  if (typeof v === 'boolean') return v ? t('on') : t('off');
  if (typeof v === 'bigint') return String(v).replace('-', '\u2212');
  if (typeof v === 'string') return v === '' ? t('(empty)') : v;
  if (!Number.isFinite(v)) return String(v);
  return formatExact(Number.isInteger(v) ? v : Number(v.toPrecision(7)));
}
