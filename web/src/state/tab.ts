// Tab: the name of this tab, by which the gateway tells one page from another. In: the name kept for the tab's session, a channel between tabs.
// Out: a name that no other open tab has. A reload keeps it. A duplicated or opened tab starts with a copy of the other's session: it asks whether
// its name is taken, waits a moment for the answer, and takes a fresh one. An answer that comes late (a sleeping tab) still counts.
// Never waits longer than `wait_ms`; without a channel the kept name is used as it is.
import { signal, type ReadonlySignal, type Signal } from '@preact/signals';

export interface TabChannel {
  postMessage(message: unknown): void;
  onmessage: ((event: MessageEvent) => void) | null;
}
type Said = { kind: 'whose' | 'mine'; name: string; nonce: string };

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
    private readonly kept: Signal<string>,
    private readonly channel: TabChannel | null,
    wait_ms = 120,
  ) {
    const inherited = kept.peek() !== '';
    if (!inherited) kept.value = freshTabName();
    this.own = signal(kept.peek());
    this.name = this.own;
    if (!channel) {
      this.settled = Promise.resolve();
      return;
    }
    let settle = (): void => undefined;
    this.settled = inherited ? new Promise((r) => (settle = r)) : Promise.resolve();
    channel.onmessage = (event) => {
      const said = event.data as Said | null;
      if (said?.name !== this.own.peek() || typeof said.nonce !== 'string') return;
      if (said.kind === 'whose' && said.nonce !== this.nonce) this.say('mine', said.nonce);
      else if (said.kind === 'mine' && said.nonce === this.nonce) {
        this.rename();
        settle();
      }
    };
    if (!inherited) return;
    this.say('whose', this.nonce);
    setTimeout(settle, wait_ms);
  }

  private rename(): void {
    this.kept.value = this.own.value = freshTabName();
  }

  private say(kind: Said['kind'], nonce: string): void {
    try {
      this.channel?.postMessage({ kind, name: this.own.peek(), nonce } satisfies Said);
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
