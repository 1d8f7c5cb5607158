// Mapping form: one mapping, added or changed: axis, point, place, type, scaling. In: the book, the texts. Out: a change, or the fault beside the field.
// Conflicts, neighbours and the one-based number are shown while typing. If somebody else changed the entry meanwhile, the difference is shown
// and what was typed stays.
import { signal, useSignal, type Signal } from '@preact/signals';
import { useEffect, useRef } from 'preact/hooks';
import { useGateway } from '../gateway';
import { gatewayText, t, theirs } from '../language';
import { addressBase, addressField, forgetAddressField } from '../state/address-base';
import { narrow } from '../state/narrow';
import { emptied, persisted } from '../state/persisted';
import type { Clash, MappingBook } from '../state/mappings';
import { checkTexts, conflictsOf, emptyTexts, fields, neighbourText, nextFree, placeText, signWarning, tables, textsOf, types, widthOf, type Field, type Known, type Mapping, type Table, type Texts } from '../text/mapping';
import { addressText, doubtText, otherText, readAddress, spanText } from '../text/address';
import { naturalType } from '../text/mapping-type';
import { Choice, quiet, Tell, TextField, reportedOf, type Reported } from './form';
import { useNamed } from './name';
import { Section } from './section';

export type Draft = Record<Field, Signal<string>>;
const keptDraft = (): Draft => Object.fromEntries(fields.map((f) => [f, persisted(`mapping.${f}`, emptyTexts[f])])) as Draft;
const draftOf = (m: Mapping): Draft => {
  const d = Object.fromEntries(Object.entries(textsOf(m)).map(([f, t]) => [f, signal(t)])) as Draft;
  d.address.value = addressText(m.table, m.address, addressBase());
  addressField(d.address, () => d.table.peek() as Table);
  return d;
};
const read = (d: Draft): Texts => Object.fromEntries(fields.map((f) => [f, d[f].value])) as Texts;
/** Nothing was typed in the draft of this entry: it may follow what others make of it. */
export function isUntouched(d: Draft | undefined, m: Mapping): boolean {
  if (!d) return true;
  const was = { ...textsOf(m), address: addressText(m.table, m.address, addressBase()) };
  return fields.every((f) => d[f].peek() === was[f]);
}

/** On a phone the form for adding is folded until it is asked for. */
const addingOpen = signal(false);
const adding = keptDraft();
addressField(adding.address, () => adding.table.peek() as Table);
/** Not empty: the type was chosen by hand, and stays whatever the point is. Of an entry that is changed: unless its type is its point's own. */
const byHand = new WeakMap<Draft, Signal<string>>([[adding, persisted('mapping.type_by_hand')]]);
/** Puts a free place into the form for adding; null: the next free one. */
export function addAt(unit: number, table: Table, address: number | null, focus: boolean): void {
  adding.unit.value = String(unit);
  adding.table.value = table;
  adding.address.value = address === null ? '' : addressText(table, address, addressBase());
  const shut = narrow.peek() && !addingOpen.peek();
  addingOpen.value = true;
  if (!focus) return;
  const enter = () => {
    document.querySelector<HTMLElement>('#mapping-form')?.scrollIntoView({ block: 'nearest' });
    document.querySelector<HTMLElement>('#mapping-form select')?.focus({ preventScroll: true });
  };
  if (shut) requestAnimationFrame(() => requestAnimationFrame(enter)); // when it has been unfolded
  else enter();
}

export interface MappingFormProps {
  book: MappingBook;
  known: Known;
  /** The entry being changed; null: a new one. */
  editing: Mapping | null;
  /** The keyboard goes into it. */
  focus?: boolean;
  /** What is typed for entries that are changed, by their id; kept while another one is looked at. */
  drafts: Map<string, Draft>;
  done: () => void;
}

export function MappingForm({ book, known, editing, focus = true, drafts, done }: MappingFormProps) {
  const { store } = useGateway();
  const named = useNamed();
  if (editing && !drafts.has(editing.id)) drafts.set(editing.id, draftOf(editing));
  const d = editing ? (drafts.get(editing.id) as Draft) : adding;
  if (editing && !byHand.has(d)) byHand.set(d, signal(naturalType('', editing.point, known) === editing.type ? '' : 'yes'));
  const hand = byHand.get(d) as Signal<string>;
  const touched = useSignal(false);
  const reported = useSignal<Reported>(quiet);
  const clash = useSignal<Clash | null>(null);
  const form = useRef<HTMLFormElement>(null);
  useEffect(() => {
    touched.value = false;
    clash.value = null;
    reported.value = quiet;
    if (editing && focus) form.current?.querySelector<HTMLElement>('input, select')?.focus();
  }, [editing?.id, focus]);

  const base = addressBase();
  const texts = read(d);
  const { spec, faults } = checkTexts(texts, known);
  // Before the first attempt only what was typed is judged; an empty field is not a fault yet.
  const shown = (f: Field) => (touched.value || (texts[f].trim() !== '' && texts[f] !== emptyTexts[f]) ? faults[f] : undefined);
  const bits = texts.table === 'coils' || texts.table === 'discrete_inputs';
  const width = widthOf((texts.type || 'i32') as Mapping['type'], Number(texts.length) || 16);
  const at = readAddress(texts.address, texts.table as Table, base);
  const place = { unit: Number(texts.unit), table: texts.table as Mapping['table'], address: at.good ? at.address : 0, type: texts.type as Mapping['type'], ...(Number(texts.length) ? { length: Number(texts.length) } : {}) };
  const placed = texts.address.trim() !== '' && !faults.address && !faults.unit && !faults.table && !faults.type;
  const conflicts = placed ? conflictsOf(place, book.rows.value, editing?.id) : [];
  const free = faults.unit || faults.table || faults.type ? null : nextFree(book.rows.value.filter((m) => m.id !== editing?.id), place.unit, place.table, width, conflicts.length > 0 ? place.address : 0);
  const natural = naturalType(texts.axis, texts.point, known);
  useEffect(() => {
    if (natural && !bits && hand.peek() === '') d.type.value = natural;
  }, [natural, bits, d]);
  const set = (f: Field) => (text: string) => {
    d[f].value = text;
    if (f === 'type') hand.value = 'yes';
    reported.value = quiet;
    if (f === 'address') {
      // A number that carries its table chooses it.
      const now = readAddress(text, d.table.peek() as Table, base);
      if (now.good && now.table !== d.table.peek()) set('table')(now.table);
    }
    if (f === 'table') d.type.value = text === 'coils' || text === 'discrete_inputs' ? 'bool' : d.type.peek() === 'bool' ? 'u16' : d.type.peek();
  };
  const others = conflicts.slice(0, 3).map((c) => t('{id} ({point} of {axis}, {place})', { id: c.id, point: c.point, axis: c.axis, place: placeText(c, base) })).join(', ');
  const taken = conflicts.length === 0 ? undefined : conflicts.length > 3 ? t('Taken by {list} and {n} more.', { list: others, n: conflicts.length - 3 }) : t('Taken by {list}.', { list: others });

  const typeHint = !natural || bits ? undefined : natural === texts.type ? t('the point’s own type') : t('the point’s own type is {type}', { type: natural });
  const warning = signWarning({ point: texts.point.trim(), type: texts.type, offset: Number(texts.offset) || 0 }, known.points);

  const send = async (opened: Mapping | null) => {
    touched.value = true;
    if (!spec || conflicts.length > 0) {
      reported.value = { tone: 'refused', text: taken ?? t('Mend the fields that are marked.') };
      requestAnimationFrame(() => form.current?.querySelector<HTMLElement>('.is-wrong')?.focus());
      return;
    }
    reported.value = { tone: 'busy', text: editing ? t('Changing …') : t('Adding …') };
    const sent = { ...texts };
    const outcome = editing ? await book.replace(editing.id, spec, opened) : await book.add(spec);
    reported.value = reportedOf(outcome);
    clash.value = outcome.good ? null : (outcome.clash ?? null);
    if (!outcome.good) return;
    touched.value = false;
    if (editing) {
      forgetAddressField(d.address);
      drafts.delete(editing.id);
      done();
    } else {
      // Ready for the next one: the place behind it.
      const next = nextFree(book.rows.peek(), spec.unit, place.table, width, spec.address + width);
      emptied(d.address, sent.address, next === null ? '' : addressText(place.table, next, base));
      if (d.point.peek() === sent.point) hand.value = '';
      emptied(d.point, sent.point);
      emptied(d.comment, sent.comment);
    }
  };
  const names = known.parameters(texts.axis) ?? [];
  const offers = [...known.points.map((p) => ({ value: p.point, text: p.description, ...gatewayText })), ...names.map((n) => ({ value: n, text: t('parameter') }))];
  return (
    <Section title={editing ? t('Change {id}', { id: editing.id }) : t('Add a mapping')} class="mapping-form" fold={!editing} unfolded={addingOpen}>
      <form
        id="mapping-form"
        ref={form}
        class="card form"
        noValidate
        aria-label={editing ? t('Change mapping {id}', { id: editing.id }) : t('Add a mapping')}
        onSubmit={(e) => {
          e.preventDefault();
          void send(editing);
        }}
      >
        <div class="form-grid">
          <Choice label={t('Axis')} value={texts.axis} onChoice={set('axis')} fault={shown('axis')} choices={[{ value: '', text: t('choose') }, ...store.axisNames.value.map((n) => ({ value: n, text: named(n) }))]} />
          <TextField label={t('Point or parameter')} class="wide" value={texts.point} onText={set('point')} fault={shown('point')} offers={offers} placeholder={t('position, MT[1] …')} hint={theirs(known.points.find((p) => p.point === texts.point)?.description ?? '') || undefined} />
          <TextField label={t('Unit ID')} number value={texts.unit} onText={set('unit')} fault={shown('unit')} />
          <Choice label={t('Table')} value={texts.table} onChoice={set('table')} fault={shown('table')} choices={tables.map((x) => ({ value: x.id, text: x.name }))} />
          <TextField
            label={t('Address')}
            number
            value={texts.address}
            onText={set('address')}
            placeholder={free === null ? '' : t('free: {address}', { address: addressText(place.table, free, base) })}
            fault={shown('address') ?? taken}
            hint={placed ? t('{doubt} {place} is {other}. Free: {neighbours}.', { doubt: doubtText(texts.address, base), place: spanText(place.table, place.address, place.address + width - 1, base), other: otherText(place.table, place.address, base), neighbours: neighbourText(place, book.rows.value, editing?.id) }).trim() : t('counted from {base}', { base })}
          />
          <Choice label={t('Type')} value={texts.type} onChoice={set('type')} fault={shown('type')} hint={warning === '' ? typeHint : <span class="flag" data-field="sign-warning">{warning}</span>} choices={(bits ? (['bool'] as const) : types).map((x) => ({ value: x, text: x }))} />
          {texts.type === 'string' && <TextField label={t('Length')} number value={texts.length} onText={set('length')} fault={shown('length')} placeholder="16" hint={t('registers')} />}
          {width > 1 && texts.type !== 'string' && <Choice label={t('Word order')} value={texts.word_order} onChoice={set('word_order')} choices={[{ value: 'high_first', text: t('high word first') }, { value: 'low_first', text: t('low word first') }]} />}
          {texts.type !== 'string' && !bits && <TextField label={t('Scale')} number value={texts.scale} onText={set('scale')} fault={shown('scale')} hint={t('register = value × scale + offset')} />}
          {texts.type !== 'string' && !bits && <TextField label={t('Offset')} number value={texts.offset} onText={set('offset')} fault={shown('offset')} />}
          {texts.type !== 'string' && !bits && <Choice label={t('Does not fit')} value={texts.on_overflow} onChoice={set('on_overflow')} fault={shown('on_overflow')} hint={t('what the register shows then')} choices={[{ value: 'mark', text: t('a mark: 8000h…, FFFFh… or NaN') }, { value: 'clamp', text: t('the nearest end of the type') }]} />}
          <Choice label={t('Access')} value={texts.access} onChoice={set('access')} fault={shown('access')} choices={[{ value: '', text: t('as the point allows') }, { value: 'R', text: t('read') }, { value: 'W', text: t('write') }, { value: 'RW', text: t('read and write') }]} />
          <TextField label={t('Comment')} class="wide" value={texts.comment} onText={set('comment')} fault={shown('comment')} />
        </div>
        <div class="form-foot">
          <button type="submit" class="button primary">
            {editing ? t('Save') : t('Add')}
          </button>
          {free !== null && (conflicts.length > 0 || texts.address.trim() === '') && (
            <button type="button" class="button" onClick={() => set('address')(addressText(place.table, free, base))}>
              {t('Next free place: {address}', { address: addressText(place.table, free, base) })}
            </button>
          )}
          {clash.value && (
            <button type="button" class="button" onClick={() => void send(null)} disabled={clash.value.now === null}>
              {t('Save mine all the same')}
            </button>
          )}
          {editing && (
            <button
              type="button"
              class="button quiet"
              onClick={() => {
                forgetAddressField(d.address);
                drafts.delete(editing.id);
                done();
              }}
            >
              {t('Leave it as it is')}
            </button>
          )}
          <Tell reported={reported.value} field="mapping-told" />
        </div>
      </form>
    </Section>
  );
}
