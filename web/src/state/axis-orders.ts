// Axis orders: what is typed to command one axis, and the commands that are made of it. In: texts of fields, the commander. Out: commands; what is wrong is told in
// the axis' line, until the field has another text. Whether the axis may do it is for the gateway to say. A field left empty is as the drive has it.
import { signal, type Signal } from '@preact/signals';
import type { Axis, Command } from '../api/types';
import { t } from '../language';
import { unitOf } from '../text/axis';
import { parseQuantity, typedNumber } from '../text/number';
import type { Commander } from './commander';
import { persisted } from './persisted';

export type Which = 'target' | 'distance' | 'speed' | 'acceleration' | 'deceleration' | 'zero';
export type Simple = 'enable' | 'disable' | 'halt' | 'reset_fault' | 'home' | 'quick_stop';
type Motion = Extract<Command, { command: 'move_absolute' | 'move_relative' }>;

/** A slow speed to begin with: a tenth of the limit, or 10 units (1000 increments) a second. */
const gentle = (axis: Pick<Axis, 'velocity_max' | 'unit'>): string => typedNumber(axis.velocity_max ? axis.velocity_max / 10 : axis.unit ? 10 : 1000);

export class AxisOrders {
  readonly fields: Readonly<Record<Which, Signal<string>>>;
  /** The field that is wrong. */
  readonly error: Signal<Which | ''> = signal('');
  readonly name: string;
  readonly unit: string;

  constructor(private readonly commander: Pick<Commander, 'send' | 'tell' | 'note' | 'forget'>, axis: Pick<Axis, 'name' | 'unit' | 'velocity_max'>) {
    this.name = axis.name;
    this.unit = unitOf(axis);
    const field = (w: Which, first = '') => persisted(`typed.${axis.name}.${w}`, first);
    this.fields = { target: field('target'), distance: field('distance'), speed: field('speed', gentle(axis)), acceleration: field('acceleration'), deceleration: field('deceleration'), zero: field('zero') };
  }

  move(kind: Motion['command'], sign = 1): void {
    const position = kind === 'move_absolute' ? this.read('target', t('Target'), 'any') : this.read('distance', t('Distance'), 'any');
    if (position === null) return;
    const command: Motion = { command: kind, position: position * sign };
    for (const [key, label, which] of [['velocity', t('Speed'), 'speed'], ['acceleration', t('Acceleration'), 'acceleration'], ['deceleration', t('Deceleration'), 'deceleration']] as const) {
      if (this.fields[which].value.trim() === '') continue;
      const v = this.read(which, label, 'positive');
      if (v === null) return;
      command[key] = v;
    }
    const where = { position: command.position, unit: this.unit };
    this.send(command, kind === 'move_absolute' ? t('Move to {position} {unit}', where) : t('Move by {position} {unit}', where));
  }
  /** null: it is no speed, and that has been said. */
  readonly jogSpeed = (): number | null => this.read('speed', t('Speed'), 'positive');
  simple(command: Simple, text: string): void {
    this.send({ command } as Command, text);
  }
  /** What the present position shall be called, as it is typed; null: it is no number, and that has been said. */
  newPosition(): number | null {
    return this.read('zero', t('Position'), 'any');
  }
  setPosition(position: number): void {
    this.send({ command: 'set_position', position }, t('Call this place {position} {unit}', { position, unit: this.unit }));
  }

  private send(command: Command, text: string): void {
    void this.commander.send(this.name, command, text);
  }

  private read(which: Which, text: string, need: 'any' | 'positive'): number | null {
    const parsed = parseQuantity(this.fields[which].value);
    let why = parsed.good ? '' : parsed.why;
    if (parsed.good && need === 'positive' && parsed.value <= 0) why = t('It must be greater than 0; the buttons give the direction.');
    this.error.value = why ? which : '';
    if (why) this.tellWrong(which, `${text}: ${why}`);
    return why || !parsed.good ? null : parsed.value;
  }

  /** Until the field has another text. */
  private tellWrong(which: Which, text: string): void {
    this.commander.tell(this.name, 'refused', text);
    const reported = this.commander.note(this.name).peek();
    const typed = this.fields[which].peek();
    const end = this.fields[which].subscribe((now) => {
      if (now === typed) return;
      queueMicrotask(() => end());
      if (this.error.peek() === which) this.error.value = '';
      this.commander.forget(this.name, reported);
    });
  }
}
