// Which condition of a twin belongs to which axis: nobody takes the wrong axis in hand. In: items as families describe them. Out: groups.
import { describe, expect, it } from 'vitest';
import { handGroups, handLabel, positionInUnit, type HandAxis } from '../src/text/hand';

const axis = (name: string, channel: number, unit = 'mm'): HandAxis => ({ name, channel, unit, increments_per_unit: 1000 });
const item = (name: string, description = name) => ({ name, value: 0, writable: true, description });
const published = (groups: ReturnType<typeof handGroups>) => groups.map((g) => `${g.folded ? 'folded ' : ''}${g.title}: ${g.items.map((i) => `${i.label}=${i.item.name}`).join(' ')}`);
const two = [axis('x', 1), axis('y', 2)];
const bare = ['power', 'inject_error', 'stall', 'limit_positive'].map((n) => item(n));
const all = [...bare, item('axis1.inject_error', 'of this axis'), item('axis2.stall'), item('axis2.limit_positive'), item('axis2.inject_error')];

describe('the conditions of a drive with two axes', () => {
  it('begin with those of the axis whose page it is; the other axis is folded under its own name', () => {
    expect(published(handGroups(all, two, 2))).toEqual([
      'y: Stall=axis2.stall Limit positive=axis2.limit_positive Inject error=axis2.inject_error',
      'The whole drive: Power=power Inject error=inject_error',
      'folded x: Stall=stall Limit positive=limit_positive Inject error=axis1.inject_error',
    ]);
    expect(published(handGroups(all, two, 1))[0]).toBe('x: Stall=stall Limit positive=limit_positive Inject error=axis1.inject_error');
  });
  it('are in order of the channels, none folded, on the page of the drive', () => {
    expect(published(handGroups(all, two, null)).map((t) => t.split(':')[0])).toEqual(['x', 'y', 'The whole drive']);
  });
  it('are never there twice: a bare name that means the same as that of channel 1 is left out', () => {
    expect(published(handGroups([item('power'), item('stall', 's'), item('axis1.stall', 's'), item('axis2.stall', 's')], two, 1))).toEqual(['x: Stall=axis1.stall', 'The whole drive: Power=power', 'folded y: Stall=axis2.stall']);
  });
  it('of a channel that no axis of the site has are named by it', () => {
    expect(published(handGroups(all, [axis('x', 1)], 1))[2]).toMatch(/^folded Channel 2, no axis of the site: /);
  });
});

it('a drive that tells nothing apart has one list; one axis of a control has its own and those of the control', () => {
  expect(published(handGroups(bare, [axis('x', 1)], 1))).toEqual([': Power=power Inject error=inject_error Stall=stall Limit positive=limit_positive']);
  expect(published(handGroups([...bare, item('axis1.inject_error', 'of this axis')], [axis('x', 1)], 1))).toEqual(['x: Stall=stall Limit positive=limit_positive Inject error=axis1.inject_error', 'The whole drive: Power=power Inject error=inject_error']);
});

it('a label has no underscore, and a position its unit', () => {
  expect([handLabel('axis12.limit_positive'), handLabel('home_switch')]).toEqual(['Limit positive', 'Home switch']);
  expect([positionInUnit(12500, axis('x', 1)), positionInUnit(12500, axis('x', 1, '')), positionInUnit('', axis('x', 1)), positionInUnit(1, null)]).toEqual(['= 12.500 mm', '', '', '']);
});
