// The words of an axis: every state has its own word and icon; nothing old is said as if it were live.
import { describe, expect, it } from 'vitest';
import type { AxisStateName } from '../src/api/types';
import { hex, markOf, motionWord, noticeOf, positionText, stateWord, statusBits } from '../src/text/axis';
import { axis } from './fixtures';

const states: AxisStateName[] = ['not_ready_to_switch_on', 'switch_on_disabled', 'ready_to_switch_on', 'switched_on', 'operation_enabled', 'quick_stop_active', 'fault_reaction_active', 'fault'];

describe('state', () => {
  it('has a different word for every state, and an icon beside the colour', () => {
    const words = states.map((state) => stateWord(axis({ state }), 'live'));
    expect(new Set(words.map((w) => w.text)).size).toBe(states.length);
    for (const w of words) expect(w.icon).toBeTruthy();
  });
  it.each(states)('%s is told in the past while the page is not connected', (state) => {
    const w = stateWord(axis({ state }), 'disconnected');
    expect(w.text).toMatch(/^Was /);
    expect(w.tone).toBe('muted');
  });
  it('of an offline axis is Offline, whatever the last state was', () => expect(stateWord(axis(), 'offline').text).toBe('Offline'));
});

describe('motion', () => {
  it.each([
    [{ moving: true, velocity: 5 }, 'live', 'Moving', 'arrow-right'],
    [{ moving: true, velocity: -5 }, 'live', 'Moving', 'arrow-left'],
    [{ moving: true, velocity: 5, mode: 'homing' }, 'live', 'Homing', 'arrow-right'],
    [{ target_reached: true }, 'live', 'In position', 'target'],
    [{}, 'live', 'At rest', 'pause'],
    [{ target_reached: true, state: 'fault' }, 'live', 'At rest', 'pause'],
    [{ target_reached: true, state: 'fault_reaction_active' }, 'live', 'At rest', 'pause'],
    [{ target_reached: true, fault: true }, 'live', 'At rest', 'pause'],
    [{ moving: true }, 'stale', 'Stale', 'clock'],
    [{ moving: true }, 'offline', 'Not known', 'circle-dashed'],
    [{ moving: true }, 'disconnected', 'Not live', 'unplugged'],
  ] as const)('%o, %s: %s', (change, trust, text, icon) => expect(motionWord(axis(change), trust)).toMatchObject({ text, icon }));
});

describe('mark', () => {
  it.each([['twin', 'SIMULATED'], ['device', 'REAL'], ['offline', 'NO DRIVE']] as const)('%s is %s', (presence, text) => expect(markOf(axis({ presence })).text).toBe(text));
});

describe('notice', () => {
  const fault = axis({ fault: true, error: { code: 8, text: 'the motor is stalled' } });
  it('tells a fault with code and text', () => expect(noticeOf(fault, 'live', '', '').text).toBe('Fault 8: the motor is stalled'));
  it('tells a fault without text too', () => expect(noticeOf(axis({ fault: true, error: { code: 3, text: '' } }), 'live', '', '').text).toContain('Fault 3'));
  it('tells the loss of the connection before anything else', () => expect(noticeOf(fault, 'disconnected', '', '12 s').text).toBe('Not live: last known 12 s ago'));
  it('tells why an axis is offline', () => expect(noticeOf(axis(), 'offline', 'no answer from address 5', '').text).toBe('Offline: no answer from address 5'));
  it('tells of stale data', () => expect(noticeOf(axis(), 'stale', '', '').text).toMatch(/^Stale/));
  it.each([
    [{ internal_limit: true }, 'A limit is active'],
    [{ warning: true }, 'Warning'],
    [{ referenced: false }, 'No error. Not referenced'],
    [{ error: { code: 5, text: '' } }, 'Error 5: the drive says no more'],
  ])('of %j is %s', (change, text) => expect(noticeOf(axis({ referenced: true, ...change }), 'live', '', '').text).toBe(text));
  it('of an axis that nobody serves says so', () => expect(noticeOf(axis(), 'offline', '', '').text).toBe('Offline: nobody answers'));
  const stopped = (stop_latch: number, change = {}) => axis({ referenced: true, stop_latch, stop_latch_by: null, fail_safe_cause: null, ...change });
  const controller = 'A controller that repeats its words does not move it: it has to change them.';
  it.each([
    [stopped(0b101, { stop_latch_by: 'modbus 192.0.2.7' }), 'Stopped by 192.0.2.7 (modbus). Enable it and order a new motion.'],
    [stopped(0b101, { stop_latch_by: 'http anna page-1a2b3c' }), 'Stopped by anna (http). Enable it and order a new motion.'],
    [stopped(0b101, { stop_latch_by: 'http 127.0.0.1 page-mine00' }), 'Stopped by this page. Enable it and order a new motion.'],
    [stopped(0b101), 'Stopped by another client. Enable it and order a new motion.'],
    [stopped(0b011), 'Stopped by the gateway. Enable it and order a new motion.'],
    [stopped(0b011, { fail_safe_cause: 'modbus_silent' }), 'Stopped by the gateway (Modbus client silent). Enable it and order a new motion.'],
    [stopped(0b1001), 'Stopped by a safe input. Give the input back, then enable the axis.'],
  ])('tells whose stop is latched and who has to do what: %#', (a, text) => expect(noticeOf(a, 'live', '', '', 'page-mine00')).toMatchObject({ text, long: `${text} ${controller}`, tone: 'warning' }));
  it('tells a fault before a latched stop, and the stop behind it', () => {
    expect(noticeOf(stopped(0b011, { fault: true, error: { code: 8, text: 'the motor is stalled' } }), 'live', '', '')).toMatchObject({ text: 'Fault 8: the motor is stalled', long: `Fault 8: the motor is stalled. Stopped by the gateway. Enable it and order a new motion. ${controller}` });
    expect(noticeOf(stopped(0), 'live', '', '').text).toBe('No error. Referenced');
  });
  it('says when nothing is wrong', () => expect(noticeOf(axis({ referenced: true }), 'live', '', '').text).toBe('No error. Referenced'));
});

it('shows the position with the places that the resolution is worth', () => {
  expect(positionText(axis({ position: 100 }))).toBe('100.000');
  expect(positionText(axis({ position: 100, increments_per_unit: 1 }))).toBe('100');
  expect(positionText(axis({ position: null }))).toBe('–');
});
it('names all 16 bits of the status word', () => expect(statusBits.map((b) => b.bit)).toEqual([...Array(16).keys()]));
it('writes hex with fixed digits, unsigned', () => {
  expect(hex(0x237, 4)).toBe('0x0237');
  expect(hex(-1, 8)).toBe('0xFFFFFFFF');
});
