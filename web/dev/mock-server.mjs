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
import { roles } from './mock/access.mjs';
import { MockDoor, problem } from './mock/door.mjs';
import { MockStream } from './mock/stream.mjs';
import { Refusal } from './mock/world.mjs';

const dist = fileURLToPath(new URL('../dist', import.meta.url));
const policy = "default-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'; object-src 'none'"; // as the program's
/** @type {Record<string, string>} */
const types = { '.html': 'text/html; charset=utf-8', '.js': 'text/javascript; charset=utf-8', '.css': 'text/css; charset=utf-8', '.svg': 'image/svg+xml' };
/** @typedef {import('node:http').IncomingMessage} Request */
/** @typedef {import('node:http').ServerResponse} Response */

const o = readArguments(process.argv.slice(2));
const door = new MockDoor({ ...(o.site ? { site: JSON.parse(readFileSync(o.site, 'utf8')) } : {}), localRole: o.localRole, address });

let last = performance.now();
setInterval(() => {
  const now = performance.now();
  door.step((now - last) / 1000, now);
  last = now;
}, 10);

const server = createServer((request, response) => void answer(request, response));

/** @param {Request} request @param {Response} response */
async function answer(request, response) {
  const target = request.url ?? '/';
  const { pathname } = new URL(target, 'http://mock');
  if (!pathname.startsWith('/api/')) return page(pathname, response);
  let text = '';
  for await (const piece of request) text += piece;
  const { remoteAddress, remotePort } = request.socket;
  send(response, door.answer({ method: request.method ?? 'GET', target, head: request.headers, text, peer: `${remoteAddress}:${remotePort}` }));
}

/** @param {Response} response @param {{status: number, head: Record<string, string>, text: string}} a */
function send(response, a) {
  response.writeHead(a.status, a.head);
  response.end(a.status === 204 ? undefined : a.text);
}

/** @param {string} path @param {Response} response */
function page(path, response) {
  let file = join(dist, normalize(path));
  const found = file.startsWith(dist) && extname(path) !== '' && isFile(file);
  if (!found) {
    if (path.slice(path.lastIndexOf('/')).includes('.')) return send(response, problem(new Refusal(404, 'not_found', `there is no ${path}`)));
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

const sockets = new WebSocketServer({ server, path: '/api/v1/stream', verifyClient: (/** @type {{req: Request}} */ { req }) => door.serves(req.headers) });
sockets.on('connection', (socket) => {
  const stream = new MockStream(door, (text) => {
    if (socket.readyState === 1) socket.send(text);
  });
  socket.on('message', (raw) => stream.hear(String(raw), performance.now()));
  const timer = setInterval(() => stream.turn(performance.now()), 10);
  socket.on('close', () => {
    clearInterval(timer);
    stream.end();
  });
});

server.listen(o.port, o.host, () => console.log(`first sign-in: code ${door.access.code}\nready http=${address()} (mock)`));
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
