// The addresses of the pages, there and back.
import { expect, it } from 'vitest';
import { axisPath, linePath, routeOf } from '../src/router';

it.each([
  ['/', { page: 'overview' }],
  ['', { page: 'overview' }],
  ['/lines', { page: 'lines' }],
  ['/events/', { page: 'events' }],
  ['/gateway', { page: 'gateway' }],
  ['/fleet', { page: 'fleet' }],
  ['/mappings', { page: 'mappings' }],
  ['/site', { page: 'site' }],
  ['/descriptions', { page: 'descriptions' }],
  ['/descriptions/maker.eds/', { page: 'description', name: 'maker.eds' }],
  ['/descriptions/maker.eds/lift.dcf/', { page: 'description', name: 'maker.eds', other: 'lift.dcf' }],
  ['/descriptions/a/b/c', { page: 'unknown', path: '/descriptions/a/b/c' }],
  ['/axes/feeder/parameters', { page: 'parameters', name: 'feeder' }],
  ['/axes/gantry.x/parameters/', { page: 'parameters', name: 'gantry.x' }],
  ['/recipes', { page: 'recipes' }],
  ['/recipes/warm-up', { page: 'recipe', name: 'warm-up' }],
  ['/axes/feeder', { page: 'axis', name: 'feeder', tab: 'move' }],
  ['/axes/feeder/scope', { page: 'axis', name: 'feeder', tab: 'scope' }],
  ['/axes/gantry.x/events/', { page: 'axis', name: 'gantry.x', tab: 'events' }],
  ['/axes/feeder/move', { page: 'unknown', path: '/axes/feeder/move' }],
  ['/lines/can0', { page: 'line', name: 'can0' }],
  ['/axes', { page: 'unknown', path: '/axes' }],
  ['/axes/a/b', { page: 'unknown', path: '/axes/a/b' }],
  ['/nonsense', { page: 'unknown', path: '/nonsense' }],
  ['/axes/%E0%A4%A', { page: 'axis', name: '%E0%A4%A', tab: 'move' }],
])('%s', (path, route) => expect(routeOf(path)).toEqual(route));

it.each(['feeder', 'gantry.x', 'a_b-c', 'Z9'])('finds the axis %s by its own address', (name) => {
  expect(routeOf(axisPath(name))).toEqual({ page: 'axis', name, tab: 'move' });
  expect(routeOf(linePath(name))).toEqual({ page: 'line', name });
});
it('ends the address of a name with a point in a slash, so that it is not taken for a file', () => {
  expect(axisPath('gantry.x')).toBe('/axes/gantry.x/');
  expect(axisPath('gantry')).toBe('/axes/gantry');
});
