// What is typed to arm a capture: as a wish of the gateway, or why not, at the field; and who asks one by one.
import { describe, expect, it, vi } from 'vitest';
import { oneByOne } from '../src/state/trend-feed';
import { toggled, toggledIn } from '../src/state/toggled';
import { checkCapture, firstCapture } from '../src/text/capture';

const texts = (change: object = {}) => ({ ...firstCapture('a'), ...change });

describe('a capture', () => {
  it('has the next free name, whole milliseconds, and the axes of its line beside its own', () => {
    expect(checkCapture(texts({ rate: '500', wait: '1.5' }), 'a', ['b'], ['capture-1'])).toEqual({
      name: 'capture-2',
      faults: {},
      wish: { name: 'capture-2', axes: ['a', 'b'], rate_hz: 500, before_ms: 200, after_ms: 1000, wait_ms: 1500, trigger: { kind: 'command', axis: 'a' } },
    });
  });
  it.each([
    [{ kind: 'level', level: '2.5', edge: 'falling' }, { kind: 'level', axis: 'a', point: 'position', edge: 'falling', level: 2.5 }],
    [{ kind: 'state', state: 'fault' }, { kind: 'state', axis: 'a', state: 'fault', edge: 'rising' }],
    [{ kind: 'at_once', level: 'x' }, { kind: 'at_once', axis: 'a' }],
  ])('begins with %j', (change, trigger) => expect(checkCapture(texts(change), 'a', [], []).wish?.trigger).toEqual(trigger));
  it.each([
    [{ rate: '1001' }, { rate: 'The rate is 1 to 1000.' }],
    [{ rate: '' }, { rate: expect.any(String) }],
    [{ before: '-1' }, { before: 'The time before is 0 to 120000.' }],
    [{ after: '0' }, { after: 'The time after is 1 to 120000.' }],
    [{ wait: '301' }, { wait: 'The wait is 0.1 to 300.' }],
    [{ name: 'old' }, { name: 'There is one of this name.' }],
    [{ name: '.x' }, { name: expect.stringContaining('1 to 64 letters') }],
    [{ kind: 'level', level: 'x' }, { level: expect.any(String) }],
  ])('is not armed with %j', (change, faults) => expect(checkCapture(texts(change), 'a', [], ['old'])).toMatchObject({ wish: null, faults }));
  it('needs an axis', () => expect(checkCapture(texts(), '', [], [])).toMatchObject({ wish: null, faults: {} }));
});

it('one of a list or of a set is taken out if it is there, else put in; what was there is not changed', () => {
  const list = ['a', 'b'];
  const set = new Set(list);
  expect([toggled(list, 'a'), toggled(list, 'c'), list]).toEqual([['b'], ['a', 'b', 'c'], ['a', 'b']]);
  expect([[...toggledIn(set, 'a')], [...toggledIn(set, 'c')], set.size]).toEqual([['b'], ['a', 'b', 'c'], 2]);
});

it('what is asked one by one is asked once more for all who asked meanwhile, and no more when it is over', async () => {
  const answers: ((more: boolean) => void)[] = [];
  const ask = vi.fn(() => new Promise<boolean>((done) => answers.push(done)));
  const load = oneByOne(ask);
  load();
  load();
  load();
  expect(ask).toHaveBeenCalledTimes(1);
  answers[0]!(true);
  await vi.waitFor(() => expect(ask).toHaveBeenCalledTimes(2));
  load();
  answers[1]!(false);
  await Promise.resolve();
  await Promise.resolve();
  expect(ask).toHaveBeenCalledTimes(2);
});
