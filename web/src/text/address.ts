// Addresses of registers as people write them: counted from 0, or the numbers of HMI and PLC editors, which count from 1 and carry the table in front
// (40001, 400001). In: text, the table that is chosen, how this page counts. Out: an address from 0 and perhaps a table, or why not; text. Pure.
import { oneBased, tableOf, tables, type Table } from './mapping';
import { parseNumber } from './number';

/** How addresses are written on the whole page. */
export type Base = '0' | '1';
export type ReadAddress = { good: true; address: number; table: Table } | { good: false; why: string };

/** Six digits always carry their table: no address from 0 is as long. Five do where the page counts from 1. */
export function readAddress(text: string, table: Table, base: Base): ReadAddress {
  const t = text.trim();
  const six = /^([0134])(\d{5})$/.exec(t);
  const five = base === '1' ? /^([0134])(\d{4})$/.exec(t) : null;
  const written = six ?? five;
  if (written) {
    const named = tables.find((x) => x.digit === written[1])!;
    const number = Number(written[2]);
    if (number < 1 || number > 65536) return { good: false, why: `${t} is no register: the first one of the ${named.name.toLowerCase()} is ${oneBased(named.id, 0)}, the last ${oneBased(named.id, 65535)}.` };
    return { good: true, address: number - 1, table: named.id };
  }
  const p = parseNumber(t);
  if (!p.good) return { good: false, why: t === '' ? 'Type the address.' : p.why };
  const first = Number(base);
  if (!Number.isInteger(p.value) || p.value < first || p.value > 65535 + first) {
    const { name, digit } = tableOf(table);
    return { good: false, why: `The address is a whole number from ${first} to ${65535 + first}, or ${oneBased(table, 0)} and the like with the ${digit} of the ${name.toLowerCase()}.` };
  }
  return { good: true, address: p.value - first, table };
}

export const addressText = (table: Table, address: number, base: Base): string => (base === '1' ? oneBased(table, address) : String(address));
/** The same place in the other way of counting. */
export const otherText = (table: Table, address: number, base: Base): string =>
  base === '1' ? `${address} counted from 0` : `${oneBased(table, address)} counted from 1`;
/** "4–5", "40005–40006". */
export const spanText = (table: Table, first: number, last: number, base: Base): string =>
  first === last ? addressText(table, first, base) : `${addressText(table, first, base)}–${addressText(table, last, base)}`;

/** 40001 where the page counts from 0: perhaps holding register 0 is meant. Empty: no doubt. */
export function doubtText(text: string, base: Base): string {
  const five = base === '0' ? /^([134])(\d{4})$/.exec(text.trim()) : null;
  const n = five ? Number(five[2]) : 0;
  if (!five || n === 0) return '';
  const named = tables.find((x) => x.digit === five[1])!;
  return `If ${text.trim()} is the number of an editor, it is ${n - 1} of the ${named.name.toLowerCase()}: let the page count from 1, or write ${five[1]}0${five[2]}.`;
}
