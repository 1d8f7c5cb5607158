// Fail-safe in words: causes, what an axis has named, one change, the cells of a rehearsal. All pure.
import { describe, expect, it } from 'vitest';
import type { Cell, FailSafeRow } from '../src/api/fail-safe';
import { actionChoices, causeHint, causeText, cellHeads, cellRow, changed, limitsText, namedText, readWatchdog, watchdogText } from '../src/text/fail-safe';

const none: FailSafeRow['drive_watchdog'] = { available: false, state: null, time_ms: null, action: null, description: 'The manual names none.' };
const noLimits: FailSafeRow['drive_limits'] = { available: false, wanted: true, state: null, refusal: null, description: 'The manual names limit switches.' };
const row = (fail_safe: FailSafeRow['fail_safe']): FailSafeRow => ({ axis: 'feeder', fail_safe, watchdog_ms_in_force: 5000, last_cause: null, drive_watchdog: none, drive_limits: noLimits });
const cell: Cell = { axis: 'feeder', cause: 'modbus_closed', chosen: null, taken: 'halt', motion: 'velocity', speed: 10, noticed_ms: 0.12, reaction_ms: 14.6, standstill_ms: 105, watched_ms: 2000, travel: 1.23456, text: '' };

describe('words', () => {
  it('names causes, also one that this page does not know yet', () => expect([causeText('enip_timed_out'), causeText('dds_deadline'), causeText('gateway_gone'), causeText('moon_full')]).toEqual(['EtherNet/IP connection timed out', 'DDS deadline missed', 'Gateway without supply', 'moon full']));
  it('says the default with each cause', () => {
    const of = (a: 'halt' | 'quick_stop', b: 'nothing' | 'quick_stop') => actionChoices({ cause: 'line_lost', number: 8, description: '', default_endless: a, default_to_a_target: b })[0]!.text;
    expect(of('halt', 'nothing')).toBe('default: halt');
    expect(of('quick_stop', 'quick_stop')).toBe('default: quick stop');
  });
  it('says when a cause is, without a word of the API', () => {
    const hint = (b: 'halt' | 'nothing') => causeHint({ cause: 'modbus_silent', number: 2, description: 'it has asked nothing for longer than watchdog_ms', default_endless: 'halt', default_to_a_target: b });
    expect(hint('halt')).toBe('it has asked nothing for longer than the time below');
    expect(hint('nothing')).toMatch(/below\. By default a motion to a target goes on\.$/);
  });
  it('says what an axis has named', () => {
    expect(namedText(row({ modbus_closed: null }))).toBe('all as by default');
    expect(namedText(row({ modbus_closed: 'quick_stop', enip_idle: 'disable', watchdog_ms: 800 }))).toBe('Modbus connection closed: quick stop; EtherNet/IP scanner idle: switch off; Modbus clients watched for 800 ms');
  });
  it('says what the drive does by itself', () => {
    const text = (w: Partial<typeof none>) => watchdogText({ ...row({}), drive_watchdog: { ...none, available: true, ...w } });
    expect(watchdogText(row({}))).toBe('The drive has no watchdog of its own. The manual names none.');
    expect(text({ state: 'armed', time_ms: 300, action: 'disable' })).toBe("The drive's own watchdog: switched off after 300 ms without the gateway.");
    expect(text({ state: 'off' })).toMatch(/switched off \(watchdog_action\)/);
    expect(text({ state: 'refused' })).toMatch(/it goes on/);
    expect(text({})).toMatch(/has not been set yet/);
  });
  it('says which limits the drive keeps by itself', () => {
    const text = (l: Partial<typeof noLimits>) => limitsText({ ...row({}), drive_limits: { ...noLimits, available: true, ...l } });
    expect(limitsText(row({}))).toBe('The drive has no limits of position of its own. The manual names limit switches.');
    expect(text({ wanted: false })).toMatch(/^The site does not limit the axis/);
    expect(text({ state: 'armed' })).toMatch(/are those of the site\.$/);
    expect(text({ state: 'off' })).toMatch(/left as they are \(drive_limits\)/);
    expect(text({ state: 'refused', refusal: '607Dh:02: no such object' })).toBe('The drive does not take limits of position: 607Dh:02: no such object');
    expect(text({})).toMatch(/has not answered/);
  });
  it('says what really ended a motion, and what moved again', () => {
    expect(cellHeads()).toHaveLength(8);
    expect(cellRow(cell, '').ended).toBe('');
    expect(cellRow({ ...cell, ended_by: 'modbus_closed', moved_again: false }, '').ended).toBe('Modbus connection closed');
    expect(cellRow({ ...cell, ended_by: 'drive', moved_again: true }, '').ended).toBe('The drive itself; moved again');
    expect(['supervisor', 'target', 'second_client', 'gateway_restarts'].map(causeText)).toEqual(['Supervisor', 'Target reached', 'A second client speaks', 'The gateway restarts']);
  });
  it('changes one member and leaves the others', () => {
    expect(changed(row({ modbus_closed: 'halt', line_lost: 'disable' }), 'modbus_closed', '')).toEqual({ modbus_closed: null, line_lost: 'disable' });
    expect(changed(row({}), 'line_lost', 'halt')).toEqual({ line_lost: 'halt' });
  });
  it('reads the time of a silent client: a number, the default, or why not', () => {
    expect([readWatchdog(' 800 '), readWatchdog('0'), readWatchdog('')].map((r) => r.good && r.value)).toEqual([800, 0, null]);
    for (const error of ['-1', '1.5', '1e3', 'soon', '600001']) expect(readWatchdog(error).good).toBe(false);
  });
  it('shows a cell, and says where it has no figure', () => {
    expect(cellRow(cell, 'mm')).toMatchObject({ action: 'Halt, by default', acted: '0.1 ms', slower: '15 ms', stood: '105 ms', way: '1.235 mm' });
    expect(cellRow({ ...cell, chosen: 'halt', noticed_ms: null, standstill_ms: null }, '')).toMatchObject({ action: 'Halt', acted: 'never', stood: 'not within 2000 ms', way: '1.235' });
    expect(cellRow({ ...cell, cause: 'gateway_gone', taken: 'nothing', noticed_ms: null }, '')).toMatchObject({ action: "the drive's own", acted: '' });
  });
});
