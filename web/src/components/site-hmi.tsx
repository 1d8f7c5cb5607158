// Site HMI: how another machine reads an axis, told with its live words: host, port, unit, addresses, a line to try it with. In: the axis. Out: text.
// Asks for the same words as the Modbus door answers, once a second while the page is seen. Nothing is written.
import { useSignal } from '@preact/signals';
import { marked } from './marked';
import { TableHead } from './table-head';
import { MappingDoor, type Registers } from '../api/mappings';
import { asProblem } from '../api/problem';
import { useDoor, useGateway } from '../gateway';
import { t } from '../language';
import { useRepeated } from '../state/repeated';
import { oneBased } from '../text/mapping';
import { hex } from '../text/axis';
import { mbpollLine, modbusPlace, standardAddress, wordsOf } from '../text/hmi-line';

const period_ms = 1000;
const count = 4;

export function ReadFromHmi({ axis }: { axis: string }) {
  const { store } = useGateway();
  const door = useDoor(MappingDoor);
  const words = useSignal<Registers | null>(null);
  const why = useSignal('');
  const copied = useSignal('');
  const data = store.axis(axis)?.value.data;
  const number = data?.number ?? 0;
  const first = standardAddress(number);
  const look = async (end: AbortSignal) => {
    try {
      words.value = await door.registers({ unit: 1, table: 'holding_registers', address: first, count }, end);
      why.value = '';
    } catch (error) {
      if (!end.aborted) why.value = asProblem(error).text;
    }
  };
  useRepeated(look, period_ms, number >= 1, [door, first, number]);
  if (!data) return null;
  const place = modbusPlace(store.about.value?.doors ?? [], location.hostname);
  if (!place) {
    return (
      <section class="read-from-hmi" aria-label={t('Read it from the HMI')} data-field="read-from-hmi">
        <h3>{t('Read it from the HMI')}</h3>
        <p class="where">{t('The Modbus door is shut: nothing can be read over it.')}</p>
      </section>
    );
  }
  const line = mbpollLine(place, first + 2);
  const raw = wordsOf(words.value?.words, words.value?.exception ?? null);
  const row = (at: number, what: string, published: string) => (
    <tr>
      <th scope="row">{what}</th>
      <td class="mono">{first + at}</td>
      <td class="mono">{oneBased('holding_registers', first + at)}</td>
      <td class="mono">{published}</td>
    </tr>
  );
  const copy = async () => {
    try {
      await navigator.clipboard.writeText(line);
      copied.value = t('Copied.');
    } catch {
      copied.value = t('The browser does not let the page copy: mark the line and copy it.');
    }
  };
  return (
    <section class="read-from-hmi" aria-label={t('Read it from the HMI')} data-field="read-from-hmi">
      <h3>{t('Read it from the HMI')}</h3>
      <p>
        {t('Host {host}, port {port}, unit 1, holding registers:', { host: place.host, port: place.port })} {place.local && <span class="form-told is-fault">{t('The door listens on this machine alone; the setting bind of the Modbus door lets others in.')}</span>}
      </p>
      <table class="hmi-words">
        <TableHead of={[t('What'), t('Address from 0'), t('Address from 1'), t('Now')]} />
        <tbody>
          {row(0, t('Status word'), raw.status === null ? '–' : hex(raw.status, 4))}
          {row(2, t('Position, 32 bits, high word first, in increments'), raw.position === null ? '–' : `${raw.text} = ${raw.position}`)}
        </tbody>
      </table>
      <p class="form-told" role="status">
        {marked(why.value || raw.fault)}
      </p>
      <p class="form-foot">
        <code data-field="mbpoll">{line}</code>
        <button type="button" class="button small" onClick={() => void copy()}>
          {t('Copy the line')}
        </button>
        <span class="where" role="status">
          {copied.value}
        </span>
      </p>
    </section>
  );
}
