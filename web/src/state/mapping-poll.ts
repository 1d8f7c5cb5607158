// Mapping poll: what the Modbus door says of the entries in sight, once a second, at most eight requests at a time; the rest has its turn next.
// In: the door, the blocks in sight. Out: what was heard, by block. Stops asking where the gateway does not offer it, and says so once.
import type { Signal } from '@preact/signals';
import { useMemo } from 'preact/hooks';
import type { MappingDoor } from '../api/mappings';
import { asProblem } from '../api/problem';
import { readsOf, type Block } from '../text/mapping-blocks';
import { isStandard } from '../text/register-map';
import { useRepeated } from './repeated';
import { lookAt, type Received, type Looked } from './register-look';

const poll_ms = 1000;
const readsAtOnce = 8;
const lookedOf = (b: Block): Looked => ({ id: b.key, unit: b.unit, table: b.table, address: b.address, type: b.type, ...(b.length ? { length: b.length } : {}) });

export interface Polled {
  door: MappingDoor;
  seen: readonly Block[];
  received: Signal<ReadonlyMap<string, Received>>;
  /** Whether anything can be asked just now. */
  asks: () => boolean;
  /** Changes with each connection. */
  epoch: number;
  offered: (yes: boolean) => void;
}

export function usePolled({ door, seen, received, asks, epoch, offered }: Polled): void {
  const reads = useMemo(() => (seen.length === 0 ? [] : readsOf(seen, isStandard(seen[0]!.unit))), [seen]);
  const turn = useMemo(() => ({ first: 0 }), [seen, epoch]);
  const look = async (end: AbortSignal) => {
    if (!asks()) return;
    const next = new Map(received.peek());
    let there = true;
    for (let i = 0; i < Math.min(reads.length, readsAtOnce) && there && !end.aborted; i += 1) {
      const own = reads[(turn.first + i) % reads.length]!.map(lookedOf);
      try {
        await lookAt(door, own, next, end);
        offered(true);
      } catch (error) {
        if (end.aborted) return;
        const p = asProblem(error);
        there = !(p.status === 404 || p.status === 405 || p.status === 501);
        if (!there) offered(false);
        for (const b of own) next.set(b.id, { words: null, value: undefined, text: there ? p.text : '' });
      }
    }
    turn.first += readsAtOnce;
    if (!end.aborted) received.value = next;
    return there ? undefined : null;
  };
  useRepeated(look, poll_ms, seen.length > 0 && epoch !== 0, [seen, epoch]);
}
