// What an event says, in the unit of its axis: the gateway's own words count in increments of the drive here and there. In: an event's text, the axis as
// it is now. Out: the text. Pure. The increments stay beside it: the axis may have had another unit when it happened.
import { decimalsOf, formatNumber } from './number';
import { plain } from './plain';

export interface Scale {
  unit: string;
  increments_per_unit: number;
}

const orders: Record<string, string> = { move_absolute: '', move_relative: '', move_velocity: '/s' };

export function inUnits(text: string, scale: Scale | undefined): string {
  if (!scale?.unit || !(scale.increments_per_unit > 0)) return plain(text);
  const both = (increments: string, per: string) => `${formatNumber(Number(increments) / scale.increments_per_unit, decimalsOf(scale.increments_per_unit))} ${scale.unit}${per} (${formatNumber(Number(increments), 0)} increments${per})`;
  const order = /^(move_\w+) (-?\d+)$/.exec(text);
  if (order && Object.hasOwn(orders, order[1] as string)) return `${plain(order[1] as string)} ${both(order[2] as string, orders[order[1] as string] as string)}`;
  return plain(text).replace(/\(at (-?\d+) increments\)/g, (_, n: string) => `at ${both(n, '')}`);
}
