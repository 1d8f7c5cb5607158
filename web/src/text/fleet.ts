// The fleet in words: gateways and axes of the domain as their gateways told them. In: documents of GET /fleet. Out: words, tones. Pure.
import type { Axis, FleetAxis, FleetGateway } from '../api/types';
import type { Trust } from '../state/store';
import type { Word } from './axis';
import { duration } from './time';

/** Silent for longer than this although it speaks twice a second: its lease runs. */
const late_ms = 1_200;

export function gatewayWord(g: Pick<FleetGateway, 'alive' | 'here' | 'silent_ms'>, connected: boolean): Word {
  if (!connected) return { text: 'Not live', icon: 'unplugged', tone: 'muted', long: 'This page is not connected: what others do now is not known' };
  if (!g.alive) return { text: 'Gone', icon: 'unplugged', tone: 'fault', long: 'It has ended, or was not heard within its lease of 2 s' };
  if (g.here) return { text: 'This one', icon: 'check', tone: 'good', long: 'The gateway that this page belongs to' };
  if (g.silent_ms > late_ms) return { text: 'Silent', icon: 'clock', tone: 'warning', long: `Not heard for ${duration(g.silent_ms)}; after 2 s it counts as gone` };
  return { text: 'Alive', icon: 'check', tone: 'good', long: 'Heard within its lease of 2 s' };
}

export function heardWords(g: Pick<FleetGateway, 'here' | 'silent_ms'>): string {
  if (g.here) return 'this gateway';
  return g.silent_ms < 1000 ? 'heard now' : `last heard ${duration(g.silent_ms)} ago`;
}

/** What is worth knowing of its clock; empty: it is as this one's. */
export function clockWords(ahead_ms: number): string {
  if (Math.abs(ahead_ms) < 1000) return '';
  return `its clock is ${duration(Math.abs(ahead_ms))} ${ahead_ms > 0 ? 'ahead of' : 'behind'} this one's`;
}

export const trustOf = (g: FleetGateway, a: FleetAxis, connected: boolean): Trust => (!connected || !g.alive ? 'disconnected' : !a.online ? 'offline' : a.stale ? 'stale' : 'live');

/** The members that words about an axis are made of, as an axis of this gateway has them. */
export function asAxis(a: FleetAxis): Pick<Axis, 'state' | 'moving' | 'velocity' | 'mode' | 'target_reached' | 'presence' | 'position' | 'increments_per_unit' | 'unit'> {
  return {
    state: a.state,
    moving: a.moving,
    velocity: a.velocity,
    mode: a.mode === 6 ? 'homing' : 'other',
    target_reached: a.target_reached,
    presence: !a.online ? 'offline' : a.simulated ? 'twin' : 'device',
    position: a.age_ms === null ? null : a.position,
    increments_per_unit: a.increments_per_unit,
    unit: a.unit,
  };
}

/** How old what is shown is, and what else there is to say of the axis. */
export function aboutAxis(g: FleetGateway, a: FleetAxis): string {
  const said = [a.age_ms === null ? 'its drive was never seen' : !g.alive || a.age_ms >= 1000 ? `${duration(a.age_ms)} old` : 'now'];
  if (a.fault) said.push(`fault ${a.error_code}`);
  else if (a.error_code !== 0) said.push(`error ${a.error_code}`);
  if (a.warning) said.push('warning');
  if (a.online && !a.referenced) said.push('not referenced');
  if (a.fail_safe_cause !== 0) said.push('fail-safe has acted');
  if (a.holder) said.push(`held by ${a.holder}`);
  return said.join(' · ');
}
