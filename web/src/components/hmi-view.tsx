// HMI view: what a Modbus client sees at any address: raw words as the Modbus door answers them, and what they mean. In: unit, table, address.
// Out: a table. Follows once a second while it is asked to and the page is seen. An exception is shown with its number and words.
import { signal, useSignal } from '@preact/signals';
import { useEffect } from 'preact/hooks';
import type { MappingDoor, Registers } from '../api/mappings';
import { asProblem } from '../api/problem';
import type { Axis } from '../api/types';
import { useGateway } from '../gateway';
import { addressBase, addressField } from '../state/address-base';
import { persisted } from '../state/persisted';
import { decodeWords, pointUnit, tableOf, tables, types, widthOf, type Mapping, type RegisterType, type Table } from '../text/mapping';
import { addressText, otherText, readAddress } from '../text/address';
import { bitAxis, bitName, isStandard, notMapped } from '../text/register-map';
import { formatExact, parseNumber } from '../text/number';
import { Choice, notOffered, TextField } from './form';
import { SimulatedMark } from './name';
import { Section } from './section';

const unit = persisted('hmi.unit', '1');
const table = persisted('hmi.table', 'holding_registers');
const address = addressField(persisted('hmi.address'), () => table.peek() as Table);
const count = persisted('hmi.count', '16');
const as = persisted('hmi.as', 'i32');
const order = persisted('hmi.order', 'high_first');
const following = signal(false);
const period_ms = 1000;

const within = (text: string, min: number, max: number): number | null => {
  const p = parseNumber(text);
  return p.good && Number.isInteger(p.value) && p.value >= min && p.value <= max ? p.value : null;
};

export function HmiView({ door, rows }: { door: MappingDoor; rows: readonly Mapping[] }) {
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
      why.value = 'Mend the fields that are marked; nothing was asked.';
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
      why.value = p.status === 404 || p.status === 501 ? notOffered('a look at its registers') : p.words;
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
  return (
    <Section title="What does the HMI see?" class="hmi">
      <form
        class="card form"
        noValidate
        aria-label="Read registers"
        onSubmit={(e) => {
          e.preventDefault();
          void look();
        }}
      >
        <div class="form-grid">
          <TextField label="Unit ID" number value={unit.value} onText={(t) => (unit.value = t)} fault={at.unit === null ? 'A whole number from 0 to 255.' : undefined} hint="1 is the standard map" />
          <Choice label="Table" value={table.value} onChoice={(t) => (table.value = t)} choices={tables.map((t) => ({ value: t.id, text: t.name }))} />
          <TextField label="Address" number value={address.value} placeholder={addressText(table.value as Table, 0, base)} onText={choose} fault={place.good ? undefined : place.why} hint={at.address === null ? undefined : `${addressText(table.value as Table, at.address, base)} is ${otherText(table.value as Table, at.address, base)}`} />
          <TextField label="Count" number value={count.value} onText={(t) => (count.value = t)} fault={at.count === null ? 'A whole number from 1 to 125.' : undefined} />
          {!tableOf(table.value as Table).bits && (
            <>
              <Choice label="Read as" value={as.value} onChoice={(t) => (as.value = t)} choices={types.filter((t) => t !== 'bool').map((t) => ({ value: t, text: t }))} />
              <Choice label="Word order" value={order.value} onChoice={(t) => (order.value = t)} choices={[{ value: 'high_first', text: 'high word first' }, { value: 'low_first', text: 'low word first' }]} />
            </>
          )}
        </div>
        <div class="form-foot">
          <button type="submit" class="button primary">
            Look
          </button>
          <button type="button" class="button" aria-pressed={following.value} onClick={() => (following.value = !following.value)}>
            {following.value ? 'Following each second' : 'Follow'}
          </button>
          <p class={`tell result-${why.value ? 'refused' : 'none'}`} role="status" data-field="hmi-told">
            {why.value || (a?.exception ? `The Modbus door answers exception ${a.exception.code}: ${a.exception.text}.${gaps ? ` Not mapped: ${gaps}.` : ''}` : waiting.value && !a ? 'Asking …' : '')}
          </p>
        </div>
        {a && !a.exception && answerTo.value !== asked && (
          <p class="form-told" role="status" data-field="hmi-former">
            This is the former answer: unit {a.unit}, {tableOf(a.table).name.toLowerCase()} from {addressText(a.table, a.address, base)} on. Press Look for what the fields say now.
          </p>
        )}
        {a && !a.exception && <Answer a={a} axes={axes} rows={rows} former={answerTo.value !== asked} />}
      </form>
    </Section>
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
function decodedUnit(unit: string | null | undefined, source: { axis: string; point: string } | null, axes: readonly Axis[]): string {
  const told = unit || (source ? pointUnit(axes.find((x) => x.name === source.axis) ?? { unit: '' }, source.point) : '');
  return told.replace(/^inc\b/, 'increments');
}

function What({ d, rows, axes }: { d: { name?: string; mapping?: string; type: string }; rows: readonly Mapping[]; axes: readonly Axis[] }) {
  const source = sourceOf(d, rows, axes);
  return (
    <>
      {d.name ?? d.mapping} {source && <SimulatedMark of={source.axis} />} <span class="where mono">{d.type}</span>
    </>
  );
}

function Answer({ a, axes, rows, former }: { a: Registers; axes: readonly Axis[]; rows: readonly Mapping[]; former: boolean }) {
  const raw = a.words ?? (a.bits ?? []).map(Number);
  const bits = a.words === undefined;
  const named = new Map((a.decoded ?? []).map((d) => [d.address, d]));
  const type = as.value as RegisterType;
  return (
    <div class={`table-scroll${former ? ' is-old' : ''}`} tabIndex={0} role="region" aria-label={former ? 'The former answer of the Modbus door' : 'Registers as the Modbus door answers them'}>
      <table class="table hmi-table">
        <thead>
          <tr>
            <th scope="col">Address</th>
            {!bits && <th scope="col">Hex</th>}
            <th scope="col" class="num">{bits ? 'Bit' : 'u16'}</th>
            {!bits && <th scope="col" class="num">as {type}</th>}
            <th scope="col">What it is</th>
            <th scope="col" class="num">Decoded</th>
          </tr>
        </thead>
        <tbody>
          {raw.map((w, i) => {
            const at = a.address + i;
            const d = named.get(at);
            return (
              <tr key={at} data-address={at}>
                <th scope="row">
                  <span class="mono id">{addressText(a.table, at, addressBase())}</span> <span class="where mono">{addressText(a.table, at, addressBase() === '0' ? '1' : '0')}</span>
                </th>
                {!bits && <td data-label="Hex" class="mono">{w.toString(16).toUpperCase().padStart(4, '0')}</td>}
                <td data-label={bits ? 'Bit' : 'u16'} class="num mono">{w}</td>
                {!bits && <td data-label={`as ${type}`} class="num mono">{shown(decodeWords(type === 'string' ? raw.slice(i) : raw.slice(i, i + widthOf(type)), type, order.value as Mapping['word_order']))}</td>}
                <td data-label="What it is">{d ? <What d={d} rows={rows} axes={axes} /> : <span class={bits && isStandard(a.unit) ? '' : 'where'}>{(bits && isStandard(a.unit) && bitName(at, axes)) || '–'} {bits && isStandard(a.unit) && bitAxis(at, axes) && <SimulatedMark of={bitAxis(at, axes)} />}</span>}</td>
                <td data-label="Decoded" class="num">{d ? <><span class="mono">{shown(d.value)}</span> <span class="unit">{decodedUnit(d.unit, sourceOf(d, rows, axes), axes)}</span> {d.text === shown(d.value) || d.text === String(d.value) ? '' : d.text}</> : ''}</td>
              </tr>
            );
          })}
        </tbody>
      </table>
    </div>
  );
}

function shown(v: number | bigint | boolean | string | null): string {
  if (v === null) return '–';
  if (typeof v === 'boolean') return v ? 'on' : 'off';
  if (typeof v === 'bigint') return String(v).replace('-', '\u2212');
  if (typeof v === 'string') return v === '' ? '(empty)' : v;
  if (!Number.isFinite(v)) return String(v);
  return Number.isInteger(v) && Math.abs(v) < 1e15 ? formatExact(v) : Number(v.toPrecision(7)).toString().replace('-', '\u2212');
}
