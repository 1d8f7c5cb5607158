// Options of a family as fields: ranges, defaults, switches, values with commas, what the family does not know; and what an increment is.
import { afterEach, describe, expect, it } from 'vitest';
import { families as told } from '../dev/mock/families.mjs';
import { familyOf, incrementHint, optionFault, optionField, optionsFor, optionsFrom, optionsTitle, optionTexts, unknownOptions, type Family, type OptionSpec } from '../src/text/options';
import { speak } from '../src/language';
import { incrementsOf, incrementsText } from '../src/text/increments';
import { parseQuantity } from '../src/text/number';
import { editText, fileText, readValue } from '../src/text/parameter';
import { checkEntry, textsOfEntry, type Entry, type Site } from '../src/text/site';

const families = new Map((told as Family[]).map((f) => [f.name, f]));
const uim = optionsFor(families.get('uim342'), 'drives');
const spec = (name: string, room: 'lines' | 'drives' = 'drives', family = 'uim342') => {
  const o = optionsFor(families.get(family), room).find((x) => x.name === name);
  if (!o) throw new Error(`no ${name}`);
  return o;
};
const site: Site = { lines: [{ name: 'can0', uri: 'twin', family: 'uim342' }], drives: [{ name: 'f', line: 'can0', address: 5, options: { notify: 'on', old_one: 'a=b,c' } }], axes: [{ name: 'f', drive: 'f', number: 1 }] };

describe('the options of a family', () => {
  it('stand at a line or a drive, with those of its twins', () => {
    expect(uim.map((o) => o.name)).toEqual(['crc', 'notify', 'home_input', 'home_timeout_s', 'boot_ms', 'reply_ms', 'notices']);
    expect(optionsFor(families.get('uim342'), 'lines').map((o) => o.name)).toEqual(['crc', 'boot_ms', 'reply_ms', 'notices']);
    expect(optionsFor(families.get('uim342'), 'axes')).toEqual([]);
    expect(optionsFor(undefined, 'drives')).toEqual([]);
  });
  it('have the freedoms of its twin among them, once each', () => {
    expect(optionField(spec('reply_ms'), 'drives')).toMatchObject({ kind: 'integer', min: 0, max: 200, hint: 'Of its twin. an answer is sent this long after its request. 0 to 200 ms. default 0 ms.' });
    expect(optionField(spec('notices'), 'drives')).toMatchObject({ kind: 'choice', hint: 'Of its twin. the end of a motion is told without a question; 0: off; 1: on. 0 to 1. default 1.' });
    const both: Family = { name: 'x', options: [{ name: 'boot_ms', of: ['twin'], default: null, description: '' }], freedoms: [{ name: 'boot_ms', unit: 'ms', min: 0, max: 9, default: 0, values: {}, named: {}, source: '', description: '' }] };
    expect(optionsFor(both, 'drives')).toHaveLength(1);
  });
  it('are fields with their range, default and description', () => {
    expect(optionField(spec('home_timeout_s'), 'drives')).toEqual({ key: 'options.home_timeout_s', label: 'Home timeout, s', kind: 'integer', min: 1, max: 3600, placeholder: '60 s', hint: 'the search is given up and stopped after that. 1 to 3600 s. default 60 s.' });
    expect(optionField(spec('notify'), 'drives').choices?.map((c) => c.value)).toEqual(['', 'on', 'off']);
    expect(optionField(spec('notify'), 'drives').choices?.[0]?.text).toBe('default: off');
    expect(optionField(spec('home_input'), 'drives').hint).toBe('input of the home or limit switch. 1 to 3. not given: as described.');
    expect(optionField(spec('boot_ms', 'lines'), 'lines').hint).toMatch(/^Of all twins of this line\. /);
    expect(optionField(spec('boot_ms'), 'drives').hint).toMatch(/^Of its twin\. /);
    expect(optionField(spec('crc', 'lines'), 'lines').hint).toMatch(/^bytes under/);
    expect(optionField(spec('pad', 'lines', 'mcode'), 'lines').choices?.map((c) => c.value)).toEqual(['', 'on', 'off']);
    expect(optionField(spec('reference_order', 'drives', 'pacontrol'), 'drives')).toMatchObject({ kind: 'text', placeholder: '' });
  });
  it.each([
    ['home_input', '', ''], ['home_input', '2', ''], ['home_input', '4', '1 to 3.'], ['home_input', '0', '1 to 3.'], ['home_input', '1.5', 'A whole number.'], ['home_input', 'x', 'A whole number.'],
    ['notify', 'on', ''], ['notify', 'yes', 'One of on, off.'],
  ])('%s: "%s" is judged: %s', (name, text, why) => expect(optionFault(spec(name), text)).toBe(why));
});

describe('what is typed for them', () => {
  it('comes back as it was where it was not touched, commas and all; unknown ones stay until they are emptied', () => {
    const own = site.drives?.[0] as Entry;
    const texts = textsOfEntry('drives', own);
    expect(optionTexts(own.options)).toEqual({ 'options.notify': 'on', 'options.old_one': 'a=b,c' });
    expect(unknownOptions(texts, uim)).toEqual(['old_one']);
    expect(checkEntry('drives', texts, site, own, uim).entry).toEqual({ presence: 'auto', ...own });
    expect(checkEntry('drives', { ...texts, 'options.old_one': '', 'options.home_input': '2' }, site, own, uim).entry?.options).toEqual({ notify: 'on', home_input: '2' });
    expect(checkEntry('drives', { ...texts, 'options.old_one': '', 'options.notify': '' }, site, own, uim).entry).not.toHaveProperty('options');
    expect(optionsFrom({ 'options.n': '5', 'options.t': 'true', 'options.z': '6' }, { n: 5, t: true, z: 5 })).toEqual({ n: 5, t: true, z: '6' });
  });
  it('is refused beside its field', () => {
    const { entry, faults } = checkEntry('drives', { name: 'g', line: 'can0', 'options.home_input': '9' }, site, null, uim);
    expect([entry, faults]).toEqual([null, { 'options.home_input': '1 to 3.' }]);
  });
  it('is summed up', () => {
    expect(optionsTitle('uim342', uim, { 'options.notify': 'on', 'options.home_input': ' ' })).toBe('Options of uim342: 7; set: notify');
    expect(optionsTitle('uim342', uim, {})).toBe('Options of uim342: 7, none set');
    expect(optionsTitle('', [], {})).toBe('Options');
  });
});

it('the family of an entry is its own, its line’s, or its drive’s line’s', () => {
  expect([familyOf('lines', { family: 'x' }, site), familyOf('drives', { line: 'can0' }, site), familyOf('axes', { drive: 'f' }, site), familyOf('axes', { drive: '?' }, site)]).toEqual(['x', 'uim342', 'uim342', '']);
});
it('an increment is said in the family’s own words', () => {
  expect(incrementHint(families.get('uim342'), 'mm')).toBe('how many increments of the drive make one mm; one increment of uim342 is one pulse');
  expect(incrementHint(families.get('pacontrol'), '')).toBe('how many increments of the drive make one unit; one increment of pacontrol is 0.001 AE');
  expect(incrementHint(undefined, 'mm')).toBe('how many increments of the drive make one mm');
});
it('who may hold an axis goes into the member that the gateway reads', () => {
  const own = { name: 'f', drive: 'f', number: 1, authority_mode: 'lease' } as Entry;
  expect(textsOfEntry('axes', own).authority_mode).toBe('lease');
  expect(checkEntry('axes', { ...textsOfEntry('axes', own), authority_mode: 'free' }, site, own).entry?.authority_mode).toBe('free');
});

describe('figures of fields, in each language', () => {
  afterEach(() => speak('en'));
  const whole: readonly OptionSpec[] = [{ name: 'n', of: ['drive'], min: 0, max: 60000, unit: 'ms', default: 1500, description: 'a time' } as unknown as OptionSpec];
  it.each([['en', '1.5', '3200.25', '0.04'], ['zh', '1.5', '3200.25', '0.04'], ['de', '1,5', '3200,25', '0,04']] as const)('%s: an option, increments and a parameter are written and read back alike', (language, option, increments, parameter) => {
    speak(language);
    const texts = optionTexts({ n: 1.5, list: '1:0.5,2:4' });
    expect(texts).toEqual({ 'options.n': option, 'options.list': '1:0.5,2:4' });
    expect(optionsFrom(texts, { n: 1.5, list: '1:0.5,2:4' })).toEqual({ n: 1.5, list: '1:0.5,2:4' });
    expect(optionsFrom({ 'options.n': increments }, { n: 1.5 })).toEqual({ n: '3200.25' });
    expect(incrementsText(3200.25)).toBe(increments);
    expect(parseQuantity(incrementsText(3200.25))).toEqual({ good: true, value: 3200.25 });
    expect(incrementsOf({ per_turn: '200', microsteps: '16', motor_turns: '1', output_turns: '1', travel: option })).toMatchObject({ good: true, value: 3200 / 1.5 });
    expect(editText(0.04)).toBe(parameter);
    expect(readValue(editText(0.04), { type: 'f32', unit: null, allowed: null, min: null, max: null } as never)).toEqual({ good: true, value: 0.04 });
    expect(fileText(0.04), 'files keep the point').toBe('0.04');
  });
  it('a whole number may be grouped as the reader does it, and goes to the gateway without', () => {
    speak('de');
    expect(optionFault(whole[0] as OptionSpec, '10.000,0')).toBe('');
    expect(optionsFrom({ 'options.n': '10 000' }, {}, whole)).toEqual({ n: '10000' });
    expect(optionFault(whole[0] as OptionSpec, '1,5')).toBe('A whole number.');
    expect(optionField(whole[0] as OptionSpec, 'drives').hint).toContain('0 to 60\u202f000 ms');
  });
});
