#!/usr/bin/env node
// Mock server: the HTTP door of axisgate over the mock world, with the built page, for developing and testing the page alone.
//   node dev/mock-server.mjs [--port 8090] [--set users.local_role=viewer]
// It also takes the command line of the program (`serve --data DIR --site FILE --set http.bind=ADDRESS:PORT`) and prints the same
// `ready` line, so that the browser tests can run against it (AXISGATE_BIN=web/dev/mock-server.mjs). It stops on SIGTERM.
import { createReadStream, readFileSync, statSync } from 'node:fs';
import { createServer } from 'node:http';
import { extname, join, normalize } from 'node:path';
import { fileURLToPath } from 'node:url';
import { WebSocketServer } from 'ws';
import { Access, roles } from './mock/access.mjs';
import { Alarms } from './mock/alarms.mjs';
import { Configuration } from './mock/configure.mjs';
import { Recipes } from './mock/recipes.mjs';
import { catalogue, demoSite, Refusal, World } from './mock/world.mjs';

const dist = fileURLToPath(new URL('../dist', import.meta.url));
const policy = "default-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'; object-src 'none'"; // as the program's
/** @type {Record<string, string>} */
const types = { '.html': 'text/html; charset=utf-8', '.js': 'text/javascript; charset=utf-8', '.css': 'text/css; charset=utf-8', '.svg': 'image/svg+xml' };
/** @typedef {import('node:http').IncomingMessage} Request */
/** @typedef {import('node:http').ServerResponse} Response */

const o = readArguments(process.argv.slice(2));
const world = new World(o.site ? JSON.parse(readFileSync(o.site, 'utf8')) : demoSite);
const configuration = new Configuration(world);
const alarms = new Alarms(world);
const recipes = new Recipes(world);
const access = new Access(o.localRole);

let last = performance.now();
setInterval(() => {
  const now = performance.now();
  world.step((now - last) / 1000);
  recipes.step(now);
  alarms.look();
  last = now;
}, 10);

const server = createServer((request, response) => {
  void answer(request, response).catch((error) => {
    if (error instanceof Refusal) return problem(response, error);
    console.error(error);
    problem(response, new Refusal(500, 'internal', String(error)));
  });
});

/** @param {Request} request @param {Response} response */
async function answer(request, response) {
  const url = new URL(request.url ?? '/', 'http://mock');
  const path = url.pathname;
  if (!path.startsWith('/api/')) return page(path, response);
  const parts = path.split('/').slice(3).map(decodeURIComponent);
  const [kind = '', name, what, id] = parts;
  const method = request.method ?? 'GET';
  const who = `${request.socket.remoteAddress}:${request.socket.remotePort}`;
  const q = url.searchParams;
  const text = method === 'GET' ? '' : await textOf(request);
  const identity = access.identify(request.headers);
  const given = text.startsWith('{') ? readJson(text) : {};
  access.check(identity, method, parts, given, String(request.headers['x-csrf-token'] ?? ''));
  const client = [identity.user ?? request.socket.remoteAddress, request.headers['x-client']].filter(Boolean).join(' ');
  const ask = { method, parts, q, text, who: identity.user ?? who, match: String(request.headers['if-match'] ?? ''), client };
  const configured = access.answer(ask, identity) ?? alarms.answer(ask) ?? recipes.answer(ask) ?? configuration.answer(ask);
  if (configured) {
    const head = { 'content-type': configured.type ?? 'application/json', 'site-revision': String(world.revision), ...configured.head };
    response.writeHead(configured.status ?? 200, head);
    return response.end(configured.status === 204 ? undefined : (configured.text ?? JSON.stringify(configured.body)));
  }
  const body = () => readJson(text);
  if (kind === 'about') {
    return json(response, { name: 'axisgate', version: '0.1.0-mock', api: '/api/v1', uptime_s: (Date.now() - world.started) / 1000, now: world.now(), site_revision: world.revision, families: ['mcode', 'pacontrol', 'uim342'], doors: [{ name: 'http', address: address() }], lines: world.site.lines.length, drives: world.drives.size, axes: world.axes.size });
  }
  if (kind === 'events') return json(response, world.events.slice(-Number(q.get('limit') ?? 200)));
  if (kind === 'lines' && !name) return json(response, world.site.lines.map((l) => world.line(l.name)));
  if (kind === 'lines' && name && !what) return json(response, world.line(name));
  if (kind === 'drives' && !name) return json(response, [...world.drives.values()].map((d) => d.document()));
  if (kind === 'drives' && name && what === 'hand') {
    if (method === 'GET') return json(response, q.get('describe') === '1' ? world.handList(name) : world.hand(name));
    return json(response, world.setHand(name, body()));
  }
  if (kind === 'drives' && name && what === 'native') return json(response, world.native(name, body()));
  if (kind === 'axes' && !name) return json(response, [...world.axes.keys()].map(axisNow));
  if (kind === 'axes' && name && !what) return json(response, { ...axisNow(name), age_ms: 3 });
  if (kind === 'axes' && name && what === 'commands') {
    access.mayCommand(name, client, given);
    return json(response, world.command(name, body(), who));
  }
  if (kind === 'axes' && name && what === 'parameters') {
    const axis = world.axisOf(name);
    if (!id) {
      const array = q.get('array');
      if (!array) return json(response, catalogue.map((p) => axis.parameter(p.id)));
      const entry = catalogue.find((p) => p.id === array && p.count);
      if (!entry) throw new Refusal(404, 'not_found', `there is no array ${array}`);
      const first = Number(q.get('first') ?? entry.first);
      const count = Math.min(256, (entry.first ?? 0) + (entry.count ?? 0) - first);
      return json(response, Array.from({ length: count }, (_, i) => axis.parameter(`${array}[${first + i}]`)));
    }
    if (method === 'GET') {
      const p = q.get('cached') ? axis.parameter(id) : axis.read(id);
      const { written_at, written_by, written_through, previous } = p;
      const history = written_at ? [{ value: p.stored, previous, written_at, written_by, written_through }] : [];
      return json(response, q.get('history') ? { ...p, history } : p);
    }
    const { value } = body();
    const old = axis.write(id, value, who);
    world.event('info', 'write', { axis: name, who, door: 'http', parameter: id, old: old === null ? null : String(old), new: String(value) }, '');
    return json(response, { ticket: (world.ticket += 1), result: 'done', reason: '', axis: name, command: 'write_parameter', code: null, text: '', value });
  }
  throw new Refusal(404, 'not_found', `there is no ${method} ${path}`);
}

/** @param {string} name */
function axisNow(name) {
  return access.withHolder(world.axis(name));
}

/** @param {string} path @param {Response} response */
function page(path, response) {
  let file = join(dist, normalize(path));
  const found = file.startsWith(dist) && extname(path) !== '' && isFile(file);
  if (!found) {
    if (path.slice(path.lastIndexOf('/')).includes('.')) return problem(response, new Refusal(404, 'not_found', `there is no ${path}`));
    file = join(dist, 'index.html');
  }
  response.writeHead(200, { 'content-type': types[extname(file)] ?? 'application/octet-stream', 'content-security-policy': policy, 'cache-control': path.startsWith('/assets/') ? 'max-age=31536000, immutable' : 'no-cache', 'x-content-type-options': 'nosniff' });
  createReadStream(file).pipe(response);
}

/** @param {string} file */
function isFile(file) {
  try {
    return statSync(file).isFile();
  } catch {
    return false;
  }
}

/** @param {Request} request */
async function textOf(request) {
  let text = '';
  for await (const piece of request) text += piece;
  return text;
}

/** @param {string} text @returns {any} */
function readJson(text) {
  try {
    return JSON.parse(text);
  } catch {
    throw new Refusal(400, 'bad_request', 'the body is not JSON');
  }
}

/** @param {Response} response @param {unknown} document */
function json(response, document) {
  response.writeHead(200, { 'content-type': 'application/json', 'site-revision': String(world.revision) });
  response.end(JSON.stringify(document));
}

/** @param {Response} response @param {Refusal} r */
function problem(response, r) {
  response.writeHead(r.status, { 'content-type': 'application/problem+json' });
  response.end(JSON.stringify({ type: `urn:axisgate:problem:${r.reason}`, title: r.reason.replaceAll('_', ' '), status: r.status, detail: r.message, code: null, reason: r.reason, ...r.more }));
}

const sockets = new WebSocketServer({ server, path: '/api/v1/stream', verifyClient: (/** @type {{req: Request}} */ { req }) => access.identify(req.headers).role !== null });
sockets.on('connection', (socket) => {
  /** @type {Map<string, {period: number, next: number}>} */
  const topics = new Map();
  /** @type {Map<string, {text: string, at: number}>} */
  const sent = new Map();
  /** @type {Map<string, number>} */
  const framesSent = new Map();
  /** @param {string} topic @param {unknown} data */
  const tell = (topic, data) => {
    if (socket.readyState === 1) socket.send(JSON.stringify({ topic, at: Date.now() * 1e6, data }));
  };
  /** @param {string} topic @param {any} document @param {boolean} always */
  const state = (topic, document, always) => {
    const text = JSON.stringify({ ...document, at: null });
    const before = sent.get(topic);
    const now = performance.now();
    if (!always && before && before.text === text && (!document.online || now - before.at < 1000)) return;
    sent.set(topic, { text, at: now });
    tell(topic, document);
  };
  /** @param {string} topic @param {boolean} always */
  const look = (topic, always) => {
    if (topic === 'alarms') {
      if (always || alarmsTold !== alarms.change) tell('alarms', alarms.document());
      alarmsTold = alarms.change;
      return;
    }
    const [kind, name, rest] = topic.split('/');
    if (rest === 'frames') {
      const frames = (world.frames.get(name ?? '') ?? []).filter((f) => always || f.sequence > (framesSent.get(topic) ?? 0));
      framesSent.set(topic, frames.at(-1)?.sequence ?? framesSent.get(topic) ?? 0);
      if (frames.length > 0 || always) tell(topic, { missed: 0, frames });
      return;
    }
    if (kind === 'axes') for (const n of name === '*' ? world.axes.keys() : [name ?? '']) state(`axes/${n}`, axisNow(n), always);
    if (kind === 'drives') for (const n of name === '*' ? world.drives.keys() : [name ?? '']) state(`drives/${n}`, world.driveOf(n).document(), always);
    if (kind === 'lines') for (const l of world.site.lines) if (name === '*' || name === l.name) state(`lines/${l.name}`, world.line(l.name), always);
  };
  const onEvent = (/** @type {import('../src/api/types').GatewayEvent} */ e) => {
    if (topics.has('events')) tell('events', e);
  };
  world.listeners.push(onEvent);
  const onSite = () => {
    if (topics.has('site')) tell('site', { revision: world.revision });
  };
  world.siteListeners.push(onSite);
  const onRun = (/** @type {import('../src/api/types').RecipeReport} */ r) => {
    if (topics.has('recipes')) tell('recipes', r);
  };
  recipes.listeners.push(onRun);
  let alarmsTold = 0;
  socket.on('message', (raw) => {
    const r = JSON.parse(String(raw));
    for (const t of r.unsubscribe ?? []) topics.delete(t);
    for (const t of r.subscribe ?? []) {
      topics.set(t, { period: r.period_ms ?? 100, next: 0 });
      if (t === 'site') tell('site', { revision: world.revision });
      else look(t, true);
    }
  });
  const timer = setInterval(() => {
    const now = performance.now();
    for (const [t, s] of topics) {
      if (now < s.next) continue;
      s.next = now + s.period;
      look(t, false);
    }
  }, 10);
  socket.on('close', () => {
    clearInterval(timer);
    world.listeners = world.listeners.filter((l) => l !== onEvent);
    world.siteListeners = world.siteListeners.filter((l) => l !== onSite);
    recipes.listeners = recipes.listeners.filter((l) => l !== onRun);
  });
});

server.listen(o.port, o.host, () => console.log(`first sign-in: code ${access.code}\nready http=${address()} (mock)`));
for (const s of ['SIGTERM', 'SIGINT']) {
  process.on(s, () => {
    for (const c of sockets.clients) c.close(1001, 'the gateway stops');
    setTimeout(() => process.exit(0), 50);
  });
}

function address() {
  const a = server.address();
  return a && typeof a === 'object' ? `${a.address}:${a.port}` : '';
}

/** @param {string[]} given */
function readArguments(given) {
  /** @type {{host: string, port: number, site: string, localRole: import('../src/api/types').Role | null}} */
  const r = { host: '127.0.0.1', port: 8090, site: '', localRole: 'engineer' };
  for (let i = 0; i < given.length; i += 1) {
    const value = given[i + 1] ?? '';
    if (given[i] === '--port') r.port = Number(value);
    if (given[i] === '--site') r.site = value;
    if (given[i] === '--set' && value.startsWith('users.local_role=')) r.localRole = roles.find((x) => value.endsWith(`=${x}`)) ?? null;
    if (given[i] === '--set' && value.startsWith('http.bind=')) {
      const at = value.lastIndexOf(':');
      r.host = value.slice('http.bind='.length, at);
      r.port = Number(value.slice(at + 1));
    }
  }
  return r;
}
