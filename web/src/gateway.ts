// Gateway: the page's half of the gateway, put together: client, stream, store, commander. In: nothing but the address of the page.
// Out: one object that components reach through useGateway(). Asks for the lists after each connection and each change of the site.
import { effect } from '@preact/signals';
import { createContext } from 'preact';
import { useContext, useMemo } from 'preact/hooks';
import { Client } from './api/client';
import { Stream, type StreamMessage } from './api/stream';
import type { Axis } from './api/types';
import { t } from './language';
import { Commander } from './state/commander';
import { Jog } from './state/jog';
import { Session } from './state/session';
import { persisted } from './state/persisted';
import { Store } from './state/store';
import { Tab, tabChannel } from './state/tab';

const closePeriod_ms = 50;
const listRetry_ms = 2_000;
/** Less than a period of the stream, so that what comes at 20 Hz is never held back. */
const leastPause_ms = 40;
/** With more axes than this nobody reads each of them ten times a second, and a browser without a graphics card has much to draw. */
const fewAxes = 32;
/** How often all axes are told, by how many there are. */
export const overviewPeriod = (axes: number): number => (axes > fewAxes ? 200 : 100);

export class Gateway {
  readonly client: Client;
  readonly store: Store;
  readonly commander: Commander;
  /** Commands to axes of the fleet, by "gateway/axis": this gateway hands them on. */
  readonly fleet: Commander;
  readonly session: Session;
  readonly stream: Stream;
  readonly tab: Tab;
  /** How many axes are followed closely. */
  private watched = 0;
  private readonly jogs = new Map<string, Jog>();
  private readonly extra = new Map<string, Set<(m: StreamMessage) => void>>();

  constructor(parts: { client?: Client; store?: Store; url?: string } = {}) {
    this.tab = new Tab(persisted('client'), parts.client ? null : tabChannel());
    this.client = parts.client ?? new Client('/api/v1', undefined, () => this.tab.name.peek());
    this.store = parts.store ?? new Store({ schedule: (flush) => beforeNextPicture(flush, pauseOf(this.store.axisNames.peek().length, this.watched)) });
    const blocked = () => (this.store.connected.peek() ? this.session.mayNot('operator') : t('The page is not connected to the gateway.'));
    this.commander = new Commander(
      this.client,
      blocked,
      (axis) => this.store.axis(axis)?.peek().data.online === false,
      (axis) => this.store.axis(axis)?.peek().data,
      () => this.store.gatewayNow_ms(),
    );
    this.fleet = new Commander(
      {
        command: (at, command, urgent) => {
          const cut = at.indexOf('/');
          return this.client.fleetCommand(at.slice(0, cut), at.slice(cut + 1), command, urgent);
        },
        dropWaitingCommands: (why) => this.client.dropWaitingCommands(why),
        axes: () => Promise.resolve([]),
      },
      blocked,
    );
    this.session = new Session(this.client, () => {
      // Another identity: the old stream belongs to the one before.
      this.stream.stop();
      if (!this.session.needed.peek()) this.stream.start();
    }, parts.client ? null : tabChannel('axisgate.session'), parts.client ? undefined : persisted('session.user', '', 'browser'));
    this.stream = new Stream({
      url: parts.url ?? streamUrl(location),
      onState: (s) => {
        const was = this.store.connected.peek();
        this.store.setConnection(s);
        if (!was || this.store.connected.peek()) return;
        // What was accepted may be otherwise by now: nothing green stands beside values that are not live, and nothing goes on moving unseen.
        this.commander.forgetGood();
        for (const j of this.jogs.values()) j.lost();
      },
      onMessage: (m) => {
        this.store.take(m);
        if (m.data !== null && /^axes\/[^/]+$/.test(m.topic)) this.commander.look(m.data as Axis);
        for (const reader of this.extra.get(m.topic) ?? []) reader(m);
      },
    });
    this.stream.subscribe({ 'axes/*': overviewPeriod(0), 'drives/*': 500, 'lines/*': 500, events: 1000, alarms: 1000 });
  }

  start(): void {
    let period_ms = overviewPeriod(0);
    effect(() => {
      const wanted_ms = overviewPeriod(this.store.axisNames.value.length);
      if (wanted_ms === period_ms) return;
      period_ms = wanted_ms;
      this.stream.subscribe({ 'axes/*': period_ms });
    });
    let listedFor = '';
    effect(() => {
      const { phase, epoch } = this.store.connection.value;
      const revision = this.store.siteRevision.value;
      if (phase !== 'live' || revision === null || `${epoch}/${revision}` === listedFor) return;
      const fresh = !listedFor.startsWith(`${epoch}/`);
      listedFor = `${epoch}/${revision}`;
      void this.list(epoch, fresh);
    });
    // A connection that was lost may be a session that has ended; a gateway that is back may be another one.
    let askedFor = '';
    effect(() => {
      const { phase, epoch, attempts } = this.store.connection.value;
      // Each refused attempt anew: a gateway that was away when it was asked for the first time refuses the stream of a session that it does not know.
      const asking = `${phase}/${epoch}/${attempts}`;
      if (phase === 'connecting' || phase === 'silent' || askedFor === asking) return;
      askedFor = asking;
      void this.session.ask();
    });
    // Nobody is given no stream: it is not knocked for before the sign-in. A gateway that is slow to say who one is holds it up for a second at most.
    void Promise.race([Promise.all([this.session.ask(), this.tab.settled]), new Promise((r) => setTimeout(r, 1000))]).then(() => {
      if (!this.session.needed.peek()) this.stream.start();
    });
    addEventListener('online', () => this.stream.wake());
    document.addEventListener('visibilitychange', () => {
      if (!document.hidden) this.stream.wake();
    });
    // Another tab of this browser may have signed in or out without a word.
    addEventListener('focus', () => void this.session.ask());
  }

  jog(axis: string): Jog {
    let j = this.jogs.get(axis);
    if (!j) this.jogs.set(axis, (j = new Jog(this.client, this.commander, axis)));
    return j;
  }

  /** Follows one axis more closely while its page is open. Gives back the function that ends it. */
  watchClosely(axis: string): () => void {
    const topic = `axes/${axis}`;
    this.stream.subscribe({ [topic]: closePeriod_ms });
    this.watched += 1;
    return () => {
      this.watched -= 1;
      this.stream.unsubscribe(topic);
    };
  }

  /** Another topic of the stream, such as the frames of a line. Gives back the function that ends it. */
  follow(topic: string, period_ms: number, reader: (message: StreamMessage) => void): () => void {
    const readers = this.extra.get(topic) ?? new Set();
    readers.add(reader);
    this.extra.set(topic, readers);
    this.stream.subscribe({ [topic]: period_ms });
    return () => {
      readers.delete(reader);
      if (readers.size === 0) this.stream.unsubscribe(topic);
    };
  }

  private async list(epoch: number, withEvents: boolean): Promise<void> {
    const current = () => this.store.connection.peek().epoch === epoch && this.store.connected.peek();
    try {
      const [axes, drives, lines] = await Promise.all([this.client.axes(), this.client.drives(), this.client.lines()]);
      if (!current()) return;
      this.store.setLists({ axes, drives, lines }, epoch);
      if (!withEvents) return;
      const [events, about] = await Promise.all([this.client.events({ limit: 200 }), this.client.about()]);
      this.store.setEvents(events);
      this.store.about.value = about;
      // Only words: a gateway that does not say them is no worse.
      const families = await Promise.resolve(this.client.families?.()).catch(() => undefined);
      if (families) this.store.families.value = new Map(families.map((f) => [f.name, f]));
      if (families) this.store.familyTitles.value = new Map(families.flatMap((f) => (typeof (f.title ?? f.maker) === 'string' ? [[f.name, String(f.title ?? f.maker)]] : [])));
    } catch {
      // The stream is up but REST did not answer. As long as the connection is the same, ask again.
      setTimeout(() => {
        if (current()) void this.list(epoch, withEvents);
      }, listRetry_ms);
    }
  }
}

export function streamUrl(at: { protocol: string; host: string }): string {
  return `${at.protocol === 'https:' ? 'wss' : 'ws'}://${at.host}/api/v1/stream`;
}

/** Between two pictures, `watched` of the axes being followed closely. Of many axes there are as many pictures as the feed brings, and none between. */
export const pauseOf = (axes: number, watched: number): number => (watched === 0 && axes > fewAxes ? overviewPeriod(axes) - 10 : leastPause_ms);

let flushedAt_ms = -Infinity;
/**
 * Before the next picture of the screen, but not before all of them: nobody reads figures that change more than 20 times a second, and a
 * feed of a thousand samples a second must leave the pictures their time. A hidden page draws none; its states are taken in all the same,
 * less often.
 */
export function beforeNextPicture(flush: () => void, pause_ms = leastPause_ms): void {
  let done = false;
  const once = () => {
    if (done) return;
    done = true;
    flushedAt_ms = performance.now();
    flush();
  };
  const wait_ms = flushedAt_ms + pause_ms - performance.now();
  if (wait_ms > 0) setTimeout(() => requestAnimationFrame(once), wait_ms);
  else requestAnimationFrame(once);
  setTimeout(once, 250);
}

const Context = createContext<Gateway | null>(null);
export const GatewayProvider = Context.Provider;
export function useGateway(): Gateway {
  const g = useContext(Context);
  if (!g) throw new Error('no gateway around this component');
  return g;
}

/** One door of the gateway's HTTP, kept as long as who uses it. */
export function useDoor<D>(Door: new (client: Client) => D): D {
  const { client } = useGateway();
  return useMemo(() => new Door(client), [client]);
}
