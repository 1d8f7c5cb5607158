// Address base: whether this page writes register addresses from 0 or from 1, for all of its parts at once. In: one switch, kept in the browser.
// Out: a signal; what stands in the fields is written anew when the switch is turned, so that it means the same place.
import type { Signal } from '@preact/signals';
import { addressText, readAddress, type Base } from '../text/address';
import type { Table } from '../text/mapping';
import { persisted } from './persisted';

const chosen = persisted('address.base', '0', 'browser');
export const addressBase = (): Base => (chosen.value === '1' ? '1' : '0');

const fields = new Map<Signal<string>, () => Table>();
/** A field that holds an address of this table. */
export function addressField(text: Signal<string>, table: () => Table): Signal<string> {
  fields.set(text, table);
  return text;
}
export const forgetAddressField = (text: Signal<string>): boolean => fields.delete(text);

export function countFrom(base: Base): void {
  const before = addressBase();
  if (before === base) return;
  for (const [text, table] of fields) {
    const read = readAddress(text.peek(), table(), before);
    if (read.good) text.value = addressText(read.table, read.address, base);
  }
  chosen.value = base;
}
