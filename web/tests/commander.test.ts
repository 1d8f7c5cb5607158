// Commands and their answers in words; stops that cannot be overtaken; the jog that ends whatever happens.
import { afterEach, beforeEach, describe, expect, it, vi } from 'vitest';
import { Problem } from '../src/api/problem';
import type { Axis, Command, CommandAnswer } from '../src/api/types';
import { Commander } from '../src/state/commander';
import { Jog } from '../src/state/jog';

const done = (command: string): CommandAnswer => ({ ticket: 1, result: 'accepted', reason: '', axis: 'a', command, code: null, text: '', value: null });
const refusal = (detail: string, reason = 'wrong_state', status = 409) => new Problem('answered', detail, status, { reason, result: 'refused' });

interface Published { axis: string; command: Command; urgent: boolean; good: () => void; bad: (p: unknown) => void }
function make(blocked = () => '') {
  const sent: Published[] = [];
  const client = {
    dropWaitingCommands: vi.fn(),
    axes: vi.fn(async (_urgent?: boolean) => [{ name: 'a' }, { name: 'b' }] as unknown as Axis[]),
    command: vi.fn((axis: string, command: Command, urgent = false) => new Promise<CommandAnswer>((good, bad) => {
      sent.push({ axis, command, urgent, good: () => good(done(command.command)), bad });
    })),
  };
  const commander = new Commander(client, blocked);
  const names = () => sent.map((s) => s.command.command);
  return { sent, client, commander, names };
}
const settle = () => vi.advanceTimersByTimeAsync(0);
beforeEach(() => void vi.useFakeTimers());
afterEach(() => void vi.useRealTimers());

describe('answers in words', () => {
  it('says that a command was accepted', async () => {
    const { sent, commander } = make();
    void commander.send('a', { command: 'enable' }, 'Enable');
    expect(commander.note('a').value).toEqual({ tone: 'busy', text: 'Enable …' });
    sent[0]!.good();
    await settle();
    expect(commander.note('a').value).toEqual({ tone: 'good', text: 'Enable: accepted' });
  });
  it('says why it was refused', async () => {
    const { sent, commander } = make();
    void commander.send('a', { command: 'move_absolute', position: 1 }, 'Move to 1 mm');
    sent[0]!.bad(refusal('the axis is switch on disabled: enable it first'));
    await settle();
    expect(commander.note('a').value).toEqual({ tone: 'refused', text: 'Move to 1 mm: refused. The axis is switch on disabled: enable it first' });
  });
  it('says failed where nobody knows what became of it', async () => {
    const { sent, commander } = make();
    void commander.send('a', { command: 'home' }, 'Home');
    sent[0]!.bad(new Problem('timed_out', 'the gateway did not answer within 15 s'));
    await settle();
    expect(commander.note('a').value.text).toBe('Home: failed. The gateway did not answer within 15 s');
  });
  it('takes good news away after a while, and leaves refusals', async () => {
    const { sent, commander } = make();
    void commander.send('a', { command: 'enable' }, 'Enable');
    void commander.send('b', { command: 'enable' }, 'Enable');
    sent[0]!.good();
    sent[1]!.bad(refusal('no'));
    await vi.advanceTimersByTimeAsync(20_001);
    expect(commander.note('a').value.text).toBe('');
    expect(commander.note('b').value.text).toBe('Enable: refused. No');
  });
  it('lets a late answer not cover a newer one', async () => {
    const { sent, commander } = make();
    void commander.send('a', { command: 'enable' }, 'Enable');
    void commander.send('a', { command: 'disable' }, 'Disable');
    sent[1]!.good();
    await settle();
    sent[0]!.good();
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
    const { sent, client, commander } = make();
    void commander.stop('a');
    expect(client.dropWaitingCommands).toHaveBeenCalled();
    expect(sent[0]).toMatchObject({ axis: 'a', urgent: true, command: { command: 'quick_stop' } });
  });
  it('is said again after a motion that was still on its way', async () => {
    const { sent, commander, names } = make();
    void commander.send('a', { command: 'move_absolute', position: 9 }, 'Move');
    void commander.stop('a');
    sent[1]!.good();
    await settle();
    expect(names()).toEqual(['move_absolute', 'quick_stop']);
    sent[0]!.good();
    await settle();
    expect(names()).toEqual(['move_absolute', 'quick_stop', 'quick_stop']);
  });
  it('is said once where no motion was on its way', async () => {
    const { sent, commander, names } = make();
    void commander.send('a', { command: 'move_absolute', position: 9 }, 'Move');
    sent[0]!.good();
    await settle();
    void commander.stop('a');
    sent[1]!.good();
    await settle();
    expect(names()).toEqual(['move_absolute', 'quick_stop']);
  });
  it('becomes a halt where the drive has no quick stop', async () => {
    const { sent, commander, names } = make();
    void commander.stop('a');
    sent[0]!.bad(refusal('this drive has no quick stop', 'not_supported'));
    await settle();
    sent[1]!.good();
    await settle();
    expect(names()).toEqual(['quick_stop', 'halt']);
    expect(commander.note('a').value).toEqual({ tone: 'good', text: 'Stop: accepted' });
  });
  it('shouts when it is not confirmed', async () => {
    const { sent, commander } = make();
    void commander.stop('a');
    sent[0]!.bad(new Problem('unreachable', 'the gateway cannot be reached'));
    await settle();
    expect(commander.note('a').value).toEqual({ tone: 'refused', text: 'Stop NOT confirmed: the gateway cannot be reached' });
  });
  it('of all reports each axis that did not confirm', async () => {
    const { sent, commander } = make();
    void commander.stopAll(['a', 'b', 'c']);
    expect(sent.map((s) => s.axis)).toEqual(['a', 'b', 'c']);
    sent[0]!.good();
    sent[1]!.bad(new Problem('answered', 'the drive does not answer', 504, { reason: 'no_answer' }));
    sent[2]!.good();
    await settle();
    expect(commander.stopReport.value).toEqual({ tone: 'refused', text: 'Stop accepted by 2 of 3. NOT confirmed by b: the drive does not answer' });
  });
  it('of all says so when all confirmed, and when there is none', async () => {
    const { sent, commander } = make();
    void commander.stopAll(['a', 'b']);
    sent.forEach((s) => s.good());
    await settle();
    expect(commander.stopReport.value.text).toBe('Stop accepted by all 2 axes.');
    await commander.stopAll([]);
    expect(commander.stopReport.value.text).toBe('There is no axis to stop.');
  });
});

describe('a stop of all before the page knows the axes', () => {
  it('asks for them, past the queue, and stops each', async () => {
    const { sent, client, commander } = make();
    void commander.stopAll(null);
    expect(commander.stopReport.value).toEqual({ tone: 'busy', text: 'Stopping all axes …' });
    await settle();
    expect(client.axes).toHaveBeenCalledWith(true);
    expect(sent.map((s) => `${s.axis} ${s.command.command} ${s.urgent}`)).toEqual(['a quick_stop true', 'b quick_stop true']);
    sent.forEach((s) => s.good());
    await settle();
    expect(commander.stopReport.value).toEqual({ tone: 'good', text: 'Stop accepted by all 2 axes.' });
  });
  it('never says that there is none when nobody could be asked', async () => {
    const { sent, client, commander } = make();
    client.axes.mockRejectedValueOnce(new Problem('timed_out', 'no answer'));
    await commander.stopAll(null);
    expect(sent).toEqual([]);
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
    const { sent, commander } = made();
    void commander.stopAll(['a', 'b', 'c', 'd']);
    expect(sent).toHaveLength(4); // it is tried for all the same
    for (const s of sent) s.good();
    await settle();
    expect(commander.stopReport.value).toEqual({ tone: 'partly', text: 'Stop accepted by 2 of 4; 2 offline: nobody confirms b, c.' });
    expect(commander.note('a').value).toEqual({ tone: 'good', text: 'Stop: accepted' });
    expect(commander.note('b').value).toMatchObject({ tone: 'partly', text: expect.stringContaining('offline') });
  });
  it('is still loud about one that answers and did not confirm', async () => {
    const { sent, commander } = made();
    void commander.stopAll(['a', 'b', 'd']);
    sent[0]!.bad(new Problem('timed_out', 'no answer'));
    sent[1]!.bad(new Problem('answered', 'the drive does not answer', 504));
    sent[2]!.good();
    await settle();
    expect(commander.stopReport.value).toEqual({ tone: 'refused', text: 'Stop accepted by 1 of 3; 1 offline. NOT confirmed by a: no answer' });
  });
});

it('nothing green is left when the connection is lost; refusals are', async () => {
  const { sent, commander } = make();
  void commander.send('a', { command: 'enable' }, 'Jog +5 mm/s');
  void commander.send('b', { command: 'enable' }, 'Enable');
  sent[0]!.good();
  sent[1]!.bad(refusal('no'));
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
    const { sent, jog, names, commander } = jogOf();
    jog.press(-5, 'Jog −5 mm/s');
    expect(sent[0]!.command).toEqual({ command: 'move_velocity', velocity: -5, hold_ms: 1000 });
    sent[0]!.good();
    await settle();
    jog.release();
    expect(names()).toEqual(['move_velocity', 'halt']);
    expect(sent[1]!.urgent).toBe(true);
    sent[1]!.good();
    await settle();
    expect(commander.note('a').value.text).toBe('Jog: ended, halt accepted');
    expect(jog.active).toBe(false);
  });
  it('says while it is held that the hand is still there, and never begins a motion by that', async () => {
    const { sent, jog } = jogOf();
    jog.press(5, 'Jog');
    sent[0]!.good();
    await settle();
    await vi.advanceTimersByTimeAsync(250);
    expect(sent[1]!.command).toEqual({ command: 'move_velocity', velocity: 5, hold_ms: 1000, renew: true });
    sent[1]!.good();
    await settle();
    await vi.advanceTimersByTimeAsync(250);
    expect(sent).toHaveLength(3);
    sent[2]!.bad(refusal('there is no held velocity move'));
    await settle();
    expect(jog.active).toBe(false);
    expect(sent.map((s) => s.command.command)).toEqual(['move_velocity', 'move_velocity', 'move_velocity', 'halt']);
    await vi.advanceTimersByTimeAsync(2000);
    expect(sent).toHaveLength(4);
  });
  it.each([
    ['fails', (s: Published) => s.bad(new Problem('unreachable', 'the gateway cannot be reached')), /Jog: ended, the gateway cannot be reached\. The gateway halts the axis by itself 1 s after/],
    ['is not answered', () => undefined, /Jog: ended, the gateway does not answer\./],
  ] as const)('is over when a renewal %s, and says so', async (_, what, text) => {
    const { sent, jog, names, commander } = jogOf();
    jog.press(5, 'Jog');
    sent[0]!.good();
    await settle();
    await vi.advanceTimersByTimeAsync(250);
    what(sent[1]!);
    await vi.advanceTimersByTimeAsync(710);
    expect(jog.active).toBe(false);
    expect(names()).toEqual(['move_velocity', 'move_velocity', 'halt']);
    expect(commander.note('a').value).toMatchObject({ tone: 'refused', text: expect.stringMatching(text) });
  });
  it('is over when the connection is lost', async () => {
    const { sent, jog, names, commander } = jogOf();
    jog.lost();
    expect(names()).toEqual([]);
    jog.press(5, 'Jog');
    sent[0]!.good();
    await settle();
    jog.lost();
    expect(names()).toEqual(['move_velocity', 'halt']);
    expect(commander.note('a').value).toMatchObject({ tone: 'refused', text: expect.stringContaining('the connection to the gateway is lost') });
  });
  it('halts a second time if it was let go before the move was answered', async () => {
    const { sent, jog, names } = jogOf();
    jog.press(5, 'Jog');
    jog.release();
    sent[1]!.good();
    sent[0]!.good();
    await settle();
    expect(names()).toEqual(['move_velocity', 'halt', 'halt']);
  });
  it('sends no halt for a move that was refused while held', async () => {
    const { sent, jog, names } = jogOf();
    jog.press(5, 'Jog');
    sent[0]!.bad(refusal('the axis is disabled'));
    await settle();
    jog.release();
    expect(names()).toEqual(['move_velocity']);
  });
  it('halts if nobody knows whether the move was taken', async () => {
    const { sent, jog, names } = jogOf();
    jog.press(5, 'Jog');
    sent[0]!.bad(new Problem('timed_out', 'no answer'));
    await settle();
    expect(names()).toEqual(['move_velocity', 'halt']);
  });
  it('tries the halt again while nobody answers, and says that it is not confirmed', async () => {
    const { sent, jog, names, commander } = jogOf();
    jog.press(5, 'Jog');
    sent[0]!.good();
    await settle();
    jog.release();
    sent[1]!.bad(new Problem('unreachable', 'the gateway cannot be reached'));
    await settle();
    expect(commander.note('a').value.text).toMatch(/halt is NOT confirmed/);
    await vi.advanceTimersByTimeAsync(300);
    expect(names()).toEqual(['move_velocity', 'halt', 'halt']);
    sent[2]!.good();
    await settle();
    expect(commander.note('a').value.text).toBe('Jog: ended, halt accepted');
  });
  it('gives up trying after a bounded number of halts', async () => {
    const { sent, jog, client } = jogOf();
    jog.press(5, 'Jog');
    sent[0]!.good();
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
