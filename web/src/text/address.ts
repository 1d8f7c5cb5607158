// Addresses of registers as people write them: counted from 0, or the numbers of HMI and PLC editors, which count from 1 and carry the table in front
// (40001, 400001). In: text, the table that is chosen, how this page counts. Out: an address from 0 and perhaps a table, or why not; text. Pure.
import { midSentence, t } from '../language';
import { oneBased, tableOf, tables, type Table } from './mapping';
import { parseNumber } from './number';

/** How addresses are written on the whole page. */
export type Base = '0' | '1';
export type ReadAddress = { good: true; address: number; table: Table } | { good: false; why: string };

/** Six digits always carry their table: no address from 0 is as long. Five do where the page counts from 1. */
export function readAddress(text: string, table: Table, base: Base): ReadAddress {
  const typed = text.trim();
  const six = /^([0134])(\d{5})$/.exec(typed);
  const five = base === '1' ? /^([0134])(\d{4})$/.exec(typed) : null;
  const written = six ?? five;
  if (written) {
    const named = tables.find((x) => x.digit === written[1])!;
    const number = Number(written[2]);
    if (number < 1 || number > 65536) return { good: false, why: t('{text} is no register: the first one of the {table} is {first}, the last {last}.', { text: typed, table: midSentence(named.name), first: oneBased(named.id, 0), last: oneBased(named.id, 65535) }) };
    return { good: true, address: number - 1, table: named.id };
  }
  const p = parseNumber(typed);
  if (!p.good) return { good: false, why: typed === '' ? t('Type the address.') : p.why };
  const first = Number(base);
  if (!Number.isInteger(p.value) || p.value < first || p.value > 65535 + first) {
    const { name, digit } = tableOf(table);
    return { good: false, why: t('The address is a whole number from {first} to {last}, or {example} and the like with the {digit} of the {table}.', { first, last: 65535 + first, example: oneBased(table, 0), digit, table: midSentence(name) }) };
  }
  return { good: true, address: p.value - first, table };
}

export const addressText = (table: Table, address: number, base: Base): string => (base === '1' ? oneBased(table, address) : String(address));
/** The same place in the other way of counting. */
export const otherText = (table: Table, address: number, base: Base): string =>
  base === '1' ? t('{address} counted from 0', { address }) : t('{address} counted from 1', { address: oneBased(table, address) });
/** "4–5", "40005–40006". */
export const spanText = (table: Table, first: number, last: number, base: Base): string =>
  first === last ? addressText(table, first, base) : `${addressText(table, first, base)}–${addressText(table, last, base)}`;

/** 40001 where the page counts from 0: perhaps holding register 0 is meant. Empty: no doubt. */
export function doubtText(text: string, base: Base): string {
  const five = base === '0' ? /^([134])(\d{4})$/.exec(text.trim()) : null;
  const n = five ? Number(five[2]) : 0;
  if (!five || n === 0) return '';
  const named = tables.find((x) => x.digit === five[1])!;
  return t('If {text} is the number of an editor, it is {address} of the {table}: let the page count from 1, or write {six}.', { text: text.trim(), address: n - 1, table: midSentence(named.name), six: `${five[1]}0${five[2]}` });
}
