// Sentences about sites on trial, steps of a unit, recipes without their axis, what a restore leaves out, who commanded last. Pure words.
import { describe, expect, it } from 'vitest';
import { scanText } from '../src/components/scan';
import { commandedText } from '../src/text/authority';
import { plain, plainWord } from '../src/text/plain';
import { readValue, steppedText, unitText } from '../src/text/parameter';
import { doneOf, unknownAxes, unknownText } from '../src/text/recipe';
import { leftOut, parametersText } from '../src/text/transfer';
import { appliedText, applyBarred, closedText, disturbedText } from '../src/text/trial';

describe('a site on trial', () => {
  const anna = { by: 'anna 10.0.0.7', client: 'anna page-1a2b3c' };
  it('says whose it is, and why it cannot be kept here', () => {
    expect(appliedText(anna, 'page-1a2b3c', '')).toBe('Applied by this page.');
    expect(appliedText(anna, 'page-999999', 'Only she.')).toBe('Applied by anna (from the page page-1a2b3c). Only she.');
    expect(appliedText({ by: 'local 127.0.0.1', client: '127.0.0.1' }, 'page-999999', '')).toBe('Applied by somebody at 127.0.0.1.');
  });
  it('does not disturb what it removes, and says that what moves of either is stopped first', () => {
    const site = (...names: string[]) => ({ axes: names.map((name) => ({ name })) });
    expect(closedText([])).toBe('');
    expect(closedText(undefined)).toBe('');
    expect(closedText([{ id: 'enip-1', kind: 'exclusive_owner', peer: '192.0.2.7:50000', axes: ['lift'] }, { id: 'enip-2', kind: 'input_only', peer: '192.0.2.8:1', axes: [] }])).toBe(
      'Applying closes EtherNet/IP connections, because their bytes change: 192.0.2.7:50000 (commands lift); 192.0.2.8:1.',
    );
    expect(closedText(null)).toContain('could not be asked');
    expect(disturbedText(['a', 'b'], site('a', 'b', 'c'), site('b', 'c'))).toBe('Applying removes a. Applying disturbs for a moment: b. What of it moves is stopped first.');
    expect([disturbedText([], site('a'), site('a')), disturbedText(['a'], site('a'), site())]).toEqual(['', 'Applying removes a. What of it moves is stopped first.']);
  });
  it('that cannot be applied yet says what to do', () => {
    expect([applyBarred({ inView: false, theirs: false, faults: false }), applyBarred({ inView: false, theirs: false, faults: true }), applyBarred({ inView: false, theirs: true, faults: true })]).toEqual(['Check first.', 'Mend the faults, then check again.', 'Decide first about what somebody else has changed.']);
  });
});

describe('a unit that is counted in steps', () => {
  it('never reads as a quantity, and says what it comes to', () => {
    expect([unitText('0.1 A'), steppedText(10, '0.1 A'), steppedText(3, '0.1 A'), steppedText(5, '100 ms'), steppedText(-3, '0.01 mm/s^2')]).toEqual(['× 0.1 A', '= 1.0 A', '= 0.3 A', '= 500 ms', '= −0.03 mm/s²']);
    expect([unitText('pulse/s^2'), steppedText(10, 'A'), steppedText(10, null), steppedText(null, '0.1 A')]).toEqual(['pulse/s²', '', '', '']);
  });
  it('is typed as the drive counts it', () => {
    expect(readValue('30', { type: 'u8', min: 0, max: 28, unit: '0.1 A', allowed: null })).toEqual({ good: false, why: '30 is outside the range 0 … 28 × 0.1 A.' });
  });
});

describe('a recipe', () => {
  const d = { parameters: { which: { type: 'axis', default: 'gone' }, free: { type: 'axis' } }, steps: [{ enable: { axis: 'a' } }, { enable: { axis: 'nobody' } }, { if: { condition: { axis: 'ghost', point: 'moving', is: true }, then: [{ home: { axis: '${which}' } }], else: [{ home: { axis: '${free}' } }] } }, { check: { axis: 'spirit', point: 'fault', is: false } }, { wait_s: 1 }] };
  it('says which steps name an axis that is not there', () => {
    expect(unknownAxes(d, ['a']).map((u) => `${u.pointer} ${u.title} ${u.axis}`)).toEqual(['/steps/1 Step 2 nobody', '/steps/2 Step 3 ghost', '/steps/2/if/then/0 Step 3 then 1 gone', '/steps/3 Step 4 spirit']);
    expect(unknownText(unknownAxes(d, ['a']).slice(0, 1))).toBe('Step 2 names nobody, which is no axis of this site. A run would be refused.');
    expect(unknownAxes(d, ['a', 'nobody', 'ghost', 'gone', 'spirit'])).toEqual([]);
  });
  it('whose run ended before its end was not carried out to its end', () => {
    const at = (state: string, begun: number) => doneOf({ state, of: 3, begun });
    expect([at('done', 3), at('failed', 3), at('cancelled', 1), at('cancelled', 0), at('interrupted', 9), at('running', 2)]).toEqual([3, 2, 0, 0, 2, 2]);
  });
});

it('what a restore leaves out is said in the words of the form', () => {
  const live = 'it acts at once and is no setting (motion_parameter_group): it is written only with include_live';
  expect(leftOut([{ parameter: 'A', why: live }, { parameter: 'B', why: live.replace('motion_parameter_group', 'other') }, { parameter: 'C', why: 'read_only' }])).toEqual([
    { why: 'acts at once and is no setting; written with “Restore also what acts at once”', parameters: ['A', 'B'] },
    { why: 'read only', parameters: ['C'] },
  ]);
  expect([parametersText(1), parametersText(2)]).toEqual(['1 parameter', '2 parameters']);
});

it('who commanded last is no holder', () => {
  expect([commandedText('none', ''), commandedText('http', ''), commandedText('http', 'http anna page-1a2b3c'), commandedText('none', 'ethernet_ip 10.0.0.7'), commandedText('http', 'http 127.0.0.1 page-1a2b3c', 'page-1a2b3c')]).toEqual(['nobody has commanded it', 'last commanded by http', 'last commanded by anna (http)', 'last commanded by 10.0.0.7 (ethernet/ip)', 'last commanded by this page']);
});

it('a scan without addresses says how the drives were found', () => {
  const r = { asked: 0, of: 0, state: 'done' as const, text: '', found: [{ address: 'com1', family: 'pacontrol' }] as never[] };
  expect(scanText(r)).toBe('The line was asked as a whole, not address by address: done, 1 found');
  expect(scanText({ ...r, asked: 3, of: 8, found: [] })).toBe('3 of 8 addresses asked, done, 0 found');
});

it('words of the API are told as people say them, names and places are left alone', () => {
  expect(plain('axis feeder is switch_on_disabled now; a new set-point needs operation_enabled')).toBe('axis feeder is disabled now; a new set-point needs enabled');
  expect(plain('wait_for: 30 s are over')).toBe('wait for: 30 s are over');
  expect(plain('see /steps/2/wait_for and "move_relative"')).toBe('see /steps/2/wait_for and "move_relative"');
  expect([plainWord('fault_cleared'), plainWord('switch_on_disabled')]).toEqual(['fault cleared', 'disabled']);
});
