// Store: everything that the page knows of the gateway, as signals. In: the messages of the stream and a few lists from REST.
// Out: axes, drives, lines, events, the state of the connection. What was heard on an older connection is known to be old.
// States that come faster than the screen are replaced by newer ones before they are shown; events never are. At most 500 events
// are kept. Never talks to the network: it is handed what came.
import { batch, computed, signal, type ReadonlySignal, type Signal } from '@preact/signals';
import type { StreamMessage, StreamState } from '../api/stream';
import type { About, AlarmList, Axis, Drive, GatewayEvent, Line } from '../api/types';
import type { Families } from '../text/options';
import { AxisHistory } from './history';

export interface Known<T> {
  data: T;
  /** Number of the connection on which it was heard. */
  epoch: number;
}

export type AxisEntry = Known<Axis>;

/** How much a value of an axis can be trusted now. */
export type Trust = 'live' | 'stale' | 'offline' | 'disconnected';

const mostEvents = 500;

export interface StoreOptions {
  /** Runs the function before the next picture of the screen. */
  schedule?: (flush: () => void) => void;
  now?: () => number;
}

type Kind = 'axes' | 'drives' | 'lines';

class Shelf<T extends { name: string }> {
  readonly entries = new Map<string, Signal<Known<T>>>();
  readonly names = signal<string[]>([]);
  private readonly pending = new Map<string, Known<T> | null>();
  private order = new Map<string, number>();

  constructor(private readonly rank: (a: T, b: T, order: Map<string, number>) => number) {}

  get waits(): boolean {
    return this.pending.size > 0;
  }

  /** Whoever asks for what is not there yet is told when it appears: asking reads the names too. */
  get(name: string): Signal<Known<T>> | undefined {
    void this.names.value;
    return this.entries.get(name);
  }

  put(name: string, data: T | null, epoch: number): void {
    this.pending.set(name, data === null ? null : { data, epoch });
  }

  /** A whole list from REST; what it does not have is gone. What was heard on this connection already is newer than the list. */
  list(all: T[], epoch: number): void {
    this.order = new Map(all.map((x, i) => [x.name, i]));
    for (const item of all) {
      const known = this.pending.get(item.name) ?? this.entries.get(item.name)?.peek();
      if (known === undefined || known === null || known.epoch !== epoch) this.pending.set(item.name, { data: item, epoch });
    }
    for (const name of this.entries.keys()) if (!this.order.has(name)) this.pending.set(name, null);
    this.flush(true);
  }

  flush(sort = false): void {
    let changed = sort;
    for (const [name, known] of this.pending) {
      const entry = this.entries.get(name);
      if (known === null) {
        changed = this.entries.delete(name) || changed;
      } else if (entry) {
        entry.value = known;
      } else {
        this.entries.set(name, signal(known));
        changed = true;
      }
    }
    this.pending.clear();
    if (!changed) return;
    const sorted = [...this.entries.values()].map((e) => e.peek().data).sort((a, b) => this.rank(a, b, this.order)).map((x) => x.name);
    const before = this.names.peek();
    if (sorted.length !== before.length || sorted.some((n, i) => n !== before[i])) this.names.value = sorted;
  }
}

const byOrder = (a: { name: string }, b: { name: string }, order: Map<string, number>) =>
  (order.get(a.name) ?? 1e9) - (order.get(b.name) ?? 1e9) || a.name.localeCompare(b.name);

export class Store {
  readonly connection = signal<StreamState>({ phase: 'connecting', epoch: 0, lastLiveAt: 0, retryAt: 0, attempts: 0, why: '' });
  readonly connected: ReadonlySignal<boolean> = computed(() => this.connection.value.phase === 'live');
  readonly about = signal<About | null>(null);
  /** Families by name, as their makers call them; empty where the gateway does not say. */
  readonly familyTitles = signal<ReadonlyMap<string, string>>(new Map());
  /** What the gateway tells of whole families: options, units. */
  readonly families = signal<Families>(new Map());
  /** null: not told yet. 0 is the real revision of a gateway that has never had a site. */
  readonly siteRevision = signal<number | null>(null);
  /** The lists have come at least once: an empty page is then really an empty site. */
  readonly listed = signal(false);
  /** Newest first. */
  readonly events = signal<GatewayEvent[]>([]);
  /** As the gateway last told it; null until it has. */
  readonly alarms = signal<AlarmList | null>(null);
  readonly axisNames: ReadonlySignal<string[]>;
  readonly driveNames: ReadonlySignal<string[]>;
  readonly lineNames: ReadonlySignal<string[]>;
  readonly counts: ReadonlySignal<{ axes: number; moving: number; fault: number; simulated: number; offline: number }>;
  /** The gateway's clock minus the page's, from the quickest message so far. */
  clockOffset_ms = 0;

  private readonly axisShelf = new Shelf<Axis>((a, b) => a.number - b.number || a.name.localeCompare(b.name));
  private readonly driveShelf = new Shelf<Drive>(byOrder);
  private readonly lineShelf = new Shelf<Line>(byOrder);
  private readonly histories = new Map<string, AxisHistory>();
  private readonly simulations = new Map<string, Signal<boolean>>();
  private readonly eventListeners = new Set<(event: GatewayEvent) => void>();
  private pendingEvents: GatewayEvent[] = [];
  private scheduled = false;
  private readonly schedule: (flush: () => void) => void;
  private readonly now: () => number;
  private clockKnown = false;

  constructor(options: StoreOptions = {}) {
    this.schedule = options.schedule ?? ((f) => f());
    this.now = options.now ?? (() => Date.now());
    this.axisNames = this.axisShelf.names;
    this.driveNames = this.driveShelf.names;
    this.lineNames = this.lineShelf.names;
    this.counts = computed(() => {
      const c = { axes: 0, moving: 0, fault: 0, simulated: 0, offline: 0 };
      for (const name of this.axisNames.value) {
        const a = this.axisShelf.get(name)?.value.data;
        if (!a) continue;
        c.axes += 1;
        if (!a.online) c.offline += 1;
        else if (a.moving) c.moving += 1;
        if (a.fault) c.fault += 1;
        if (a.simulated) c.simulated += 1;
      }
      return c;
    });
  }

  axis(name: string): ReadonlySignal<AxisEntry> | undefined {
    return this.axisShelf.get(name);
  }
  drive(name: string): ReadonlySignal<Known<Drive>> | undefined {
    return this.driveShelf.get(name);
  }
  line(name: string): ReadonlySignal<Known<Line>> | undefined {
    return this.lineShelf.get(name);
  }

  /** Whether the model answers for it now. Changes only when that does, however often the rest is told: many places may follow it. */
  simulation(kind: 'axis' | 'drive', name: string): ReadonlySignal<boolean> {
    const key = `${kind}/${name}`;
    let s = this.simulations.get(key);
    if (!s) this.simulations.set(key, (s = signal(this.isSimulated(key))));
    return s;
  }
  private isSimulated(key: string): boolean {
    const name = key.slice(key.indexOf('/') + 1);
    if (key.startsWith('axis/')) return this.axisShelf.entries.get(name)?.peek().data.presence === 'twin';
    return this.driveShelf.entries.get(name)?.peek().data.status.simulated === true;
  }
  private lookAtSimulations(): void {
    for (const [key, s] of this.simulations) s.value = this.isSimulated(key);
  }

  history(axis: string): AxisHistory {
    let t = this.histories.get(axis);
    if (!t) this.histories.set(axis, (t = new AxisHistory()));
    return t;
  }

  /** The gateway's clock now, as the page reckons it; the page's own until the gateway has told one. */
  gatewayNow_ms(): number {
    return this.clockKnown ? this.now() + this.clockOffset_ms : Date.now();
  }

  trustOf(entry: AxisEntry): Trust {
    const c = this.connection.value;
    if (c.phase !== 'live' || entry.epoch !== c.epoch) return 'disconnected';
    if (!entry.data.online) return 'offline';
    return entry.data.stale ? 'stale' : 'live';
  }

  onEvent(listener: (event: GatewayEvent) => void): () => void {
    this.eventListeners.add(listener);
    return () => this.eventListeners.delete(listener);
  }

  setConnection(state: StreamState): void {
    const before = this.connection.peek();
    this.flush();
    this.connection.value = state;
    if (before.phase === 'live' && state.phase !== 'live') {
      for (const t of this.histories.values()) t.gap();
      this.clockKnown = false;
    }
  }

  /** Lists of the site, asked for after each (re)connection and each change of the site. */
  setLists(lists: { axes: Axis[]; drives: Drive[]; lines: Line[] }, epoch: number): void {
    batch(() => {
      this.axisShelf.list(lists.axes, epoch);
      this.driveShelf.list(lists.drives, epoch);
      this.lineShelf.list(lists.lines, epoch);
      this.lookAtSimulations();
      for (const name of this.histories.keys()) if (!this.axisShelf.entries.has(name)) this.histories.delete(name);
      this.listed.value = true;
    });
  }

  /** The newest events from REST, oldest first: what happened before, or while the connection was down. */
  setEvents(list: GatewayEvent[]): void {
    this.flush();
    const known = new Map(this.events.peek().map((e) => [e.id, e.at]));
    const newest = list.at(-1)?.id ?? 0;
    // Ids count up over the life of a data directory. If they do not fit, the gateway has another one now.
    const other = newest < (this.events.peek()[0]?.id ?? 0) - list.length || list.some((e) => known.has(e.id) && known.get(e.id) !== e.at);
    if (other) this.events.value = [];
    this.pendingEvents.push(...list);
    this.flush();
  }

  take(message: StreamMessage): void {
    const [kind, name, rest] = message.topic.split('/') as [string, string | undefined, string | undefined];
    this.keepClock(message.at / 1e6);
    if (message.topic === 'events') {
      const event = message.data as GatewayEvent;
      this.pendingEvents.push(event);
      for (const l of this.eventListeners) l(event);
    } else if (message.topic === 'alarms') {
      this.alarms.value = message.data as AlarmList;
      return;
    } else if (message.topic === 'site') {
      this.siteRevision.value = (message.data as { revision: number }).revision;
      return;
    } else if (name !== undefined && rest === undefined && (kind === 'axes' || kind === 'drives' || kind === 'lines')) {
      this.takeState(kind, name, message);
    } else {
      return;
    }
    if (!this.scheduled) {
      this.scheduled = true;
      this.schedule(() => this.flush());
    }
  }

  flush(): void {
    this.scheduled = false;
    batch(() => {
      if (this.axisShelf.waits) this.axisShelf.flush();
      if (this.driveShelf.waits) this.driveShelf.flush();
      if (this.lineShelf.waits) this.lineShelf.flush();
      this.lookAtSimulations();
      this.flushEvents();
    });
  }

  private takeState(kind: Kind, name: string, message: StreamMessage): void {
    const epoch = this.connection.peek().epoch;
    if (kind === 'drives') return this.driveShelf.put(name, message.data as Drive | null, epoch);
    if (kind === 'lines') return this.lineShelf.put(name, message.data as Line | null, epoch);
    const axis = message.data as Axis | null;
    this.axisShelf.put(name, axis, epoch);
    if (axis === null) {
      this.histories.delete(name);
    } else if (axis.online && !axis.stale) {
      this.history(name).add({ at_ms: message.at / 1e6, position: axis.position, velocity: axis.velocity, target: axis.target_position, demand: axis.position_demand, error: axis.following_error, source: axis.demand_source });
    } else {
      this.history(name).gap();
    }
  }

  private flushEvents(): void {
    if (this.pendingEvents.length === 0) return;
    const byId = new Map<number, GatewayEvent>();
    for (const e of this.pendingEvents) byId.set(e.id, e);
    for (const e of this.events.peek()) byId.set(e.id, e);
    this.pendingEvents = [];
    this.events.value = [...byId.values()].sort((a, b) => b.id - a.id).slice(0, mostEvents);
  }

  private keepClock(gateway_ms: number): void {
    const offset = gateway_ms - this.now();
    if (!this.clockKnown || offset > this.clockOffset_ms) this.clockOffset_ms = offset;
    this.clockKnown = true;
  }
}
