// Authority: who holds an axis and for how long still; taking it, giving it back or to another client, taking it over. In: the axis. Out: words, buttons.
// While this page holds the axis and is open and connected, it renews; hidden or closed it does not, so the axis is free a little later.
import { useEffect, useRef } from 'preact/hooks';
import { useSignal } from '@preact/signals';
import { asProblem } from '../api/problem';
import type { Authority } from '../api/types';
import { useGateway } from '../gateway';
import { tick } from '../state/clock';
import { barred } from '../state/session';
import type { AxisEntry } from '../state/store';
import { handOverChoices, heldBy, heldWords, holderName } from '../text/authority';
import { quiet, Tell, TextField, type Told } from './form';

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
  const was = useRef(false);
  useEffect(() => {
    // "Taken." is true only as long as nobody else has taken it.
    if (was.current && !mine && /^Taken/.test(told.peek().text)) told.value = held.holder ? { tone: 'refused', text: `${holderName(held.holder)} has it now.` } : quiet;
    was.current = mine;
  }, [mine, held.holder]);
  const giving = useSignal(false);
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
      {mine && (
        <button type="button" class="button small" aria-expanded={giving.value} {...barred(session.mayNot('operator'))} onClick={() => (giving.value = !giving.value)}>
          Hand over …
        </button>
      )}
      {held.holder !== '' && !mine && (
        <button type="button" class="button small" {...barred(session.mayNot('engineer'))} onClick={() => void act('Taken over', () => take(true))}>
          Take over
        </button>
      )}
      <Tell told={told.value} field="authority-told" />
      {mine && giving.value && (
        <HandOver
          name={name}
          give={async (to) => {
            await act(`Handed over to ${to}`, () => client.call(`${path}/hand-over`, { method: 'POST', body: { to } }));
            if (told.peek().tone === 'good') giving.value = false;
          }}
        />
      )}
    </div>
  );
}

/** To whom: chosen from the clients that the gateway knows, or typed. */
function HandOver({ name, give }: { name: string; give: (to: string) => Promise<void> }) {
  const { client, tab } = useGateway();
  const to = useSignal('');
  const offers = useSignal<string[]>([]);
  useEffect(() => {
    void client.call<{ axes: Authority[]; clients?: { client: string }[] }>('/authority').then(
      (l) => (offers.value = handOverChoices(l.axes, (l.clients ?? []).map((c) => c.client), tab.name.peek())),
      () => undefined,
    );
  }, [client]);
  return (
    <form
      class="form-foot hand-over"
      aria-label={`Hand ${name} over`}
      onSubmit={(e) => {
        e.preventDefault();
        if (to.peek().trim()) void give(to.peek().trim());
      }}
    >
      <TextField label="To" value={to.value} onText={(t) => (to.value = t)} offers={offers.value.map((value) => ({ value }))} placeholder="modbus 192.0.2.7" hint="a door and its client: modbus, http, ethernet_ip or dds, and the address, user or name" />
      {offers.value.slice(0, 6).map((o) => (
        <button key={o} type="button" class="button small quiet" onClick={() => (to.value = o)}>
          {o}
        </button>
      ))}
      <button type="submit" class="button small" disabled={to.value.trim() === ''}>
        Hand over
      </button>
    </form>
  );
}
