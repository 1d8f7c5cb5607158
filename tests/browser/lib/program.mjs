// Program: starts the gateway that is tested, waits for its `ready` line, stops it, starts it again on the same port.
// In: AXISGATE_BIN (default build/release/axisgate). Out: its address. Each start has a bound: 20 s, then the test fails with its output.
import { spawn } from 'node:child_process';
import { mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import { createServer } from 'node:net';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { fileURLToPath } from 'node:url';

const root = fileURLToPath(new URL('../../../', import.meta.url));
export const binary = process.env.AXISGATE_BIN ?? join(root, 'build/release/axisgate');
export const isMock = binary.endsWith('.mjs');
const site = fileURLToPath(new URL('../site.json', import.meta.url));

/** One command of the program under test, from its first word to its end. */
export class Process {
  static async run(args, ready) {
    const p = new Process();
    p.child = spawn(binary, args, { stdio: ['ignore', 'pipe', 'pipe'] });
    p.ended = new Promise((resolve) => p.child.once('close', (code, signal) => resolve(signal ?? code)));
    let output = '';
    await new Promise((resolve, reject) => {
      const fail = (text) => {
        p.child.kill('SIGKILL');
        reject(new Error(`${binary} ${args.join(' ')} ${text}:\n${output}`));
      };
      const limit = setTimeout(() => fail('was not ready within 20 s'), 20_000);
      p.child.once('error', (e) => fail(`cannot be started: ${e.message}`));
      p.child.once('close', (code) => fail(`ended with ${code} before it was ready`));
      const look = (piece) => {
        output = (output + piece).slice(-20_000);
        if (!(p.said = ready.exec(output))) return;
        p.code = /first sign-in: code (\S+)/.exec(output)?.[1];
        clearTimeout(limit);
        resolve();
      };
      p.child.stdout.on('data', look);
      p.child.stderr.on('data', look);
    });
    return p;
  }

  async stop(signal = 'SIGTERM') {
    this.child.kill(signal);
    const late = setTimeout(() => this.child.kill('SIGKILL'), 10_000);
    await this.ended;
    clearTimeout(late);
  }
}

export class Program {
  /** `site`: a document in place of site.json; null: none at all, a data directory that is really new. */
  /** `set`: more settings, such as users.local_role=none. */
  static async start({ site: document, set = [] } = {}) {
    const p = new Program();
    p.data = mkdtempSync(join(tmpdir(), 'axisgate-browser-'));
    p.site = document === null ? null : site;
    p.set = set;
    if (document) writeFileSync((p.site = join(p.data, 'site.json')), JSON.stringify(document));
    p.port = await freePort(); // chosen here, so that a restart has the same address
    await p.run();
    return p;
  }

  async run() {
    const args = ['serve', '--data', this.data, ...(this.site ? ['--site', this.site] : [])];
    for (const s of [`http.bind=127.0.0.1:${this.port}`, 'modbus.bind=127.0.0.1:0', 'enip.bind=127.0.0.1:0', ...(this.set ?? [])]) args.push('--set', s);
    this.process = await Process.run(args, /^ready .*?\bhttp=(\S+)/m);
    // Printed once, before `ready`, while no user exists.
    this.firstCode = /^first sign-in: code (\S+)/m.exec(this.process.said.input)?.[1] ?? this.firstCode ?? '';
    this.url = `http://${this.process.said[1]}`;
  }

  /** The process is gone when this returns. SIGKILL: as if the power had failed. */
  async stop(signal = 'SIGTERM') {
    await this.process?.stop(signal);
    this.process = null;
  }

  async end() {
    await this.stop();
    rmSync(this.data, { recursive: true, force: true });
  }

  async call(method, path, body) {
    const init = { method, headers: { 'content-type': 'application/json' } };
    if (body !== undefined) init.body = JSON.stringify(body);
    const response = await fetch(`${this.url}/api/v1${path}`, init);
    const text = await response.text();
    return { status: response.status, body: text ? JSON.parse(text) : null };
  }

  axis = async (name) => (await this.call('GET', `/axes/${name}`)).body;
  command = (name, body) => this.call('POST', `/axes/${name}/commands`, body);
}

/** A port that nobody listens at, below those that the system gives to connections: none of them takes it before the program does. */
export async function freePort() {
  for (;;) {
    const port = 15_000 + Math.floor(Math.random() * 15_000);
    const free = await new Promise((resolve) => {
      const s = createServer();
      s.once('error', () => resolve(false));
      s.listen(port, '127.0.0.1', () => s.close(() => resolve(true)));
    });
    if (free) return port;
  }
}
