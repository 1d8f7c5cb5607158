// The fleet in words: liveliness, ages, clocks; old words are never shown as live ones.
import { expect, it } from 'vitest';
import type { FleetAxis, FleetGateway } from '../src/api/types';
import { markOf, positionText } from '../src/text/axis';
import { aboutAxis, asAxis, clockText, gatewayWord, receivedText, trustOf } from '../src/text/fleet';

const axis = (change: Partial<FleetAxis> = {}): FleetAxis => ({
  axis: 'lift', number: 1, family: 'uim342', unit: 'mm', online: true, simulated: true, stale: false, referenced: true, moving: false, target_reached: true, fault: false, warning: false,
  state: 'operation_enabled', statusword: 0x27, mode: 1, error_code: 0, fail_safe_cause: 0, authority: 'none', holder: '', position: 12.5, velocity: 0, position_increments: 1250,
  increments_per_unit: 100, at: '2026-01-02T03:04:05Z', age_ms: 40, ...change,
});
const gateway = (change: Partial<FleetGateway> = {}): FleetGateway => ({ gateway: 'hall-2', instance: '7', here: false, alive: true, namesake: false, version: '1', page: '', clock_ahead_ms: 0, uptime_s: 1, silent_ms: 300, axes: [axis()], ...change });

it('a gateway is alive, silent, gone or this one; without a connection nothing is known of it', () => {
  expect([gateway(), gateway({ silent_ms: 1500 }), gateway({ alive: false }), gateway({ here: true })].map((g) => gatewayWord(g, true).text)).toEqual(['Alive', 'Silent', 'Gone', 'This one']);
  expect(gatewayWord(gateway(), false).text).toBe('Not live');
  expect([receivedText(gateway()), receivedText(gateway({ silent_ms: 4000 }))]).toEqual(['heard now', 'last heard 4 s ago']);
});

it('a clock is told when it is another one by a second', () => {
  expect([clockText(900), clockText(7_200_000), clockText(-3000)]).toEqual(['', "its clock is 2 h ahead of this one", "its clock is 3 s behind this one"]);
});

it('what is old says its age, and is not trusted', () => {
  expect(trustOf(gateway(), axis(), true)).toBe('live');
  expect(trustOf(gateway({ alive: false }), axis(), true)).toBe('disconnected');
  expect(trustOf(gateway(), axis(), false)).toBe('disconnected');
  expect(trustOf(gateway(), axis({ online: false }), true)).toBe('offline');
  expect(trustOf(gateway(), axis({ stale: true }), true)).toBe('stale');
  expect(aboutAxis(gateway(), axis())).toBe('now');
  expect(aboutAxis(gateway({ alive: false }), axis({ age_ms: 5000, fault: true, error_code: 17, holder: 'anna' }))).toBe('5 s old · fault 17 · held by anna');
  expect(aboutAxis(gateway(), axis({ referenced: false, fail_safe_cause: 3 }))).toBe('now · not referenced · fail-safe has acted');
});

it('a drive that was never seen has no position', () => {
  const never = asAxis(axis({ online: false, at: null, age_ms: null, position: 0 }));
  expect(positionText(never)).toBe('–');
  expect(markOf(never).text).toBe('NO DRIVE');
  expect(aboutAxis(gateway(), axis({ age_ms: null, online: false }))).toBe('its drive was never seen');
});
