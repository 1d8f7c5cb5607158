// Profiles in words: what is typed becomes an entry or faults by field; registers of a language as rows. All pure.
import { describe, expect, it } from 'vitest';
import type { Language } from '../src/api/profiles';
import { instanceText, profileText, readProfile, registerRows } from '../src/text/profile';

const register = (address: number, more: object = {}) => ({ tables: ['holding_registers' as const, 'input_registers' as const], address, type: 'i32' as const, access: 'RW' as const, name: 'MA', description: 'moves', axis: null, min: null, max: null, object: null, ...more });
const languages: Language[] = [
  { language: 'lexium', title: 'Lexium MCode', description: '', source: '', word_order: 'low_first', axes: 1, registers: [register(67, { access: 'W' })] },
  { language: 'pacontrol', title: 'PA-CONTROL', description: '', source: '', word_order: 'high_first', axes: 8, registers: [register(0, { type: 'u16', tables: ['input_registers'], access: 'R' }), register(8, { axis: 1 }), register(14, { axis: 2 })] },
];
const draft = { unit: '10', language: 'lexium', axes: ['feeder'], counts: '', velocity: '', acceleration: '', input: '', output: '', object: '' };

describe('what is typed', () => {
  it('becomes an entry; what is left empty is left out', () => {
    expect(readProfile(draft, languages, new Map())).toEqual({ unit: 10, entry: { language: 'lexium', axes: [{ axis: 'feeder' }] } });
    expect(readProfile({ ...draft, counts: '51200', velocity: '2.5' }, languages, new Map())).toEqual({ unit: 10, entry: { language: 'lexium', axes: [{ axis: 'feeder', counts_per_unit: 51200, velocity: 2.5 }] } });
    expect(readProfile({ ...draft, language: 'pacontrol', axes: ['feeder', 'lift', ''] }, languages, new Map())).toMatchObject({ entry: { axes: [{ axis: 'feeder' }, { axis: 'lift' }] } });
  });
  it('says where it stands on EtherNet/IP; objects belong to a Lexium alone', () => {
    const places = { input: '210', output: '310', object: '1' };
    expect(readProfile({ ...draft, ...places }, languages, new Map())).toMatchObject({ entry: { input_assembly: 210, output_assembly: 310, object_instance: 1 } });
    expect(readProfile({ ...draft, ...places, language: 'pacontrol' }, languages, new Map())).not.toHaveProperty('entry.object_instance');
    expect(instanceText({ unit: 10, language: 'lexium', axes: [{ axis: 'a' }], input_assembly: 210, object_instance: 1 })).toBe('input assembly 210, objects with instance 1');
  });
  it.each([
    [{ unit: '1' }, { unit: 'A whole number from 2 to 254.' }], [{ unit: '' }, { unit: 'A whole number from 2 to 254.' }], [{ unit: '12' }, { unit: 'Unit 12 has mappings.' }],
    [{ language: '' }, { language: 'Choose a language.' }], [{ axes: [''] }, { axes: 'Choose an axis.' }], [{ axes: ['a', 'b'] }, { axes: 'Lexium MCode has one axis.' }],
    [{ language: 'pacontrol', axes: ['a', 'a'] }, { axes: 'Each axis once.' }], [{ counts: '0' }, { counts: 'A number above 0, or nothing.' }], [{ acceleration: 'fast' }, { acceleration: 'A number above 0, or nothing.' }],
    [{ input: '70000' }, { input: 'A whole number from 1 to 65535, or nothing.' }], [{ object: '1.5' }, { object: 'A whole number from 1 to 255, or nothing.' }], [{ object: '256' }, { object: 'A whole number from 1 to 255, or nothing.' }],
  ])('%o is told at its field', (change, faults) => expect(readProfile({ ...draft, ...change }, languages, new Map([[12, 'mappings']]))).toEqual({ faults }));
});

describe('what is shown', () => {
  it('says what the entry says of its axes', () => expect(profileText({ unit: 10, language: 'lexium', axes: [{ axis: 'feeder', counts_per_unit: 51200, acceleration: 500 }, { axis: 'lift' }] })).toBe('feeder (51200 counts per unit, 500 units/s²), lift'));
  it('lists the registers of the axes that are there, in the addresses of the page', () => {
    expect(registerRows(languages[1]!, 1, '0').map((r) => [r.where, r.access])).toEqual([['0', 'read, input register'], ['8, 9', 'read and write']]);
    expect(registerRows(languages[0]!, 1, '1').map((r) => [r.where, r.access])).toEqual([['40068, 40069', 'write']]);
  });
});
