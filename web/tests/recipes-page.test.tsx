// @vitest-environment happy-dom
// The page of a recipe over the mock door: what its forms say that depends on what was chosen elsewhere.
import { afterEach, expect, it } from 'vitest';
import { MockDoor } from '../dev/mock/door.mjs';
import { openPage, soon, type MockPage } from './mock-page';

let p: MockPage;
const recipe = (which: object) => ({ parameters: { which: { type: 'axis', ...which } }, steps: [{ command: { axis: '${which}', command: 'move_absolute', position: 1, velocity: 2 } }, { command: { axis: 'lift', command: 'move_velocity', velocity: 2 } }] });
const open = async (document: object) => {
  const door = new MockDoor();
  door.answer({ method: 'PUT', target: '/api/v1/recipes/r', head: {}, text: JSON.stringify(document), peer: '127.0.0.1:1' });
  p = await openPage('/recipes/r', { door });
  await p.see('[data-step="/steps/0"]', 'Step 1');
};
const labels = (n: number) => [...p.root.querySelectorAll(`[data-step="/steps/${n}"] .step-field > span`)].map((e) => e.textContent).filter((t) => /Position|Velocity/.test(t ?? ''));
afterEach(() => p.close());

it('a step whose axis is a parameter shows the unit of what is chosen for it, of its default, or none', async () => {
  await open(recipe({ default: 'turntable' }));
  await soon(() => expect(labels(0)).toEqual(['Position, deg', 'Velocity, deg/s']));
  expect(labels(1)).toEqual(['Velocity, mm/s']);
  p.type(p.field('Argument which'), 'feeder');
  await soon(() => expect(labels(0)).toEqual(['Position, mm', 'Velocity, mm/s']));
  p.type(p.field('Argument which'), 'nobody');
  await soon(() => expect(labels(0)).toEqual(['Position', 'Velocity']));
  p.type(p.field('Argument which'), '');
  await soon(() => expect(labels(0)).toEqual(['Position, deg', 'Velocity, deg/s']));
  p.type(p.field('Parameter which: Default'), '');
  await soon(() => expect(labels(0)).toEqual(['Position', 'Velocity']));
  expect(labels(1)).toEqual(['Velocity, mm/s']);
});
