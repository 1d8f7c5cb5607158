// What an event says, in the unit of its axis: the gateway's own words count in increments of the drive here and there; and many events that one bulk
// edit made, as one. In: events, the axis as it is now. Out: texts, groups. Pure. The increments stay beside it: the axis may have had another
// unit when it happened. A group has nothing of severity in it: what needs attention keeps a line of its own.
import { t } from '../language';
import type { GatewayEvent } from '../api/types';
import { decimalsOf, formatNumber } from './number';
import { plain } from './plain';

export interface Scale {
  unit: string;
  increments_per_unit: number;
}

const orders: Record<string, string> = { move_absolute: '', move_relative: '', move_velocity: '/s' };

export function inUnits(text: string, scale: Scale | undefined): string {
  if (!scale?.unit || !(scale.increments_per_unit > 0)) return plain(text);
  const both = (increments: string, per: string) => t('{n} {unit}{per} ({n2} increments{per2})', { n: formatNumber(Number(increments) / scale.increments_per_unit, decimalsOf(scale.increments_per_unit)), unit: scale.unit, per, n2: formatNumber(Number(increments), 0), per2: per });
  const order = /^(move_\w+) (-?\d+)$/.exec(text);
  if (order && Object.hasOwn(orders, order[1] as string)) return `${plain(order[1] as string)} ${both(order[2] as string, orders[order[1] as string] as string)}`;
  return plain(text).replace(/\(at (-?\d+) increments\)/g, (_, n: string) => t('at {n}', { n: both(n, '') }));
}

/** Between two writes of one bulk edit; a slow line needs its time. */
const together_ms = 3_000;
const fewest = 4;
const bulk = (e: GatewayEvent): string => (e.kind === 'write' && e.severity === 'info' && e.axis && e.who ? `${e.axis} ${e.who} ${e.door ?? ''}` : '');

/** Newest first, as they came; parameters of one axis written by one person in one go are one entry of several. */
export function groupsOf(events: readonly GatewayEvent[]): GatewayEvent[][] {
  const runs: GatewayEvent[][] = [];
  for (const e of events) {
    const run = runs.at(-1);
    const last = run?.at(-1);
    if (run && last && bulk(e) !== '' && bulk(e) === bulk(last) && Date.parse(last.at) - Date.parse(e.at) <= together_ms) run.push(e);
    else runs.push([e]);
  }
  return runs.flatMap((run) => (run.length >= fewest ? [run] : run.map((e) => [e])));
}
