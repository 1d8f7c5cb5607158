// What the HMI sees: the registers of a unit as the Modbus door answers a read of them. In: unit, table, address, count, word order. Out: a form and
// the map; an exception in words, with the places that nothing answers for. Follows once a second when it is asked to. Never writes.
import { signal, useSignal } from '@preact/signals';
import type { MappingDoor, Registers } from '../api/mappings';
import { asProblem } from '../api/problem';
import { useGateway } from '../gateway';
import { midSentence, t } from '../language';
import { addressBase, addressField } from '../state/address-base';
import { persisted } from '../state/persisted';
import { useRepeated } from '../state/repeated';
import { addressText, otherText, readAddress } from '../text/address';
import { wholeWithin } from '../text/hmi-answer';
import { orderChoices, tableChoices, tableOf, types, type Mapping, type MappingPoint, type RegisterType, type Table } from '../text/mapping';
import { notMapped } from '../text/register-map';
import { Choice, notOffered, TextField } from './form';
import { AnswerMap } from './mapping-answer';
import { marked } from './marked';

const unit = persisted('hmi.unit', '1');
const table = persisted('hmi.table', 'holding_registers');
const address = addressField(persisted('hmi.address'), () => table.peek() as Table);
const count = persisted('hmi.count', '16');
const as = persisted('hmi.as', 'i32');
const order = persisted('hmi.order', 'high_first');
const following = signal(false);
const period_ms = 1000;

export function MappingHmi({ door, rows, points }: { door: MappingDoor; rows: readonly Mapping[]; points: readonly MappingPoint[] }) {
  const { store } = useGateway();
  const answer = useSignal<Registers | null>(null);
  const why = useSignal('');
  const waiting = useSignal(false);
  /** What the answer that is shown was asked with. */
  const answerTo = useSignal('');
  const base = addressBase();
  // Nothing typed: from the first register on.
  const place = readAddress(address.value.trim() === '' ? base : address.value, table.value as Table, base);
  const at = { unit: wholeWithin(unit.value, 0, 255), address: place.good ? place.address : null, count: wholeWithin(count.value, 1, 125) };

  const choose = (text: string) => {
    address.value = text;
    const now = readAddress(text, table.peek() as Table, base);
    if (now.good) table.value = now.table;
  };

  const asked = `${unit.value.trim()}/${table.value}/${address.value.trim()}/${count.value.trim()}`;
  const look = async (end?: AbortSignal) => {
    if (at.unit === null || at.address === null || at.count === null) {
      // Nothing stands below fields that it does not belong to.
      answer.value = null;
      why.value = t('Mend the fields that are marked; nothing was asked.');
      return;
    }
    waiting.value = true;
    try {
      answer.value = await door.registers({ unit: at.unit, table: table.value as Table, address: at.address, count: at.count }, end);
      answerTo.value = asked;
      why.value = '';
    } catch (error) {
      if (end?.aborted) return;
      const p = asProblem(error);
      why.value = p.status === 404 || p.status === 501 ? notOffered(t('a look at its registers')) : p.text;
      answer.value = null;
      following.value = false;
    } finally {
      waiting.value = false;
    }
  };
  useRepeated(look, period_ms, following.value, [unit.value, table.value, address.value, count.value]);

  const a = answer.value;
  const axes = store.axisNames.value.flatMap((n) => store.axis(n)?.peek().data ?? []);
  const gaps = a?.exception && at.unit !== null && at.address !== null && at.count !== null ? notMapped({ unit: at.unit, table: table.value as Table, address: at.address, count: at.count }, rows, axes) : '';
  const refused = a?.exception ? (gaps ? t('The Modbus door answers exception {code}: {text}. Not mapped: {places}.', { code: a.exception.code, text: a.exception.text, places: gaps }) : t('The Modbus door answers exception {code}: {text}.', { code: a.exception.code, text: a.exception.text })) : '';
  const former = answerTo.value !== asked;
  return (
    <div class="hmi">
      <form
        class="card form"
        noValidate
        aria-label={t('Read registers')}
        onSubmit={(e) => {
          e.preventDefault();
          void look();
        }}
      >
        <div class="form-grid">
          <TextField label={t('Unit ID')} number value={unit.value} onText={(text) => (unit.value = text)} fault={at.unit === null ? t('A whole number from 0 to 255.') : undefined} hint={t('1 is the standard map')} />
          <Choice label={t('Table')} value={table.value} onChoice={(text) => (table.value = text)} choices={tableChoices} />
          <TextField label={t('Address')} number value={address.value} placeholder={addressText(table.value as Table, 0, base)} onText={choose} fault={place.good ? undefined : place.why} hint={at.address === null ? undefined : t('{address} is {other}', { address: addressText(table.value as Table, at.address, base), other: otherText(table.value as Table, at.address, base) })} />
          <TextField label={t('Count')} number value={count.value} onText={(text) => (count.value = text)} fault={at.count === null ? t('A whole number from 1 to 125.') : undefined} />
          {!tableOf(table.value as Table).bits && (
            <>
              <Choice label={t('Read as')} value={as.value} onChoice={(text) => (as.value = text)} choices={types.filter((x) => x !== 'bool').map((x) => ({ value: x, text: x }))} />
              <Choice label={t('Word order')} value={order.value} onChoice={(text) => (order.value = text)} choices={orderChoices} />
            </>
          )}
        </div>
        <div class="form-foot">
          <button type="submit" class="button primary">
            {t('Look')}
          </button>
          <button type="button" class="button" aria-pressed={following.value} onClick={() => (following.value = !following.value)}>
            {following.value ? t('Following each second') : t('Follow')}
          </button>
          <p class={`tell result-${why.value ? 'refused' : 'none'}`} role="status" data-field="hmi-told">
            {marked(why.value || refused || (waiting.value && !a ? t('Asking …') : ''))}
          </p>
        </div>
        {a && !a.exception && former && (
          <p class="form-told" role="status" data-field="hmi-former">
            {t('This is the former answer: unit {unit}, {table} from {address} on. Press Look for what the fields say now.', { unit: a.unit, table: midSentence(tableOf(a.table).name), address: addressText(a.table, a.address, base) })}
          </p>
        )}
      </form>
      {a && !a.exception && <AnswerMap a={a} axes={axes} rows={rows} points={points} type={as.value as RegisterType} order={order.value as Mapping['word_order']} former={former} />}
    </div>
  );
}
