// Mock of what is configured: mappings, registers, the Modbus door, snapshots, scans, backup. In: requests. Out: documents of the HTTP door.
// A stand-in for the page's author: the shapes of the answers and the refusals that the page must show, not a second gateway.
import { commands, families, specimen } from './families.mjs';
import { SiteDesk } from './site.mjs';
import { Refusal } from './world.mjs';

/** @typedef {{status?: number, type?: string, head?: Record<string, string>, body?: any, text?: string}} Answer */
/**
 * `match`, `none`: If-Match and If-None-Match, empty where they are not sent. `client`: user or host, with X-Client.
 * @typedef {{method: string, parts: string[], q: URLSearchParams, text: string, who: string, match: string, none?: string, client?: string, role?: string | null}} Ask
 */

const columns = ['id', 'unit', 'table', 'address', 'axis', 'point', 'type', 'word_order', 'scale', 'offset', 'access', 'length', 'comment'];
/** Some of those of the gateway. */
export const points = [
  ['statusword', 'R', 'CiA 402 status word', 'u16', null, 'statusword'],
  ['position', 'R', 'position actual value, increments', 'i32', 'increments', 'position_increments'],
  ['velocity', 'R', 'velocity actual value, increments/s', 'i32', 'increments/s', 'velocity_increments'],
  ['position_demand', 'R', 'position demand value, increments; the position while nobody says it', 'i32', 'increments', 'position_demand_increments'],
  ['following_error', 'R', 'following error actual value: demand less position, increments; 0 while nobody says the demand', 'i32', 'increments', 'following_error_increments'],
  ['target_position', 'RW', 'target position, increments', 'i32', 'increments', 'target_position_increments'],
  ['mode', 'RW', 'modes of operation: 1 position, 3 velocity, 6 homing', 'i16', null, null],
  ['flags', 'R', 'flags', 'u16', null, null],
  ['online', 'R', 'the drive answers', 'bool', null, 'online'],
  ['moving', 'R', 'the axis moves', 'bool', null, 'moving'],
  ['position_units', 'R', "position actual value in the axis' unit", 'f32', 'unit', 'position'],
  ['velocity_units', 'R', "velocity actual value in the axis' unit per second", 'f32', 'unit/s', 'velocity'],
].map(([point, access, description, type, unit, member]) => ({ point, access, description, type, unit, member }));
/** @param {any} m */
const width = (m) => ({ bool: 1, u16: 1, i16: 1, u64: 4, i64: 4, f64: 4, string: m.length ?? 16 })[/** @type {'bool'} */ (m.type)] ?? 2;

export class Configuration {
  /** @param {import('./world.mjs').World} world @param {import('./site.mjs').SiteDesk} site */
  constructor(world, site = new SiteDesk(world)) {
    this.world = world;
    this.site = site;
    this.next = 1;
    /** @type {Map<string, any[]>} */
    this.snapshots = new Map();
    /** @type {Map<string, any>} */
    this.scans = new Map();
    /** @type {any} */
    this.pending = null;
    world.site.mappings ??= [];
    /** @type {import('../../src/api/types').ModbusDoor} */
    this.modbus = { bind: '127.0.0.1:1502', allow: [], functions: [1, 2, 3, 4, 5, 6, 15, 16, 23, 43], read_only: false, connections: [] };
  }
  /** @returns {any[]} */
  get mappings() {
    return /** @type {any[]} */ (this.world.site.mappings);
  }
  get hash() {
    let h = 2166136261;
    for (const c of JSON.stringify(this.mappings)) h = Math.imul(h ^ c.charCodeAt(0), 16777619) >>> 0;
    return `0x${h.toString(16).toUpperCase().padStart(8, '0')}`;
  }

  /** @param {Ask} ask @returns {Answer | null} null: not one of these */
  answer(ask) {
    const [kind, name, what] = ask.parts;
    if (kind === 'mapping-points') return { body: points };
    if (kind === 'mappings' || kind === 'mappings.csv') {
      if (ask.method !== 'GET') this.site.mayChange(ask);
      return this.mapping(ask);
    }
    if (kind === 'modbus') {
      if (ask.method === 'PATCH') Object.assign(this.modbus, JSON.parse(ask.text));
      return { body: this.modbus };
    }
    if (kind === 'descriptions' && !name && ask.method === 'GET') return { body: [] };
    if (kind === 'registers') return { body: this.registers(ask.q) };
    if (kind === 'site') return this.site.answer(ask);
    if (kind === 'backup') return this.backup(ask);
    if (kind === 'families' && what === 'commands') return { body: commands };
    if (kind === 'families' && what === 'specimens') {
      const body = specimen(name ?? '', ask.parts[3] ?? '');
      if (!body) throw new Refusal(404, 'not_found', `specimen = ${ask.parts[3]}: write a seed from 0 to 1000000000, or slow, sparse, strict, chatty, weak, old`);
      return { body };
    }
    if (kind === 'families' && !what) return { body: name ? families.find((f) => f.name === name) : families };
    if (kind === 'lines' && name && what === 'scan') return this.scan(ask, name);
    if (kind === 'axes' && name && what === 'snapshots') return this.snapshot(ask, name);
    if (kind === 'axes' && name && (what === 'parameters.csv' || ask.parts[4] === 'history')) return this.parameters(ask, name);
    return null;
  }

  /** A restore that is laid down waits for the next start, which never comes here. @param {Ask} ask @returns {Answer} */
  backup({ method, parts, text, who }) {
    const nothing = { waiting: false, at: null, who: null, bytes: null, version: null, site_revision: null };
    if (parts[1] === 'pending' && method === 'GET') return { body: this.pending ?? nothing };
    if (parts[1] === 'pending') {
      if (!this.pending) throw new Refusal(404, 'not_found', 'no backup waits for the next start');
      this.pending = null;
      return { status: 204 };
    }
    if (method === 'GET') return { type: 'application/octet-stream', text: 'backup.json' };
    this.pending = { waiting: true, at: new Date().toISOString(), who, bytes: text.length, version: 4, site_revision: 7 };
    return { status: 202, body: { text: 'the backup is checked and laid down: start the gateway anew to take it', restart_needed: true } };
  }

  /** @param {any} given @param {any[]} all */
  check(given, all) {
    const m = { table: 'holding_registers', type: 'i32', word_order: 'high_first', scale: 1, offset: 0, access: 'R', ...given };
    for (const k of Object.keys(m)) if (m[k] === '' || m[k] === undefined) delete m[k];
    if (!this.world.axes.has(m.axis)) throw new Refusal(422, 'invalid', `axis: there is no axis ${m.axis}`);
    if (!(m.unit >= 2 && m.unit <= 254)) throw new Refusal(422, 'invalid', 'unit: 2 to 254');
    const other = all.find((o) => o.id !== m.id && o.unit === m.unit && o.table === m.table && o.address < m.address + width(m) && o.address + width(o) > m.address);
    if (other) throw new Refusal(409, 'conflict', `unit ${m.unit} ${m.table} ${m.address} is taken by mapping ${other.id}`);
    if (!m.id) {
      while (all.some((o) => o.id === `m${this.next}`)) this.next += 1;
      m.id = `m${this.next}`;
    }
    return m;
  }

  /** @param {Ask} ask @returns {Answer} */
  mapping({ method, parts, q, text }) {
    const head = { 'mapping-revision': this.hash };
    const csv = (/** @type {any[]} */ list) => [columns.join(','), ...list.map((m) => columns.map((c) => m[c] ?? '').join(','))].join('\n') + '\n';
    if (parts[0] === 'mappings.csv') {
      if (method === 'GET') return { type: 'text/csv', text: csv(this.mappings) };
      const [first = '', ...lines] = text.trim().split(/\r?\n/);
      const heads = first.split(',');
      const before = this.mappings;
      let all = method === 'PUT' ? [] : [...before];
      lines.forEach((l, i) => {
        const cells = l.split(',');
        const m = Object.fromEntries(heads.map((h, k) => [h, ['unit', 'address', 'scale', 'offset', 'length'].includes(h) && cells[k] ? Number(cells[k]) : cells[k] || undefined]).filter(([, v]) => v !== undefined));
        all = all.filter((o) => o.id !== m.id);
        try {
          all.push(this.check(m, all));
        } catch (e) {
          const why = /** @type {Error} */ (e).message;
          throw new Refusal(422, 'invalid', `line ${i + 2}: ${why}`, { faults: [{ document: 'body', pointer: `/${i + 2}`, text: why, remedy: 'mend the line: nothing has been taken from the file' }] });
        }
      });
      const differences = all.filter((m) => !before.some((b) => JSON.stringify(b) === JSON.stringify(m))).map((m) => `mapping ${m.id}: ${m.point} of ${m.axis}`);
      const dry = q.get('dry_run') === '1';
      if (!dry) {
        this.world.site.mappings = all;
        this.site.changed();
      }
      return { body: { dry_run: dry, rows: lines.length, mappings: all.length, differences } };
    }
    const id = parts[1];
    if (id === 'units') {
      const units = () => /** @type {any[]} */ (this.world.site.modbus_units ?? []);
      const told = (/** @type {number} */ unit) => {
        const gaps = units().find((u) => u.unit === unit)?.gaps ?? null;
        return { unit, gaps, shown: gaps ?? 'zero', mappings: this.mappings.filter((m) => m.unit === unit).length };
      };
      if (method === 'GET') return { body: [...new Set([...this.mappings, ...units()].map((m) => m.unit))].sort((a, b) => a - b).map(told) };
      const unit = Number(parts[2]);
      const gaps = JSON.parse(text).gaps;
      this.world.site.modbus_units = [...units().filter((u) => u.unit !== unit), ...(gaps ? [{ unit, gaps }] : [])];
      this.site.changed();
      return { body: told(unit) };
    }
    if (id === 'list') return { type: q.get('format') === 'html' ? 'text/html' : 'text/plain', text: `revision ${this.hash}\n${csv(this.mappings)}` };
    if (id === 'template') {
      const b = JSON.parse(text);
      const block = [['statusword', 'u16', 0], ['position', 'i32', 2], ['velocity', 'i32', 4]].map(([point, type, at]) => this.check({ unit: b.unit, axis: b.axis, point, type, address: b.address + at, id: `${b.axis}-${point}-${b.address}` }, this.mappings));
      if (!b.dry_run) {
        this.mappings.push(...block);
        this.site.changed();
      }
      return { body: { dry_run: b.dry_run, rows: block.length, mappings: this.mappings.length, differences: block.map((m) => `mapping ${m.id} is added`) } };
    }
    if (method === 'GET') return { head, body: id ? this.mappings.find((m) => m.id === id) : this.mappings };
    const at = this.mappings.findIndex((m) => m.id === id);
    if (id && at < 0) throw new Refusal(404, 'not_found', `there is no mapping ${id}`);
    if (method === 'POST') this.mappings.push(this.check(JSON.parse(text), this.mappings));
    if (method === 'PUT') this.mappings[at] = this.check({ ...JSON.parse(text), id }, this.mappings);
    if (method === 'DELETE') this.mappings.splice(at, 1);
    this.site.changed();
    return method === 'DELETE' ? { status: 204 } : { status: method === 'POST' ? 201 : 200, body: this.mappings[at < 0 ? this.mappings.length - 1 : at] };
  }

  /** @param {URLSearchParams} q */
  registers(q) {
    const unit = Number(q.get('unit'));
    const address = Number(q.get('address'));
    const count = Number(q.get('count'));
    const table = q.get('table') ?? 'holding_registers';
    const words = Array.from({ length: count }, () => 0);
    const decoded = [];
    const own = this.mappings.filter((m) => m.unit === unit && m.table === table && m.address >= address && m.address < address + count);
    if (unit > 1 && own.length === 0) return { unit, table, address, words: [], exception: { code: 2, text: 'illegal data address' }, decoded: [] };
    for (const m of unit > 1 ? own : []) {
      const a = this.world.axis(m.axis);
      const value = m.point === 'position_units' ? a.position : m.point === 'position' ? a.position_increments : m.point === 'position_demand' ? (a.position_demand_increments ?? a.position_increments) : m.point === 'following_error' ? (a.following_error_increments ?? 0) : 42;
      const view = new DataView(new ArrayBuffer(8));
      if (m.type === 'f32') view.setFloat32(0, Number(value));
      else if (width(m) === 1) view.setInt16(0, Number(value));
      else view.setInt32(0, Number(value));
      for (let i = 0; i < Math.min(width(m), 4) && m.address - address + i < count; i += 1) words[m.address - address + i] = view.getUint16(i * 2);
      decoded.push({ address: m.address, mapping: m.id, type: m.type, value, unit: m.point === 'position_units' ? a.unit : '', text: '' });
    }
    if (unit <= 1) decoded.push({ address, name: 'statusword', type: 'u16', value: 0, unit: '', text: 'switch on disabled' });
    return { unit, table, address, words, exception: null, decoded };
  }

  /** @param {Ask} ask @param {string} line @returns {Answer} */
  scan({ method, text }, line) {
    const l = this.world.line(line);
    if (method === 'POST') {
      const { from = 1, to = 10 } = text ? JSON.parse(text) : {};
      if (Number(to) < Number(from)) throw new Refusal(422, 'invalid', `the last address ${to} is before the first ${from}`);
      const now = this.scans.get(line);
      if (now && !now.ended && Date.now() - now.begun < 800) throw new Refusal(409, 'conflict', `line ${line} is being scanned already`);
      this.scans.set(line, { begun: Date.now(), from: Number(from), to: Number(to), ended: 0 });
    }
    const s = this.scans.get(line);
    const of = s ? s.to - s.from + 1 : 0;
    if (!s) return { body: { line, state: 'none', progress: 0, asked: 0, of, found: [], text: '' } };
    const progress = Math.min(1, ((s.ended || Date.now()) - s.begun) / 800);
    if (method === 'DELETE' && progress < 1) s.ended = Date.now();
    const state = progress >= 1 ? 'done' : s.ended ? 'cancelled' : 'running';
    const known = [...this.world.drives.values()].find((d) => d.spec.line === line);
    const found = progress < 1 ? [] : [{ address: String(known?.spec.address ?? 5), family: l.family, text: 'answers', known_as: known?.spec.name ?? null }, { address: '9', family: l.family, text: 'answers', known_as: null }];
    const body = { line, state, progress, found, asked: Math.round(progress * of), of, text: state === 'cancelled' ? 'ended by hand' : '' };
    return method === 'POST' ? { status: 202, head: { location: `/api/v1/lines/${line}/scan` }, body } : { body };
  }

  /** @param {Ask} ask @param {string} name @returns {Answer} */
  snapshot({ method, parts, q, text, who }, name) {
    const axis = this.world.axisOf(name);
    const list = this.snapshots.get(name) ?? [];
    this.snapshots.set(name, list);
    const n = parts[3];
    if (!n && method === 'GET') return { body: list.map(({ values, ...s }) => ({ ...s, parameters: Object.keys(values).length })) };
    if (!n) {
      const b = JSON.parse(text);
      const values = Object.fromEntries(this.world.catalogue.filter((p) => p.access === 'RW' && !p.count).map((p) => [p.id, axis.read(p.id).value]));
      const s = { n: (list.at(-1)?.n ?? 0) + 1, name: b.name, comment: b.comment ?? '', at: new Date().toISOString(), who, from: b.from ?? 'device', family: this.world.axis(name).family, values };
      list.push(s);
      return { status: 201, body: { ...s, parameters: Object.keys(values).length } };
    }
    const at = list.findIndex((s) => String(s.n) === n);
    const s = list[at];
    if (!s) throw new Refusal(404, 'not_found', `there is no snapshot ${n}`);
    if (method === 'DELETE') {
      list.splice(at, 1);
      return { status: 204 };
    }
    if (parts[4] === 'diff') {
      const other = q.get('with') ?? 'device';
      const rows = Object.entries(s.values).map(([parameter, snapshot]) => {
        const p = axis.parameter(parameter);
        const value = other === 'default' ? p.default : other.startsWith('snapshot:') ? list.find((x) => `snapshot:${x.n}` === other)?.values[parameter] : other.startsWith('axis:') ? this.world.axisOf(other.split(':')[1] ?? '').parameter(parameter).value : axis.read(parameter).value;
        return { parameter, name: p.name, unit: p.unit, snapshot, other: value ?? null, other_known: value !== undefined && value !== null, same: snapshot === value, writable: p.access !== 'R' };
      });
      return { body: { with: other, not_known: rows.filter((r) => !r.other_known).length, text: '', rows, live: [] } };
    }
    if (parts[4] === 'restore') {
      const b = JSON.parse(text || '{}');
      const wanted = Object.entries(s.values).filter(([id]) => !b.parameters || b.parameters.includes(id));
      const changes = wanted.map(([parameter, to]) => ({ parameter, from: axis.read(parameter).value, to })).filter((c) => c.from !== c.to);
      if (b.dry_run) return { body: { changes, skipped: [] } };
      if (axis.moving) throw new Refusal(409, 'wrong_state', `axis ${name} is moving: stop it first`);
      for (const c of changes) axis.write(c.parameter, c.to, who);
      return { body: { changed: changes, failed: [] } };
    }
    return { body: s };
  }

  /** @param {Ask} ask @param {string} name @returns {Answer} */
  parameters({ method, parts, q, text, who }, name) {
    const axis = this.world.axisOf(name);
    if (parts[4] === 'history') {
      const p = axis.parameter(parts[3] ?? '');
      return { body: p.written_at ? [{ at: p.written_at, who: p.written_by, door: 'http', old: p.previous, new: p.stored }] : [] };
    }
    if (method === 'GET') return { type: 'text/csv', text: `parameter,value\n${this.world.catalogue.filter((p) => p.access === 'RW' && !p.count).map((p) => `${p.id},${axis.read(p.id).value}`).join('\n')}\n` };
    const rows = text.trim().split(/\r?\n/).slice(1).map((l) => l.split(','));
    const changes = rows.map(([parameter = '', to]) => ({ parameter, from: axis.read(parameter).value, to: Number(to) })).filter((c) => c.from !== c.to);
    const dry = q.get('dry_run') === '1';
    if (!dry) for (const c of changes) axis.write(c.parameter, c.to, who);
    return { body: dry ? { dry_run: true, changes, skipped: [] } : { dry_run: false, changed: changes, failed: [] } };
  }
}
