// Authority: who holds an axis and for how long still; taking it, giving it back, taking it over. In: the axis. Out: words and three buttons.
// While this page holds the axis and is open and connected, it renews; hidden or closed it does not, so the axis is free a little later.
import { useEffect } from 'preact/hooks';
import { useSignal } from '@preact/signals';
import { asProblem } from '../api/problem';
import type { Authority } from '../api/types';
import { useGateway } from '../gateway';
import { tick } from '../state/clock';
import { barred } from '../state/session';
import type { AxisEntry } from '../state/store';
import { heldBy, heldWords } from '../words/authority';
import { quiet, Tell, type Told } from './form';

const ttl_s = 30;
const renew_ms = 10_000;

const useHeld = (entry: AxisEntry) => {
  const { store, tab } = useGateway();
  void tick.value; // the rest is counted down between two readings
  return heldBy(entry.data, store.gatewayNow_ms(), tab.name.value);
};

/** One line for a tile; empty while nobody holds the axis, so that the place is there when somebody does. */
export function HolderLine({ entry }: { entry: AxisEntry }) {
  const held = useHeld(entry);
  return (
    <p class="holder" data-field="authority" title={held.holder ? heldWords(held) : undefined}>
      {held.holder ? heldWords(held) : ''}
    </p>
  );
}

export function AuthorityBar({ entry }: { entry: AxisEntry }) {
  const { client, session, store } = useGateway();
  const held = useHeld(entry);
  const told = useSignal<Told>(quiet);
  const name = entry.data.name;
  const path = `/axes/${encodeURIComponent(name)}/authority`;
  const act = async (words: string, work: () => Promise<unknown>) => {
    try {
      await work();
      told.value = { tone: 'good', text: `${words}.` };
    } catch (error) {
      told.value = { tone: 'refused', text: `${words}: refused. ${asProblem(error).words}` };
    }
  };
  const take = (take_over: boolean) => client.call<Authority>(path, { method: 'PUT', body: { ttl_s, take_over } });
  const mine = held.mine;
  useEffect(() => {
    if (!mine) return;
    const timer = setInterval(() => {
      if (document.hidden || !store.connected.peek()) return;
      take(false).catch((error) => (told.value = { tone: 'refused', text: `Not renewed: ${asProblem(error).words}` }));
    }, renew_ms);
    return () => clearInterval(timer);
  }, [mine, name]);

  return (
    <div class="authority" role="group" aria-label={`Authority over ${name}`}>
      <span data-field="authority">{heldWords(held)}</span>
      {!held.holder && (
        <button type="button" class="button small" {...barred(session.mayNot('operator'))} onClick={() => void act('Taken', () => take(false))}>
          Take
        </button>
      )}
      {mine && (
        <button type="button" class="button small" {...barred(session.mayNot('operator'))} onClick={() => void act('Released', () => client.call(path, { method: 'DELETE' }))}>
          Release
        </button>
      )}
      {held.holder !== '' && !mine && (
        <button type="button" class="button small" {...barred(session.mayNot('engineer'))} onClick={() => void act('Taken over', () => take(true))}>
          Take over
        </button>
      )}
      <Tell told={told.value} field="authority-told" />
    </div>
  );
}
