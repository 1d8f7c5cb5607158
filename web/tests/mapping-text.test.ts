// Mappings in words and numbers: places, conflicts, gaps, checks, live values, raw words. All pure.
import { describe, expect, it } from 'vitest';
import { freeBlock, cellsOf, conflictsOf, decodeText, differenceText, neighbourText, nextFree, oneBased, pointUnit, pointValue, registerValue, signWarning, textsOf, widthOf, type Known, type Mapping, type Texts } from '../src/text/mapping';
import { checkTexts } from '../src/text/mapping-check';
import { bitName, notMapped } from '../src/text/register-map';
import { catalogueMissing, csvOfSpecs, readTable } from '../src/text/mapping-table';
import { csvOf, mostRows, rowsOf } from '../src/text/table-text';
import { axis, points } from './fixtures';

const m = (id: string, address: number, type: Mapping['type'] = 'i32', more: Partial<Mapping> = {}): Mapping => ({ id, unit: 2, table: 'holding_registers', address, axis: 'feeder', point: 'position', type, word_order: 'high_first', scale: 1, offset: 0, access: 'R', ...more });
const known: Known = {
  axes: ['feeder', 'slide.x'],
  points: points.filter((p) => p.point === 'position' || p.point === 'target_position'),
  parameters: (a) => (a === 'feeder' ? ['MT[1]', 'working_current', 'PP'] : null),
};
const texts = (change: Partial<Texts>): Partial<Texts> => ({ unit: '2', table: 'holding_registers', address: '4', axis: 'feeder', point: 'position', type: 'i32', ...change });

describe('places', () => {
  it.each([['bool', 1], ['u16', 1], ['i32', 2], ['f32', 2], ['u64', 4], ['f64', 4], ['string', 7]] as const)('%s takes %i', (type, n) => expect(widthOf(type, 7)).toBe(n));
  it.each([['holding_registers', 0, '40001'], ['input_registers', 99, '30100'], ['coils', 9998, '09999'], ['holding_registers', 9999, '410000'], ['discrete_inputs', 65535, '165536']] as const)('%s %i is %s from 1', (t, a, text) => expect(oneBased(t, a)).toBe(text));
  it('conflicts where one register is shared, not beside, in another table, another unit or with itself', () => {
    const all = [m('a', 0), m('b', 10, 'u16'), m('c', 4, 'i32', { table: 'input_registers' }), m('d', 4, 'i32', { unit: 3 })];
    expect(conflictsOf(m('x', 1), all).map((c) => c.id)).toEqual(['a']);
    expect(conflictsOf(m('x', 2), all)).toEqual([]);
    expect(conflictsOf(m('x', 9), all).map((c) => c.id)).toEqual(['b']);
    expect(conflictsOf(m('x', 4), all)).toEqual([]);
    expect(conflictsOf(m('a', 1), all, 'a')).toEqual([]);
  });
  it.each([[2, 0, 2], [4, 0, 6], [2, 5, 6], [1, 20, 20], [65531, 0, null]])('the next %i free from %i begin at %s', (width, from, at) => {
    expect(nextFree([m('a', 0), m('b', 4)], 2, 'holding_registers', width, from)).toBe(at);
  });
  it('tells the neighbours', () => {
    expect(neighbourText(m('x', 4), [m('a', 0), m('b', 6)])).toBe('2 places free after a; b follows without a gap');
    expect(neighbourText(m('x', 4), [])).toBe('nothing before it; nothing behind it');
  });
});

describe('what was typed', () => {
  it('becomes a specification', () => {
    expect(checkTexts(texts({ scale: '0.1', offset: '-5', access: 'r', comment: ' for the HMI ' }), known)).toEqual({
      spec: { unit: 2, table: 'holding_registers', address: 4, axis: 'feeder', point: 'position', type: 'i32', word_order: 'high_first', scale: 0.1, offset: -5, access: 'R', comment: 'for the HMI' },
      faults: {},
    });
  });
  it('takes the axis from before the point, also one with a point in its name', () => {
    expect(checkTexts(texts({ axis: '', point: 'slide.x.position' }), known).spec).toMatchObject({ axis: 'slide.x', point: 'position' });
  });
  it.each([
    [{ unit: '1' }, 'unit', '2 to 254'],
    [{ unit: '255' }, 'unit', '2 to 254'],
    [{ address: '65535' }, 'address', 'beyond'],
    [{ address: '1.5' }, 'address', 'whole number'],
    [{ address: '' }, 'address', 'Type'],
    [{ axis: 'nobody' }, 'axis', 'no axis nobody'],
    [{ axis: '' }, 'axis', 'Choose'],
    [{ point: 'nonsense' }, 'point', 'neither'],
    [{ type: 'i33' }, 'type', 'no type'],
    [{ table: 'coils', type: 'i32' }, 'type', 'bits'],
    [{ table: 'heap' }, 'table', 'no table'],
    [{ scale: '0' }, 'scale', 'not be 0'],
    [{ scale: '1,5' }, 'scale', 'point'],
    [{ access: 'RW' }, 'access', 'only be read'],
    [{ access: 'W', table: 'input_registers', point: 'target_position' }, 'access', 'only be read'],
    [{ access: 'X' }, 'access', 'R, W or RW'],
    [{ type: 'string', length: '65' }, 'length', '64'],
  ] as [Partial<Texts>, keyof Texts, string][])('%o is refused at its field', (change, field, text) => {
    const { spec, faults } = checkTexts(texts(change), known);
    expect(spec).toBeNull();
    expect(faults[field]).toContain(text);
  });
  it('knows parameters by id, name and element, and does not judge those of an axis it does not know', () => {
    for (const point of ['MT[1]', 'working_current', 'PP[17]']) expect(checkTexts(texts({ point }), known).faults).toEqual({});
    expect(checkTexts(texts({ axis: 'slide.x', point: 'anything' }), known).faults).toEqual({});
  });
  it('comes back as it was', () => expect(checkTexts(textsOf(m('a', 4)), known).spec).toMatchObject({ address: 4, type: 'i32', access: 'R' }));
  it('says what differs', () => {
    expect(differenceText(m('a', 4), m('a', 6, 'f32'))).toBe('address 4 → 6, type i32 → f32');
    expect(differenceText(m('a', 4), null)).toBe('removed');
  });
});

describe('tables', () => {
  it.each([
    ['tabs', 'unit\taddress\n2\t0'],
    ['commas', '\uFEFFunit,address\r\n2,0\r\n'],
    ['semicolons', 'unit;address\n2;0\n\n'],
  ])('are read with %s', (_, text) => expect(rowsOf(text).rows).toEqual([{ line: 1, cells: ['unit', 'address'] }, { line: 2, cells: ['2', '0'] }]));
  it('keep quoted separators, quotes and line breaks, and count lines', () => {
    expect(rowsOf('a,"x, ""y""\nz"\nb,c').rows).toEqual([{ line: 1, cells: ['a', 'x, "y"\nz'] }, { line: 3, cells: ['b', 'c'] }]);
    expect(rowsOf(csvOf([['a', 'x, "y"\nz']])).rows[0]?.cells).toEqual(['a', 'x, "y"\nz']);
  });
  it('have an end', () => {
    const r = rowsOf('1,2\n'.repeat(mostRows + 5));
    expect(r.tooMany).toBe(true);
    expect(r.rows).toHaveLength(mostRows);
  });
  it('are checked row by row, among one another and against what is there', () => {
    const r = readTable('unit\taddress\taxis\tpoint\ttype\n2\t0\tfeeder\tposition\ti32\n2\t1\tfeeder\tposition\ti32\n2\t20\tfeeder\tposition\tq\n2\t10\tfeeder\tposition\ti32', known, [m('old', 11, 'u16')]);
    expect(r.rows.map((x) => x.faults.length > 0)).toEqual([false, true, true, true]);
    expect(r.rows[1]?.faults[0]).toContain('line 2');
    expect(r.rows[2]?.faults[0]).toContain('no type');
    expect(r.rows[3]?.faults[0]).toContain('taken by old');
    expect(r.rows.map((x) => x.line)).toEqual([2, 3, 4, 5]);
  });
  it('let a row with a known id take its place', () => expect(readTable('id,unit,address,axis,point\nold,2,11,feeder,position', known, [m('old', 11)]).rows[0]?.faults).toEqual([]));
  it('tell columns that nobody knows, and ids that stand twice', () => {
    expect(readTable('unit,address,colour\n2,1,red', known, []).problem).toContain('colour');
    expect(readTable('id,unit,address,axis,point\na,2,0,feeder,position\na,2,4,feeder,position', known, []).rows[1]?.faults[0]).toContain('line 2 has a too');
  });
  it('need no head', () => expect(readTable('2\tholding\t8\tfeeder\tposition\tf32', known, []).rows[0]?.spec).toMatchObject({ unit: 2, table: 'holding_registers', address: 8, type: 'f32' }));
  it('go back to the gateway with all columns', () => {
    expect(csvOfSpecs([{ unit: 2, address: 8, axis: 'feeder', point: 'position', comment: 'a;b' }])).toBe('id,unit,table,address,axis,point,type,word_order,scale,offset,access,length,comment,on_overflow\n,2,,8,feeder,position,,,,,,,"a;b",\n');
    expect(cellsOf(m('a', 4))).toHaveLength(14);
  });
  it('say what a value that does not fit shows: a mark unless the table says clamp', () => {
    const read = (cell: string) => readTable(`unit,address,axis,point,type,on_overflow\n2,8,feeder,position,i16,${cell}`, known, []).rows[0];
    expect([read('')?.spec?.on_overflow, read('mark')?.spec?.on_overflow, read('clamp')?.spec?.on_overflow]).toEqual([undefined, undefined, 'clamp']);
    expect(read('cut')?.faults).toEqual(['on overflow: mark or clamp.']);
  });
});

describe('values', () => {
  it('come from the axis where it has them', () => {
    const a = axis({ position: 12.5, position_increments: 40000, moving: true, online: true, simulated: true });
    expect(pointValue(a, 'position', points)).toBe(40000);
    expect(pointValue(a, 'position_units', points)).toBe(12.5);
    expect((pointValue(a, 'flags', points) as number) & 0b10011).toBe(0b10011);
    expect(pointValue(a, 'MT[1]', points)).toBeUndefined();
    expect(pointValue(axis({ authority: 'ethernet_ip' }), 'authority', points)).toBe(2);
  });
  it('of a point that only the gateway knows come by the member that it names', () => {
    const one = { point: 'temperature', access: 'R', description: '', type: 'i16', unit: null, member: 'temperature' } as const;
    expect(pointValue({ ...axis(), temperature: 41 } as never, 'temperature', [one])).toBe(41);
    expect(pointUnit({ unit: 'mm' }, 'temperature', [{ ...one, unit: 'unit/s' }])).toBe('mm/s');
    expect(signWarning({ point: 'temperature', type: 'u16', offset: 0 }, [one])).toContain('i16 holds it');
  });
  it('of demand and following error are the axis\' increments, and not known while nobody says them', () => {
    const reported = axis({ demand_source: 'computed', position_demand_increments: 40010, following_error_increments: -7 });
    expect(['position_demand', 'following_error'].map((p) => [pointValue(reported, p, points), pointUnit(reported, p, points)])).toEqual([[40010, 'inc'], [-7, 'inc']]);
    expect(pointValue(axis({ following_error_increments: null }), 'following_error', points)).toBeNull();
    expect(signWarning({ point: 'following_error', type: 'u32', offset: 0 }, points)).toContain('can be negative');
  });
  it('are scaled as in the register', () => {
    expect(registerValue(12.5, m('a', 0, 'i16', { scale: 10, offset: 1 }))).toBe(126);
    expect(registerValue(0.1, m('a', 0, 'f32'))).toBe(Math.fround(0.1));
    expect(registerValue(true, m('a', 0, 'bool'))).toBe(1);
  });
  it.each([
    [[0xffff, 0xfffe], 'i32', 'high_first', -2],
    [[0xfffe, 0xffff], 'i32', 'low_first', -2],
    [[0x4148, 0x0000], 'f32', 'high_first', 12.5],
    [[0x8000], 'i16', 'high_first', -32768],
    [[1, 2, 3, 4], 'u64', 'high_first', 0x0001000200030004n],
    [[4, 3, 2, 1], 'u64', 'low_first', 0x0001000200030004n],
    [[0x4142, 0x4300], 'string', 'high_first', 'ABC'],
    [[1], 'i32', 'high_first', null],
  ] as const)('%o as %s, %s is %s', (text, type, order, value) => expect(decodeText(text, type, order)).toBe(value));
});

describe('before it is mapped, and where nothing is', () => {
  it('warns of a point that can be negative in a type that cannot', () => {
    expect(signWarning({ point: 'position', type: 'u32', offset: 0 }, points)).toBe('position can be negative, and u32 holds no negative value: reading it then is an exception. i32 holds it.');
    for (const fine of [{ point: 'position', type: 'i32', offset: 0 }, { point: 'statusword', type: 'u16', offset: 0 }, { point: 'position_units', type: 'u16', offset: 500 }, { point: 'position', type: 'f32', offset: 0 }]) expect(signWarning(fine, points)).toBe('');
  });
  it('names the places of a span that are not mapped', () => {
    const span = { unit: 2, table: 'holding_registers' as const, address: 0, count: 10 };
    expect(notMapped(span, [m('a', 0), m('b', 4, 'u16')], [])).toBe('2–3, 5–9');
    expect(notMapped({ ...span, count: 2 }, [m('a', 0)], [])).toBe('');
    expect(notMapped({ ...span, unit: 1, address: 60, count: 8 }, [], [{ number: 1 }])).toBe('64–67');
  });
  it('says what the bits of the standard map are', () => {
    const axes = [{ name: 'feeder', number: 1 }, { name: 'lift', number: 2 }];
    expect(bitName(4, axes)).toBe('feeder: flag moving');
    expect(bitName(64 + 19, axes)).toBe('lift: status word, bit 3, Fault');
    expect(bitName(40, axes)).toBe('feeder: not used');
    expect(bitName(128, axes)).toBe('');
  });
});

it('rows of a table wait for the catalogue before they are called good', () => {
  const spec = { unit: 2, table: 'holding_registers' as const, address: 0, axis: 'slide.x', point: 'AC', type: 'i32' as const };
  expect(catalogueMissing([spec], { ...known, points: [] })).toBe('Waiting for the list of points …');
  expect(catalogueMissing([spec], known)).toBe('Waiting for the parameters of slide.x …');
  expect(catalogueMissing([{ ...spec, axis: 'feeder' }, { ...spec, point: 'position' }], known)).toBe('');
});

describe('a block of an axis', () => {
  const at = (address: number, table = 'holding_registers', unit = 2) => ({ id: `m${address}`, unit, table, address, axis: 'x', point: 'position', type: 'i32', word_order: 'high_first', scale: 1, offset: 0, access: 'R' }) as Parameters<typeof freeBlock>[0][number];
  it('begins at a multiple of its width, whatever lies before', () => {
    expect(freeBlock([], 2, 64)).toBe(0);
    expect(freeBlock([at(0)], 2, 64)).toBe(64);
    expect(freeBlock([at(63)], 2, 64)).toBe(128); // two registers: 63 and 64
    expect(freeBlock([at(70), at(10)], 2, 64)).toBe(128);
    expect(freeBlock([at(0, 'holding_registers', 3)], 2, 64)).toBe(0);
  });
  it('leaves room in every table, and says when there is none', () => {
    expect(freeBlock([at(5, 'input_registers')], 2, 64)).toBe(64);
    expect(freeBlock(Array.from({ length: 1024 }, (_, i) => at(i * 64 + 3)), 2, 64)).toBeNull();
  });
});
