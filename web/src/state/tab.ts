// Tab: the name of this tab, by which the gateway tells one page from another. In: the name kept for the tab's session, a channel between tabs.
// Out: a name that no other open tab has. A reload keeps it. A duplicated or opened tab starts with a copy of the other's session: it asks whether
// its name is taken, waits a moment for the answer, and takes a fresh one. An answer that comes late (a sleeping tab) still counts.
// Never waits longer than `wait_ms`; without a channel the kept name is used as it is.
import { signal, type ReadonlySignal, type Signal } from '@preact/signals';

export interface TabChannel {
  postMessage(message: unknown): void;
  onmessage: ((event: MessageEvent) => void) | null;
}
type Published = { kind: 'whose' | 'mine'; name: string; nonce: string };

export const tabNameLength = 6;
const random = (n: number): string => Array.from({ length: n }, () => Math.floor(Math.random() * 36).toString(36)).join('');
export const freshTabName = (): string => `page-${random(tabNameLength)}`;

export class Tab {
  readonly name: ReadonlySignal<string>;
  /** The name can be relied on. */
  readonly settled: Promise<void>;
  private readonly own: Signal<string>;
  private readonly nonce = random(12);

  constructor(
    /** What is kept in the tab's session; '' in a new tab. */
    private readonly stored: Signal<string>,
    private readonly channel: TabChannel | null,
    wait_ms = 120,
  ) {
    const inherited = stored.peek() !== '';
    if (!inherited) stored.value = freshTabName();
    this.own = signal(stored.peek());
    this.name = this.own;
    if (!channel) {
      this.settled = Promise.resolve();
      return;
    }
    let settle = (): void => undefined;
    this.settled = inherited ? new Promise((r) => (settle = r)) : Promise.resolve();
    channel.onmessage = (event) => {
      const published = event.data as Published | null;
      if (published?.name !== this.own.peek() || typeof published.nonce !== 'string') return;
      if (published.kind === 'whose' && published.nonce !== this.nonce) this.say('mine', published.nonce);
      else if (published.kind === 'mine' && published.nonce === this.nonce) {
        this.rename();
        settle();
      }
    };
    if (!inherited) return;
    this.say('whose', this.nonce);
    setTimeout(settle, wait_ms);
  }

  private rename(): void {
    this.stored.value = this.own.value = freshTabName();
  }

  private say(kind: Published['kind'], nonce: string): void {
    try {
      this.channel?.postMessage({ kind, name: this.own.peek(), nonce } satisfies Published);
    } catch {
      // A channel that is shut tells nobody; the name stays.
    }
  }
}

/** Between the tabs of this browser that are open on this gateway; null where there is none. */
export function tabChannel(name = 'axisgate.tab'): TabChannel | null {
  try {
    return typeof BroadcastChannel === 'function' ? new BroadcastChannel(name) : null;
  } catch {
    return null;
  }
}
