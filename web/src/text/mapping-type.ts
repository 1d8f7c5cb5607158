// The type and unit that a mapped value has by itself: what a register should be for a point, or for a parameter of the drive.
// In: the point, the parameter as the catalogue has it. Out: a type, or null where nobody says; the unit of the value before scaling. Pure.
import type { Axis, AxisParameter } from '../api/types';
import { pointUnit, type Known, type RegisterType } from './mapping';
import { unitText } from './parameter';

export type ParameterShape = Pick<AxisParameter, 'type' | 'unit'>;

/** As the standard map has them. */
const ofPoints: Record<string, RegisterType> = {
  statusword: 'u16', controlword: 'u16', error_code: 'u16', flags: 'u16', heartbeat: 'u16', family: 'u16', setpoints_accepted: 'u16', authority: 'u16',
  mode_display: 'i16', mode: 'i16', homing_method: 'i16',
  position: 'i32', velocity: 'i32', position_demand: 'i32', following_error: 'i32', target_position: 'i32', target_velocity: 'i32',
  native_status: 'u32', age_ms: 'u32', mapping_revision: 'u32', profile_velocity: 'u32', profile_acceleration: 'u32', profile_deceleration: 'u32',
  position_units: 'f32', velocity_units: 'f32',
  online: 'bool', simulated: 'bool', stale: 'bool', referenced: 'bool', moving: 'bool', target_reached: 'bool', fault: 'bool', warning: 'bool',
};
const ofParameters: Record<AxisParameter['type'], RegisterType> = {
  bool: 'bool', u8: 'u16', i8: 'i16', u16: 'u16', i16: 'i16', i24: 'i32', u32: 'u32', i32: 'i32', i64: 'i64', f32: 'f32', f64: 'f64', text: 'string', bytes: 'string',
};

const shapeOf = (known: Known, axis: string, point: string): ParameterShape | null => known.parameter?.(axis, point) ?? known.parameter?.(axis, point.replace(/\[\d+\]$/, '')) ?? null;

/** null: the point is not known (yet). */
export function naturalType(axis: string, point: string, known: Known): RegisterType | null {
  const p = point.trim();
  const simple = Object.hasOwn(ofPoints, p) ? ofPoints[p] : undefined;
  if (simple) return simple;
  const shape = p === '' ? null : shapeOf(known, axis, p);
  return shape ? ofParameters[shape.type] : null;
}

/** "mm", "inc/s", "mA"; empty: none, or not known. */
export function valueUnit(axis: Pick<Axis, 'unit'> | undefined, name: string, point: string, known: Known): string {
  const own = pointUnit(axis ?? { unit: '' }, point);
  return own || (Object.hasOwn(ofPoints, point) ? '' : unitText(shapeOf(known, name, point)?.unit ?? null));
}
