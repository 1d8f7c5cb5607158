// The fleet in words: gateways and axes of the domain as their gateways told them. In: documents of GET /fleet. Out: words, tones. Pure.
import type { Axis, FleetAxis, FleetGateway } from '../api/types';
import { t } from '../language';
import type { Trust } from '../state/store';
import type { Word } from './axis';
import { duration } from './time';

/** Silent for longer than this although it speaks twice a second: its lease runs. */
const late_ms = 1_200;

export function gatewayWord(g: Pick<FleetGateway, 'alive' | 'here' | 'silent_ms'>, connected: boolean): Word {
  if (!connected) return { text: t('Not live'), icon: 'unplugged', tone: 'muted', long: t('This page is not connected: what others do now is not known') };
  if (!g.alive) return { text: t('Gone'), icon: 'unplugged', tone: 'fault', long: t('It has ended, or was not heard within its lease of 2 s') };
  if (g.here) return { text: t('This one'), icon: 'check', tone: 'good', long: t('The gateway that this page belongs to') };
  if (g.silent_ms > late_ms) return { text: t('Silent'), icon: 'clock', tone: 'warning', long: t('Not heard for {time}; after 2 s it counts as gone', { time: duration(g.silent_ms) }) };
  return { text: t('Alive'), icon: 'check', tone: 'good', long: t('Heard within its lease of 2 s') };
}

export function receivedText(g: Pick<FleetGateway, 'here' | 'silent_ms'>): string {
  if (g.here) return t('this gateway');
  return g.silent_ms < 1000 ? t('heard now') : t('last heard {time} ago', { time: duration(g.silent_ms) });
}

/** What is worth knowing of its clock; empty: it is as this one's. */
export function clockText(ahead_ms: number): string {
  if (Math.abs(ahead_ms) < 1000) return '';
  return ahead_ms > 0 ? t('its clock is {time} ahead of this one', { time: duration(ahead_ms) }) : t('its clock is {time} behind this one', { time: duration(-ahead_ms) });
}

export const trustOf = (g: FleetGateway, a: FleetAxis, connected: boolean): Trust => (!connected || !g.alive ? 'disconnected' : !a.online ? 'offline' : a.stale ? 'stale' : 'live');

/** The members that words about an axis are made of, as an axis of this gateway has them. */
export function asAxis(a: FleetAxis): Pick<Axis, 'state' | 'moving' | 'velocity' | 'mode' | 'target_reached' | 'fault' | 'presence' | 'position' | 'increments_per_unit' | 'unit'> {
  return {
    state: a.state,
    moving: a.moving,
    velocity: a.velocity,
    mode: a.mode === 6 ? 'homing' : 'other',
    target_reached: a.target_reached,
    fault: a.fault,
    presence: !a.online ? 'offline' : a.simulated ? 'twin' : 'device',
    position: a.age_ms === null ? null : a.position,
    increments_per_unit: a.increments_per_unit,
    unit: a.unit,
  };
}

/** How old what is shown is, and what else there is to say of the axis. */
export function aboutAxis(g: FleetGateway, a: FleetAxis): string {
  const published = [a.age_ms === null ? t('its drive was never seen') : !g.alive || a.age_ms >= 1000 ? t('{time} old', { time: duration(a.age_ms) }) : t('now')];
  if (a.fault) published.push(t('fault {code}', { code: a.error_code }));
  else if (a.error_code !== 0) published.push(t('error {code}', { code: a.error_code }));
  if (a.warning) published.push(t('warning'));
  if (a.online && !a.referenced) published.push(t('not referenced'));
  if (a.fail_safe_cause !== 0) published.push(t('fail-safe has acted'));
  if (a.holder) published.push(t('held by {holder}', { holder: a.holder }));
  return published.join(' · ');
}
