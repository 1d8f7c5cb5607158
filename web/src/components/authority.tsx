// Authority: who holds an axis and for how long still; taking it, giving it back or to another client, taking it over. In: the axis. Out: words, buttons.
// While this page holds the axis and is open and connected, it renews; hidden or closed it does not, so the axis is free a little later.
import { useEffect, useRef } from 'preact/hooks';
import { useSignal } from '@preact/signals';
import { asProblem } from '../api/problem';
import type { Authority } from '../api/types';
import { useGateway } from '../gateway';
import { t } from '../language';
import { tick } from '../state/clock';
import { barred } from '../state/session';
import type { AxisEntry } from '../state/store';
import { quiet, type Reported } from '../state/reported';
import { handOverChoices, heldBy, heldText, holderName } from '../text/authority';
import { Tell, TextField } from './form';

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
    <p class="holder" data-field="authority" title={held.holder ? heldText(held) : undefined}>
      {held.holder ? heldText(held) : ''}
    </p>
  );
}

export function AuthorityBar({ entry }: { entry: AxisEntry }) {
  const { client, session, store } = useGateway();
  const held = useHeld(entry);
  const reported = useSignal<Reported>(quiet);
  const name = entry.data.name;
  const path = `/axes/${encodeURIComponent(name)}/authority`;
  const act = async (text: string, work: () => Promise<unknown>) => {
    try {
      await work();
      reported.value = { tone: 'good', text: `${text}.` };
    } catch (error) {
      reported.value = { tone: 'refused', text: t('{what}: refused. {why}', { what: text, why: asProblem(error).text }) };
    }
  };
  const take = (take_over: boolean) => client.call<Authority>(path, { method: 'PUT', body: { ttl_s, take_over } });
  const mine = held.mine;
  const was = useRef(false);
  const taken = useRef<Reported | null>(null);
  useEffect(() => {
    // "Taken." is true only as long as nobody else has taken it.
    if (was.current && !mine && reported.peek().tone === 'good' && taken.current === reported.peek()) reported.value = held.holder ? { tone: 'refused', text: t('{holder} has it now.', { holder: holderName(held.holder) }) } : quiet;
    was.current = mine;
  }, [mine, held.holder]);
  const giving = useSignal(false);
  useEffect(() => {
    if (!mine) return;
    const timer = setInterval(() => {
      if (document.hidden || !store.connected.peek()) return;
      take(false).catch((error) => (reported.value = { tone: 'refused', text: t('Not renewed: {why}', { why: asProblem(error).text }) }));
    }, renew_ms);
    return () => clearInterval(timer);
  }, [mine, name]);

  return (
    <div class="authority" role="group" aria-label={t('Authority over {name}', { name })}>
      <span data-field="authority">{heldText(held)}</span>
      {!held.holder && (
        <button type="button" class="button small" {...barred(session.mayNot('operator'))} onClick={() => void act(t('Taken'), () => take(false)).then(() => (taken.current = reported.peek()))}>
          {t('Take')}
        </button>
      )}
      {mine && (
        <button type="button" class="button small" {...barred(session.mayNot('operator'))} onClick={() => void act(t('Released'), () => client.call(path, { method: 'DELETE' }))}>
          {t('Release')}
        </button>
      )}
      {mine && (
        <button type="button" class="button small" aria-expanded={giving.value} {...barred(session.mayNot('operator'))} onClick={() => (giving.value = !giving.value)}>
          {t('Hand over …')}
        </button>
      )}
      {held.holder !== '' && !mine && (
        <button type="button" class="button small" {...barred(session.mayNot('engineer'))} onClick={() => void act(t('Taken over'), () => take(true)).then(() => (taken.current = reported.peek()))}>
          {t('Take over')}
        </button>
      )}
      <Tell reported={reported.value} field="authority-told" />
      {mine && giving.value && (
        <HandOver
          name={name}
          give={async (to) => {
            await act(t('Handed over to {to}', { to }), () => client.call(`${path}/hand-over`, { method: 'POST', body: { to } }));
            if (reported.peek().tone === 'good') giving.value = false;
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
      aria-label={t('Hand {name} over', { name })}
      onSubmit={(e) => {
        e.preventDefault();
        if (to.peek().trim()) void give(to.peek().trim());
      }}
    >
      <TextField label={t('To')} value={to.value} onText={(text) => (to.value = text)} offers={offers.value.map((value) => ({ value }))} placeholder="modbus 192.0.2.7" hint={t('a door and its client: modbus, http, ethernet_ip or dds, and the address, user or name')} />
      {offers.value.slice(0, 6).map((o) => (
        <button key={o} type="button" class="button small quiet" onClick={() => (to.value = o)}>
          {o}
        </button>
      ))}
      <button type="submit" class="button small" disabled={to.value.trim() === ''}>
        {t('Hand over')}
      </button>
    </form>
  );
}
