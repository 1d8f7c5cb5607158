// Modbus door: who may come in, what may be asked, whether anything may be written, who is connected. In: /modbus. Out: a list and one switch.
// Read-only is kept over a restart; the rest stands in the configuration. Never changes anything but the switch.
import { useSignal } from '@preact/signals';
import type { ModbusDoor as Door } from '../api/types';
import { useGateway } from '../gateway';
import { t } from '../language';
import { quiet, tellOf, type Reported } from '../state/reported';
import { allowedText, functionText } from '../text/register-map';
import { Tell } from './form';
import { useBarred, Why } from './gate';
import { Empty } from './lines';
import { useLoaded } from './loaded';
import { Section } from './section';

export function ModbusDoor() {
  const { client } = useGateway();
  const no = useBarred('engineer');
  const door = useSignal<Door | null>(null);
  const reported = useSignal<Reported>(quiet);
  const why = useLoaded(async () => void (door.value = await client.modbus()), [client], (p) => (p.status === 404 ? t('This gateway does not say more about its Modbus door.') : p.text));
  const change = (read_only: boolean) => tellOf(reported, t('Changing …'), async () => (door.value = await client.setModbus(read_only)), read_only ? t('Read-only now: writes are refused, a quick stop and switching off are not.') : t('Writing is allowed now.'));
  const d = door.value;
  return (
    <Section title={t('Modbus door')} help="door-modbus-tcp">
      <div class="card" data-field="modbus-door">
        {why && <Empty text={why} />}
        {d && (
          <dl class="facts">
            <div><dt>{t('Address')}</dt><dd class="mono">{d.bind}</dd></div>
            <div><dt>{t('Allowed from')}</dt><dd><span class="mono" data-field="modbus-allow">{allowedText(d.allow, d.bind)}</span></dd></div>
            <div><dt>{t('Functions')}</dt><dd data-field="modbus-functions">{functionText(d.functions)}</dd></div>
            <div>
              <dt>{t('Writing')}</dt>
              <dd>
                <span data-field="modbus-writing">{d.read_only ? t('read-only: no write is taken but a quick stop or switching off by the control word alone') : t('allowed')}</span>{' '}
                <button type="button" class="button small" aria-pressed={d.read_only} disabled={reported.value.tone === 'busy'} {...no} onClick={() => void change(!d.read_only)}>
                  {d.read_only ? t('Allow writing') : t('Make it read-only')}
                </button>
              </dd>
            </div>
            <div>
              <dt>{t('Clients')}</dt>
              <dd>
                {d.connections.length === 0
                  ? t('none now')
                  : d.connections.slice(0, 50).map((c) => (
                      <div key={c.peer}>
                        <span class="mono">{c.peer}</span> {t('{requests} requests, {writes} writes, {exceptions} exceptions', { requests: c.requests, writes: c.writes, exceptions: c.exceptions })}
                        {c.holds.length > 0 && t(', holds {axes}', { axes: c.holds.join(', ') })}
                      </div>
                    ))}
              </dd>
            </div>
          </dl>
        )}
        {d && (
          <p class="where modbus-where" data-field="modbus-where">
            {t("Address, addresses allowed and functions are set in the gateway's TOML file, section [modbus]: bind, allow, functions; they count from its next start. Writing is switched here, and is kept.")}
          </p>
        )}
        {d && <Why need="engineer" what={t('Making the door read-only, or not,')} />}
        <Tell reported={reported.value} field="modbus-told" />
      </div>
    </Section>
  );
}
