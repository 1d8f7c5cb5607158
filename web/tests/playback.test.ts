// What playback shows while its instant moves on, with a gateway that answers slowly: the newest answer that came, never nothing, never one from far away.
import { describe, expect, it } from 'vitest';
import { Moments } from '../src/state/playback';

/** A gateway whose answers come when the test says so. */
function desk() {
  const asked: { at: number; answer: (v: string) => void; refuse: (e: Error) => void }[] = [];
  const shown: string[] = [];
  const faults: string[] = [];
  const m = new Moments<string>(
    (at) => new Promise((answer, refuse) => asked.push({ at, answer, refuse })),
    (doc) => shown.push(doc),
    (e) => faults.push((e as Error).message),
  );
  const settle = async () => {
    for (let i = 0; i < 5; i += 1) await Promise.resolve();
  };
  return { m, asked, shown, faults, settle };
}

describe('playback', () => {
  it('shows each answer though the next step has been taken before it came', async () => {
    const d = desk();
    d.m.known(0, 'begin');
    for (let step = 1; step <= 12; step += 1) {
      d.m.want(step * 250);
      if (step % 3 === 0) d.asked.at(-1)!.answer(`at ${d.asked.at(-1)!.at}`); // it takes three steps
      await d.settle();
    }
    expect(d.shown).toEqual(['begin', 'at 250', 'at 750', 'at 1500', 'at 2250']);
    expect(d.asked).toHaveLength(5); // one at a time
    d.asked.at(-1)!.answer('the end');
    await d.settle();
    expect([d.asked.at(-1)!.at, d.shown.at(-1)]).toEqual([3000, 'the end']);
  });
  it('never goes back to an answer that is further away than what is shown', async () => {
    const d = desk();
    d.m.known(10_000, 'the end');
    d.m.want(0);
    d.m.want(9_900);
    d.asked[0]!.answer('the beginning');
    await d.settle();
    expect(d.shown).toEqual(['the end']);
    d.asked[1]!.answer('shortly before the end');
    await d.settle();
    expect(d.shown.at(-1)).toBe('shortly before the end');
  });
  it('asks on after a refusal, and for nothing when it is closed', async () => {
    const d = desk();
    d.m.known(0, 'begin');
    d.m.want(1);
    d.m.want(2);
    d.asked[0]!.refuse(new Error('busy'));
    await d.settle();
    expect([d.faults, d.asked.map((a) => a.at)]).toEqual([['busy'], [1, 2]]);
    d.m.want(3);
    d.m.end();
    d.asked[1]!.answer('two');
    await d.settle();
    expect([d.shown, d.asked.length]).toEqual([['begin'], 2]);
  });
});
