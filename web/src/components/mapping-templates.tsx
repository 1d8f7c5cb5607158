// Mapping templates: a whole block at once: the standard map of an axis at the next free place of a unit of one's own. In: the book.
// Out: a block of mappings, after a look at what it would be. Can be undone like every other change.
import { useSignal } from '@preact/signals';
import { MappingDoor } from '../api/mappings';
import { asProblem } from '../api/problem';
import { useGateway } from '../gateway';
import { t } from '../language';
import { addressBase, addressField } from '../state/address-base';
import { emptied, persisted } from '../state/persisted';
import type { MappingBook } from '../state/mappings';
import { quiet, reportedOf, type Reported } from '../state/reported';
import { addressText, readAddress, spanText } from '../text/address';
import { freeBlock, placeText, type Mapping } from '../text/mapping';
import { parseNumber } from '../text/number';
import { Choice, notOffered, Tell, TextField } from './form';
import { accessText } from './mapping-cell';
import { useNamed } from './name';

const axis = persisted('template.axis');
const unit = persisted('template.unit', '2');
const address = addressField(persisted('template.address'), () => 'holding_registers');
/** Registers of the standard map of one axis. */
const blockWidth = 64;

export function MappingTemplates({ book, door }: { book: MappingBook; door: MappingDoor }) {
  const { store } = useGateway();
  const named = useNamed();
  const reported = useSignal<Reported>(quiet);
  const differences = useSignal<string[]>([]);
  const whole = (text: string, min: number, max: number) => {
    const p = parseNumber(text);
    return p.good && Number.isInteger(p.value) && p.value >= min && p.value <= max ? p.value : null;
  };
  const u = whole(unit.value, 2, 254);
  const base = addressBase();
  const text = (n: number) => addressText('holding_registers', n, base);
  const free = u === null ? null : freeBlock(book.rows.value, u, blockWidth);
  const typed = readAddress(address.value, 'holding_registers', base);
  const fault = address.value.trim() === '' ? '' : !typed.good ? typed.why : typed.table !== 'holding_registers' ? t('The block lies in the holding registers.') : '';
  const at = address.value.trim() === '' ? free : typed.good && fault === '' ? typed.address : null;

  const run = async (dry: boolean) => {
    if (axis.value === '' || u === null || at === null) {
      reported.value = { tone: 'refused', text: axis.value === '' ? t('Choose an axis.') : t('Mend the fields that are marked.') };
      return;
    }
    reported.value = { tone: 'busy', text: dry ? t('The gateway checks …') : t('Adding …') };
    try {
      if (dry) {
        const r = await door.template({ template: 'standard_map', axis: axis.value, unit: u, address: at, dry_run: true });
        // A gateway says the block entry by entry, or as sentences.
        differences.value = Array.isArray(r.mappings) ? (r.mappings as Mapping[]).map((m) => t('{place}: {point} of {axis}, {type}, {access}', { place: placeText(m, base), point: m.point, axis: m.axis, type: m.type, access: accessText[m.access] })) : (r.differences ?? []);
        reported.value = { tone: 'good', text: t('{n} mappings at {place} of unit {unit}. Nothing has been changed.', { n: differences.value.length, place: spanText('holding_registers', at, at + blockWidth - 1, base), unit: u }) };
        return;
      }
    } catch (error) {
      const p = asProblem(error);
      reported.value = { tone: 'refused', text: p.status === 404 || p.status === 405 || p.status === 501 ? notOffered(t('templates')) : p.text };
      return;
    }
    const sent = address.value;
    const outcome = await book.template(axis.value, u, at);
    differences.value = [];
    reported.value = !outcome.good && (outcome.problem?.status === 404 || outcome.problem?.status === 405) ? { tone: 'refused', text: notOffered(t('templates')) } : reportedOf(outcome);
    if (outcome.good) emptied(address, sent);
  };
  return (
    <div class="mapping-templates">
      <form
        class="form"
        noValidate
        aria-label={t('Template')}
        onSubmit={(e) => {
          e.preventDefault();
          void run(false);
        }}
      >
        <div class="form-grid">
          <Choice label={t('Axis')} value={axis.value} onChoice={(v) => (axis.value = v)} choices={[{ value: '', text: t('choose') }, ...store.axisNames.value.map((n) => ({ value: n, text: named(n) }))]} />
          <TextField label={t('Unit ID')} number value={unit.value} onText={(x) => (unit.value = x)} fault={u === null ? t('A whole number from 2 to 254.') : undefined} />
          <TextField
            label={t('Address')}
            class="takes-some"
            number
            value={address.value}
            onText={(x) => (address.value = x)}
            placeholder={free === null ? t('none is free') : t('next free block: {address}', { address: text(free) })}
            fault={fault || undefined}
            hint={t('{n} registers, as in unit 1, where each axis begins at a multiple of {n}', { n: blockWidth })}
          />
        </div>
        <div class="form-foot">
          <button type="button" class="button" onClick={() => void run(true)}>
            {t('Show what it adds')}
          </button>
          <button type="submit" class="button primary">
            {t('Add the block')}
          </button>
          <Tell reported={reported.value} field="template-told" />
        </div>
        {differences.value.length > 0 && (
          <ul class="differences" aria-label={t('What would be added')}>
            {differences.value.slice(0, 200).map((d) => (
              <li key={d}>{d}</li>
            ))}
          </ul>
        )}
      </form>
    </div>
  );
}
