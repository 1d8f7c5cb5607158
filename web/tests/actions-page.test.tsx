// @vitest-environment happy-dom
// The actions of an axis' family over the mock door: found, filled in, refused before they are sent, sent once.
import { afterEach, expect, it } from 'vitest';
import { openPage, soon, type MockPage } from './mock-page';

let p: MockPage;
afterEach(() => p.close());
const sent = () => p.wire.asked.filter((a) => /^POST .*\/actions/.test(a)).length;

it('a command runs from its form, and not before its fields are right', async () => {
  p = await openPage('/axes/feeder/drive');
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

it('a command that loses something asks first, in its sentence; what was changed since is asked anew', async () => {
  p = await openPage('/axes/feeder/drive');
  await p.see('[data-part=actions]', /of 3/);
  p.type(p.field('Find'), '');
  await p.see('[data-part=actions]', /3 of 3/);
  const choice = p.field('Action') as unknown as HTMLSelectElement;
  choice.value = 'save';
  choice.dispatchEvent(new Event('change', { bubbles: true }));
  await p.see('[data-field=action-description]', 'Keeps the settings.');
  await p.press('Run …');
  await p.see('[data-field=action-question]', 'save on feeder: What has been saved is replaced. Run it?');
  await soon(() => expect(document.activeElement?.textContent).toBe('Leave it'));
  expect(sent()).toBe(0);
  await p.press('Leave it');
  await soon(() => expect(document.querySelector('[data-field=action-question]')).toBeNull());
  await p.press('Run …');
  await p.see('[data-field=action-question]', 'save on feeder');
  p.type(p.field('Argument'), 'all');
  await soon(() => expect(document.querySelector('[data-field=action-question]')).toBeNull());
  expect(sent()).toBe(0);
  await p.press('Run …');
  await p.see('[data-field=action-question]', 'save on feeder');
  await p.press('Run save');
  await soon(() => expect(sent()).toBe(1));
});

it('a parameter by which the drive is reached is written after a question with its old and new value', async () => {
  p = await openPage('/axes/feeder/parameters');
  await p.see('[data-parameter=PP]', 'PP');
  await p.press('List elements');
  await p.see('[data-parameter="PP[1]"]', 'PP[1]');
  const written = () => p.wire.asked.filter((a) => /^PUT .*\/parameters\/PP(\[|%5B)1/.test(a)).length;
  p.type(p.field('New value of PP[1]'), '9');
  await p.press('Write PP[1]');
  await p.see('[data-field=addressing-question]', /The drive of feeder is reached by PP\[1\] .* and will be 9\. The gateway may not find/);
  expect(written()).toBe(0);
  await p.press('Leave it');
  await soon(() => expect(document.querySelector('[data-field=addressing-question]')).toBeNull());
  expect(written()).toBe(0);
  await p.press('Write PP[1]');
  await p.see('[data-field=addressing-question]', 'PP[1]');
  const yes = document.querySelector<HTMLButtonElement>('[data-field=addressing-question] button')!;
  yes.click();
  await soon(() => expect(written()).toBe(1));
});
