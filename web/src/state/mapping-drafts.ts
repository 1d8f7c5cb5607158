// Mapping drafts: what is typed for mappings: one that is added, and each one that is changed. In: texts of fields, how addresses are counted. Out: signals. What is
// typed for a new one is kept over a reload; whether its type was chosen by hand is kept with it.
import { signal, type Signal } from '@preact/signals';
import { addressText, readAddress } from '../text/address';
import { emptyTexts, fields, isBits, textsOf, type Field, type Known, type Mapping, type Table, type Texts } from '../text/mapping';
import { naturalType } from '../text/mapping-type';
import { addressBase, addressField, forgetAddressField } from './address-base';
import { emptied, persisted } from './persisted';

export type Draft = Record<Field, Signal<string>>;
export const adding = Object.fromEntries(fields.map((f) => [f, persisted(`mapping.${f}`, emptyTexts[f])])) as Draft;
addressField(adding.address, () => adding.table.peek() as Table);
/** Not empty: the type was chosen by hand, and stays whatever the point is. Of an entry that is changed: unless its type is its point's own. */
const byHand = new WeakMap<Draft, Signal<string>>([[adding, persisted('mapping.type_by_hand')]]);

/** What is typed for entries that are changed, by their id; kept while another one is looked at. */
export type Drafts = Map<string, Draft>;

function shownTexts(m: Mapping): Texts {
  return { ...textsOf(m), address: addressText(m.table, m.address, addressBase()) };
}
/** Of the entry that is changed; null: of a new one. */
export function draftFor(m: Mapping | null, drafts: Drafts, known: Known): { draft: Draft; hand: Signal<string> } {
  let draft = m ? drafts.get(m.id) : adding;
  if (m && !draft) {
    draft = Object.fromEntries(Object.entries(shownTexts(m)).map(([f, text]) => [f, signal(text)])) as Draft;
    const { address, table } = draft;
    addressField(address, () => table.peek() as Table);
    drafts.set(m.id, draft);
    byHand.set(draft, signal(naturalType('', m.point, known) === m.type ? '' : 'yes'));
  }
  return { draft: draft!, hand: byHand.get(draft!) as Signal<string> };
}
export const textsIn = (d: Draft): Texts => Object.fromEntries(fields.map((f) => [f, d[f].value])) as Texts;

/** Nothing was typed in the draft of this entry: it may follow what others make of it. */
export function isUntouched(d: Draft | undefined, m: Mapping): boolean {
  const was = shownTexts(m);
  return !d || fields.every((f) => d[f].peek() === was[f]);
}
export function forgetDraft(m: Mapping, drafts: Drafts): void {
  const d = drafts.get(m.id);
  if (d) forgetAddressField(d.address);
  drafts.delete(m.id);
}

/** A text that is typed, and what goes with it: a number that carries its table chooses it, and a table of bits its type. */
export function typeIn(d: Draft, hand: Signal<string>, f: Field, text: string): void {
  d[f].value = text;
  if (f === 'type') hand.value = 'yes';
  if (f === 'address') {
    const now = readAddress(text, d.table.peek() as Table, addressBase());
    if (now.good && now.table !== d.table.peek()) typeIn(d, hand, 'table', now.table);
  }
  if (f === 'table') d.type.value = isBits(text) ? 'bool' : d.type.peek() === 'bool' ? 'u16' : d.type.peek();
}

/** Puts a place into the draft of a new one; null: the next free one. */
export function placeNew(unit: number, table: Table, address: number | null): void {
  adding.unit.value = String(unit);
  adding.table.value = table;
  adding.address.value = address === null ? '' : addressText(table, address, addressBase());
}
/** Ready for the next one: what was sent and taken is emptied, what was typed since then stays. `next`: the place behind it. */
export function readyForNext(sent: Texts, hand: Signal<string>, next: string): void {
  emptied(adding.address, sent.address, next);
  if (adding.point.peek() === sent.point) hand.value = '';
  emptied(adding.point, sent.point);
  emptied(adding.comment, sent.comment);
}
