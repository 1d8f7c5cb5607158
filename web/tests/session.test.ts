// Session: what goes with requests, who one is, what a role may not do, and who holds an axis, in words.
import { describe, expect, it, vi } from 'vitest';
import { signal, type Signal } from '@preact/signals';
import { Client } from '../src/api/client';
import type { SessionInfo } from '../src/api/types';
import { passwordFault, Session, signInText, userFault, whoText } from '../src/state/session';
import { asProblem, Problem } from '../src/api/problem';
import { handOverChoices, heldBy, heldText } from '../src/text/authority';

const info = (change: Partial<SessionInfo> = {}): SessionInfo => ({ user: 'anna', role: 'engineer', via: 'cookie', csrf: 'c1', expires_at: null, ended: null, first_sign_in: false, roles: ['viewer', 'operator', 'engineer', 'administrator'], ...change });
const nobody = info({ user: null, role: null, via: 'none', csrf: null });
const answer = (body: unknown, status = 200, head: Record<string, string> = {}) => new Response(status === 204 ? null : JSON.stringify(body), { status, headers: { 'content-type': 'application/json', ...head } });

function made(answers: (url: string, init: RequestInit) => Response) {
  const asked: { url: string; method: string; head: Record<string, string> }[] = [];
  const fetcher = vi.fn(async (url: RequestInfo | URL, init: RequestInit = {}) => {
    asked.push({ url: String(url), method: String(init.method), head: init.headers as Record<string, string> });
    return answers(String(url), init);
  });
  const client = new Client('/api/v1', fetcher as unknown as typeof fetch, 'page-abc123');
  const changed = vi.fn();
  return { asked, client, changed, session: new Session(client, changed) };
}

describe('requests', () => {
  it('carry the CSRF token with every change, urgent stops too, but not with reads; and the name of the tab always', async () => {
    const { asked, client, session } = made((url) => answer(url.endsWith('/session') ? info() : {}));
    await session.ask();
    await client.axes();
    await client.command('feeder', { command: 'quick_stop' }, true);
    await client.command('feeder', { command: 'enable' });
    expect(asked.map((a) => [a.method, a.head['x-csrf-token']])).toEqual([['GET', undefined], ['GET', undefined], ['POST', 'c1'], ['POST', 'c1']]);
    expect(asked.every((a) => a.head['x-client'] === 'page-abc123')).toBe(true);
  });
  it('ask who one is when a request is answered 401, and once at a time', async () => {
    let now = info();
    const { asked, client, session } = made((url) => (url.endsWith('/session') ? answer(now) : answer({ detail: 'sign in' }, 401)));
    await session.ask();
    now = nobody;
    await Promise.allSettled([client.axes(), client.axes(), client.axes()]);
    await vi.waitFor(() => expect(session.needed.value).toBe(true));
    expect(asked.filter((a) => a.url.endsWith('/session')).length).toBeLessThanOrEqual(3);
    expect(client.csrf).toBeNull();
  });
});

describe('a session that has ended', () => {
  const local = info({ user: null, via: 'local', csrf: null });
  const signedIn = async (then: () => Response, path = '/axes') => {
    let over = false;
    let reported = false;
    const made_ = made((url, init) => {
      if (init.method === 'POST') {
        over = false;
        return answer(info());
      }
      if (!over) return answer(url.endsWith('/session') ? info() : {});
      if (url.endsWith(path) && !reported) {
        reported = true;
        return then();
      }
      return answer(url.endsWith('/session') ? local : {});
    });
    await made_.session.ask();
    over = true;
    return made_;
  };
  const refused = () => answer({ type: 'urn:axisgate:problem:session_ended', status: 401, detail: 'the session has ended', reason: 'session_ended' }, 401);

  it('is told in words, keeps the page behind the sign-in, and offers to go on where local access exists', async () => {
    const { client, session } = await signedIn(refused);
    await client.axes().catch(() => undefined);
    await vi.waitFor(() => expect(session.mayGoOn.value).toBe(true));
    expect(session.needed.value).toBe(true);
    expect(session.ended.value).toBe('Your session has ended: it was ended elsewhere, it expired, or the gateway was restarted. Sign in again; what you typed is kept.');
    expect(await session.signIn('anna', 'x')).toBeNull();
    expect(session.needed.value).toBe(false);
  });
  it('is told by the answer about the session too, and by a cookie that is gone', async () => {
    const a = await signedIn(() => answer({ ...info({ user: null, role: null, via: 'none', csrf: null }), ended: 'the gateway was restarted' }), '/session');
    await a.session.ask();
    await vi.waitFor(() => expect(a.session.mayGoOn.value).toBe(true));
    expect(a.session.ended.value).toContain('the gateway was restarted');
    const b = await signedIn(() => answer(local), '/session');
    await b.session.ask();
    expect(b.session.ended.value).toContain('it was ended elsewhere, it expired, or the gateway was restarted.');
  });
});

describe('several tabs of one browser', () => {
  const channel = () => {
    const ends = [0, 1].map(() => ({ onmessage: null as ((e: MessageEvent) => void) | null, published: 0 }));
    return ends.map((own, i) => ({
      get onmessage() { return own.onmessage; },
      set onmessage(f) { own.onmessage = f; },
      postMessage: (data: unknown) => (own.published += 1, ends[1 - i]!.onmessage?.({ data } as MessageEvent)),
    }));
  };
  it('a sign-in and a sign-out in one are known in the others at once, also behind an ended session', async () => {
    let now = nobody;
    const caller = { call: async (_: string, o: { method?: string } = {}) => { if (o.method === 'POST') now = info(); if (o.method === 'DELETE') now = nobody; return now; }, csrf: null };
    const [one, two] = channel();
    const changed = vi.fn();
    const a = new Session(caller as never, () => undefined, one as never);
    const b = new Session({ ...caller } as never, changed, two as never);
    await Promise.all([a.ask(), b.ask()]);
    expect([a, b].map((s) => s.needed.value)).toEqual([true, true]);
    await a.signIn('anna', 'x');
    await vi.waitFor(() => expect(b.needed.value).toBe(false));
    expect(changed).toHaveBeenCalledTimes(1);
    await a.signOut();
    await vi.waitFor(() => expect(b.needed.value).toBe(true));
    expect(b.ended.value).toContain('Your session has ended');
    await a.signIn('anna', 'x');
    await vi.waitFor(() => expect(b.needed.value).toBe(false));
    expect(b.ended.value).toBe('');
  });
});

it('a stop is barred only where the gateway has said that it serves nobody here', async () => {
  const { session } = made(() => answer(nobody));
  expect(session.stopBarred.value).toBe('');
  await session.ask();
  expect(session.stopBarred.value).toContain('the machine’s own emergency stop');
  session.info.value = info({ user: null, via: 'local', role: 'viewer' });
  expect(session.stopBarred.value).toBe('');
});

describe('session', () => {
  it('signs in and out, and says that one is another', async () => {
    let now = nobody;
    const { client, session, changed } = made((_url, init) => {
      if (init.method === 'POST') now = info();
      if (init.method === 'DELETE') now = nobody;
      return init.method === 'DELETE' ? answer(null, 204) : answer(now);
    });
    await session.ask();
    expect(session.needed.value).toBe(true);
    expect(await session.signIn('anna', 'x')).toBeNull();
    expect(session.needed.value).toBe(false);
    expect(client.csrf).toBe('c1');
    expect(await session.signOut()).toBeNull();
    expect(session.ended.value).toBe('');
    expect(session.needed.value).toBe(true);
    expect(client.csrf).toBeNull();
    expect(changed).toHaveBeenCalledTimes(2);
  });
  it('says a lockout with the seconds to wait, and a wrong password in the words of the gateway', async () => {
    const locked = made(() => answer({ detail: 'wait' }, 429, { 'retry-after': '8' }));
    expect(signInText((await locked.session.signIn('anna', 'x'))!)).toBe('Too many wrong attempts. Try again in 8 s.');
    const error = made(() => answer({ detail: 'the name or the password is wrong' }, 401));
    expect(signInText((await error.session.signIn('anna', 'x'))!)).toBe('the name or the password is wrong');
    expect(error.asked).toHaveLength(1);
  });
  it('keeps what was known when the gateway does not answer', async () => {
    let up = true;
    const { session } = made(() => {
      if (!up) throw new TypeError('gone');
      return answer(info());
    });
    await session.ask();
    up = false;
    await session.ask();
    expect(session.info.value?.user).toBe('anna');
  });
  it.each([
    [null, 'administrator', ''],
    [info({ role: 'viewer' }), 'viewer', ''],
    [info({ role: 'viewer' }), 'operator', 'This needs the role operator. Yours is viewer.'],
    [info({ role: 'operator' }), 'engineer', 'This needs the role engineer. Yours is operator.'],
    [info({ role: 'administrator' }), 'engineer', ''],
    [nobody, 'viewer', 'This needs the role viewer. You are not signed in.'],
  ] as const)('%# tells why a role may not', (who, need, why) => {
    const { session } = made(() => answer({}));
    session.info.value = who;
    expect(session.mayNot(need)).toBe(why);
  });
  it('says who one is', () => {
    expect(whoText(info())).toBe('anna, engineer');
    expect(whoText(info({ user: null, via: 'local' }))).toBe('local access, engineer');
    expect(whoText(nobody)).toBe('not signed in');
  });
  it('tells the rules of names and passwords', () => {
    expect(passwordFault('short', 'short')).toContain('at least 12');
    expect(passwordFault('long enough 12', 'long enough 13')).toContain('not the same');
    expect(passwordFault('long enough 12', 'long enough 12')).toBe('');
    expect(userFault('Anna')).not.toBe('');
    expect(userFault('anna.b-1@x')).toBe('');
  });
  it('makes a refusal of anything', () => expect(signInText(asProblem(new Problem('unreachable', 'gone')))).toBe('gone'));
});

describe('authority', () => {
  const now = Date.parse('2026-01-02T03:04:00Z');
  it.each([
    ['', null, 'Nobody holds it', false],
    ['anna page-abc123', '2026-01-02T03:04:12Z', 'Held by this page, 12 s left', true],
    ['anna page-zzz999', '2026-01-02T03:04:12Z', 'Held by anna, 12 s left', false],
    ['10.0.0.7', '2026-01-02T03:03:59Z', 'Held by 10.0.0.7, about to end', false],
  ])('of %j is said', (authority_holder, authority_until, text, mine) => {
    const held = heldBy({ authority_holder, authority_until }, now, 'page-abc123');
    expect(heldText(held)).toBe(text);
    expect(held.mine).toBe(mine);
  });
});

it('a lease can be given to whoever is there or holds another axis, to a user by her name alone, not to the page itself', () => {
  const held = [{ door: 'http', holder: 'anna page-abc123' }, { door: 'http', holder: 'bert page-000000' }, { door: 'none', holder: '' }];
  const there = ['http anna page-abc123', 'http olga page-77', 'http line3', 'modbus 192.0.2.7'];
  expect(handOverChoices(held, there, 'page-abc123')).toEqual(['http bert', 'http bert page-000000', 'http line3', 'http olga', 'http olga page-77', 'modbus 192.0.2.7']);
});

describe('who was signed in in this browser', () => {
  const local = info({ user: null, via: 'local', csrf: null });
  const open = (signedIn: Signal<string>, now: () => SessionInfo) => {
    const { client, changed } = made((_, init) => (init.method === 'DELETE' ? answer(null, 204) : answer(now())));
    return new Session(client, changed, null, signedIn);
  };
  it('is asked for a sign-in by a page that is loaded after the end of the session, until he goes on without on purpose', async () => {
    const signedIn = signal('');
    let now = info();
    await open(signedIn, () => now).ask();
    expect(signedIn.value).toBe('anna');
    now = local; // ended elsewhere, and the cookie with it
    const reloaded = open(signedIn, () => now);
    await reloaded.ask();
    expect([reloaded.needed.value, reloaded.mayGoOn.value]).toEqual([true, true]);
    reloaded.goOn();
    const again = open(signedIn, () => now);
    await again.ask();
    expect(again.needed.value).toBe(false);
  });
  it('is local access again without a question when he signed out himself', async () => {
    const signedIn = signal('');
    let now = info();
    const session = open(signedIn, () => now);
    await session.ask();
    now = local;
    await session.signOut();
    const reloaded = open(signedIn, () => now);
    await reloaded.ask();
    expect([signedIn.value, reloaded.needed.value]).toEqual(['', false]);
  });
});
