// Small words: a restore that waits, a snapshot and its family, an event in the axis' unit, the type and unit that a mapped value has by itself.
import { describe, expect, it } from 'vitest';
import { groupsOf, inUnits } from '../src/text/event';
import { allowedText } from '../src/text/register-map';
import type { GatewayEvent } from '../src/api/types';
import { points } from './fixtures';
import { plain } from '../src/text/plain';
import { naturalType, valueUnit } from '../src/text/mapping-type';
import type { Known } from '../src/text/mapping';
import { pendingText, sizeText } from '../src/text/site-files';
import { axisChoice, foreignText, snapshotChoice, snapshotText } from '../src/text/snapshot';
import { clockTime, dateTime } from '../src/text/time';

const at = '2026-03-01T10:11:12Z';
const titles = new Map([['uim342', 'UIROBOT UIM342']]);

it('a restore that waits says when, who, how large, what it brings, and what goes', () => {
  expect(pendingText({ waiting: true, at, who: 'anna 10.0.0.2', bytes: 319_488, version: 5, site_revision: 7 })).toBe(`Laid down ${clockTime(at)} by anna 10.0.0.2, 312 KiB. It brings site revision 7 with it, and a database of structure 5. Site, mappings, parameters, snapshots, recipes, events, users and tokens of now go with that start.`);
  expect(pendingText({ waiting: true, at: null, who: null, bytes: null, version: null, site_revision: null })).toMatch(/^Laid down\. Site,/);
  expect([sizeText(5), sizeText(2048), sizeText(3_500_000)]).toEqual(['5 bytes', '2 KiB', '3.3 MiB']);
});

describe('a snapshot', () => {
  const s = { n: 1, name: 'first', at, who: 'anna', family: 'uim342', values: 58, comment: 'as delivered' };
  it('says when, of what, how much, by whom', () => {
    expect(snapshotText(s, titles)).toBe(`${clockTime(at)} · UIROBOT UIM342 (uim342) · 58 values · by anna · as delivered`);
    expect(snapshotText({ n: 1, name: 'x', family: null, values: 1 }, titles)).toBe('family not known: taken by an older program · 1 value');
  });
  it('of another family says why it is of no use, everywhere; one that nobody knows is not barred', () => {
    expect(foreignText(s, 'uim342', titles)).toBe('');
    expect(foreignText({ ...s, family: null }, 'mcode', titles)).toBe('');
    expect(foreignText(s, 'mcode', titles)).toBe('Taken of UIROBOT UIM342 (uim342); the drive is mcode now, so it is neither compared nor restored.');
    expect(snapshotChoice(s, '1', 'mcode')).toEqual({ value: '1', text: 'snapshot first: of uim342, not comparable', disabled: true });
    expect(snapshotChoice(s, '1', 'uim342')).toEqual({ value: '1', text: 'snapshot first' });
    expect([axisChoice('b', 'mcode', 'uim342').text, axisChoice('b', 'uim342', 'uim342').text]).toEqual(['axis b: mcode, not comparable', 'axis b, values known now']);
  });
});

it.each([
  ['move_relative 16000', 'move by 5.000 mm (16 000 increments)'],
  ['move_velocity -32000', 'move at −10.000 mm/s (−32 000 increments/s)'],
  ['interrupted: axis feeder has stopped before its target (at 3200 increments)', 'interrupted: axis feeder has stopped before its target at 1.000 mm (3200 increments)'],
  ['enable', 'enable'],
  ['AC 16000', 'AC 16000'],
])('an event says %s in the unit of its axis', (text, published) => {
  expect(inUnits(text, { unit: 'mm', increments_per_unit: 3200 }).replaceAll('\u202f', ' ')).toBe(published.replaceAll('16 000', '16 000'));
  expect(inUnits(text, { unit: '', increments_per_unit: 1 })).toBe(plain(text));
  expect(inUnits(text, undefined)).toBe(plain(text));
});

describe('a mapped value by itself', () => {
  const known: Known = { axes: ['a'], points, parameters: () => ['MT', 'AC'], parameter: (_, id) => (id === 'MT' ? { type: 'u8', unit: null } : id === 'AC' ? { type: 'u32', unit: 'pulse/s^2' } : null) };
  it.each([['position', 'i32'], ['statusword', 'u16'], ['position_units', 'f32'], ['moving', 'bool'], ['mode', 'i16'], ['AC', 'u32'], ['MT[3]', 'u16'], ['toString', null], ['', null], ['nothing', null]])('%s is %s', (point, type) => {
    expect(naturalType('a', point, known)).toBe(type);
  });
  it('has a unit', () => {
    expect(['position_units', 'velocity', 'statusword', 'AC', 'MT[3]', 'nothing'].map((p) => valueUnit({ unit: 'mm' }, 'a', p, known))).toEqual(['mm', 'inc/s', '', 'pulse/s²', '', '']);
  });
});

describe('many writes of one go are one entry', () => {
  const at = (n: number) => new Date(1_700_000_000_000 + n * 1000).toISOString();
  const write = (id: number, s: number, change: object = {}) => ({ id, at: at(s), kind: 'write', severity: 'info', axis: 'feeder', who: 'anna', door: 'http', parameter: `P${id}`, text: '', ...change }) as unknown as GatewayEvent;
  const ids = (events: GatewayEvent[]) => groupsOf(events).map((g) => g.map((e) => e.id).join(' '));
  it('from four on, of one axis by one person, each soon after the other', () => {
    expect(ids([write(5, 9), write(4, 7), write(3, 6), write(2, 4), write(1, 2)])).toEqual(['5 4 3 2 1']);
    expect(ids([write(3, 3), write(2, 2), write(1, 1)])).toEqual(['3', '2', '1']);
    expect(ids([write(5, 20), write(4, 4), write(3, 3), write(2, 2), write(1, 1)])).toEqual(['5', '4 3 2 1']);
  });
  it.each([[{ axis: 'gripper' }], [{ who: 'bert' }], [{ severity: 'alarm' }], [{ kind: 'command' }], [{ door: 'modbus' }], [{ who: '' }]])('%j stands between, by itself', (other) =>
    expect(ids([write(9, 9), write(8, 8), write(7, 7), write(6, 6), write(5, 5, other), write(4, 4), write(3, 3), write(2, 2), write(1, 1)])).toEqual(['9 8 7 6', '5', '4 3 2 1']));
});

it.each([
  [[], '0.0.0.0:502', 'everywhere'], [['10.0.0.0/8', '::1'], '0.0.0.0:502', '10.0.0.0/8, ::1'], [[], '127.0.0.1:1502', 'this machine alone: the door listens at 127.0.0.1:1502'],
  [[], '[::1]:502', 'this machine alone: the door listens at [::1]:502'], [['10.0.0.0/8'], '127.0.0.1:502', 'this machine alone: the door listens at 127.0.0.1:502'], [[], '[::]:502', 'everywhere'],
])('allowed %j at %s: %s', (allow, bind, text) => expect(allowedText(allow, bind)).toBe(text));

it('says the day of what is kept, also of today', () => {
  const now = new Date();
  expect(clockTime(now.toISOString(), now)).toMatch(/^\d\d:\d\d:\d\d$/);
  expect(dateTime(now.toISOString())).toMatch(new RegExp(`^${now.getFullYear()}-\\d\\d-\\d\\d \\d\\d:\\d\\d:\\d\\d$`));
});
