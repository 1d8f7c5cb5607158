// What is typed to command one axis, as commands: what is empty is left to the drive, what is wrong is told at its field until that has another text, and sends nothing.
import { signal } from '@preact/signals';
import { beforeEach, expect, it, vi } from 'vitest';
import { AxisOrders } from '../src/state/axis-orders';
import type { Note } from '../src/state/commander';

const note = signal<Note>({ tone: 'none', text: '' });
const commander = {
  send: vi.fn(async () => ({}) as never),
  note: () => note,
  tell: (_axis: string, tone: Note['tone'], text: string) => void (note.value = { tone, text }),
  forget: vi.fn(() => void (note.value = { tone: 'none', text: '' })),
};
let n = 0;
let o: AxisOrders;
beforeEach(() => {
  vi.clearAllMocks();
  note.value = { tone: 'none', text: '' };
  o = new AxisOrders(commander as never, { name: `axis${(n += 1)}`, unit: 'mm', velocity_max: 300 });
});

it('begins with a slow speed: a tenth of the limit, or 10 units, or 1000 increments', () => {
  const speed = (unit: string) => new AxisOrders(commander as never, { name: `other${(n += 1)}`, unit }).fields.speed.value;
  expect([o.fields.speed.value, speed('mm'), speed('')]).toEqual(['30', '10', '1000']);
});
it('moves to the target and by the distance, with what is typed of speed and ramps', () => {
  o.fields.target.value = '12.5';
  o.fields.deceleration.value = '7';
  o.move('move_absolute');
  expect(commander.send).toHaveBeenCalledWith(o.name, { command: 'move_absolute', position: 12.5, velocity: 30, deceleration: 7 }, 'Move to 12.5 mm');
  o.fields.distance.value = '3';
  o.fields.speed.value = ' ';
  o.fields.deceleration.value = '';
  o.move('move_relative', -1);
  expect(commander.send).toHaveBeenLastCalledWith(o.name, { command: 'move_relative', position: -3 }, 'Move by -3 mm');
});
it('sends nothing with a field that is wrong, and says which until it has another text', async () => {
  o.fields.target.value = '1';
  o.fields.acceleration.value = '-2';
  o.move('move_absolute');
  expect([commander.send.mock.calls.length, o.error.value, note.value]).toEqual([0, 'acceleration', { tone: 'refused', text: 'Acceleration: It must be greater than 0; the buttons give the direction.' }]);
  o.fields.acceleration.value = '2';
  await Promise.resolve();
  expect([o.error.value, commander.forget.mock.calls.length]).toEqual(['', 1]);
  o.fields.acceleration.value = '3';
  expect(commander.forget).toHaveBeenCalledTimes(1);
});
it('jogs with a speed alone; a place gets another name by a number', () => {
  o.fields.speed.value = 'x';
  expect([o.jogSpeed(), o.error.value]).toEqual([null, 'speed']);
  o.fields.speed.value = '5';
  expect(o.jogSpeed()).toBe(5);
  o.fields.zero.value = '-4';
  expect(o.newPosition()).toBe(-4);
  o.setPosition(-4);
  o.simple('halt', 'Halt');
  expect(commander.send.mock.calls.map((c: unknown[]) => c[1])).toEqual([{ command: 'set_position', position: -4 }, { command: 'halt' }]);
});
