// @vitest-environment happy-dom
// The actions of an axis' family over the mock door: found, filled in, refused before they are sent, sent once.
import { afterEach, expect, it } from 'vitest';
import { openPage, soon, type MockPage } from './mock-page';

let p: MockPage;
afterEach(() => p.close());
const sent = () => p.wire.asked.filter((a) => /^POST .*\/actions/.test(a)).length;

it('a command runs from its form, and not before its fields are right', async () => {
  p = await openPage('/axes/feeder');
  await p.see('[data-part=actions]', /3 of 3/);
  p.type(p.field('Find'), 'go pos');
  await p.see('[data-part=actions]', /1 of 3/);
  const choice = p.field('Action') as unknown as HTMLSelectElement;
  choice.value = '010xh';
  choice.dispatchEvent(new Event('change', { bubbles: true }));
  await p.see('[data-field=action-description]', 'Moves to a position.');
  p.type(p.field('Position, mm'), '300000');
  await p.press('Run');
  await p.see('[data-field=action-result]', 'Not sent: see the fields.');
  expect(sent()).toBe(0);
  p.type(p.field('Position, mm'), '12.5');
  p.type(p.field('Velocity, m/s'), '0.1');
  await p.see('[data-field=action-as-text]', 'Go To Pos: position=12.5 velocity=0.1');
  await p.press('Run');
  await p.see('[data-field=action-result]', /"position":12.5,"velocity":0.1/);
  await soon(() => expect(sent()).toBe(1));
});
