// Mapping poll: what the Modbus door says of the entries in sight, once a second, at most eight requests at a time; the rest has its turn next.
// In: the door, the blocks in sight. Out: what was heard, by block. Stops asking where the gateway does not offer it, and says so once.
import type { Signal } from '@preact/signals';
import { useEffect } from 'preact/hooks';
import type { MappingDoor } from '../api/mappings';
import { asProblem } from '../api/problem';
import { readsOf, type Block } from '../text/mapping-blocks';
import { isStandard } from '../text/register-map';
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
  useEffect(() => {
    if (seen.length === 0 || epoch === 0) return;
    const end = new AbortController();
    let timer: ReturnType<typeof setTimeout>;
    let turn = 0;
    const reads = readsOf(seen, isStandard(seen[0]!.unit));
    const again = async () => {
      let there = true;
      if (!document.hidden && asks()) {
        const next = new Map(received.peek());
        for (let i = 0; i < Math.min(reads.length, readsAtOnce) && there && !end.signal.aborted; i += 1) {
          const own = reads[(turn + i) % reads.length]!.map(lookedOf);
          try {
            await lookAt(door, own, next, end.signal);
            offered(true);
          } catch (error) {
            if (end.signal.aborted) return;
            const p = asProblem(error);
            there = !(p.status === 404 || p.status === 405 || p.status === 501);
            if (!there) offered(false);
            for (const b of own) next.set(b.id, { words: null, value: undefined, text: there ? p.text : '' });
          }
        }
        turn += readsAtOnce;
        if (!end.signal.aborted) received.value = next;
      }
      if (there && !end.signal.aborted) timer = setTimeout(() => void again(), poll_ms);
    };
    void again();
    return () => {
      end.abort();
      clearTimeout(timer);
    };
  }, [seen, epoch]);
}
