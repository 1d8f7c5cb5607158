// Alarms in words: states without colour, what is wrong now and where it is mended, the filter of the events and of their files.
import { describe, expect, it } from 'vitest';
import type { Alarm, Drive, Line } from '../src/api/types';
import { Store } from '../src/state/store';
import { alarmWord, canAcknowledge, asked, eventFile, gathered, passes, subjectOf, withoutSubject } from '../src/text/alarm';
import { offlineReason, errorsNow } from '../src/text/errors';
import { axis, event, world } from './fixtures';

const alarm = (change: Partial<Alarm> = {}): Alarm => ({
  id: 4, axis: 'feeder', drive: 'feeder', line: null, kind: 'fault', code: 8, text: 'fault 8', severity: 'alarm', state: 'unacknowledged_active', active: true, acknowledged: false,
  since: '2026-01-02T03:04:05Z', cleared_at: null, acknowledged_by: null, acknowledged_at: null, comment: null, shelved_until: null, shelved_by: null, reason: null, count: 1, ...change,
});
const drive = (presence: string): Drive => {
  const d = structuredClone(world().driveOf('feeder').document()) as Drive;
  return { ...d, status: { ...d.status, presence: presence as Drive['status']['presence'], text: 'silent' } };
};
const line = (state: string): Line => ({ name: 'can0', uri: 'twin', family: 'uim342', drives: [], status: { state, text: 'no such device' } }) as unknown as Line;

describe('an alarm', () => {
  it('tells its state in a word and a shape of its own', () => {
    const words = (['unacknowledged_active', 'acknowledged_active', 'unacknowledged_cleared', 'shelved', 'normal'] as const).map((state) => alarmWord(alarm({ state })));
    expect(new Set(words.map((w) => w.text)).size).toBe(5);
    expect(new Set(words.map((w) => w.icon)).size).toBe(5);
  });
  it('can be acknowledged unless it is, or is shelved', () => {
    expect([alarm(), alarm({ acknowledged: true, state: 'acknowledged_active' }), alarm({ state: 'shelved' }), alarm({ state: 'unacknowledged_cleared' })].map(canAcknowledge)).toEqual([true, false, false, true]);
    expect(subjectOf({ axis: null, drive: null, line: 'can0' })).toBe('can0');
  });
});

describe('what is wrong', () => {
  it('is nothing when all is well', () => {
    expect(errorsNow([axis()], [line('up')], [drive('twin')], 0)).toEqual([]);
  });
  it('is each with a link to where it can be mended', () => {
    const all = errorsNow([axis({ name: 'feeder', fault: true, error: { code: 8, text: 'stalled' } })], [line('down')], [{ ...drive('offline'), line: 'rs485' }], 2);
    expect(all.map((w) => [w.word.text, w.text, w.path])).toEqual([
      ['Fault', 'Fault 8: stalled', '/axes/feeder'],
      ['Line down', 'no such device', '/lines/can0'],
      ['Drive offline', 'silent', '/lines/rs485'],
      ['Alarms', '2 alarms are not acknowledged', '/events'],
    ]);
  });
});

describe('an offline axis', () => {
  const off = (name: string, change: object = {}) => axis({ name, online: false, drive: 'feeder', line: 'can0', ...change });
  it('is told with its line, its silent drive, or by itself, with a reason of its own', () => {
    const answers = { ...drive('device'), name: 'pa', line: 'com1', status: { ...drive('device').status, presence: 'device', online: true, text: 'the drive answers' } } as Drive;
    const silent = { ...drive('offline'), name: 'md', line: 'rs485', status: { ...drive('offline').status, online: false } } as Drive;
    const errors = errorsNow(
      [off('a', { line: 'can0', drive: 'x' }), off('b', { line: 'rs485', drive: 'md' }), off('c', { line: 'com1', drive: 'pa' }), off('d', { line: 'com1', drive: 'pa' }), off('e', { line: 'com1', drive: 'pa' }), axis({ name: 'f' })],
      [line('down')], [silent, answers], 0,
      [alarm({ axis: 'e', text: 'the encoder is gone' }), alarm({ axis: 'e', text: 'older', since: '2025-01-01T00:00:00Z' }), alarm({ axis: 'c', text: 'over', active: false }), alarm({ axis: 'other', drive: 'pa', text: 'of another axis' })],
    );
    expect(errors.map((w) => [w.word.text, w.about, w.text, w.axes, w.path])).toEqual([
      ['Line down', 'can0', 'no such device', ['a'], '/lines/can0'],
      ['Drive offline', 'md', 'silent', ['b'], '/lines/rs485'],
      ['2 axes offline', 'pa', 'the drive answers, this axis does not', ['c', 'd'], '/lines/com1'],
      ['Axis offline', 'e', 'the encoder is gone', [], '/axes/e'],
    ]);
  });
  it('of a drive that answers says what the drive as a whole says, then its own error, never that the drive answers alone', () => {
    const answers = { ...drive('device'), status: { ...drive('device').status, online: true, text: 'the drive answers' } } as Drive;
    expect(offlineReason(off('a'), answers, [alarm({ axis: null, drive: 'feeder', text: 'no supply' })])).toBe('no supply');
    expect(offlineReason(off('a', { error: { code: 7, text: 'no encoder' } }), answers, [])).toBe('error 7: no encoder');
    expect(offlineReason(off('a'), undefined, [])).toBe('nobody answers');
  });
});

it('a subject is said once, however the gateway begins its sentence', () => {
  expect(withoutSubject('drive drive is silent: no answer', 'drive')).toBe('is silent: no answer');
  expect(withoutSubject('line can0 is down', 'can0')).toBe('is down');
  expect(withoutSubject('axis feeder stalled', 'feeder')).toBe('stalled');
  expect(withoutSubject('drive feeder2 is silent', 'feeder')).toBe('drive feeder2 is silent');
  expect(withoutSubject('fault 8', 'feeder')).toBe('fault 8');
});

describe('events', () => {
  const all = { least: 'info', axis: '', kind: '', text: '' };
  it('pass by severity, axis, kind and text', () => {
    const e = event(1, { severity: 'warning', kind: 'line', axis: null, line: 'can0', text: 'line can0 is down' });
    for (const [f, wanted] of [[all, true], [{ ...all, least: 'alarm' }, false], [{ ...all, axis: 'feeder' }, false], [{ ...all, kind: 'line' }, true], [{ ...all, kind: 'write' }, false], [{ ...all, text: ' CAN0' }, true], [{ ...all, text: 'usb' }, false]] as const) {
      expect(passes(e, f)).toBe(wanted);
    }
  });
  it('are gathered once each, newest first, and saved as they are shown, by the text too', () => {
    const had = [event(1, { text: 'stalled' }), event(2, { text: 'other' }), event(3, { text: 'stalled, again', code: 8, who: 'anna', severity: 'alarm', kind: 'fault' })];
    const f = { ...all, text: 'stall' };
    expect(asked({ least: 'alarm', axis: 'x y', kind: 'fault', text: 'stall' })).toEqual({ severity: 'alarm', axis: 'x y', kind: 'fault' });
    const shown = gathered(had, [had[2]!, event(4, { text: 'STALL' })], f, 1000);
    expect(shown.map((e) => e.id)).toEqual([4, 3, 1]);
    expect(gathered(had, [], all, 2).map((e) => e.id)).toEqual([3, 2]);
    const csv = eventFile(shown, 'csv').trim().split('\n');
    expect(csv[0]).toBe('id,at,severity,kind,axis,drive,line,code,text,who,door,parameter,old,new');
    expect(csv.slice(1).map((l) => l.split(',')[0])).toEqual(['1', '3', '4']);
    expect(csv[2]).toContain('8,"stalled, again",anna');
    const lines = eventFile(shown, 'text').trim().split('\n');
    expect(lines).toHaveLength(3);
    expect(lines[1]).toMatch(/ alarm   fault        feeder           stalled, again \(code 8\) by anna$/);
  });
});

it('the store keeps the list that the gateway last told', () => {
  const store = new Store();
  expect(store.alarms.value).toBeNull();
  store.take({ topic: 'alarms', at: 1e15, data: { unacknowledged: 1, dropped: 0, alarms: [alarm()] } });
  expect(store.alarms.value?.unacknowledged).toBe(1);
});
