// Mapping answer: each register of an answer of the Modbus door as a cell of the register map: hex, a number, the value that begins there, and what it is of. In: the
// answer, how its words are read. Out: the map; nothing in it is changed.
import { computed, useSignal } from '@preact/signals';
import { useMemo, useRef } from 'preact/hooks';
import type { Registers } from '../api/mappings';
import type { Axis } from '../api/types';
import { t } from '../language';
import { addressBase } from '../state/address-base';
import { addressText } from '../text/address';
import { decodedUnit, sourceOf, valueShown } from '../text/hmi-answer';
import { decodeText, widthOf, type Mapping, type MappingPoint, type RegisterType } from '../text/mapping';
import type { Block } from '../text/mapping-blocks';
import { bitAxis, bitName, isStandard } from '../text/register-map';
import { RegisterMap } from './mapping-map';
import type { MapHandle } from './mapping-scroll';
import { SimulatedMark } from './name';

const nobody = computed(() => new Set<string>());
const nothing = computed(() => null);

interface AnswerProps {
  a: Registers;
  axes: readonly Axis[];
  rows: readonly Mapping[];
  points: readonly MappingPoint[];
  type: RegisterType;
  order: Mapping['word_order'];
  /** It was asked with other fields than those that are shown. */
  former: boolean;
}
type Decoded = NonNullable<Registers['decoded']>[number];

/** Each register of the answer as a cell of the map. */
export function AnswerMap({ a, axes, rows, points, type, order, former }: AnswerProps) {
  const base = addressBase();
  const handle = useRef<MapHandle | null>(null);
  const cursor = useSignal(a.address);
  const raw = useMemo(() => a.words ?? (a.bits ?? []).map(Number), [a]);
  const bits = a.words === undefined;
  // By the place alone: a new answer of the same registers draws the cells, not the map.
  const blocks = useMemo(() => raw.map((_, i): Block => ({ key: `hmi/${a.address + i}`, unit: a.unit, table: a.table, address: a.address + i, width: 1, type: bits ? 'bool' : 'u16', access: 'R', axis: '', point: '', name: '' })), [a.unit, a.table, a.address, raw.length, bits]);
  const open = useMemo(() => [], []);
  const draw = useMemo(() => {
    const named = new Map((a.decoded ?? []).map((d) => [d.address, d]));
    return (b: Block) => {
      const i = b.address - a.address;
      const w = raw[i] ?? 0;
      const d = named.get(b.address);
      const read = bits ? null : decodeText(type === 'string' ? raw.slice(i) : raw.slice(i, i + widthOf(type)), type, order);
      return (
        <>
          <span class="map-name mono">{addressText(a.table, b.address, base)} {bits ? '' : w.toString(16).toUpperCase().padStart(4, '0')}</span>
          <span class="map-value mono" title={bits ? undefined : t('u16; as {type}: {value}', { type, value: valueShown(read) })}>{bits ? w : `${w} · ${valueShown(read)}`}</span>
          {d ? <What d={d} rows={rows} axes={axes} points={points} /> : <BitWhat a={a} bits={bits} at={b.address} axes={axes} />}
        </>
      );
    };
  }, [a, raw, bits, type, order, base, rows, points, axes.map((x) => x.name).join()]);
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
        <span class="mono">{valueShown(d.value)}</span> <span class="unit">{decodedUnit(d.unit, source, axes, points)}</span> {d.text === valueShown(d.value) || d.text === String(d.value) ? '' : d.text} <span class="map-type mono">{d.type}</span>
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
