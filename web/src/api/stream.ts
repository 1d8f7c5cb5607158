// Stream: the one WebSocket of the page, kept up. In: topics that the page wants. Out: messages, and the state of the connection.
// Pauses between attempts grow from 0.5 s to 10 s and start anew only after a connection that was live for 5 s. A connection that says nothing for
// `quiet_ms` is asked for a sign of life; after `answer_ms` without one it is "silent", not live any more, and live again with the next word; after
// `lost_ms` without a word it is given up: a dead cable closes no socket by itself.
// Never keeps messages: they go to the reader at once. Never reports "live" before the gateway has spoken.
import { t } from '../language';

/** `silent`: it was live, the socket is open, but nobody answers. */
export type Phase = 'connecting' | 'live' | 'silent' | 'waiting';

export interface StreamState {
  phase: Phase;
  /** Counts connections that went live; what was heard under an older number is not live any more. */
  epoch: number;
  /** When it was last live; milliseconds of the page's own clock, 0: never. */
  lastLiveAt: number;
  /** When the next attempt is made; only while waiting. */
  retryAt: number;
  attempts: number;
  why: string;
}

export interface StreamMessage {
  topic: string;
  /** ns since 1970, the gateway's clock (rounded to what a double holds). */
  at: number;
  data: unknown;
}

export interface StreamOptions {
  url: string;
  onState: (state: StreamState) => void;
  onMessage: (message: StreamMessage) => void;
  open?: (url: string) => WebSocket;
  now?: () => number;
  random?: () => number;
  firstPause_ms?: number;
  longestPause_ms?: number;
  connectLimit_ms?: number;
  quiet_ms?: number;
  answer_ms?: number;
  lost_ms?: number;
}

const steady_ms = 5_000;
const mostLate_ms = 300;
const silence = t('the gateway has fallen silent');
/** Asking for `site` anew is answered at once: that is the sign of life. */
const signOfLife = JSON.stringify({ subscribe: ['site'] });

export class Stream {
  private socket: WebSocket | undefined;
  private timer: ReturnType<typeof setTimeout> | undefined;
  private wanted = new Map<string, number>();
  private receivedAt = 0;
  private liveSince = 0;
  private askedAt = 0;
  private dueAt = 0;
  private stopped = true;
  private state: StreamState = { phase: 'connecting', epoch: 0, lastLiveAt: 0, retryAt: 0, attempts: 0, why: '' };
  private readonly o: Required<StreamOptions>;

  constructor(options: StreamOptions) {
    this.o = {
      open: (url) => new WebSocket(url),
      now: () => performance.now(),
      random: Math.random,
      firstPause_ms: 500,
      longestPause_ms: 10_000,
      connectLimit_ms: 5_000,
      // The gateway speaks once a second even when nothing changes; between two of its words it is asked once. Together: not live after 1.4 s.
      quiet_ms: 700,
      answer_ms: 700,
      lost_ms: 4_000,
      ...options,
    };
  }

  start(): void {
    if (!this.stopped) return;
    this.stopped = false;
    this.connect();
  }

  stop(): void {
    this.stopped = true;
    clearTimeout(this.timer);
    this.drop();
  }

  /** Tries at once, without waiting for the pause to end (a button; the network came back; the page is seen again). */
  retryNow(): void {
    if (this.stopped || this.state.phase !== 'waiting') return;
    clearTimeout(this.timer);
    this.connect();
  }

  /** Something woke the page up: look whether the connection is alive, without waiting for the next turn. */
  wake(): void {
    if (this.stopped) return;
    if (this.state.phase === 'waiting') this.retryNow();
    else if (this.state.phase === 'live' || this.state.phase === 'silent') this.watch();
  }

  subscribe(topics: Record<string, number>): void {
    for (const [topic, period_ms] of Object.entries(topics)) this.wanted.set(topic, period_ms);
    // As soon as the socket is open, also before the first answer: what was wanted at its opening has been asked for by then, this has not.
    this.ask(Object.entries(topics));
  }

  unsubscribe(topic: string): void {
    if (this.wanted.delete(topic)) this.send(JSON.stringify({ unsubscribe: [topic] }));
  }

  private tell(change: Partial<StreamState>): void {
    this.state = { ...this.state, ...change };
    this.o.onState(this.state);
  }

  private connect(): void {
    this.tell({ phase: 'connecting', retryAt: 0 });
    let socket: WebSocket;
    try {
      socket = this.o.open(this.o.url);
    } catch (error) {
      return this.lost(error instanceof Error ? error.message : t('the address cannot be opened'));
    }
    this.socket = socket;
    this.timer = setTimeout(() => this.lost(t('the gateway does not answer')), this.o.connectLimit_ms);
    socket.onopen = () => {
      if (socket !== this.socket) return;
      // Live only after the first answer: an open socket alone says nothing about the gateway behind it.
      this.ask([['site', 1000], ...[...this.wanted].filter(([t]) => t !== 'site')]);
    };
    socket.onmessage = (event: MessageEvent) => {
      if (socket === this.socket) this.received(event.data);
    };
    socket.onclose = (event: CloseEvent) => {
      if (socket === this.socket) this.lost(closeText(event));
    };
    socket.onerror = () => {
      // The close event follows and says more.
    };
  }

  private received(text: unknown): void {
    this.receivedAt = this.o.now();
    this.askedAt = 0;
    if (this.state.phase === 'connecting') {
      clearTimeout(this.timer);
      this.liveSince = this.receivedAt;
      this.tell({ phase: 'live', epoch: this.state.epoch + 1, why: '', lastLiveAt: this.receivedAt });
      this.again(this.o.quiet_ms);
    } else if (this.state.phase === 'silent') {
      this.tell({ phase: 'live', why: '' });
      this.again(this.o.quiet_ms);
    }
    if (typeof text !== 'string') return;
    let message: StreamMessage;
    try {
      message = JSON.parse(text) as StreamMessage;
    } catch {
      return; // not ours; the connection itself is alive
    }
    if (typeof message?.topic === 'string') this.o.onMessage(message);
  }

  private watch(): void {
    clearTimeout(this.timer);
    const now = this.o.now();
    const quiet = now - this.receivedAt;
    const waited = this.askedAt > 0 ? now - this.askedAt : 0;
    // Only a page that was held up itself comes so late: what has arrived meanwhile waits behind this timer and is heard first.
    const late = this.dueAt > 0 && now - this.dueAt > mostLate_ms;
    if (this.askedAt > 0 && waited >= this.o.answer_ms && !late) {
      if (quiet >= this.o.lost_ms) return this.lost(silence);
      if (this.state.phase === 'live') this.tell({ phase: 'silent', why: silence, lastLiveAt: this.receivedAt });
      return this.again(Math.max(this.o.lost_ms - quiet, 10));
    }
    if (quiet >= this.o.quiet_ms && this.askedAt === 0) {
      this.askedAt = now;
      this.send(signOfLife);
      return this.again(this.o.answer_ms);
    }
    this.again(Math.max(this.askedAt > 0 ? this.o.answer_ms - waited : this.o.quiet_ms - quiet, 10));
  }

  private again(in_ms: number): void {
    clearTimeout(this.timer);
    this.dueAt = this.o.now() + in_ms;
    this.timer = setTimeout(() => this.watch(), in_ms);
  }

  private ask(topics: Iterable<[string, number]>): void {
    const byPeriod = new Map<number, string[]>();
    for (const [topic, period] of topics) byPeriod.set(period, [...(byPeriod.get(period) ?? []), topic]);
    for (const [period_ms, subscribe] of byPeriod) this.send(JSON.stringify({ subscribe, period_ms }));
  }

  /** Nothing while the socket is not open: its opening asks for all that is wanted. */
  private send(text: string): void {
    if (this.socket?.readyState === 1 /* OPEN */) this.socket.send(text);
  }

  private drop(): void {
    const socket = this.socket;
    this.socket = undefined;
    this.askedAt = 0;
    if (!socket) return;
    socket.onopen = socket.onmessage = socket.onclose = socket.onerror = null;
    try {
      socket.close();
    } catch {
      // It was never open.
    }
  }

  private lost(why: string): void {
    clearTimeout(this.timer);
    const wasLive = this.state.phase === 'live' || this.state.phase === 'silent';
    const lastLiveAt = wasLive ? this.receivedAt : this.state.lastLiveAt;
    this.drop();
    if (this.stopped) return;
    // A gateway that accepts and closes in a circle is not knocked at twice a second for ever.
    const steady = wasLive && this.o.now() - this.liveSince >= steady_ms;
    const attempts = (steady ? 0 : this.state.attempts) + 1;
    const grown = Math.min(this.o.firstPause_ms * 2 ** (attempts - 1), this.o.longestPause_ms);
    // Spread by a fifth, so that many pages do not knock at the same instant after a restart.
    const pause = Math.min(grown * (0.8 + 0.4 * this.o.random()), this.o.longestPause_ms);
    this.timer = setTimeout(() => this.connect(), pause);
    this.tell({ phase: 'waiting', attempts, why, retryAt: this.o.now() + pause, lastLiveAt });
  }
}

function closeText(event: CloseEvent): string {
  if (event.reason) return event.reason;
  switch (event.code) {
    case 1001: return t('the gateway has stopped');
    case 1008: return t('the gateway refused the connection');
    case 1013: return t('this page read too slowly');
    default: return t('the gateway cannot be reached');
  }
}
