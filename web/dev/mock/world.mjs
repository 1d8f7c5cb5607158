// Mock world: axes that move, for developing the page without the program. In: commands and time. Out: the documents of the HTTP door.
// A stand-in for the page's author, not a second gateway: drives that are there or not, events, frames, and axes (axis.mjs).
// Time is given by the caller, so that tests need not wait.
import { catalogue, MockAxis, Refusal } from './axis.mjs';

export { catalogue, Refusal };

/** @typedef {import('../../src/api/types').Drive} Drive */
/** @typedef {import('../../src/api/types').Line} Line */
/** @typedef {import('../../src/api/types').GatewayEvent} GatewayEvent */
/** @typedef {{name: string, uri: string, family: string, bitrate?: number}} LineSpec */
/** @typedef {{name: string, line: string, address?: number | string, presence?: 'device' | 'twin' | 'auto'}} DriveSpec */
/** @typedef {{name: string, drive: string, channel?: number, number: number, unit?: string, increments_per_unit?: number, velocity_max?: number, position_min?: number, position_max?: number}} AxisSpec */
/** @typedef {{lines: LineSpec[], drives: DriveSpec[], axes: AxisSpec[], mappings?: unknown[], modbus_units?: {unit: number, gaps: string}[]}} Site */

/** @type {Site} */
export const demoSite = {
  lines: [
    { name: 'can0', uri: 'twin', family: 'uim342', bitrate: 1000000 },
    { name: 'rs485', uri: 'serial:/dev/ttyUSB0?baud=9600&rs485=1', family: 'mcode' },
    { name: 'bench', uri: 'twin', family: 'pacontrol' },
  ],
  drives: [
    { name: 'feeder', line: 'can0', address: 5, presence: 'auto' },
    { name: 'turntable', line: 'can0', address: 6, presence: 'auto' },
    { name: 'lift', line: 'rs485', address: 'A', presence: 'device' },
    { name: 'gripper', line: 'rs485', address: 'B', presence: 'device' },
    { name: 'gantry', line: 'bench', address: 1, presence: 'twin' },
  ],
  axes: [
    { name: 'feeder', drive: 'feeder', channel: 1, number: 1, unit: 'mm', increments_per_unit: 3200, velocity_max: 400 },
    { name: 'turntable', drive: 'turntable', channel: 1, number: 2, unit: 'deg', increments_per_unit: 88.89 },
    { name: 'lift', drive: 'lift', channel: 1, number: 3, unit: 'mm', increments_per_unit: 5120 },
    { name: 'gripper', drive: 'gripper', channel: 1, number: 4, unit: 'mm', increments_per_unit: 1000 },
    { name: 'gantry-x', drive: 'gantry', channel: 1, number: 5, unit: 'mm', increments_per_unit: 1000 },
    { name: 'gantry-y', drive: 'gantry', channel: 2, number: 6, unit: '', increments_per_unit: 1 },
  ],
  mappings: [],
};

export class MockDrive {
  /** @param {DriveSpec} spec @param {string} family @param {boolean} twinLine */
  constructor(spec, family, twinLine) {
    this.spec = { address: 1, presence: /** @type {const} */ ('auto'), ...spec };
    this.family = family;
    /** @type {MockAxis[]} */
    this.axes = [];
    /** @type {'device' | 'twin' | 'offline'} */
    this.presence = this.spec.presence === 'twin' || (twinLine && this.spec.presence === 'auto') ? 'twin' : twinLine ? 'offline' : 'device';
    /** @type {Record<string, boolean | number>} */
    this.hand = { power: true, silent: false, stall: false, inputs: 0, limit_positive: false, limit_negative: false, home_switch: false, temperature: 36, inject_error: 0, load: 0.2, position: 0 };
  }

  get online() {
    return this.presence !== 'offline' && this.hand.power === true;
  }

  get text() {
    if (this.hand.power !== true) return 'the drive has no power';
    if (this.presence === 'twin') return 'the embedded model answers: no real drive on this line';
    if (this.presence === 'device') return 'the real drive answers';
    return `no answer from address ${this.spec.address}; the site allows the real drive only`;
  }

  /** @returns {Drive} */
  document() {
    return {
      ...this.spec,
      family: this.family,
      axes: this.axes.map((a) => a.spec.name),
      status: {
        presence: this.online ? this.presence : 'offline',
        online: this.online,
        simulated: this.presence === 'twin',
        device_online: this.presence === 'device',
        text: this.text,
        silent_exchanges: this.presence === 'offline' ? 41 : 0,
        retry_pause_ms: this.presence === 'offline' ? 5000 : 0,
        sync: null,
      },
    };
  }
}

const ofAnAxis = ['stall', 'limit_positive', 'limit_negative', 'home_switch', 'temperature', 'load', 'position'];
const descriptions = {
  power: 'the drive has power', silent: 'hears, does not answer', stall: 'the shaft is held', inputs: 'digital inputs, one bit each',
  limit_positive: 'the positive limit switch is pressed', limit_negative: 'the negative limit switch is pressed', home_switch: 'the home switch is pressed',
  temperature: 'deg C', inject_error: 'an error code of the drive; 0 clears', load: 'share of the torque, 0 to 1', position: 'shaft position, increments',
};

export class World {
  /** @param {Site} site */
  constructor(site = demoSite) {
    this.site = site;
    this.revision = 1;
    this.started = Date.now();
    this.ticket = 0;
    /** @type {GatewayEvent[]} */
    this.events = [];
    /** @type {((e: GatewayEvent) => void)[]} */
    this.listeners = [];
    /** @type {Map<string, MockDrive>} */
    this.drives = new Map();
    /** @type {Map<string, MockAxis>} */
    this.axes = new Map();
    /** @type {Map<string, any[]>} */
    this.frames = new Map();
    /** @type {(() => void)[]} */
    this.siteListeners = [];
    this.catalogue = catalogue;
    this.exchanges = 0;
    this.askedFor = 0;
    this.frameCount = 0;
    this.reload(site);
    this.event('info', 'site', {}, 'the site is in force');
  }

  /** Everything anew from a site; parameters and positions begin again. @param {Site} site */
  reload(site) {
    this.site = site;
    this.drives.clear();
    this.axes.clear();
    for (const l of site.lines) if (!this.frames.has(l.name)) this.frames.set(l.name, []);
    for (const d of site.drives) {
      const line = site.lines.find((l) => l.name === d.line);
      if (!line) throw new Error(`drive ${d.name}: there is no line ${d.line}`);
      this.drives.set(d.name, new MockDrive(d, line.family, line.uri === 'twin'));
    }
    for (const a of site.axes) {
      const drive = this.drives.get(a.drive);
      if (!drive) throw new Error(`axis ${a.name}: there is no drive ${a.drive}`);
      const axis = new MockAxis(a, drive);
      drive.axes.push(axis);
      // As a control of several axes has it: those of channel 1 bare, the others named.
      if ((a.channel ?? 1) > 1) for (const k of ofAnAxis) drive.hand[`axis${a.channel}.${k}`] = /** @type {boolean | number} */ (new MockDrive(drive.spec, '', true).hand[k]);
      this.axes.set(a.name, axis);
    }
  }

  now() {
    return new Date().toISOString().replace('Z', '000Z');
  }

  /** @param {'info' | 'warning' | 'alarm'} severity @param {string} kind @param {Partial<GatewayEvent>} what @param {string} text */
  event(severity, kind, what, text) {
    /** @type {GatewayEvent} */
    const e = { id: this.events.length + 1, at: this.now(), severity, kind, axis: null, drive: null, line: null, code: null, text, who: null, door: null, parameter: null, old: null, new: null, ...what };
    this.events.push(e);
    for (const l of this.listeners) l(e);
  }

  /** @param {number} dt seconds */
  step(dt) {
    this.askedFor += dt;
    if (this.askedFor > 0.2) {
      this.askedFor = 0;
      for (const [line, list] of this.frames) {
        for (const to_drive of [true, false]) {
          const data = to_drive ? '01' : '0100A3';
          list.push({ sequence: (this.frameCount += 1), at: this.now(), to_drive, simulated: this.line(line).uri === 'twin', kind: 'can', id: 0x04280095, extended: true, remote: false, data, text: `04280095#${data}`, decoded: [to_drive ? 'host -> 5 MS[0]' : '5 -> host MS[0] = 163'] });
        }
        list.splice(0, list.length - 200);
      }
    }
    for (const axis of this.axes.values()) {
      const was = axis.faultCode;
      if (axis.drive.online) {
        axis.step(dt);
        this.exchanges += 1;
      }
      const injected = Number(axis.drive.hand.inject_error);
      if (injected && !axis.faultCode) axis.fail(injected, 'an injected error');
      if (axis.faultCode && !was) this.event('alarm', 'alarm', { axis: axis.spec.name, drive: axis.drive.spec.name, code: axis.faultCode }, axis.faultText ?? '');
    }
  }

  /** @param {string} name */
  axisOf(name) {
    const a = this.axes.get(name);
    if (!a) throw new Refusal(404, 'not_found', `there is no axis ${name}`);
    return a;
  }
  /** @param {string} name */
  driveOf(name) {
    const d = this.drives.get(name);
    if (!d) throw new Refusal(404, 'not_found', `there is no drive ${name}`);
    return d;
  }
  /** @param {string} name */
  axis(name) {
    return this.axisOf(name).document(this.now());
  }
  /** @param {string} name @returns {Line} */
  line(name) {
    const l = this.site.lines.find((x) => x.name === name);
    if (!l) throw new Refusal(404, 'not_found', `there is no line ${name}`);
    const drives = [...this.drives.values()].filter((d) => d.spec.line === name);
    const busy = drives.filter((d) => d.online).length;
    const status = { state: /** @type {const} */ ('up'), text: 'up', frames_in: this.exchanges, frames_out: this.exchanges, bytes_in: this.exchanges * 8, bytes_out: this.exchanges * 8, dropped: 0, errors: 0, reopened: 0, queued: 0, load: busy * 0.061, tx_errors: 0, rx_errors: 0 };
    return {
      ...l,
      drives: drives.map((d) => d.spec.name),
      status: {
        ...status,
        counters: { exchanges: this.exchanges, timeouts: l.uri === 'twin' ? 0 : 12, retries: l.uri === 'twin' ? 0 : 7, refused: 0, garbled: 0, unexpected: 0 },
        scan_counters: { exchanges: 0, timeouts: 0, retries: 0, refused: 0, garbled: 0, unexpected: 0 },
        has_twin_bus: drives.some((d) => d.presence === 'twin'),
        twin: null,
      },
    };
  }

  /** @param {string} name */
  hand(name) {
    const d = this.driveOf(name);
    if (d.presence !== 'twin') throw new Refusal(409, 'not_simulated', `drive ${name} is not simulated now`);
    return d.hand;
  }
  /** @param {string} name */
  handList(name) {
    return Object.entries(this.hand(name)).map(([n, value]) => ({ name: n, value, writable: true, description: descriptions[/** @type {keyof typeof descriptions} */ (n.replace(/^axis\d+\./, ''))] ?? '' }));
  }
  /** @param {string} name @param {Record<string, any>} change */
  setHand(name, change) {
    const hand = this.hand(name);
    for (const [k, v] of Object.entries(change)) {
      if (!(k in hand)) throw new Refusal(422, 'unknown_point', `the twin has no condition ${k}`);
      if (typeof v !== typeof hand[k]) throw new Refusal(422, 'out_of_range', `${k} must be a ${typeof hand[k]}`);
    }
    Object.assign(hand, change);
    return hand;
  }

  /** @param {string} name @param {any} c @param {string} who */
  command(name, c, who) {
    const axis = this.axisOf(name);
    this.ticket += 1;
    const more = { ticket: this.ticket, command: c.command };
    try {
      const text = axis.command(c);
      this.event('info', 'command', { axis: name, who, door: 'http' }, c.command);
      return { ...more, result: 'accepted', reason: '', axis: name, code: null, text, value: null };
    } catch (error) {
      if (error instanceof Refusal) Object.assign(error.more, more, { result: error.status === 504 ? 'failed' : 'refused' });
      throw error;
    }
  }

  /** @param {string} drive @param {{send?: string, send_hex?: string}} request */
  native(drive, request) {
    const d = this.driveOf(drive);
    if (!d.online) throw new Refusal(504, 'no_answer', 'the drive does not answer');
    const text = request.send ?? Buffer.from((request.send_hex ?? '').replace(/\s/g, ''), 'hex').toString('latin1');
    let reply = '';
    if (/^PR\s+P$/i.test(text.trim())) reply = String(Math.round((d.axes[0]?.position ?? 0) * (d.axes[0]?.spec.increments_per_unit ?? 1)));
    else if (/^PR\s+/i.test(text.trim())) reply = '0';
    else throw new Refusal(409, 'drive_refused', `the drive does not know ${text.trim()}`, { code: 20 });
    return { reply, reply_hex: Buffer.from(`${reply}\r`, 'latin1').toString('hex').toUpperCase(), took_ms: 4 };
  }
}
