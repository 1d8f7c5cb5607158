// A parameter's range and what is typed for it: out of range tells the range; nothing is bent to fit.
import { describe, expect, it } from 'vitest';
import { fieldLines, fieldValue, rangeText, readValue, sameValue, searchRank, unitText, valueText, withField } from '../src/text/parameter';

const p = (change: object) => ({ type: 'u32', min: null, max: null, unit: null, allowed: null, ...change }) as Parameters<typeof readValue>[1];

describe('rangeText', () => {
  it.each([
    [{ min: 1, max: 65000000 }, '1 … 65\u202f000\u202f000'],
    [{ type: 'u8' }, '0 … 255'],
    [{ type: 'i16' }, '\u221232\u202f768 … 32\u202f767'],
    [{ type: 'i16', max: 100 }, '\u221232\u202f768 … 100'],
    [{ type: 'u8', min: -5, max: 1000 }, '0 … 255'],
    [{ type: 'f32', min: 0 }, 'from 0'],
    [{ type: 'f64', max: 2.5 }, 'up to 2.5'],
    [{ type: 'f32' }, 'number'],
    [{ type: 'i64' }, 'whole number'],
    [{ type: 'bool' }, '0, 1'],
    [{ type: 'text' }, 'text'],
    [{ allowed: [{ value: 0, meaning: 'nothing' }, { value: 2, meaning: 'origin' }] }, '0, 2'],
  ])('%o', (change, text) => expect(rangeText(p(change))).toBe(text));
});

describe('readValue', () => {
  it.each([
    [{ min: 1, max: 100 }, '50', 50], [{ type: 'i16' }, '-2', -2], [{ type: 'f32' }, '1.25', 1.25], [{ type: 'bool' }, 'on', true], [{ type: 'bool' }, '0', false],
    [{ type: 'text' }, ' as it is ', ' as it is '], [{ type: 'bytes' }, '0a ff', '0AFF'], [{ allowed: [{ value: 2, meaning: '' }] }, '2', 2], [{ type: 'u32' }, '0x10', 16],
  ])('%o takes %j', (change, text, value) => expect(readValue(text, p(change))).toEqual({ good: true, value }));
  it.each([
    [{ min: 1, max: 65000000, unit: 'pulse/s^2' }, '0', /0 is outside the range 1 … 65\u202f000\u202f000 pulse\/s²/],
    [{ min: 1, max: 100 }, '101', /outside the range 1 … 100/],
    [{ type: 'u8' }, '256', /0 … 255/],
    [{ type: 'u8' }, '1.5', /not a whole number.*0 … 255/],
    [{ allowed: [{ value: 0, meaning: '' }, { value: 2, meaning: '' }] }, '1', /Allowed: 0, 2/],
    [{ type: 'bool' }, '2', /1 \(on\) or 0 \(off\)/],
    [{ type: 'bytes' }, 'ABC', /pairs/],
    [{}, 'abc', /not a number/],
    [{}, '', /Type a number/],
  ])('%o refuses %j with the range', (change, text, why) => {
    const r = readValue(text, p(change));
    expect(r.good).toBe(false);
    if (!r.good) expect(r.why).toMatch(why);
  });
});

it('shows values with their meaning', () => {
  expect(valueText(2, { allowed: [{ value: 2, meaning: 'origin' }] })).toBe('2 = origin');
  expect(valueText(true, { allowed: null })).toBe('on');
  expect(valueText('', { allowed: null })).toBe('(empty)');
  expect(valueText(null, { allowed: null })).toBe('–');
});
it('does not say a value twice that its meaning says already', () => expect(valueText(17, { allowed: [{ value: 17, meaning: '17 bits' }] })).toBe('17 bits'));
it('tells code and meaning apart, and leaves out no code that the meaning only seems to say', () => {
  const say = (value: number, meaning: string) => valueText(value, { allowed: [{ value, meaning }] });
  expect(say(2, '500 kbit/s')).toBe('2 = 500 kbit/s');
  expect(say(5, '500 kbit/s')).toBe('5 = 500 kbit/s');
  expect(say(0, '0.1 A')).toBe('0 = 0.1 A');
  expect(say(28, '0.1 A')).toBe('28 = 0.1 A');
});
it.each([['AC', 0], ['a', 1], ['c', 2], ['profile accel', 3], ['profile_accel', 3], ['ramp', 4], ['zzz', null], ['', 0]])('the search for %j ranks %s', (text, rank) =>
  expect(searchRank({ id: 'AC', name: 'profile_acceleration', description: 'The ramp' }, text)).toBe(rank));
it('compares values as the drive means them', () => {
  expect(sameValue(0.1, Math.fround(0.1))).toBe(true);
  expect(sameValue(1, 2)).toBe(false);
  expect(sameValue(true, 1)).toBe(true);
  expect(sameValue(null, 0)).toBe(false);
});
it('writes units as people do', () => {
  expect(unitText('pulse/s^2')).toBe('pulse/s²');
  expect(unitText('deg C')).toBe('°C');
  expect(unitText(null)).toBe('');
});

describe('a number of parts', () => {
  const actions = [{ value: 0, meaning: 'no action' }, { value: 6, meaning: 'origin, then stop' }];
  const logic = p({
    type: 'u16',
    fields: [
      { name: 'falling_edge_action', low_bit: 0, bits: 7, allowed: actions },
      { name: 'flag', low_bit: 7, bits: 1, allowed: [{ value: 0, meaning: 'always' }, { value: 1, meaning: 'on a change' }] },
      { name: 'rising_edge_action', low_bit: 8, bits: 7, allowed: actions },
    ],
  });
  it('is told part by part', () => {
    expect(fieldLines(0x0680, logic)).toEqual(['falling edge action: no action', 'flag: on a change', 'rising edge action: origin, then stop']);
    expect(fieldLines(null, logic)).toEqual([]);
  });
  it('changes in one part alone', () => {
    const [falling, flag, rising] = logic.fields as NonNullable<typeof logic.fields>;
    expect(withField(0x8680, falling!, 6)).toBe(0x8686);
    expect(withField(0x8686, flag!, 0)).toBe(0x8606);
    expect(fieldValue(withField(0x8606, rising!, 0), rising!)).toBe(0);
  });
  it('is refused for one part, with what that part can be', () => {
    expect(readValue('5', logic)).toMatchObject({ good: false, why: expect.stringMatching(/5 as falling edge action. Allowed: 0 \(no action\), 6 \(origin, then stop\)/) });
    expect(readValue('1670', logic)).toEqual({ good: true, value: 0x0686 });
  });
  it('has words for ranges of values', () => {
    const meanings = [{ from: 0, through: 0, meaning: 'continuous' }, { from: 1, through: 60000, meaning: 'filter, ms' }];
    expect(valueText(100, { allowed: null, meanings })).toBe('100 = filter, ms');
  });
});
