// What became of a command that was taken, and refusals that go with their cause. Pure, with a clock of its own.
import { describe, expect, it } from 'vitest';
import { Problem } from '../src/api/problem';
import type { Axis, Command, CommandAnswer } from '../src/api/types';
import { Commander } from '../src/state/commander';
import { emptied } from '../src/state/persisted';
import { signal } from '@preact/signals';

const t0 = Date.parse('2026-03-01T10:00:00Z');
const axisAt = (ms: number, more: Partial<Axis> = {}) =>
  ({ name: 'a', unit: 'mm', increments_per_unit: 100, online: true, stale: false, state: 'operation_enabled', fault: false, error: { code: 0, text: '' }, moving: false, target_reached: false, referenced: false, position: 1, target_position: 5, authority_holder: '', at: new Date(t0 + ms).toISOString(), ...more }) as Axis;
const answer = (command: string): CommandAnswer => ({ ticket: 1, result: 'accepted', reason: '', axis: 'a', command, code: null, text: '', value: null });
const settle = async () => { for (let i = 0; i < 4; i += 1) await Promise.resolve(); };

async function taken(command: Command) {
  let now = axisAt(0);
  let connected = true;
  const client = { dropWaitingCommands: () => undefined, axes: async () => [], command: async (_: string, c: Command) => answer(c.command) };
  const commander = new Commander(client, () => (connected ? '' : 'no connection'), () => false, () => now, () => t0);
  const look = (ms: number, more: Partial<Axis> = {}) => commander.look((now = axisAt(ms, more)));
  const reported = () => `${commander.note('a').value.tone} ${commander.note('a').value.text}`.trim();
  await commander.send('a', command, 'It');
  await settle();
  return { commander, look, reported, connect: (yes: boolean) => void (connected = yes) };
}
const move: Command = { command: 'move_absolute', position: 5 };

describe('a command that was taken', () => {
  it('is done when its axis has moved and arrived', async () => {
    const { look, reported: published } = await taken(move);
    look(50, { target_reached: true }); // read before the drive took it
    look(150, { target_reached: true }); // the end of the motion before
    expect(published()).toBe('good It: accepted');
    look(300, { moving: true });
    look(900, { moving: true });
    look(1200, { target_reached: true });
    expect(published()).toBe('good It: done');
  });
  it('that moved too shortly to be seen is done all the same', async () => {
    const { look, reported: published } = await taken(move);
    look(600, { target_reached: true });
    expect(published()).toBe('good It: done');
  });
  it.each([
    ['a fault', { fault: true, state: 'fault', error: { code: 29, text: 'stall' } }, 'refused It: ended by a fault, 29: stall'],
    ['a stop', { state: 'quick_stop_active' }, 'refused It: interrupted: the axis is quick stop now, at 1.00 mm'],
    ['standing still before its end', {}, 'refused It: interrupted: the axis stopped at 1.00 mm'],
    ['another target', { moving: true, target_position: 9 }, 'refused It: ended: another command took its place'],
    ['silence', { online: false }, 'refused It: the axis went offline; whether it has finished is not known'],
  ] as [string, Partial<Axis>, string][])('is told as ended by %s', async (_, more, text) => {
    const { look, reported: published } = await taken(move);
    look(300, { moving: true });
    look(1500, more);
    expect(published()).toBe(text);
  });
  it('leaves no green word behind when a jog is over, and says when power is there', async () => {
    const jog = await taken({ command: 'move_velocity', velocity: 1 });
    jog.look(300, { moving: true });
    jog.look(900);
    expect(jog.reported()).toBe('none');
    const power = await taken({ command: 'enable' });
    power.look(200, { state: 'switched_on' });
    expect(power.reported()).toBe('good It: accepted');
    power.look(300);
    expect(power.reported()).toBe('good It: done');
  });
  it('is not told of any more when another one was given', async () => {
    const { commander, look, reported: published } = await taken(move);
    await commander.stop('a');
    look(1500, { state: 'quick_stop_active' });
    expect(published()).toBe('good Stop: accepted');
  });
});

describe('a refusal', () => {
  it('goes with its cause, and not before', async () => {
    let now = axisAt(0, { state: 'switch_on_disabled' });
    const client = { dropWaitingCommands: () => undefined, axes: async () => [], command: async () => { throw new Problem('answered', 'the axis is switch_on_disabled: enable it first', 409, { reason: 'wrong_state' }); } };
    const commander = new Commander(client, () => '', () => false, () => now, () => t0);
    await commander.send('a', move, 'Move');
    expect(commander.note('a').value).toEqual({ tone: 'refused', text: 'Move: refused. The axis is disabled: enable it first' });
    commander.look((now = axisAt(500, { state: 'switch_on_disabled', position: 2 })));
    expect(commander.note('a').value.tone).toBe('refused');
    commander.look((now = axisAt(900)));
    expect(commander.note('a').value.tone).toBe('none');
  });
  it('for want of a connection goes when there is one', async () => {
    const { commander, look, reported: published, connect } = await taken(move);
    connect(false);
    await commander.send('a', move, 'Move');
    look(500);
    expect(published()).toBe('refused Move: not sent. no connection');
    connect(true);
    look(600);
    expect(published()).toBe('none');
  });
});

it('a field whose text was taken is emptied, unless somebody has gone on typing', () => {
  const [same, other] = [signal('5'), signal('7')];
  emptied(same, '5');
  emptied(other, '5');
  expect([same.value, other.value]).toEqual(['', '7']);
});
