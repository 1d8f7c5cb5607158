// Addresses as people write them: 40001 and 400001 are holding register 0 where they can be nothing else; the switch keeps what the fields mean.
import { signal } from '@preact/signals';
import { describe, expect, it } from 'vitest';
import { addressBase, addressField, countFrom, forgetAddressField } from '../src/state/address-base';
import { addressText, doubtText, readAddress, spanText, type Base } from '../src/text/address';
import { tables, type Table } from '../src/text/mapping';

const read = (text: string, base: Base, table: Table = 'holding_registers') => {
  const r = readAddress(text, table, base);
  return r.good ? `${r.table} ${r.address}` : r.why;
};

describe('what is typed', () => {
  it.each<[string, Base, string]>([
    ['0', '0', 'holding_registers 0'], ['65535', '0', 'holding_registers 65535'], ['40001', '0', 'holding_registers 40001'],
    ['400001', '0', 'holding_registers 0'], ['300010', '0', 'input_registers 9'], ['000001', '0', 'coils 0'], ['165536', '0', 'discrete_inputs 65535'],
    ['0x10', '0', 'holding_registers 16'],
    ['40001', '1', 'holding_registers 0'], ['400001', '1', 'holding_registers 0'], ['30005', '1', 'input_registers 4'], ['00001', '1', 'coils 0'],
    ['1', '1', 'holding_registers 0'], ['65536', '1', 'holding_registers 65535'],
  ])('%j counted from %s: %s', (text, base, meant) => expect(read(text, base)).toBe(meant));
  it.each<[string, Base, RegExp]>([
    ['65536', '0', /from 0 to 65535, or 40001/], ['0', '1', /from 1 to 65536/], ['465537', '0', /is no register/], ['400000', '0', /is no register: the first one of the holding registers is 40001/],
    ['40000', '1', /is no register/], ['', '0', /Type the address/], ['x', '0', /not a number/], ['1.5', '0', /whole number/],
  ])('%j counted from %s is refused', (text, base, why) => expect(read(text, base)).toMatch(why));
});

it('what is shown is read back as the same place, in every table, at both ends and where the digits grow', () => {
  for (const base of ['0', '1'] as const)
    for (const t of tables)
      for (const at of [0, 1, 9998, 9999, 10000, 39999, 40000, 65535]) expect(read(addressText(t.id, at, base), base, t.id), `${base} ${t.id} ${at}`).toBe(`${t.id} ${at}`);
});

it('a span, and a doubt', () => {
  expect(spanText('holding_registers', 4, 5, '0')).toBe('4–5');
  expect(spanText('holding_registers', 4, 5, '1')).toBe('40005–40006');
  expect(spanText('coils', 4, 4, '1')).toBe('00005');
  expect(doubtText('40001', '0')).toMatch(/it is 0 of the holding registers.*write 400001\./);
  expect(doubtText('40001', '1') + doubtText('500', '0') + doubtText('50001', '0')).toBe('');
});

it('turning the switch writes the fields anew, and leaves what is no address', () => {
  const field = addressField(signal('5'), () => 'input_registers');
  const odd = addressField(signal('x'), () => 'coils');
  countFrom('1');
  expect([addressBase(), field.value, odd.value]).toEqual(['1', '30006', 'x']);
  countFrom('0');
  expect([addressBase(), field.value, odd.value]).toEqual(['0', '5', 'x']);
  forgetAddressField(field);
  forgetAddressField(odd);
});
