// Program: starts the gateway that is tested, waits for its `ready` line, stops it, starts it again on the same port.
// In: AXISGATE_BIN (default build/release/axisgate). Out: its address. Each start has a bound: 20 s, then the test fails with its output.
import { spawn } from 'node:child_process';
import { mkdtempSync, rmSync } from 'node:fs';
import { createServer } from 'node:net';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { fileURLToPath } from 'node:url';

const root = fileURLToPath(new URL('../../../', import.meta.url));
export const binary = process.env.AXISGATE_BIN ?? join(root, 'build/release/axisgate');
export const isMock = binary.endsWith('.mjs');
const site = fileURLToPath(new URL('../site.json', import.meta.url));

export class Program {
  static async start() {
    const p = new Program();
    p.data = mkdtempSync(join(tmpdir(), 'axisgate-browser-'));
    p.port = await freePort(); // chosen here, so that a restart has the same address
    await p.run();
    return p;
  }

  async run() {
    const args = ['serve', '--data', this.data, '--site', site];
    for (const s of [`http.bind=127.0.0.1:${this.port}`, 'modbus.bind=127.0.0.1:0', 'enip.bind=127.0.0.1:0']) args.push('--set', s);
    const child = spawn(binary, args, { stdio: ['ignore', 'pipe', 'pipe'] });
    this.child = child;
    let output = '';
    this.ended = new Promise((resolve) => child.once('close', (code, signal) => resolve(signal ?? code)));
    await new Promise((resolve, reject) => {
      const limit = setTimeout(() => reject(new Error(`${binary} was not ready within 20 s:\n${output}`)), 20_000);
      child.once('error', (e) => reject(new Error(`${binary} cannot be started: ${e.message}`)));
      child.once('close', (code) => reject(new Error(`${binary} ended with ${code} before it was ready:\n${output}`)));
      const look = (piece) => {
        output = (output + piece).slice(-20_000);
        const ready = /^ready .*?\bhttp=(\S+)/m.exec(output);
        if (!ready) return;
        clearTimeout(limit);
        this.url = `http://${ready[1]}`;
        resolve();
      };
      child.stdout.on('data', look);
      child.stderr.on('data', look);
    });
  }

  /** The process is gone when this returns. SIGKILL: as if the power had failed. */
  async stop(signal = 'SIGTERM') {
    if (!this.child) return;
    this.child.kill(signal);
    const late = setTimeout(() => this.child.kill('SIGKILL'), 10_000);
    await this.ended;
    clearTimeout(late);
    this.child = null;
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

function freePort() {
  return new Promise((resolve, reject) => {
    const s = createServer();
    s.once('error', reject);
    s.listen(0, '127.0.0.1', () => {
      const { port } = s.address();
      s.close(() => resolve(port));
    });
  });
}
