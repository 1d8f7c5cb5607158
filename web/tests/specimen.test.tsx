// @vitest-environment happy-dom
// The specimen of a simulated drive on the tab of its axis: in words, chosen by a seed or a name, and put into the draft of the site; nothing is in force before.
import { afterEach, beforeEach, expect, it } from 'vitest';
import { MockDoor } from '../dev/mock/door.mjs';
import { openPage, soon, type MockPage } from './mock-page';

let p: MockPage;
let door: MockDoor;
beforeEach(() => void (door = new MockDoor()));
afterEach(() => p.close());

it('is shown in words and goes through the draft of the site', async () => {
  p = await openPage('/axes/feeder/simulation', { door });
  await soon(() => expect((p.field('The simulated drive is specimen') as HTMLInputElement).value).toBe('0'));
  const before = JSON.stringify(door.configuration.site);
  p.type(p.field('The simulated drive is specimen'), 'slow');
  await p.see('[data-field=specimen-words]', 'reply_ms = 200');
  expect(p.root.querySelector('[data-field=specimen-words]')?.getAttribute('lang')).toBe('en');
  await p.press('Save to draft');
  await p.see('.section:nth-last-child(2) form.card', 'Check and apply the draft');
  expect((p.field('The simulated drive is specimen') as HTMLInputElement).value).toBe('slow');
  expect(JSON.stringify(door.configuration.site)).toBe(before);
  p.go('/site');
  await p.see('.site-page', 'specimen');
});

it('is refused by the words of the gateway', async () => {
  p = await openPage('/axes/feeder/simulation', { door });
  await soon(() => p.field('The simulated drive is specimen'));
  p.type(p.field('The simulated drive is specimen'), 'fast');
  await p.see('.section:nth-last-child(2) form.card', 'write a seed from 0');
  expect((p.button('Save to draft') as HTMLButtonElement).disabled).toBe(true);
});
