// Mock door: the HTTP door over the mock world, without a socket: one request in, one answer out. In: method, target, headers, body, peer.
// Out: status, headers, text. The server (../mock-server.mjs) and the unit tests of the page stand before the same one.
// A stand-in for the page's author, not a second gateway: the shapes of the answers, and the refusals that the page must show.
import { Access } from './access.mjs';
import { Alarms } from './alarms.mjs';
import { Configuration } from './configure.mjs';
import { Recipes } from './recipes.mjs';
import { catalogue, demoSite, Refusal, World } from './world.mjs';

/** @typedef {{method: string, target: string, head: Record<string, string | string[] | undefined>, text: string, peer: string}} Request */
/** @typedef {{status: number, head: Record<string, string>, text: string}} Answer */

export class MockDoor {
  /** @param {{site?: import('./world.mjs').Site, localRole?: import('../../src/api/types').Role | null, address?: () => string}} how */
  constructor({ site = structuredClone(demoSite), localRole = 'engineer', address = () => '' } = {}) {
    this.world = new World(site);
    this.configuration = new Configuration(this.world);
    this.alarms = new Alarms(this.world);
    this.recipes = new Recipes(this.world);
    this.access = new Access(localRole);
    this.address = address;
  }

  /** @param {number} dt seconds @param {number} now_ms */
  step(dt, now_ms) {
    this.world.step(dt);
    this.recipes.step(now_ms);
    this.alarms.look();
    this.configuration.site.look();
  }

  /** An axis with who holds it. @param {string} name */
  axis(name) {
    return this.access.withHolder(this.world.axis(name));
  }

  /** Whether somebody with these headers is given the stream. @param {Request['head']} head */
  serves(head) {
    return this.access.identify(head).role !== null;
  }

  /** @param {Request} request @returns {Answer} */
  answer(request) {
    try {
      return this.good(request);
    } catch (error) {
      if (error instanceof Refusal) return problem(error);
      console.error(error);
      return problem(new Refusal(500, 'internal', String(error)));
    }
  }

  /** @param {Request} request @returns {Answer} */
  good({ method, target, head, text, peer }) {
    const url = new URL(target, 'http://mock');
    const parts = url.pathname.split('/').slice(3).map(decodeURIComponent);
    const q = url.searchParams;
    const header = (/** @type {string} */ name) => String(head[name] ?? '');
    const identity = this.access.identify(head);
    const given = text.startsWith('{') ? readJson(text) : {};
    this.access.check(identity, method, parts, given, header('x-csrf-token'));
    const host = peer.replace(/:\d+$/, '');
    const who = identity.via === 'none' ? peer : `${identity.user ?? 'local'} ${peer}`;
    const ask = { method, parts, q, text, who, match: header('if-match'), none: header('if-none-match'), client: [identity.user ?? host, header('x-client')].filter(Boolean).join(' '), role: identity.role };
    const a = this.access.answer(ask, identity) ?? this.alarms.answer(ask) ?? this.recipes.answer(ask) ?? this.configuration.answer(ask) ?? { body: this.other(ask, given) };
    return {
      status: a.status ?? 200,
      head: { 'content-type': a.type ?? 'application/json', 'site-revision': String(this.world.revision), ...a.head },
      text: a.status === 204 ? '' : (a.text ?? JSON.stringify(a.body)),
    };
  }

  /** What the world itself tells. @param {import('./configure.mjs').Ask & {client: string}} ask @param {any} given @returns {unknown} */
  other({ method, parts, q, text, who, client }, given) {
    const { world } = this;
    const [kind = '', name, what, id] = parts;
    const body = () => readJson(text);
    // The mock is in no domain with others.
    if (kind === 'fleet') return { enabled: false, gateways: [] };
    if (kind === 'about') {
      return { name: 'axisgate', version: '0.1.0-mock', api: '/api/v1', uptime_s: (Date.now() - world.started) / 1000, now: world.now(), site_revision: world.revision, families: ['mcode', 'pacontrol', 'uim342'], doors: [{ name: 'http', address: this.address() }], lines: world.site.lines.length, drives: world.drives.size, axes: world.axes.size };
    }
    if (kind === 'events') return this.events(q);
    if (kind === 'lines' && !name) return world.site.lines.map((l) => world.line(l.name));
    if (kind === 'lines' && name && !what) return world.line(name);
    if (kind === 'host' && name === 'ports') return [{ kind: 'can', name: 'can0', uri: 'can:can0', text: 'virtual', up: true, line: null }];
    if (kind === 'drives' && !name) return [...world.drives.values()].map((d) => d.document());
    if (kind === 'drives' && name && what === 'hand') {
      if (method === 'GET') return q.get('describe') === '1' ? world.handList(name) : world.hand(name);
      return world.setHand(name, body());
    }
    if (kind === 'drives' && name && what === 'native') return world.native(name, body());
    if (kind === 'axes' && !name) return [...world.axes.keys()].map((n) => this.axis(n));
    if (kind === 'axes' && name && !what) return { ...this.axis(name), age_ms: 3 };
    if (kind === 'axes' && name && what === 'commands') {
      this.access.mayCommand(name, client, given);
      return world.command(name, body(), who);
    }
    if (kind === 'axes' && name && what === 'actions') {
      this.access.mayCommand(name, client, given);
      const { name: action, arguments: by = {} } = body();
      return { ticket: 1, axis: name, result: 'done', text: `${action}: ${JSON.stringify(by)}` };
    }
    if (kind === 'axes' && name && what === 'parameters') {
      const axis = world.axisOf(name);
      if (!id) {
        const array = q.get('array');
        if (!array) return catalogue.map((p) => axis.parameter(p.id));
        const entry = catalogue.find((p) => p.id === array && p.count);
        if (!entry) throw new Refusal(404, 'not_found', `there is no array ${array}`);
        const first = Number(q.get('first') ?? entry.first);
        const count = Math.min(256, (entry.first ?? 0) + (entry.count ?? 0) - first);
        return Array.from({ length: count }, (_, i) => axis.parameter(`${array}[${first + i}]`));
      }
      if (method === 'GET') {
        const p = q.get('cached') ? axis.parameter(id) : axis.read(id);
        const { written_at, written_by, written_through, previous } = p;
        const history = written_at ? [{ value: p.stored, previous, written_at, written_by, written_through }] : [];
        return q.get('history') ? { ...p, history } : p;
      }
      const { value } = body();
      const old = axis.write(id, value, who);
      world.event('info', 'write', { axis: name, who, door: 'http', parameter: id, old: old === null ? null : String(old), new: String(value) }, '');
      return { ticket: (world.ticket += 1), result: 'done', reason: '', axis: name, command: 'write_parameter', code: null, text: '', value };
    }
    throw new Refusal(404, 'not_found', `there is nothing at ${method} /api/v1/${parts.join('/')}`);
  }

  /** The newest that fit, oldest first. @param {URLSearchParams} q */
  events(q) {
    const rank = { info: 0, warning: 1, alarm: 2 };
    const least = rank[/** @type {'info'} */ (q.get('severity') ?? 'info')];
    const fits = this.world.events.filter((e) => rank[e.severity] >= least && (!q.get('axis') || e.axis === q.get('axis')) && (!q.get('kind') || e.kind === q.get('kind')));
    return fits.slice(-Math.min(1000, Number(q.get('limit') ?? 200)));
  }
}

/** @param {string} text @returns {any} */
function readJson(text) {
  try {
    return JSON.parse(text);
  } catch {
    throw new Refusal(400, 'bad_request', 'the body is not JSON');
  }
}

/** @param {Refusal} r @returns {Answer} */
export function problem(r) {
  const body = { type: `urn:axisgate:problem:${r.reason}`, title: r.reason.replaceAll('_', ' '), status: r.status, detail: r.message, code: null, reason: r.reason, ...r.more };
  return { status: r.status, head: { 'content-type': 'application/problem+json', ...r.head }, text: JSON.stringify(body) };
}
