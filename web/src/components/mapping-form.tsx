// Mapping form: one mapping, added or changed: axis, point, place, type, scaling. In: the book, the texts. Out: a change, or the fault beside the field.
// Conflicts, neighbours and the one-based number are shown while typing. If somebody else changed the entry meanwhile, the difference is shown
// and what was typed stays.
import { signal, useSignal } from '@preact/signals';
import { useEffect, useRef } from 'preact/hooks';
import { useGateway } from '../gateway';
import { gatewayText, t, theirs } from '../language';
import { addressBase } from '../state/address-base';
import { draftFor, forgetDraft, placeNew, readyForNext, textsIn, typeIn, type Drafts } from '../state/mapping-drafts';
import type { Clash, MappingBook } from '../state/mappings';
import { narrow } from '../state/narrow';
import { quiet, reportedOf, type Reported } from '../state/reported';
import { addressText } from '../text/address';
import { emptyTexts, nextFree, orderChoices, tableChoices, types, type Field, type Known, type Mapping, type Table } from '../text/mapping';
import { mappingFacts } from '../text/mapping-facts';
import { Choice, Tell, TextField } from './form';
import { useNamed } from './name';
import { Section } from './section';

/** On a phone the form for adding is folded until it is asked for. */
const addingOpen = signal(false);
/** Puts a free place into the form for adding; null: the next free one. */
export function addAt(unit: number, table: Table, address: number | null, focus: boolean): void {
  placeNew(unit, table, address);
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
  drafts: Drafts;
  done: () => void;
}

export function MappingForm({ book, known, editing, focus = true, drafts, done }: MappingFormProps) {
  const { store } = useGateway();
  const named = useNamed();
  const { draft: d, hand } = draftFor(editing, drafts, known);
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
  const texts = textsIn(d);
  const { spec, faults, bits, width, free, taken, natural, addressHint, typeHint, warning } = mappingFacts(texts, book.rows.value, known, base, editing?.id);
  // Before the first attempt only what was typed is judged; an empty field is not a fault yet.
  const shown = (f: Field) => (touched.value || (texts[f].trim() !== '' && texts[f] !== emptyTexts[f]) ? faults[f] : undefined);
  useEffect(() => {
    if (natural && !bits && hand.peek() === '') d.type.value = natural;
  }, [natural, bits, d]);
  const set = (f: Field) => (text: string) => {
    typeIn(d, hand, f, text);
    reported.value = quiet;
  };
  const leave = (m: Mapping) => {
    forgetDraft(m, drafts);
    done();
  };

  const send = async (opened: Mapping | null) => {
    touched.value = true;
    if (!spec || taken) {
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
    if (editing) return leave(editing);
    const table = sent.table as Table;
    const next = nextFree(book.rows.peek(), spec.unit, table, width, spec.address + width);
    readyForNext(sent, hand, next === null ? '' : addressText(table, next, base));
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
          <Choice label={t('Table')} value={texts.table} onChoice={set('table')} fault={shown('table')} choices={tableChoices} />
          <TextField
            label={t('Address')}
            number
            value={texts.address}
            onText={set('address')}
            placeholder={free === null ? '' : t('free: {address}', { address: free })}
            fault={shown('address') ?? taken}
            hint={addressHint}
          />
          <Choice label={t('Type')} value={texts.type} onChoice={set('type')} fault={shown('type')} hint={warning === '' ? typeHint : <span class="flag" data-field="sign-warning">{warning}</span>} choices={(bits ? (['bool'] as const) : types).map((x) => ({ value: x, text: x }))} />
          {texts.type === 'string' && <TextField label={t('Length')} number value={texts.length} onText={set('length')} fault={shown('length')} placeholder="16" hint={t('registers')} />}
          {width > 1 && texts.type !== 'string' && <Choice label={t('Word order')} value={texts.word_order} onChoice={set('word_order')} choices={orderChoices} />}
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
          {free !== null && (taken || texts.address.trim() === '') && (
            <button type="button" class="button" onClick={() => set('address')(free)}>
              {t('Next free place: {address}', { address: free })}
            </button>
          )}
          {clash.value && (
            <button type="button" class="button" onClick={() => void send(null)} disabled={clash.value.now === null}>
              {t('Save mine all the same')}
            </button>
          )}
          {editing && (
            <button type="button" class="button quiet" onClick={() => leave(editing)}>
              {t('Leave it as it is')}
            </button>
          )}
          <Tell reported={reported.value} field="mapping-told" />
        </div>
      </form>
    </Section>
  );
}
