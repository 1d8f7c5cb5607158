// Descriptions in words: names of files, the objects that a filter leaves, the difference of two files, the drive that a file makes, its start in words.
import { describe, expect, it } from 'vitest';
import type { DescriptionEntry, DescriptionObject } from '../src/api/descriptions';
import { bootTexts } from '../src/text/boot';
import { commissioningText, deviceText, describedFamily, driveOf, limitsText, matchingObjects, rateText, storedName, usersText } from '../src/text/description';
import { differenceOfObjects, differenceText, sidesOf } from '../src/text/description-difference';
import type { Families, OptionSpec } from '../src/text/options';

const object = (o: Partial<DescriptionObject> & { object: string }): DescriptionObject => ({ of: null, name: 'x', type: 'UNSIGNED16', access: 'rw', mappable: false, low: null, high: null, default: null, configured: null, line: 1, ...o });
const entry = (d: Partial<DescriptionEntry> = {}): DescriptionEntry => ({
  name: 'maker.dcf', bytes: 2048, added_at: '2026-01-01T00:00:00Z', added_by: null, vendor: 'Example Motion', vendor_number: 1, product: 'SD-400', product_number: 2,
  revision_number: 3, order_code: 'SD-400-24', bit_rates_kbit: [500], objects: 3, entries: 9, commissioning: { node: 12, node_name: 'Lift 1', bit_rate_kbit: 500 }, used_by: [], ...d,
});

it.each([
  ['Maker Model.EDS', 'Maker-Model.eds'], ['a.dcf', 'a.dcf'], ['..hidden.eds', 'hidden.eds'], ['Ünïcode–9.eds', 'n-code-9.eds'], ['äöü.dcf', 'drive.dcf'],
  [`${'a'.repeat(90)}.eds`, `${'a'.repeat(60)}.eds`], ['a.eds.txt', ''], ['eds', ''], ['.eds', 'drive.eds'],
])('a file %s is stored as %s', (file, name) => {
  expect(storedName(file)).toBe(name);
  if (name !== '') expect(name).toMatch(/^[A-Za-z0-9_-][A-Za-z0-9_.-]{0,59}\.(eds|dcf)$/);
});

it('says what a file is of, for whom, and who uses it', () => {
  expect(deviceText(entry())).toBe('Example Motion SD-400, order code SD-400-24');
  expect(deviceText(entry({ vendor: null, product: null, order_code: null }))).toBe('no maker is named');
  expect(commissioningText(entry())).toBe('Made for: node 12, called Lift 1, 500 kbit/s.');
  expect([commissioningText(entry({ commissioning: null })), commissioningText(entry({ commissioning: { node: null, node_name: null, bit_rate_kbit: null } }))]).toEqual(['', '']);
  expect([usersText([]), usersText(['a']), usersText(['a', 'b'])]).toEqual(['No drive uses it.', 'Used by drive a.', 'Used by drives a, b.']);
  expect([limitsText({ low: '1', high: '5' }), limitsText({ low: '1', high: null }), limitsText({ low: null, high: '5' }), limitsText({ low: null, high: null })]).toEqual(['1 to 5', 'from 1', 'up to 5', '']);
});

it('filters objects by words and by kind', () => {
  const list = [object({ object: '1018h:01', of: 'Identity', name: 'Vendor', access: 'ro' }), object({ object: '2010h:01', name: 'Gain', configured: '5' }), object({ object: '6040h', name: 'Controlword', mappable: true })];
  const found = (text: string, kind: Parameters<typeof matchingObjects>[2] = 'all') => matchingObjects(list, text, kind).map((o) => o.object);
  expect([found(''), found('vendor ident'), found('6040'), found('nothing')]).toEqual([['1018h:01', '2010h:01', '6040h'], ['1018h:01'], ['6040h'], []]);
  expect([found('', 'writable'), found('', 'mappable'), found('', 'configured'), found('', 'maker'), found('', 'profile')]).toEqual([['2010h:01', '6040h'], ['6040h'], ['2010h:01'], ['2010h:01'], ['6040h']]);
});

describe('the difference of two files', () => {
  const a = [object({ object: '1000h' }), object({ object: '1018h:01', default: '1' }), object({ object: '1018h:0A', low: '0' }), object({ object: '6040h', mappable: true }), object({ object: '1014h', default: '$NODEID + 128' })];
  const b = [object({ object: '1000h', name: 'other words', line: 99 }), object({ object: '1018h:01', default: '2', type: 'UNSIGNED32' }), object({ object: '1018h:02' }), object({ object: '6040h' }), object({ object: '1014h', default: '$NODEID+128' })];
  it('names objects of one file alone and members that differ, in order of index and subindex; names and lines are none', () => {
    expect(differenceOfObjects(a, b)).toEqual([
      { object: '1018h:01', name: 'x', side: 'both', differing: [{ member: 'type', first: 'UNSIGNED16', second: 'UNSIGNED32' }, { member: 'default', first: '1', second: '2' }] },
      { object: '1018h:02', name: 'x', side: 'second', differing: [] },
      { object: '1018h:0A', name: 'x', side: 'first', differing: [] },
      { object: '6040h', name: 'x', side: 'both', differing: [{ member: 'mappable', first: 'yes', second: 'no' }] },
    ]);
  });
  it.each(['low', 'high', 'default', 'configured'] as const)('tells a missing %s from one that is 0', (member) =>
    expect(differenceOfObjects([object({ object: '6065h', [member]: '0' })], [object({ object: '6065h' })])[0]?.differing).toEqual([{ member, first: '0', second: null }]));
  it('is the same from the other side, and nothing with itself', () => {
    expect(sidesOf(differenceOfObjects(b, a))).toEqual({ first: 1, second: 1, both: 2 });
    expect(differenceOfObjects(a, a)).toEqual([]);
    expect(differenceText([], 'a', 'b')).toMatch(/same objects/);
    expect(differenceText(differenceOfObjects(a, b), 'a.eds', 'b.eds')).toBe('2 objects of both files differ; 1 are only in a.eds, 1 only in b.eds.');
  });
  it('of 2,000 objects takes no square of the time', () => {
    const many = (n: number) => Array.from({ length: n }, (_, i) => object({ object: `${(0x2000 + i).toString(16).toUpperCase()}h`, default: String(i % 7) }));
    expect(differenceOfObjects(many(2000), many(1999))).toHaveLength(1);
  });
});

describe('a drive of a file', () => {
  const families: Families = new Map([['uim342', { name: 'uim342', takes_description: false }], ['aposs', { name: 'aposs', takes_description: true }], ['cia402', { name: 'cia402', takes_description: true }]]);
  const line = (family: string, bitrate?: number) => ({ name: 'can0', uri: 'can:can0', family, ...(bitrate === undefined ? {} : { bitrate }) });
  it('has its description, its node number, a free name, and a family of its own where the line has another one', () => {
    expect(driveOf(entry(), line('cia402'), { drives: [{ name: 'lift-1' }] }, families)).toEqual({ name: 'lift-12', description: 'maker.dcf', family: '', address: '12' });
    expect(driveOf(entry({ commissioning: null }), line('uim342'), {}, families)).toEqual({ name: 'sd-400', description: 'maker.dcf', family: 'cia402' });
    expect(driveOf(entry({ commissioning: null, product: null }), undefined, {}, families)).toMatchObject({ name: 'maker', family: 'cia402' });
  });
  it('keeps the family of a line that takes descriptions', () => expect([describedFamily(line('aposs'), families), describedFamily(undefined, new Map())]).toEqual(['aposs', '']));
  it('is told when it was made for another bit rate than that of its line', () => {
    expect(rateText(entry(), line('cia402', 1_000_000))).toContain('500 kbit/s; line can0 has 1000');
    expect([rateText(entry(), line('cia402', 500_000)), rateText(entry(), line('cia402')), rateText(entry({ commissioning: null }), line('cia402', 1_000_000))]).toEqual(['', '', '']);
  });
});

describe('the start of a drive in words', () => {
  const specs: OptionSpec[] = [
    { name: 'heartbeat_ms', of: ['drive'], min: 0, max: 60000, default: '500', description: '' },
    { name: 'watchdog_action', of: ['drive'], values: ['quick_stop', 'none'], default: 'quick_stop', description: '' },
    { name: 'watchdog_ms', of: ['drive'], min: 100, max: 60000, default: '1000', description: '' },
    { name: 'quick_stop_stays', of: ['drive'], values: ['yes', 'no'], default: 'no', description: '' },
  ];
  it('says the defaults, and what is typed instead', () => {
    expect(bootTexts({}, specs)).toEqual([expect.stringContaining('each 500 ms'), expect.stringMatching(/1000 ms without one.*by a quick stop/), expect.stringContaining('605Ah stays')]);
    const typed = bootTexts({ 'options.heartbeat_ms': '0', 'options.watchdog_ms': '300', 'options.quick_stop_stays': 'yes' }, specs);
    expect(typed).toEqual([expect.stringContaining('no heartbeat'), expect.stringContaining('300 ms'), expect.stringContaining('set to 6')]);
    expect(bootTexts({ 'options.watchdog_action': 'none' }, specs)[1]).toContain('nothing stops it');
  });
  it('takes a text that is no value for none, and says nothing of a family without such options', () => {
    expect(bootTexts({ 'options.heartbeat_ms': 'soon', 'options.watchdog_action': 'never' }, specs).slice(0, 2)).toEqual(bootTexts({}, specs).slice(0, 2));
    expect(bootTexts({}, [{ name: 'crc', of: ['line'], default: '12', description: '' }, { name: 'heartbeat_ms', of: ['twin'], default: '1', description: '' }])).toEqual([]);
  });
});
