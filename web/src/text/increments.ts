// How many increments make one unit, from what stands on the motor, the gear and the screw. In: texts. Out: the number, or which of them is none. Pure.
import { parseQuantity, typedNumber } from './number';

export interface Mechanics {
  /** Full steps of a turn times micro-steps, or counts of the encoder in a turn (each edge of both tracks is one: four times its lines). */
  per_turn: string;
  microsteps: string;
  /** So many turns of the motor are so many of what it drives. */
  motor_turns: string;
  output_turns: string;
  /** How far the axis goes in one turn of what is driven, in the axis' unit: the pitch of a screw, the circumference of a pulley, 360 deg. */
  travel: string;
}
export const plainMechanics: Mechanics = { per_turn: '200', microsteps: '16', motor_turns: '1', output_turns: '1', travel: '' };

export type Reckoned = { good: true; value: number } | { good: false; errors: (keyof Mechanics)[] };

/** Increments per unit = increments in a turn of the motor × turns of the motor for one of the output ÷ travel. */
export function incrementsOf(m: Mechanics): Reckoned {
  const keys = Object.keys(plainMechanics) as (keyof Mechanics)[];
  const n = Object.fromEntries(keys.map((k) => [k, parseQuantity(m[k])]));
  const errors = keys.filter((k) => {
    const p = n[k];
    return !p?.good || !(p.value > 0);
  });
  if (errors.length > 0) return { good: false, errors };
  const of = (k: keyof Mechanics) => (n[k] as { value: number }).value;
  return { good: true, value: (of('per_turn') * of('microsteps') * of('motor_turns')) / of('output_turns') / of('travel') };
}

/** As it goes into the field, with the reader's decimal sign: ten significant digits are finer than any gear. */
export const incrementsText = (value: number): string => typedNumber(Number(value.toPrecision(10)));
