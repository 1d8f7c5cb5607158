// The client: problem documents in words, time limits, and stops that never wait behind other requests.
import { afterEach, beforeEach, describe, expect, it, vi } from 'vitest';
import { Client } from '../src/api/client';
import { asProblem, Problem } from '../src/api/problem';

const answer = (body: unknown, status = 200, type = 'application/json') => new Response(typeof body === 'string' ? body : JSON.stringify(body), { status, headers: { 'content-type': type } });
const caught = async (p: Promise<unknown>): Promise<Problem> => {
  try {
    await p;
  } catch (e) {
    return e as Problem;
  }
  throw new Error('it did not fail');
};
interface Open { url: string; init: RequestInit; answer: (r: Response) => void; fail: (e: unknown) => void }
function manual() {
  const open: Open[] = [];
  const fetcher = vi.fn((url: RequestInfo | URL, init: RequestInit = {}) => new Promise<Response>((resolve, reject) => {
    open.push({ url: String(url), init, answer: resolve, fail: reject });
    init.signal?.addEventListener('abort', () => reject(new DOMException('aborted', 'AbortError')));
  }));
  return { open, client: new Client('/api/v1', fetcher as unknown as typeof fetch), fetcher };
}
const settle = () => vi.advanceTimersByTimeAsync(0);

beforeEach(() => void vi.useFakeTimers());
afterEach(() => void vi.useRealTimers());

describe('requests', () => {
  it('encodes names in paths', async () => {
    const { client, open } = manual();
    void client.parameter('a/b', 'PP[5]', { cached: true, history: 3 });
    await settle();
    expect(open[0]?.url).toBe('/api/v1/axes/a%2Fb/parameters/PP%5B5%5D?cached=1&history=3');
  });
  it('sends commands as JSON', async () => {
    const { client, open } = manual();
    void client.command('feeder', { command: 'move_absolute', position: -2 });
    await settle();
    expect(open[0]?.init).toMatchObject({ method: 'POST', body: '{"command":"move_absolute","position":-2}' });
    expect((open[0]?.init.headers as Record<string, string>)['content-type']).toBe('application/json');
  });
});

describe('a stop without a token that fits', () => {
  const refused = () => answer({ status: 403, title: 'Csrf', detail: 'the header X-CSRF-Token is missing', reason: 'csrf' }, 403, 'application/problem+json');
  const tokenOf = (o: Open | undefined) => (o?.init.headers as Record<string, string> | undefined)?.['x-csrf-token'];
  it('asks for one and goes again, once, past the queue; the page keeps its own', async () => {
    const { client, open } = manual();
    client.csrf = 'old';
    const p = client.command('feeder', { command: 'quick_stop' }, true);
    await settle();
    expect(tokenOf(open[0])).toBe('old');
    open[0]!.answer(refused());
    await settle();
    expect(open[1]).toMatchObject({ url: '/api/v1/session', init: { method: 'GET' } });
    open[1]!.answer(answer({ csrf: 'new' }));
    await settle();
    expect(open[2]).toMatchObject({ url: '/api/v1/axes/feeder/commands', init: { method: 'POST', body: '{"command":"quick_stop"}' } });
    expect(tokenOf(open[2])).toBe('new');
    open[2]!.answer(answer({ result: 'accepted' }));
    expect(await p).toMatchObject({ result: 'accepted' });
    expect(client.csrf).toBe('old');
  });
  it('is told as it is when that does not help either', async () => {
    const { client, open } = manual();
    const p = caught(client.command('feeder', { command: 'quick_stop' }, true));
    await settle();
    open[0]!.answer(refused());
    await settle();
    open[1]!.answer(answer({ csrf: 'new' }));
    await settle();
    open[2]!.answer(refused());
    expect((await p).reason).toBe('csrf');
    expect(open).toHaveLength(3);
  });
  it('anything else is not said again', async () => {
    const { client, open } = manual();
    const p = caught(client.command('feeder', { command: 'enable' }));
    await settle();
    open[0]!.answer(refused());
    expect((await p).reason).toBe('csrf');
    expect(open).toHaveLength(1);
  });
});

describe('problems', () => {
  it('shows the detail of a problem document, its reason and the code of the drive', async () => {
    const { client, open } = manual();
    const p = caught(client.command('feeder', { command: 'enable' }));
    await settle();
    open[0]?.answer(answer({ status: 409, title: 'Wrong state', detail: 'the axis is in fault: reset it first', code: 8, reason: 'wrong_state', result: 'refused' }, 409, 'application/problem+json'));
    const problem = await p;
    expect(problem).toMatchObject({ kind: 'answered', status: 409, reason: 'wrong_state' });
    expect(problem.text).toBe("the axis is in fault: reset it first (drive's code 8)");
  });
  it('adds faults that the detail does not say already', async () => {
    const p = new Problem('answered', 'two things are wrong: A', 422, { faults: [{ document: 'body', pointer: '/a', text: 'A', remedy: '' }, { document: 'body', pointer: '/b', text: 'B', remedy: '' }] });
    expect(p.text).toBe('two things are wrong: A; B');
  });
  it.each([
    ['half a document', '{"detail":', 'application/problem+json'],
    ['no document', '<html>bad gateway</html>', 'text/html'],
    ['a document without words', '{}', 'application/json'],
  ])('says the status where there is %s', async (_what, body, type) => {
    const { client, open } = manual();
    const p = caught(client.about());
    await settle();
    open[0]?.answer(answer(body, 502, type));
    expect((await p).text).toContain('502');
  });
  it('says when nobody answers', async () => {
    const { client, open } = manual();
    const p = caught(client.about());
    await settle();
    open[0]?.fail(new TypeError('fetch failed'));
    expect(await p).toMatchObject({ kind: 'unreachable', text: 'the gateway cannot be reached' });
  });
  it('gives up after the time limit, and says it', async () => {
    const { client } = manual();
    const p = caught(client.about());
    await vi.advanceTimersByTimeAsync(15_001);
    expect(await p).toMatchObject({ kind: 'timed_out', text: 'the gateway did not answer within 15 s' });
  });
  it('says when an answer cannot be read', async () => {
    const { client, open } = manual();
    const p = caught(client.about());
    await settle();
    open[0]?.answer(answer('{"name":', 200));
    expect((await p).text).toContain('cannot be read');
  });
  it('makes a problem of anything', () => expect(asProblem('x').text).toBe('x'));
});

describe('turns', () => {
  it('lets at most four ordinary requests run, and starts the next when one ends', async () => {
    const { client, open, fetcher } = manual();
    for (let i = 0; i < 6; i += 1) void client.axes().catch(() => undefined);
    await settle();
    expect(fetcher).toHaveBeenCalledTimes(4);
    open[0]?.answer(answer([]));
    await settle();
    expect(fetcher).toHaveBeenCalledTimes(5);
  });
  it('lets a stop pass all that wait', async () => {
    const { client, open } = manual();
    for (let i = 0; i < 6; i += 1) void client.axes().catch(() => undefined);
    void client.command('feeder', { command: 'quick_stop' }, true);
    await settle();
    const stop = open.find((o) => String(o.init.body).includes('quick_stop'));
    expect(stop?.init.keepalive).toBe(true);
    expect(open).toHaveLength(5);
  });
  it('drops commands that wait when a stop comes, but not reads', async () => {
    const { client, open } = manual();
    for (let i = 0; i < 4; i += 1) void client.axes().catch(() => undefined);
    const move = caught(client.command('feeder', { command: 'move_absolute', position: 1 }));
    const read = client.about();
    await settle();
    client.dropWaitingCommands('a stop came first');
    expect(await move).toMatchObject({ kind: 'cancelled', text: 'a stop came first' });
    open[0]?.answer(answer([]));
    await settle();
    open.at(-1)?.answer(answer({ name: 'axisgate' }));
    expect(await read).toEqual({ name: 'axisgate' });
    expect(open.some((o) => String(o.init.body).includes('move_absolute'))).toBe(false);
  });
  it('refuses in words when too many wait', async () => {
    const { client } = manual();
    for (let i = 0; i < 204; i += 1) void client.axes().catch(() => undefined);
    await settle();
    expect(await caught(client.axes())).toMatchObject({ kind: 'crowded' });
  });
  it('gives its place back after a failure', async () => {
    const { client, open, fetcher } = manual();
    for (let i = 0; i < 5; i += 1) void client.axes().catch(() => undefined);
    await settle();
    open[0]?.fail(new TypeError('gone'));
    await settle();
    expect(fetcher).toHaveBeenCalledTimes(5);
  });
});
