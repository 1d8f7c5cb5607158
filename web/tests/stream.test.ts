// The stream with a false socket and a false clock: growing pauses, signs of life, and never "live" before the gateway has spoken.
import { afterEach, beforeEach, describe, expect, it, vi } from 'vitest';
import { Stream, type StreamMessage, type StreamState } from '../src/api/stream';
import { streamUrl } from '../src/gateway';

class FalseSocket {
  static all: FalseSocket[] = [];
  static get last(): FalseSocket {
    return FalseSocket.all.at(-1) as FalseSocket;
  }
  readyState = 0;
  sent: string[] = [];
  closed = false;
  onopen: (() => void) | null = null;
  onmessage: ((e: { data: unknown }) => void) | null = null;
  onclose: ((e: { code: number; reason: string }) => void) | null = null;
  onerror: (() => void) | null = null;
  constructor(readonly url: string) {
    FalseSocket.all.push(this);
  }
  send(text: string): void {
    this.sent.push(text);
  }
  close(): void {
    this.closed = true;
  }
  opens(): void {
    this.readyState = 1;
    this.onopen?.();
  }
  says(message: unknown): void {
    this.onmessage?.({ data: typeof message === 'string' ? message : JSON.stringify(message) });
  }
  ends(code = 1006, reason = ''): void {
    this.readyState = 3;
    this.onclose?.({ code, reason });
  }
}

let states: StreamState[];
let messages: StreamMessage[];
const state = () => states.at(-1) as StreamState;
const make = (more: object = {}) =>
  new Stream({
    url: 'ws://gateway/api/v1/stream',
    onState: (s) => states.push(s),
    onMessage: (m) => messages.push(m),
    open: (url) => new FalseSocket(url) as unknown as WebSocket,
    now: () => Date.now(),
    random: () => 0.5,
    ...more,
  });
const site = { topic: 'site', at: 1, data: { revision: 1 } };
const live = (stream = make()) => {
  stream.start();
  FalseSocket.last.opens();
  FalseSocket.last.says(site);
  return stream;
};

beforeEach(() => {
  vi.useFakeTimers({ now: 1_000_000 });
  states = [];
  messages = [];
  FalseSocket.all = [];
});
afterEach(() => void vi.useRealTimers());

describe('going live', () => {
  it('is live only after the gateway has spoken', () => {
    const s = make();
    s.start();
    expect(state().phase).toBe('connecting');
    FalseSocket.last.opens();
    expect(state().phase).toBe('connecting');
    FalseSocket.last.says(site);
    expect(state()).toMatchObject({ phase: 'live', epoch: 1 });
  });
  it('asks for a topic that is wanted between the opening and the first word', () => {
    const s = make();
    s.start();
    s.subscribe({ 'axes/*': 100 });
    expect(FalseSocket.last.sent).toEqual([]);
    FalseSocket.last.opens();
    s.subscribe({ 'lines/can0/frames': 200 });
    s.unsubscribe('axes/*');
    expect(FalseSocket.last.sent.map((t) => JSON.parse(t))).toEqual([
      { subscribe: ['site'], period_ms: 1000 },
      { subscribe: ['axes/*'], period_ms: 100 },
      { subscribe: ['lines/can0/frames'], period_ms: 200 },
      { unsubscribe: ['axes/*'] },
    ]);
  });
  it('asks for its topics, by period, and for the site that answers at once', () => {
    const s = make();
    s.subscribe({ 'axes/*': 100, events: 1000, 'lines/*': 1000 });
    s.start();
    FalseSocket.last.opens();
    expect(FalseSocket.last.sent.map((t) => JSON.parse(t))).toEqual([
      { subscribe: ['site', 'events', 'lines/*'], period_ms: 1000 },
      { subscribe: ['axes/*'], period_ms: 100 },
    ]);
  });
  it('asks again for everything after a reconnection, and not for what was given up', () => {
    const s = live();
    s.subscribe({ 'axes/feeder': 50, 'axes/*': 100 });
    s.unsubscribe('axes/feeder');
    expect(FalseSocket.last.sent.at(-1)).toBe('{"unsubscribe":["axes/feeder"]}');
    FalseSocket.last.ends();
    vi.advanceTimersByTime(600);
    FalseSocket.last.opens();
    expect(FalseSocket.last.sent.join()).toContain('axes/*');
    expect(FalseSocket.last.sent.join()).not.toContain('axes/feeder');
  });
  it('hands messages on, and ignores what is not one', () => {
    live();
    FalseSocket.last.says('not json');
    FalseSocket.last.says('null');
    FalseSocket.last.says({ topic: 'axes/feeder', at: 5, data: {} });
    expect(messages.map((m) => m.topic)).toEqual(['site', 'axes/feeder']);
  });
});

describe('losing it', () => {
  it('waits longer and longer, up to 10 s', () => {
    make().start();
    const pauses: number[] = [];
    for (let i = 0; i < 7; i += 1) {
      FalseSocket.last.ends();
      expect(state().phase).toBe('waiting');
      pauses.push(state().retryAt - Date.now());
      vi.advanceTimersByTime(state().retryAt - Date.now());
      expect(state().phase).toBe('connecting');
    }
    expect(pauses).toEqual([500, 1000, 2000, 4000, 8000, 10000, 10000]);
    expect(FalseSocket.all).toHaveLength(8);
  });
  it('spreads the pauses by chance, but not beyond the longest', () => {
    const s = make({ random: () => 1, firstPause_ms: 10_000 });
    s.start();
    FalseSocket.last.ends();
    expect(state().retryAt - Date.now()).toBe(10_000);
    FalseSocket.all = [];
    const quick = make({ random: () => 0 });
    quick.start();
    FalseSocket.last.ends();
    expect(state().retryAt - Date.now()).toBe(400);
  });
  it('begins with short pauses again after a connection that lasted', () => {
    live();
    for (let i = 0; i < 6; i += 1) {
      vi.advanceTimersByTime(1000);
      FalseSocket.last.says(site);
    }
    FalseSocket.last.ends();
    expect(state()).toMatchObject({ attempts: 1 });
  });
  it('does not knock twice a second at a gateway that accepts and closes in a circle', () => {
    live();
    for (let i = 1; i <= 4; i += 1) {
      FalseSocket.last.ends();
      expect(state().attempts).toBe(i);
      vi.advanceTimersByTime(state().retryAt - Date.now());
      FalseSocket.last.opens();
      FalseSocket.last.says(site);
      expect(state().phase).toBe('live');
    }
  });
  it('tells when it was last live and counts the connections', () => {
    live();
    vi.advanceTimersByTime(1500);
    FalseSocket.last.says(site);
    const received = Date.now();
    vi.advanceTimersByTime(1000);
    FalseSocket.last.ends(1001);
    expect(state()).toMatchObject({ phase: 'waiting', lastLiveAt: received, why: 'the gateway has stopped', epoch: 1 });
    vi.advanceTimersByTime(600);
    FalseSocket.last.opens();
    FalseSocket.last.says(site);
    expect(state()).toMatchObject({ phase: 'live', epoch: 2, why: '' });
  });
  it('tries at once when asked to', () => {
    const s = make();
    s.start();
    FalseSocket.last.ends();
    s.retryNow();
    expect(FalseSocket.all).toHaveLength(2);
    s.retryNow(); // is trying already
    expect(FalseSocket.all).toHaveLength(2);
  });
  it('gives up an attempt that is not answered in 5 s', () => {
    make().start();
    vi.advanceTimersByTime(5000);
    expect(state()).toMatchObject({ phase: 'waiting', why: 'the gateway does not answer' });
    expect(FalseSocket.last.closed).toBe(true);
  });
  it('hears nothing of a socket that was given up', () => {
    make().start();
    const old = FalseSocket.last;
    vi.advanceTimersByTime(5000);
    old.says(site);
    old.ends();
    expect(messages).toEqual([]);
    expect(state().attempts).toBe(1);
  });
  it('survives an address that cannot be opened', () => {
    const s = make({
      open: () => {
        throw new Error('bad address');
      },
    });
    s.start();
    expect(state()).toMatchObject({ phase: 'waiting', why: 'bad address' });
  });
  it('ends when stopped', () => {
    const s = live();
    s.stop();
    expect(FalseSocket.last.closed).toBe(true);
    vi.advanceTimersByTime(60_000);
    expect(FalseSocket.all).toHaveLength(1);
  });
});

describe('signs of life', () => {
  it('asks after 0.7 s of silence and stays live if the answer comes', () => {
    live();
    const before = FalseSocket.last.sent.length;
    vi.advanceTimersByTime(700);
    expect(FalseSocket.last.sent.slice(before)).toEqual(['{"subscribe":["site"]}']);
    vi.advanceTimersByTime(600);
    FalseSocket.last.says(site);
    vi.advanceTimersByTime(600);
    expect(state().phase).toBe('live');
  });
  it('is not live 1.4 s after the last word of a dead cable, and lost after 4 s', () => {
    live();
    const received = Date.now();
    vi.advanceTimersByTime(1390);
    expect(state().phase).toBe('live');
    vi.advanceTimersByTime(20);
    expect(state()).toMatchObject({ phase: 'silent', why: 'the gateway has fallen silent', lastLiveAt: received, epoch: 1 });
    expect(FalseSocket.last.closed).toBe(false);
    vi.advanceTimersByTime(2580);
    expect(state().phase).toBe('silent');
    vi.advanceTimersByTime(20);
    expect(state()).toMatchObject({ phase: 'waiting', why: 'the gateway has fallen silent', lastLiveAt: received });
    expect(FalseSocket.last.closed).toBe(true);
  });
  it('is live again with the next word, on the same connection, and watched as before', () => {
    live();
    vi.advanceTimersByTime(2000);
    expect(state().phase).toBe('silent');
    FalseSocket.last.says(site);
    expect(state()).toMatchObject({ phase: 'live', epoch: 1, why: '' });
    vi.advanceTimersByTime(1410);
    expect(state().phase).toBe('silent');
  });
  it('is no silence of the gateway when the page itself was held up: what waited is heard first', () => {
    live();
    vi.advanceTimersByTime(700); // asked
    vi.setSystemTime(Date.now() + 3_000); // a long task: the answer is there, but the timer comes first
    vi.advanceTimersByTime(700);
    expect(state().phase).toBe('live');
    FalseSocket.last.says(site);
    vi.advanceTimersByTime(100);
    expect(state().phase).toBe('live');
  });
  it('does not ask while the gateway speaks', () => {
    live();
    const before = FalseSocket.last.sent.length;
    for (let i = 0; i < 20; i += 1) {
      vi.advanceTimersByTime(500);
      FalseSocket.last.says(site);
    }
    expect(FalseSocket.last.sent.length).toBe(before);
  });
  it('asks at once when the page wakes up after a long silence', () => {
    const s = live();
    const before = FalseSocket.last.sent.length;
    vi.setSystemTime(Date.now() + 3_600_000); // asleep: no timer ran
    s.wake();
    expect(FalseSocket.last.sent.length).toBe(before + 1);
  });
});

it('uses the protocol and host of the page', () => {
  expect(streamUrl({ protocol: 'http:', host: 'a:8080' })).toBe('ws://a:8080/api/v1/stream');
  expect(streamUrl({ protocol: 'https:', host: 'b' })).toBe('wss://b/api/v1/stream');
});
