// Fixtures: an axis, drive, line, event and the points of an axis as the gateway tells them, from the mock world. Each test changes what it is about.
import type { Axis, GatewayEvent } from '../src/api/types';
import type { MappingPoint } from '../src/text/mapping';
import { points as mockPoints } from '../dev/mock/configure.mjs';
import { World } from '../dev/mock/world.mjs';

export const world = () => new World();
export const points = mockPoints as MappingPoint[];
const base = new World().axis('feeder');

export function axis(change: Partial<Axis> = {}): Axis {
  return { ...base, online: true, stale: false, simulated: true, presence: 'twin', state: 'operation_enabled', moving: false, target_reached: false, fault: false, warning: false, error: { code: 0, text: '' }, ...change } as Axis;
}

export function event(id: number, change: Partial<GatewayEvent> = {}): GatewayEvent {
  return { id, at: new Date(1.7e12 + id * 1000).toISOString(), severity: 'info', kind: 'command', axis: 'feeder', drive: null, line: null, code: null, text: `event ${id}`, who: null, door: null, parameter: null, old: null, new: null, ...change };
}
