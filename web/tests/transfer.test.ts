// Parameters as CSV and JSON, out and in, and two sets of values side by side. All pure.
import { describe, expect, it } from 'vitest';
import type { AxisParameter } from '../src/api/types';
import { comparedText, compareWith, csvOfParameters, isMarked, jsonOfParameters, readTransfer, leftOut } from '../src/text/transfer';
import { world } from './fixtures';

const w = world();
const axis = w.axisOf('feeder');
const list = ['AC', 'DC', 'IC[4]', 'TE', 'IL'].map((id) => axis.read(id)) as AxisParameter[];
const only = (text: string) => readTransfer(text, list).rows[0]!;

describe('parameters as text', () => {
  it('come back from CSV and from JSON as they went', () => {
    for (const text of [csvOfParameters(list), jsonOfParameters('feeder', list)]) {
      const { rows, problem } = readTransfer(text, list);
      expect(problem).toBe('');
      expect(rows.map((r) => r.id)).toEqual(['AC', 'DC', 'IC[4]', 'TE', 'IL']);
      expect(rows.filter((r) => r.fault).map((r) => r.id)).toEqual(['TE']); // it can only be read
      expect(rows.filter((r) => !r.fault).every((r) => r.same)).toBe(true);
    }
  });
  it('leave out what is not known', () => expect(csvOfParameters([{ ...list[0]!, value: null }])).toBe('parameter,name,value,unit,default,stored,at\n'));
  it('are read from an object too, and by name', () => {
    expect(only('{"AC": 30000}')).toMatchObject({ id: 'AC', value: 30000, fault: '', same: false });
    expect(only('name,id,value\nx,acceleration,30000')).toMatchObject({ id: 'AC', value: 30000 });
    expect(only('parameter\tvalue\nIC[4]\t0')).toMatchObject({ id: 'IC[4]', value: false });
  });
  it.each([
    ['parameter,value\nAC,0', 'outside the range'],
    ['parameter,value\nAC,1.5', 'whole number'],
    ['parameter,value\nZZ,1', 'no parameter ZZ'],
    ['parameter,value\nTE,1', 'only be read'],
    ['parameter,value\nIL,7', 'not allowed'],
    ['[{"parameter":"AC"}]', 'Type a number'],
    ['[5]', 'no parameter'],
  ])('%s is refused', (text, why) => expect(only(text).fault).toContain(why));
  it('refuse the second row of the same parameter', () => expect(readTransfer('id,value\nAC,5\nacceleration,6', list).rows[1]?.fault).toContain('Line 2 has AC too'));
  it.each([['{"a":', 'not JSON'], ['"x', 'columns'], ['a,b\n1,2', 'columns']])('%s says why it cannot be read', (text, why) => expect(readTransfer(text, list).problem).toContain(why));
});

describe('comparison', () => {
  it('has what both sides know, and says what is the same', () => {
    const rows = compareWith(list, (p) => (p.id === 'AC' ? 1 : p.id === 'DC' ? p.value : null));
    expect(rows.filter((r) => r.known !== false).map((r) => [r.id, r.same])).toEqual([['AC', false], ['DC', true]]);
    expect(rows.filter((r) => r.known === false).every((r) => !r.same && r.other === null)).toBe(true);
    expect(comparedText(rows, 9)).toBe('1 of 2 values differ; 7 of 9 cannot be compared, because one side does not know them.');
    expect(comparedText(rows.filter((r) => r.known !== false), 2)).toBe('1 of 2 values differ.');
    expect(comparedText([], 4)).toBe('None of the 4 values can be compared: no value is known by both sides.');
  });
  it.each([
    ['id;value\nTN;1,5', '1.5'], ['id\tvalue\nTN\t1,5', '1.5'], ['id,value\nTN,"1,5"', 'fault'], ['id;value\nTN;1.234,5', 'fault'], ['id;value\nTT;1,5', '1,5'],
  ])('%j: a decimal comma is read where the cells are not separated by commas (%s)', (text, meant) => {
    const tuned = [{ ...list[0]!, id: 'TN', name: 'tuning', type: 'f32', min: null, max: null, allowed: null, value: null }, { ...list[0]!, id: 'TT', name: 'text', type: 'text', allowed: null, value: null }] as AxisParameter[];
    const row = readTransfer(text, tuned).rows[0]!;
    expect(row.fault ? 'fault' : String(row.value)).toBe(meant);
  });
});

describe('marks', () => {
  const p = { ...list[0]!, value: 5, default: 20000, stored: 5, written_at: null } as AxisParameter;
  it.each([
    ['all', p, true], ['changed', p, true], ['changed', { ...p, value: 20000 }, false], ['changed', { ...p, value: null }, false], ['unsaved', p, false],
    ['unsaved', { ...p, stored: 6 }, true], ['written', p, false], ['writable', p, true], ['writable', { ...p, access: 'R' as const }, false],
  ] as const)('%s', (mark, parameter, yes) => expect(isMarked(parameter, mark)).toBe(yes));
});

it('what is left out is counted by its reason', () => {
  expect(leftOut([{ parameter: 'a', why: 'read only' }, { parameter: 'b', why: 'address' }, { parameter: 'c', why: 'read only' }])).toEqual([{ why: 'read only', parameters: ['a', 'c'] }, { why: 'address', parameters: ['b'] }]);
});
