// Commands and their answers in words; stops that cannot be overtaken; the jog that ends whatever happens.
import { afterEach, beforeEach, describe, expect, it, vi } from 'vitest';
import { Problem } from '../src/api/problem';
import type { Axis, Command, CommandAnswer } from '../src/api/types';
import { Commander } from '../src/state/commander';
import { Jog } from '../src/state/jog';

const done = (command: string): CommandAnswer => ({ ticket: 1, result: 'accepted', reason: '', axis: 'a', command, code: null, text: '', value: null });
const refusal = (detail: string, reason = 'wrong_state', status = 409) => new Problem('answered', detail, status, { reason, result: 'refused' });

interface Said { axis: string; command: Command; urgent: boolean; good: () => void; bad: (p: unknown) => void }
function make(blocked = () => '') {
  const said: Said[] = [];
  const client = {
    dropWaitingCommands: vi.fn(),
    axes: vi.fn(async (_urgent?: boolean) => [{ name: 'a' }, { name: 'b' }] as unknown as Axis[]),
    command: vi.fn((axis: string, command: Command, urgent = false) => new Promise<CommandAnswer>((good, bad) => {
      said.push({ axis, command, urgent, good: () => good(done(command.command)), bad });
    })),
  };
  const commander = new Commander(client, blocked);
  const names = () => said.map((s) => s.command.command);
  return { said, client, commander, names };
}
const settle = () => vi.advanceTimersByTimeAsync(0);
beforeEach(() => void vi.useFakeTimers());
afterEach(() => void vi.useRealTimers());

describe('answers in words', () => {
  it('says that a command was accepted', async () => {
    const { said, commander } = make();
    void commander.send('a', { command: 'enable' }, 'Enable');
    expect(commander.note('a').value).toEqual({ tone: 'busy', text: 'Enable …' });
    said[0]!.good();
    await settle();
    expect(commander.note('a').value).toEqual({ tone: 'good', text: 'Enable: accepted' });
  });
  it('says why it was refused', async () => {
    const { said, commander } = make();
    void commander.send('a', { command: 'move_absolute', position: 1 }, 'Move to 1 mm');
    said[0]!.bad(refusal('the axis is switch on disabled: enable it first'));
    await settle();
    expect(commander.note('a').value).toEqual({ tone: 'refused', text: 'Move to 1 mm: refused. The axis is switch on disabled: enable it first' });
  });
  it('says failed where nobody knows what became of it', async () => {
    const { said, commander } = make();
    void commander.send('a', { command: 'home' }, 'Home');
    said[0]!.bad(new Problem('timed_out', 'the gateway did not answer within 15 s'));
    await settle();
    expect(commander.note('a').value.text).toBe('Home: failed. The gateway did not answer within 15 s');
  });
  it('takes good news away after a while, and leaves refusals', async () => {
    const { said, commander } = make();
    void commander.send('a', { command: 'enable' }, 'Enable');
    void commander.send('b', { command: 'enable' }, 'Enable');
    said[0]!.good();
    said[1]!.bad(refusal('no'));
    await vi.advanceTimersByTimeAsync(20_001);
    expect(commander.note('a').value.text).toBe('');
    expect(commander.note('b').value.text).toBe('Enable: refused. No');
  });
  it('lets a late answer not cover a newer one', async () => {
    const { said, commander } = make();
    void commander.send('a', { command: 'enable' }, 'Enable');
    void commander.send('a', { command: 'disable' }, 'Disable');
    said[1]!.good();
    await settle();
    said[0]!.good();
    await settle();
    expect(commander.note('a').value.text).toBe('Disable: accepted');
  });
  it('sends no motion from a page that is not live, but every stop', async () => {
    const { commander, names } = make(() => 'The page is not connected to the gateway.');
    await commander.send('a', { command: 'move_absolute', position: 1 }, 'Move to 1 mm');
    expect(commander.note('a').value.text).toBe('Move to 1 mm: not sent. The page is not connected to the gateway.');
    void commander.send('a', { command: 'halt' }, 'Halt');
    void commander.send('a', { command: 'disable' }, 'Disable');
    void commander.stop('a');
    expect(names()).toEqual(['halt', 'disable', 'quick_stop']);
  });
});

describe('stop', () => {
  it('goes past the queue and drops what waits there', () => {
    const { said, client, commander } = make();
    void commander.stop('a');
    expect(client.dropWaitingCommands).toHaveBeenCalled();
    expect(said[0]).toMatchObject({ axis: 'a', urgent: true, command: { command: 'quick_stop' } });
  });
  it('is said again after a motion that was still on its way', async () => {
    const { said, commander, names } = make();
    void commander.send('a', { command: 'move_absolute', position: 9 }, 'Move');
    void commander.stop('a');
    said[1]!.good();
    await settle();
    expect(names()).toEqual(['move_absolute', 'quick_stop']);
    said[0]!.good();
    await settle();
    expect(names()).toEqual(['move_absolute', 'quick_stop', 'quick_stop']);
  });
  it('is said once where no motion was on its way', async () => {
    const { said, commander, names } = make();
    void commander.send('a', { command: 'move_absolute', position: 9 }, 'Move');
    said[0]!.good();
    await settle();
    void commander.stop('a');
    said[1]!.good();
    await settle();
    expect(names()).toEqual(['move_absolute', 'quick_stop']);
  });
  it('becomes a halt where the drive has no quick stop', async () => {
    const { said, commander, names } = make();
    void commander.stop('a');
    said[0]!.bad(refusal('this drive has no quick stop', 'not_supported'));
    await settle();
    said[1]!.good();
    await settle();
    expect(names()).toEqual(['quick_stop', 'halt']);
    expect(commander.note('a').value).toEqual({ tone: 'good', text: 'Stop: accepted' });
  });
  it('shouts when it is not confirmed', async () => {
    const { said, commander } = make();
    void commander.stop('a');
    said[0]!.bad(new Problem('unreachable', 'the gateway cannot be reached'));
    await settle();
    expect(commander.note('a').value).toEqual({ tone: 'refused', text: 'Stop NOT confirmed: the gateway cannot be reached' });
  });
  it('of all reports each axis that did not confirm', async () => {
    const { said, commander } = make();
    void commander.stopAll(['a', 'b', 'c']);
    expect(said.map((s) => s.axis)).toEqual(['a', 'b', 'c']);
    said[0]!.good();
    said[1]!.bad(new Problem('answered', 'the drive does not answer', 504, { reason: 'no_answer' }));
    said[2]!.good();
    await settle();
    expect(commander.stopReport.value).toEqual({ tone: 'refused', text: 'Stop accepted by 2 of 3. NOT confirmed by b: the drive does not answer' });
  });
  it('of all says so when all confirmed, and when there is none', async () => {
    const { said, commander } = make();
    void commander.stopAll(['a', 'b']);
    said.forEach((s) => s.good());
    await settle();
    expect(commander.stopReport.value.text).toBe('Stop accepted by all 2 axes.');
    await commander.stopAll([]);
    expect(commander.stopReport.value.text).toBe('There is no axis to stop.');
  });
});

describe('a stop of all before the page knows the axes', () => {
  it('asks for them, past the queue, and stops each', async () => {
    const { said, client, commander } = make();
    void commander.stopAll(null);
    expect(commander.stopReport.value).toEqual({ tone: 'busy', text: 'Stopping all axes …' });
    await settle();
    expect(client.axes).toHaveBeenCalledWith(true);
    expect(said.map((s) => `${s.axis} ${s.command.command} ${s.urgent}`)).toEqual(['a quick_stop true', 'b quick_stop true']);
    said.forEach((s) => s.good());
    await settle();
    expect(commander.stopReport.value).toEqual({ tone: 'good', text: 'Stop accepted by all 2 axes.' });
  });
  it('never says that there is none when nobody could be asked', async () => {
    const { said, client, commander } = make();
    client.axes.mockRejectedValueOnce(new Problem('timed_out', 'no answer'));
    await commander.stopAll(null);
    expect(said).toEqual([]);
    expect(commander.stopReport.value).toEqual({ tone: 'refused', text: 'NOT stopped: the gateway did not say which axes there are. No answer' });
  });
});

describe('a stop of all with axes that are offline', () => {
  const offline = new Set(['b', 'c']);
  const made = () => {
    const m = make();
    return { ...m, commander: new Commander(m.client, () => '', (a) => offline.has(a)) };
  };
  it('counts only who answers, and says who does not', async () => {
    const { said, commander } = made();
    void commander.stopAll(['a', 'b', 'c', 'd']);
    expect(said).toHaveLength(4); // it is tried for all the same
    for (const s of said) s.good();
    await settle();
    expect(commander.stopReport.value).toEqual({ tone: 'partly', text: 'Stop accepted by 2 of 4; 2 offline: nobody confirms b, c.' });
    expect(commander.note('a').value).toEqual({ tone: 'good', text: 'Stop: accepted' });
    expect(commander.note('b').value).toMatchObject({ tone: 'partly', text: expect.stringContaining('offline') });
  });
  it('is still loud about one that answers and did not confirm', async () => {
    const { said, commander } = made();
    void commander.stopAll(['a', 'b', 'd']);
    said[0]!.bad(new Problem('timed_out', 'no answer'));
    said[1]!.bad(new Problem('answered', 'the drive does not answer', 504));
    said[2]!.good();
    await settle();
    expect(commander.stopReport.value).toEqual({ tone: 'refused', text: 'Stop accepted by 1 of 3; 1 offline. NOT confirmed by a: no answer' });
  });
});

it('nothing green is left when the connection is lost; refusals are', async () => {
  const { said, commander } = make();
  void commander.send('a', { command: 'enable' }, 'Jog +5 mm/s');
  void commander.send('b', { command: 'enable' }, 'Enable');
  said[0]!.good();
  said[1]!.bad(refusal('no'));
  await settle();
  commander.forgetGood();
  expect(commander.note('a').value.tone).toBe('none');
  expect(commander.note('b').value.tone).toBe('refused');
});

describe('jog', () => {
  const jogOf = () => {
    const m = make();
    return { ...m, jog: new Jog(m.client, m.commander, 'a') };
  };
  it('moves while held and halts when let go', async () => {
    const { said, jog, names, commander } = jogOf();
    jog.press(-5, 'Jog −5 mm/s');
    expect(said[0]!.command).toEqual({ command: 'move_velocity', velocity: -5, hold_ms: 1000 });
    said[0]!.good();
    await settle();
    jog.release();
    expect(names()).toEqual(['move_velocity', 'halt']);
    expect(said[1]!.urgent).toBe(true);
    said[1]!.good();
    await settle();
    expect(commander.note('a').value.text).toBe('Jog: ended, halt accepted');
    expect(jog.active).toBe(false);
  });
  it('says while it is held that the hand is still there, and never begins a motion by that', async () => {
    const { said, jog } = jogOf();
    jog.press(5, 'Jog');
    said[0]!.good();
    await settle();
    await vi.advanceTimersByTimeAsync(250);
    expect(said[1]!.command).toEqual({ command: 'move_velocity', velocity: 5, hold_ms: 1000, renew: true });
    said[1]!.good();
    await settle();
    await vi.advanceTimersByTimeAsync(250);
    expect(said).toHaveLength(3);
    said[2]!.bad(refusal('there is no held velocity move'));
    await settle();
    expect(jog.active).toBe(false);
    expect(said.map((s) => s.command.command)).toEqual(['move_velocity', 'move_velocity', 'move_velocity', 'halt']);
    await vi.advanceTimersByTimeAsync(2000);
    expect(said).toHaveLength(4);
  });
  it.each([
    ['fails', (s: Said) => s.bad(new Problem('unreachable', 'the gateway cannot be reached')), /Jog: ended, the gateway cannot be reached\. The gateway halts the axis by itself 1 s after/],
    ['is not answered', () => undefined, /Jog: ended, the gateway does not answer\./],
  ] as const)('is over when a renewal %s, and says so', async (_, what, words) => {
    const { said, jog, names, commander } = jogOf();
    jog.press(5, 'Jog');
    said[0]!.good();
    await settle();
    await vi.advanceTimersByTimeAsync(250);
    what(said[1]!);
    await vi.advanceTimersByTimeAsync(710);
    expect(jog.active).toBe(false);
    expect(names()).toEqual(['move_velocity', 'move_velocity', 'halt']);
    expect(commander.note('a').value).toMatchObject({ tone: 'refused', text: expect.stringMatching(words) });
  });
  it('is over when the connection is lost', async () => {
    const { said, jog, names, commander } = jogOf();
    jog.lost();
    expect(names()).toEqual([]);
    jog.press(5, 'Jog');
    said[0]!.good();
    await settle();
    jog.lost();
    expect(names()).toEqual(['move_velocity', 'halt']);
    expect(commander.note('a').value).toMatchObject({ tone: 'refused', text: expect.stringContaining('the connection to the gateway is lost') });
  });
  it('halts a second time if it was let go before the move was answered', async () => {
    const { said, jog, names } = jogOf();
    jog.press(5, 'Jog');
    jog.release();
    said[1]!.good();
    said[0]!.good();
    await settle();
    expect(names()).toEqual(['move_velocity', 'halt', 'halt']);
  });
  it('sends no halt for a move that was refused while held', async () => {
    const { said, jog, names } = jogOf();
    jog.press(5, 'Jog');
    said[0]!.bad(refusal('the axis is disabled'));
    await settle();
    jog.release();
    expect(names()).toEqual(['move_velocity']);
  });
  it('halts if nobody knows whether the move was taken', async () => {
    const { said, jog, names } = jogOf();
    jog.press(5, 'Jog');
    said[0]!.bad(new Problem('timed_out', 'no answer'));
    await settle();
    expect(names()).toEqual(['move_velocity', 'halt']);
  });
  it('tries the halt again while nobody answers, and says that it is not confirmed', async () => {
    const { said, jog, names, commander } = jogOf();
    jog.press(5, 'Jog');
    said[0]!.good();
    await settle();
    jog.release();
    said[1]!.bad(new Problem('unreachable', 'the gateway cannot be reached'));
    await settle();
    expect(commander.note('a').value.text).toMatch(/halt is NOT confirmed/);
    await vi.advanceTimersByTimeAsync(300);
    expect(names()).toEqual(['move_velocity', 'halt', 'halt']);
    said[2]!.good();
    await settle();
    expect(commander.note('a').value.text).toBe('Jog: ended, halt accepted');
  });
  it('gives up trying after a bounded number of halts', async () => {
    const { said, jog, client } = jogOf();
    jog.press(5, 'Jog');
    said[0]!.good();
    await settle();
    client.command.mockImplementation(() => Promise.reject(new Problem('unreachable', 'gone')));
    jog.release();
    await vi.advanceTimersByTimeAsync(60_000);
    expect(client.command.mock.calls.length).toBeLessThan(15);
  });
  it('takes no second press while held, and no release that was no press', () => {
    const { jog, names } = jogOf();
    jog.release();
    jog.press(5, 'Jog');
    jog.press(9, 'Jog');
    expect(names()).toEqual(['move_velocity']);
  });
});
