// The type and unit that a mapped value has by itself: what a register should be for a point, or for a parameter of the drive.
// In: the point, the parameter as the catalogue has it. Out: a type, or null where nobody says; the unit of the value before scaling. Pure.
import type { Axis, AxisParameter } from '../api/types';
import { pointUnit, type Known, type RegisterType } from './mapping';
import { unitText } from './parameter';

export type ParameterShape = Pick<AxisParameter, 'type' | 'unit'>;

const ofParameters: Record<AxisParameter['type'], RegisterType> = {
  bool: 'bool', u8: 'u16', i8: 'i16', u16: 'u16', i16: 'i16', i24: 'i32', u32: 'u32', i32: 'i32', i64: 'i64', f32: 'f32', f64: 'f64', text: 'string', bytes: 'string',
};

const shapeOf = (known: Known, axis: string, point: string): ParameterShape | null => known.parameter?.(axis, point) ?? known.parameter?.(axis, point.replace(/\[\d+\]$/, '')) ?? null;

/** null: the point is not known (yet). */
export function naturalType(axis: string, point: string, known: Known): RegisterType | null {
  const p = point.trim();
  const simple = known.points.find((x) => x.point === p);
  if (simple) return simple.type;
  const shape = p === '' ? null : shapeOf(known, axis, p);
  return shape ? ofParameters[shape.type] : null;
}

/** "mm", "inc/s", "mA"; empty: none, or not known. */
export function valueUnit(axis: Pick<Axis, 'unit'> | undefined, name: string, point: string, known: Known): string {
  if (known.points.some((x) => x.point === point)) return pointUnit(axis ?? { unit: '' }, point, known.points);
  return unitText(shapeOf(known, name, point)?.unit ?? null);
}
