// The whole page over the mock door, in one process: every request and the stream are real, only the wire between them is not.
// In: a door, perhaps furnished. Out: the page as a person has it: what it says, its buttons and fields, and the way to be somebody else beside it.
// Nothing waits for time here: the world stands still until a test lets it go on.
import './all-pages';
import { render } from 'preact';
import { afterAll, vi } from 'vitest';
import { MockDoor } from '../dev/mock/door.mjs';
import { MockStream } from '../dev/mock/stream.mjs';
import { Client } from '../src/api/client';
import { App } from '../src/app';
import { Gateway, GatewayProvider } from '../src/gateway';
import { route, routeOf } from '../src/router';
import { persisted } from '../src/state/persisted';

export interface How {
  door?: MockDoor;
  cookie?: string;
  /** As after a reload: what the session of the tab keeps is still there. */
  again?: boolean;
}
// A slow machine has its time: what is waited for ends a wait at once, and what never comes is told all the same.
const limit_ms = 20_000;
vi.setConfig({ testTimeout: 60_000 });
/** A picture is drawn up to 250 ms after its cause; none may be asked for when the window of the file is gone. */
afterAll(() => new Promise((resolve) => setTimeout(resolve, 300)));
/** Until it holds; fails with why it does not. */
export const soon = <T,>(holds: () => T | Promise<T>): Promise<T> => vi.waitFor(holds, { timeout: limit_ms, interval: 5 });

type Answer = { status: number; head: Record<string, string>; body: any };

/** A browser's half of the wire: its cookie, and whether the gateway is there. */
class Wire {
  cookie = '';
  away = false;
  readonly asked: string[] = [];
  private readonly sockets = new Set<Socket>();
  constructor(readonly door: MockDoor) {}

  fetch = async (url: RequestInfo | URL, init: RequestInit = {}): Promise<Response> => {
    const method = init.method ?? 'GET';
    this.asked.push(`${method} ${String(url).replace('/api/v1', '')}`);
    await Promise.resolve();
    if (this.away) throw new TypeError('Failed to fetch');
    const text = init.body === undefined || init.body === null ? '' : typeof init.body === 'string' ? init.body : await new Response(init.body).text();
    const a = this.door.answer({ method, target: String(url), head: { ...(init.headers as Record<string, string>), ...(this.cookie ? { cookie: this.cookie } : {}) }, text, peer: '127.0.0.1:50001' });
    const set = a.head['set-cookie'];
    if (set !== undefined) this.cookie = /Max-Age=0/.test(set) ? '' : (set.split(';')[0] as string);
    return new Response(a.status === 204 ? null : a.text, { status: a.status, headers: a.head });
  };
  open = (socket: Socket): MockStream | null => {
    if (this.away || !this.door.serves(this.cookie ? { cookie: this.cookie } : {})) return null;
    this.sockets.add(socket);
    return new MockStream(this.door, (text) => queueMicrotask(() => socket.onmessage?.({ data: text } as MessageEvent)));
  };
  forget = (socket: Socket) => this.sockets.delete(socket);
  /** As a gateway that stops, or a cable that is drawn: nothing is heard any more, nothing can be asked. */
  goAway(): void {
    this.away = true;
    for (const s of this.sockets) s.shut(1001);
  }
  /** What has changed is told; the world itself is not moved. */
  turn(): void {
    for (const s of this.sockets) s.stream?.turn(performance.now() + 10_000);
  }
}

let wire: Wire;
class Socket {
  readyState = 0;
  stream: MockStream | null = null;
  onopen: (() => void) | null = null;
  onmessage: ((e: MessageEvent) => void) | null = null;
  onclose: ((e: CloseEvent) => void) | null = null;
  onerror: (() => void) | null = null;
  constructor() {
    queueMicrotask(() => {
      this.stream = wire.open(this);
      if (!this.stream) return this.shut(1006);
      this.readyState = 1;
      this.onopen?.();
    });
  }
  send(text: string): void {
    this.stream?.hear(text, performance.now());
  }
  close(): void {
    this.readyState = 3;
    wire.forget(this);
    this.stream?.end();
    this.stream = null;
  }
  shut(code: number): void {
    this.close();
    this.onclose?.({ code, reason: '' } as CloseEvent);
  }
}

export interface MockPage {
  door: MockDoor;
  wire: Wire;
  gateway: Gateway;
  root: HTMLElement;
  text(selector: string): string;
  button(name: string): HTMLButtonElement;
  /** By its label or its aria-label. */
  field(name: string): HTMLInputElement;
  type(field: HTMLElement, value: string): void;
  /** One of several. */
  choose(name: string): void;
  go(path: string): void;
  /** Until it is so; fails with what it is. */
  see(selector: string, text: RegExp | string): Promise<void>;
  press(name: string): Promise<void>;
  /** Until what is drawn has had its effects: what would be asked by them has been asked. */
  drawn(): Promise<void>;
  /** Somebody else at the same gateway, with a name of his own. */
  other(method: string, path: string, body?: unknown, head?: Record<string, string>): Answer;
  close(): void;
}

const squeezed = (e: Element | null | undefined) => e?.textContent?.replace(/\s+/g, ' ').trim() ?? '';

export async function openPage(path: string, { door: made = new MockDoor(), cookie = '', again = false }: How = {}): Promise<MockPage> {
  // What another test has typed or chosen is none of this one's.
  const mine = ['line', 'drive', 'axis'].flatMap((k) => [`wizard.${k}`, `wizard.typed.${k}`]);
  if (!again) for (const name of ['site.draft', 'site.wizard', ...mine]) persisted(name).value = '';
  if (!again) persisted('wizard.step', '0').value = '0';
  wire = new Wire(made);
  wire.cookie = cookie;
  const here = wire;
  vi.stubGlobal('WebSocket', Socket);
  route.value = routeOf(path);
  const root = document.createElement('div');
  document.body.append(root);
  const client: Client = new Client('/api/v1', here.fetch as typeof fetch, () => gateway.tab.name.peek());
  const gateway: Gateway = new Gateway({ client, url: 'ws://mock/' });
  gateway.start();
  render(<GatewayProvider value={gateway}><App /></GatewayProvider>, root);
  const all = <E extends Element>(selector: string) => [...root.querySelectorAll<E>(selector)].filter((e) => !e.closest('[hidden]'));
  const p: MockPage = {
    door: made,
    wire: here,
    gateway,
    root,
    text: (selector) => squeezed(all(selector)[0]),
    button(name) {
      const b = all<HTMLButtonElement>('button').find((e) => (e.getAttribute('aria-label') ?? squeezed(e)) === name);
      if (!b) throw new Error(`there is no button ${name}; there are: ${all('button').map((e) => e.getAttribute('aria-label') ?? squeezed(e)).join(', ')}`);
      return b;
    },
    field(name) {
      const fields = all<HTMLInputElement>('input, select, textarea');
      const named = (e: HTMLInputElement) => e.getAttribute('aria-label') ?? squeezed(root.querySelector(`label[for="${e.id}"]`) ?? e.closest('label')?.querySelector('span') ?? e.closest('label'));
      const f = fields.find((e) => named(e) === name);
      if (!f) throw new Error(`there is no field ${name}; there are: ${fields.map(named).join(', ')}`);
      return f;
    },
    type(field, value) {
      (field as HTMLInputElement).value = value;
      field.dispatchEvent(new Event('input', { bubbles: true }));
      field.dispatchEvent(new Event('change', { bubbles: true }));
    },
    choose(name) {
      p.field(name).checked = true;
      p.field(name).dispatchEvent(new Event('change', { bubbles: true }));
    },
    go: (to) => (route.value = routeOf(to)),
    see: (selector, text) =>
      soon(() => {
        const now = p.text(selector);
        if (typeof text === 'string' ? !now.includes(text) : !text.test(now)) throw new Error(`${selector} does not say ${text}: ${now}`);
      }),
    async press(name) {
      await soon(() => {
        if (p.button(name).disabled) throw new Error(`${name} cannot be pressed`);
      });
      p.button(name).click();
    },
    async drawn() {
      for (let i = 0; i < 3; i += 1) await new Promise<void>((r) => requestAnimationFrame(() => setTimeout(r, 0)));
    },
    other(method, target, body, head = {}) {
      const a = made.answer({ method, target: `/api/v1${target}`, head: { 'x-client': 'bert', ...head }, text: body === undefined ? '' : JSON.stringify(body), peer: '10.0.0.9:50002' });
      return { status: a.status, head: a.head, body: a.text ? JSON.parse(a.text) : null };
    },
    close() {
      render(null, root);
      root.remove();
      gateway.stream.stop();
      vi.unstubAllGlobals();
    },
  };
  return p;
}
