// Register look: what the Modbus door answers for a run of places. In: the door, a span without gaps and what stands in it. Out: for each its raw words
// and what they mean, or its own exception. An exception for a whole span says nothing about each of it: the span is halved until every one
// has its own answer. At most `most` requests for one look; what was not reached keeps what was said before.
import type { MappingDoor, Registers } from '../api/mappings';
import { t } from '../language';
import { widthOf, type Mapping } from '../text/mapping';

export interface Received {
  words: number[] | null;
  value: number | string | boolean | null | undefined;
  /** Why there are no words: the exception, or what went wrong. */
  text: string;
}
/** `id`: of the mapping, or any name of one's own for what is none. */
export type Looked = Pick<Mapping, 'id' | 'unit' | 'table' | 'address' | 'type' | 'length'>;

export async function lookAt(door: Pick<MappingDoor, 'registers'>, own: readonly Looked[], into: Map<string, Received>, end: AbortSignal, most = 64): Promise<void> {
  let left = most;
  const read = async (rows: readonly Looked[]): Promise<void> => {
    const first = rows[0];
    if (!first || left === 0 || end.aborted) return;
    left -= 1;
    const count = rows.reduce((n, m) => Math.max(n, m.address + widthOf(m.type, m.length)), 0) - first.address;
    const r = await door.registers({ unit: first.unit, table: first.table, address: first.address, count }, end);
    if (r.exception && rows.length > 1) {
      const half = Math.ceil(rows.length / 2);
      await read(rows.slice(0, half));
      return read(rows.slice(half));
    }
    for (const m of rows) into.set(m.id, receivedOf(r, m));
  };
  await read([...own].sort((a, b) => a.address - b.address));
}

function receivedOf(r: Registers, m: Looked): Received {
  if (r.exception) return { words: null, value: undefined, text: t('exception {code}: {text}', { code: r.exception.code, text: r.exception.text }) };
  const raw = r.words ?? (r.bits ?? []).map(Number);
  const at = m.address - r.address;
  const decoded = r.decoded?.find((d) => d.mapping === m.id || (d.mapping === undefined && d.address === m.address));
  return { words: raw.slice(at, at + widthOf(m.type, m.length)), value: decoded?.value, text: '' };
}
