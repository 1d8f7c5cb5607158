// The code of a part of the page: fetched once, when it is wanted; missing with a reason; fetched again when it is wanted again.
import { expect, it } from 'vitest';
import { Code } from '../src/state/code';
import type { Upgrade } from '../src/state/upgrade';

function made(upgrade: Upgrade) {
  let asked = 0;
  let there = false;
  const code = new Code(
    async () => {
      asked += 1;
      if (!there) throw new TypeError('Failed to fetch dynamically imported module');
      return 'part';
    },
    async () => upgrade,
  );
  return { code, asked: () => asked, arrive: () => void (there = true) };
}

it('is fetched when it is wanted, once', async () => {
  const { code, asked, arrive } = made('same');
  arrive();
  expect(code.state.value).toEqual({ at: 'waiting' });
  await Promise.all([code.want(), code.want()]);
  await code.want();
  expect([code.state.value, asked()]).toEqual([{ at: 'there', part: 'part' }, 1]);
});

it.each([['away', true, /cannot be reached/], ['same', false, /has not sent/]] as const)('says why it is missing (%s), and is fetched when it is wanted again', async (upgrade, away, why) => {
  const { code, asked, arrive } = made(upgrade);
  await code.want();
  expect(code.state.value).toMatchObject({ at: 'missing', away, why: expect.stringMatching(why) });
  arrive();
  await code.want();
  expect([code.state.value, asked()]).toEqual([{ at: 'there', part: 'part' }, 2]);
});

it('says nothing while the tab is being loaded again', async () => {
  const { code } = made('reloading');
  await code.want();
  expect(code.state.value).toEqual({ at: 'waiting' });
});
