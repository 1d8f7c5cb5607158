// Client: the REST half of the HTTP door. In: calls of the page. Out: documents, or a Problem.
// A browser opens at most six connections to one host. Ordinary requests use at most four at once and wait here for their turn;
// urgent ones (stop, halt, disable) never wait behind them. At most 200 wait; beyond that a call is refused in words.
// Never retries a command: a move that was perhaps taken must not be said twice. Only what is urgent and was refused for its token goes again, once.
import { t } from '../language';
import type { CatalogueCommand } from '../text/action';
import type { Family } from '../text/options';
import { asProblem, Problem, problemOf } from './problem';
import type {
  Action,
  About, Alarm, AlarmList, Axis, AxisParameter, Command, CommandAnswer, Drive, FleetGateway, GatewayEvent, HandItem, Line, ModbusDoor, NativeReply,
  RecipeCheck, RecipeEntry, RecipeRehearsal, RecipeReport, RecipeReportHead, ScanReport, Specimen, Value,
} from './types';

const ordinaryAtOnce = 4;
const mostWaiting = 200;

interface Options {
  method?: 'GET' | 'POST' | 'PUT' | 'PATCH' | 'DELETE';
  body?: unknown;
  /** A body that is no JSON: a table, a copy of the database. */
  content?: { type: string; data: string | Blob };
  headers?: Record<string, string>;
  urgent?: boolean;
  timeout_ms?: number;
  signal?: AbortSignal;
}

/** An answer with its head: for revisions, entity tags, and documents that are no JSON. */
export interface Reply {
  status: number;
  head: Headers;
  text: string;
}

interface Waiting {
  start: () => void;
  giveUp: (problem: Problem) => void;
  reads: boolean;
}

const part = encodeURIComponent;

export class Client {
  /** Goes with every change, also with stops, while the session has one. */
  csrf: string | null = null;
  /** The gateway knows nobody here any more. */
  onUnauthorized: ((problem: Problem) => void) | undefined;
  private running = 0;
  private waiting: Waiting[] = [];

  constructor(
    private readonly base = '/api/v1',
    private readonly fetcher: typeof fetch = (...a) => fetch(...a),
    /** X-Client: what makes all connections of one tab one client, which can hold an axis. */
    private readonly named: string | (() => string) = '',
  ) {}
  get name(): string {
    return typeof this.named === 'string' ? this.named : this.named();
  }

  about = () => this.call<About>('/about');
  /** What the catalogues say of whole families; beyond the name nothing is promised. */
  families = () => this.call<Family[]>('/families');
  specimen = (family: string, specimen: string) => this.call<Specimen>(`/families/${part(family)}/specimens/${part(specimen)}`);
  familyCommands = (family: string) => this.call<CatalogueCommand[]>(`/families/${part(family)}/commands`);
  /** A function of the drive's family by its catalogue name; a motion is answered when it has begun. */
  act = (axis: string, action: Action) => this.call<CommandAnswer>(`/axes/${part(axis)}/actions`, { method: 'POST', body: action });
  axes = (urgent = false) => this.call<Axis[]>('/axes', { urgent });
  drives = () => this.call<Drive[]>('/drives');
  lines = () => this.call<Line[]>('/lines');

  fleet = () => this.call<{ enabled: boolean; gateways: FleetGateway[] }>('/fleet');
  /** Answered when it is done, or has not been within five seconds; a stop when it is accepted. */
  fleetCommand = (gateway: string, axis: string, command: Command, urgent = false) =>
    this.call<CommandAnswer>(`/fleet/${part(gateway)}/axes/${part(axis)}/commands${urgent ? '' : '?wait=5'}`, { method: 'POST', body: command, urgent });

  modbus = () => this.call<ModbusDoor>('/modbus');
  setModbus = (read_only: boolean) => this.call<ModbusDoor>('/modbus', { method: 'PATCH', body: { read_only } });

  alarms = () => this.call<AlarmList>('/alarms');
  acknowledgeAlarm = (id: number, comment: string) => this.call<Alarm>(`/alarms/${id}/acknowledge`, { method: 'POST', body: comment ? { comment } : {} });
  acknowledgeAlarms = (ids: number[], comment: string) => this.call<{ acknowledged: number }>('/alarms/acknowledge', { method: 'POST', body: comment ? { ids, comment } : { ids } });
  shelveAlarm = (id: number, for_s: number, reason: string) => this.call<Alarm>(`/alarms/${id}/shelve`, { method: 'POST', body: { for_s, reason } });
  unshelveAlarm = (id: number) => this.call<Alarm>(`/alarms/${id}/unshelve`, { method: 'POST' });

  events(query: { since?: number; before?: number; limit?: number; axis?: string; severity?: string; kind?: string } = {}) {
    const q = new URLSearchParams();
    for (const [k, v] of Object.entries(query)) if (v !== undefined && v !== '') q.set(k, String(v));
    return this.call<GatewayEvent[]>(`/events${q.size ? `?${q}` : ''}`);
  }

  command(axis: string, command: Command, urgent = false) {
    return this.call<CommandAnswer>(`/axes/${part(axis)}/commands`, { method: 'POST', body: command, urgent });
  }

  parameters(axis: string, query: { array?: string; first?: number } = {}, signal?: AbortSignal) {
    const q = new URLSearchParams();
    if (query.array !== undefined) q.set('array', query.array);
    if (query.first !== undefined) q.set('first', String(query.first));
    return this.call<AxisParameter[]>(`/axes/${part(axis)}/parameters${q.size ? `?${q}` : ''}`, signal ? { signal } : {});
  }

  /** `cached`: the last known value; else the drive is asked now. */
  parameter(axis: string, id: string, query: { cached?: boolean; history?: number } = {}, signal?: AbortSignal) {
    const q = new URLSearchParams();
    if (query.cached) q.set('cached', '1');
    if (query.history) q.set('history', String(query.history));
    return this.call<AxisParameter>(`/axes/${part(axis)}/parameters/${part(id)}${q.size ? `?${q}` : ''}`, signal ? { signal } : {});
  }

  writeParameter(axis: string, id: string, value: Value) {
    return this.call<CommandAnswer>(`/axes/${part(axis)}/parameters/${part(id)}`, { method: 'PUT', body: { value } });
  }

  native(drive: string, send: { send: string } | { send_hex: string }) {
    return this.call<NativeReply>(`/drives/${part(drive)}/native`, { method: 'POST', body: send });
  }

  hand = (drive: string, signal?: AbortSignal) =>
    this.call<HandItem[]>(`/drives/${part(drive)}/hand?describe=1`, signal ? { signal } : {});

  setHand = (drive: string, change: Record<string, Value>) =>
    this.call<Record<string, Value>>(`/drives/${part(drive)}/hand`, { method: 'PATCH', body: change });

  recipes = () => this.call<RecipeEntry[]>('/recipes');
  /** Finds what is wrong; keeps nothing. */
  checkRecipe = (name: string, document: object) => this.call<unknown>(`/recipes/${part(name)}?dry_run=1`, { method: 'PUT', body: document });
  runRecipe = (name: string, given: object) => this.call<RecipeReport>(`/recipes/${part(name)}/run`, { method: 'POST', body: { arguments: given } });
  checkRun = (name: string, given: object) => this.call<RecipeCheck>(`/recipes/${part(name)}/run`, { method: 'POST', body: { arguments: given, dry_run: true } });
  recipeRuns = (name: string) => this.call<RecipeReportHead[]>(`/recipes/${part(name)}/runs`);
  recipeRun = (name: string, n: number) => this.call<RecipeReport>(`/recipes/${part(name)}/runs/${n}`);
  /** Stops what the run has set in motion: it waits behind nothing. */
  cancelRun = (name: string, n: number) => this.call<RecipeReport>(`/recipes/${part(name)}/runs/${n}/cancel`, { method: 'POST', urgent: true });
  /** The newest rehearsal against specimens, with the rows from `first` on. */
  recipeRehearsal = (name: string, first: number) => this.call<RecipeRehearsal>(`/recipes/${part(name)}/rehearsal?first=${first}`);
  rehearseRecipe = (name: string, order: object) => this.call<RecipeRehearsal>(`/recipes/${part(name)}/rehearsal`, { method: 'POST', body: order });
  cancelRehearsal = (name: string) => this.call<RecipeRehearsal>(`/recipes/${part(name)}/rehearsal`, { method: 'DELETE' });
  scan = (line: string) => this.call<ScanReport>(`/lines/${part(line)}/scan`);
  startScan = (line: string, range: { from?: string; to?: string }) => this.call<ScanReport>(`/lines/${part(line)}/scan`, { method: 'POST', body: range });
  cancelScan = (line: string) => this.call<ScanReport>(`/lines/${part(line)}/scan`, { method: 'DELETE' });

  /** Commands that wait in the page and have not been sent are given up: a stop overtakes them. Reads go on. */
  dropWaitingCommands(why: string): void {
    const commands = this.waiting.filter((w) => !w.reads);
    this.waiting = this.waiting.filter((w) => w.reads);
    for (const w of commands) w.giveUp(new Problem('cancelled', why));
  }

  async call<T>(path: string, options: Options = {}): Promise<T> {
    if (!options.urgent) await this.turn((options.method ?? 'GET') === 'GET');
    try {
      return await this.send<T>(path, options, async (r) => (r.status === 204 ? undefined : await r.json()) as T);
    } finally {
      if (!options.urgent) this.done();
    }
  }

  async whole(path: string, options: Options = {}): Promise<Reply> {
    await this.turn((options.method ?? 'GET') === 'GET');
    try {
      return await this.send(path, options, async (r) => ({ status: r.status, head: r.headers, text: await r.text() }));
    } finally {
      this.done();
    }
  }

  /** A document of bytes. */
  async bytes(path: string, options: Options = {}): Promise<Blob> {
    await this.turn(true);
    try {
      return await this.send(path, options, (r) => r.blob());
    } finally {
      this.done();
    }
  }

  private turn(reads: boolean): Promise<void> {
    if (this.running < ordinaryAtOnce) {
      this.running += 1;
      return Promise.resolve();
    }
    if (this.waiting.length >= mostWaiting) {
      return Promise.reject(new Problem('crowded', t('too many requests of this page wait for an answer: try again in a moment')));
    }
    return new Promise((resolve, reject) => {
      this.waiting.push({ start: resolve, giveUp: reject, reads });
    });
  }

  private done(): void {
    const next = this.waiting.shift();
    if (next) next.start(); // it takes over the place: `running` stays
    else this.running -= 1;
  }

  private async send<T>(path: string, options: Options, read: (response: Response) => Promise<T>): Promise<T> {
    const limit = options.timeout_ms ?? 15_000;
    const aborter = new AbortController();
    let timedOut = false;
    const timer = setTimeout(() => {
      timedOut = true;
      aborter.abort();
    }, limit);
    const given = () => aborter.abort();
    if (options.signal?.aborted) given();
    options.signal?.addEventListener('abort', given, { once: true });
    try {
      const headers: Record<string, string> = { accept: 'application/json, application/problem+json' };
      const init: RequestInit = { method: options.method ?? 'GET', headers, signal: aborter.signal, cache: 'no-store' };
      const name = this.name;
      if (name) headers['x-client'] = name;
      if (this.csrf && init.method !== 'GET') headers['x-csrf-token'] = this.csrf;
      if (options.body !== undefined) {
        headers['content-type'] = 'application/json';
        init.body = JSON.stringify(options.body);
      } else if (options.content) {
        headers['content-type'] = options.content.type;
        init.body = options.content.data;
      }
      Object.assign(headers, options.headers);
      if (options.urgent) {
        init.keepalive = true; // a stop on its way survives the closing of the page
        init.priority = 'high';
      }
      const response = await this.fetcher(this.base + path, init);
      if (!response.ok) {
        const problem = await problemOf(response);
        // A stop does not end because the page has no token yet, or another tab signed in anew: it asks for one and goes again, once.
        if (problem.is('csrf') && options.urgent && !options.headers?.['x-csrf-token']) {
          const fresh = await this.send<{ csrf: string | null }>('/session', { urgent: true }, (r) => r.json());
          if (fresh.csrf) return await this.send(path, { ...options, headers: { ...options.headers, 'x-csrf-token': fresh.csrf } }, read);
        }
        if (response.status === 401 && (!path.startsWith('/session') || problem.is('session_ended'))) this.onUnauthorized?.(problem);
        throw problem;
      }
      return await read(response);
    } catch (error) {
      if (error instanceof Problem) throw error;
      if (timedOut) throw new Problem('timed_out', t('the gateway did not answer within {n} s', { n: limit / 1000 }));
      if (options.signal?.aborted) throw new Problem('cancelled', t('given up'));
      if (error instanceof SyntaxError) throw new Problem('answered', t('the answer of the gateway cannot be read'));
      throw asProblem(new Problem('unreachable', t('the gateway cannot be reached')));
    } finally {
      clearTimeout(timer);
      options.signal?.removeEventListener('abort', given);
    }
  }
}
