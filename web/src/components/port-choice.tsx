// Port choice: the CAN interfaces and serial ports of the gateway's machine, to choose a line's URI from. In: the URI as it is typed. Out: another one.
// Asked for when it is shown, and again by a button: an adapter may be plugged in meanwhile. What is typed by hand stays as good.
import { useSignal } from '@preact/signals';
import { hostPorts, type HostPort } from '../api/host';
import { useGateway } from '../gateway';
import { t } from '../language';
import { atPort, portKind, portOf, portText } from '../text/ports';
import { Choice } from './form';
import { useLoaded } from './loaded';

export function PortChoice({ uri, own, onUri }: { uri: string; own: string; onUri: (uri: string, port: HostPort) => void }) {
  const { client } = useGateway();
  const ports = useSignal<HostPort[] | null>(null);
  const asked = useSignal(0);
  const why = useLoaded(async () => void (ports.value = await hostPorts(client)), [client, asked.value]);
  const kind = portKind(uri);
  const list = (ports.value ?? []).filter((p) => kind === '' || p.kind === kind);
  const now = portOf(list, uri);
  const again = (
    <button type="button" class="link" onClick={() => (asked.value += 1)}>
      {t('Look again')}
    </button>
  );
  if (ports.value === null) return why ? <p class="form-told">{why}</p> : null;
  if (list.length === 0) {
    return (
      <p class="form-told" data-field="no-port">
        {kind === 'can' ? t('This machine has no CAN interface now.') : kind === 'serial' ? t('This machine has no serial port now.') : t('This machine has neither a CAN interface nor a serial port now.')} {again}
      </p>
    );
  }
  return (
    <div class="port-choice" data-field="ports">
      <Choice
        label={t('Port of this machine')}
        value={now?.uri ?? ''}
        onChoice={(v) => {
          const port = list.find((p) => p.uri === v);
          if (port) onUri(atPort(port, uri), port);
        }}
        choices={[{ value: '', text: t('as typed') }, ...list.map((p) => ({ value: p.uri, text: portText(p, own) }))]}
        hint={<>{now?.kind === 'can' && !now.up && t('The interface is switched off: an administrator of the machine switches it on with its bit rate.')} {again}</>}
      />
    </div>
  );
}
