// Modbus door: who may come in, what may be asked, whether anything may be written, who is connected. In: /modbus. Out: a list and one switch.
// Read-only is kept over a restart; the rest stands in the configuration. Never changes anything but the switch.
import { useSignal } from '@preact/signals';
import { useEffect } from 'preact/hooks';
import { asProblem } from '../api/problem';
import type { ModbusDoor as Door } from '../api/types';
import { useGateway } from '../gateway';
import { capital } from '../state/commander';
import { functionWords } from '../words/register-map';
import { quiet, Tell, type Told } from './form';
import { useBarred, Why } from './gate';
import { Section } from './section';

export function ModbusDoor() {
  const { client, store } = useGateway();
  const no = useBarred('engineer');
  const door = useSignal<Door | null>(null);
  const told = useSignal<Told>(quiet);
  const epoch = store.connection.value.epoch;
  useEffect(() => {
    if (epoch === 0) return;
    client.modbus().then(
      (d) => (door.value = d),
      (error) => {
        const p = asProblem(error);
        told.value = { tone: 'refused', text: p.status === 404 ? 'This gateway does not say more about its Modbus door.' : capital(p.words) };
      },
    );
  }, [client, epoch]);
  const change = async (read_only: boolean) => {
    told.value = { tone: 'busy', text: 'Changing …' };
    try {
      door.value = await client.setModbus(read_only);
      told.value = { tone: 'good', text: read_only ? 'Read-only now: writes are refused, a quick stop and switching off are not.' : 'Writing is allowed now.' };
    } catch (error) {
      told.value = { tone: 'refused', text: capital(asProblem(error).words) };
    }
  };
  const d = door.value;
  return (
    <Section title="Modbus door">
      <div class="card" data-field="modbus-door">
        {d && (
          <dl class="facts">
            <div><dt>Address</dt><dd class="mono">{d.bind}</dd></div>
            <div><dt>Allowed from</dt><dd class="mono" data-field="modbus-allow">{d.allow.join(', ') || 'everywhere'}</dd></div>
            <div><dt>Functions</dt><dd data-field="modbus-functions">{functionWords(d.functions)}</dd></div>
            <div>
              <dt>Writing</dt>
              <dd>
                <span data-field="modbus-writing">{d.read_only ? 'read-only: nothing can be written' : 'allowed'}</span>{' '}
                <button type="button" class="button small" aria-pressed={d.read_only} disabled={told.value.tone === 'busy'} {...no} onClick={() => void change(!d.read_only)}>
                  {d.read_only ? 'Allow writing' : 'Make it read-only'}
                </button>
              </dd>
            </div>
            <div>
              <dt>Clients</dt>
              <dd>
                {d.connections.length === 0
                  ? 'none now'
                  : d.connections.slice(0, 50).map((c) => (
                      <div key={c.peer}>
                        <span class="mono">{c.peer}</span> {c.requests} requests, {c.writes} writes, {c.exceptions} exceptions{c.holds.length > 0 ? `, holds ${c.holds.join(', ')}` : ''}
                      </div>
                    ))}
              </dd>
            </div>
          </dl>
        )}
        {d && <Why need="engineer" what="Making the door read-only, or not," />}
        <Tell told={told.value} field="modbus-told" />
      </div>
    </Section>
  );
}
