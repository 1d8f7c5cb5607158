// Mapping cell: what one entry of the register map says: name, axis, live value, the words in its registers, type and access. In: a block, what the
// Modbus door has said. Out: four lines. The value comes from the axis stream where the point is a field of the axis, else from the door, once a
// second; what is not live is said to be so. Drawn anew only when one of its texts changes.
import { computed, type ReadonlySignal } from '@preact/signals';
import { useMemo } from 'preact/hooks';
import { useGateway } from '../gateway';
import { t } from '../language';
import { pointUnit, pointValue, tableOf, type Mapping, type MappingPoint } from '../text/mapping';
import type { Block } from '../text/mapping-blocks';
import { formatExact } from '../text/number';
import type { Received } from '../state/register-look';
import type { Store } from '../state/store';
import { SimulatedMark } from './name';

export const accessText: Record<Mapping['access'], string> = { R: t('read'), W: t('write'), RW: t('read and write') };
export const valueWords = (v: number | string | boolean): string => (typeof v === 'number' ? formatExact(Number.isInteger(v) ? v : Number(v.toPrecision(7))) : typeof v === 'boolean' ? (v ? t('on') : t('off')) : v);
export const hexWords = (words: readonly number[]): string => words.map((w) => w.toString(16).toUpperCase().padStart(4, '0')).join(' ');
const trustText = { live: '', stale: t('stale'), offline: t('offline'), disconnected: t('disconnected') } as const;

/** What is known of a block now. `text` is empty where nobody says it, whatever stands in the register. */
export interface Published {
  text: string;
  unit: string;
  live: boolean;
  note: string;
  raw: string;
  /** Why there are no words in the register: an exception, or what went wrong. */
  why: string;
}

export function publishedOf(b: Block, store: Store, received: ReadonlyMap<string, Received>, points: readonly MappingPoint[]): Published {
  const entry = b.axis ? store.axis(b.axis)?.value : undefined;
  const axis = entry?.data;
  const trust = entry ? store.trustOf(entry) : 'offline';
  const fromAxis = axis && b.point ? pointValue(axis, b.point, points) : undefined;
  const h = received.get(b.key);
  const bits = tableOf(b.table).bits;
  const inWord = b.width === 1 && !b.mapping && h?.words?.length === 1 ? (b.type === 'bool' ? h.words[0] === 1 : h.words[0]) : undefined;
  const value = fromAxis === undefined ? (h?.value ?? inWord) : fromAxis;
  const live = fromAxis === undefined ? h !== undefined && store.connected.value && h.text === '' : trust === 'live';
  const known = value !== null && value !== undefined;
  return {
    text: known ? valueWords(value) : '',
    unit: known && axis && b.point ? pointUnit(axis, b.point, points) : '',
    live,
    note: live || !known ? '' : trust === 'live' ? t('not live') : trustText[trust],
    raw: h?.words ? (bits ? h.words.join(' ') : hexWords(h.words)) : '',
    why: h?.words ? '' : h?.text || (b.access === 'W' ? t('written only') : t('not read yet')),
  };
}

/** Follows one block; changes only when one of its texts does. */
export function usePublished(b: Block, received: ReadonlySignal<ReadonlyMap<string, Received>>, points: readonly MappingPoint[]): Published {
  const { store } = useGateway();
  const published = useMemo(() => {
    let last: Published | null = null;
    return computed(() => {
      const now = publishedOf(b, store, received.value, points);
      if (last && (Object.keys(now) as (keyof Published)[]).every((k) => last![k] === now[k])) return last;
      return (last = now);
    });
  }, [b, received, points]);
  return published.value;
}

export function ValueOf({ published }: { published: Published }) {
  return (
    <span class="map-value" data-field="value" data-live={published.live}>
      {published.text === '' ? (
        <span class="where">{t('not known')}</span>
      ) : (
        <span class={published.live ? '' : 'is-old-value'}>
          <span class="mono">{published.text}</span> <span class="unit">{published.unit}</span>
          {published.note && <span class="flag"> {published.note}</span>}
        </span>
      )}
    </span>
  );
}
/** What the Modbus door itself has said, and nothing that is reckoned from elsewhere. */
export function RawOf({ published }: { published: Published }) {
  return (
    <span class="map-raw" data-field="in-register">
      {published.raw ? <span class="mono">{published.raw}</span> : <span class="where">{published.why}</span>}
    </span>
  );
}

export function BlockCell({ block: b, received, points }: { block: Block; received: ReadonlySignal<ReadonlyMap<string, Received>>; points: readonly MappingPoint[] }) {
  const published = usePublished(b, received, points);
  return (
    <>
      <span class="map-name mono" title={b.name}>{b.name}</span>
      <span class="map-axis">
        {b.axis} {b.axis && <SimulatedMark of={b.axis} />}
      </span>
      <ValueOf published={published} />
      <span class="map-foot">
        <RawOf published={published} />{' '}
        <span class="map-type mono" title={accessText[b.access]}>
          {b.type} {b.access}
        </span>
      </span>
    </>
  );
}
