// Mock world: axes that move, for developing the page without the program. In: commands and time. Out: the documents of the HTTP door.
// A stand-in for the page's author, not a second gateway: simple ramps, a few parameters, the refusals that the page must show.
// Time is given by the caller in milliseconds, so that tests need not wait.

/** @typedef {import('../../src/api/types').Axis} Axis */
/** @typedef {import('../../src/api/types').Drive} Drive */
/** @typedef {import('../../src/api/types').Line} Line */
/** @typedef {import('../../src/api/types').GatewayEvent} GatewayEvent */
/** @typedef {import('../../src/api/types').AxisParameter} AxisParameter */
/** @typedef {{name: string, uri: string, family: string, bitrate?: number}} LineSpec */
/** @typedef {{name: string, line: string, address?: number | string, presence?: 'device' | 'twin' | 'auto'}} DriveSpec */
/** @typedef {{name: string, drive: string, channel?: number, number: number, unit?: string, increments_per_unit?: number, velocity_max?: number, position_min?: number, position_max?: number}} AxisSpec */
/** @typedef {{lines: LineSpec[], drives: DriveSpec[], axes: AxisSpec[], mappings?: unknown[]}} Site */

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

/** What a drive answered that did not go well. */
export class Refusal extends Error {
  /** @param {number} status @param {string} reason @param {string} detail @param {Record<string, unknown>} more */
  constructor(status, reason, detail, more = {}) {
    super(detail);
    this.status = status;
    this.reason = reason;
    this.more = more;
  }
}

/** @type {Omit<AxisParameter, 'value' | 'quality' | 'at' | 'stored' | 'previous' | 'written_at' | 'written_by' | 'written_through' | 'text'>[]} */
export const catalogue = [
  ['AC', 'acceleration', 'motion', 'u32', 'pulse/s^2', 1, 65000000, 20000, 'RW', 'Acceleration of the profile'],
  ['DC', 'deceleration', 'motion', 'u32', 'pulse/s^2', 1, 65000000, 20000, 'RW', 'Deceleration of the profile'],
  ['SP', 'cruise_speed', 'motion', 'i32', 'pulse/s', -300000, 300000, 32000, 'RW', 'Speed of the profile'],
  ['SD', 'stop_deceleration', 'motion', 'u32', 'pulse/s^2', 1, 65000000, 200000, 'RW', 'Deceleration of an emergency stop'],
  ['BL', 'backlash', 'motion', 'u16', 'pulse', 0, 65535, 0, 'RW', 'Backlash compensation'],
  ['MT[0]', 'micro_stepping', 'motor', 'u16', null, 1, 128, 16, 'RW', 'Microsteps per full step'],
  ['MT[1]', 'working_current', 'motor', 'u16', '0.1 A', 5, 80, 30, 'RW', 'Phase current while moving'],
  ['MT[2]', 'idle_current_percent', 'motor', 'u16', '%', 0, 100, 50, 'RW', 'Share of the working current at rest'],
  ['IC[4]', 'use_closed_loop', 'setup', 'bool', null, null, null, true, 'RW', 'Closed-loop control with the encoder'],
  ['IC[5]', 'software_limits', 'setup', 'bool', null, null, null, false, 'RW', 'Software limits active'],
  ['IL', 'input_logic', 'inputs', 'u16', null, 0, 2, 0, 'RW', 'What an input does', [[0, 'nothing'], [1, 'stop'], [2, 'origin']]],
  ['TE', 'driver_temperature', 'status', 'i16', 'deg C', null, null, null, 'R', 'Temperature of the driver'],
  ['VB', 'bus_voltage', 'status', 'f32', 'V', null, null, null, 'R', 'Supply voltage'],
  ['ML', 'model', 'status', 'text', null, null, null, null, 'R', 'Model and firmware'],
  ['PP', 'protocol', 'setup', 'u16', null, 0, 65535, 0, 'RW', 'A long table of settings', undefined, 0, 600],
].map((row) => {
  const [id, name, group, type, unit, min, max, fallback, access, description, allowed, first, count] = /** @type {any[]} */ (row);
  return {
    id, name, group, type, unit, min, max, default: fallback, access, storage: access === 'R' ? null : 'flash', addressing: id === 'PP', live: false, description,
    allowed: allowed ? allowed.map((/** @type {[number, string]} */ [value, meaning]) => ({ value, meaning })) : null,
    first: first ?? null, count: count ?? null,
  };
});

class MockAxis {
  /** @param {AxisSpec} spec @param {MockDrive} drive */
  constructor(spec, drive) {
    this.spec = { channel: 1, unit: '', increments_per_unit: 1, ...spec };
    this.drive = drive;
    this.position = 0;
    this.velocity = 0;
    this.target = 0;
    this.speed = 50;
    this.acceleration = 400;
    /** @type {'none' | 'position' | 'velocity'} */
    this.motion = 'none';
    this.wantedVelocity = 0;
    this.enabled = false;
    this.quickStopped = false;
    this.faultCode = 0;
    this.reached = false;
    this.referenced = false;
    this.setpoints = 0;
    /** @type {Map<string, any>} */
    this.values = new Map();
    /** @type {Map<string, any>} */
    this.stored = new Map();
    /** @type {Map<string, {at: string, by: string}>} */
    this.written = new Map();
  }

  /** @param {number} dt seconds */
  step(dt) {
    let wanted = 0;
    if (this.motion === 'velocity') wanted = this.wantedVelocity;
    if (this.motion === 'position') {
      const left = this.target - this.position;
      const braking = Math.sqrt(2 * this.acceleration * Math.abs(left));
      wanted = Math.sign(left) * Math.min(this.speed, braking);
      if (Math.abs(left) < Math.max(1e-3, Math.abs(this.velocity) * dt) && Math.abs(this.velocity) < this.acceleration * dt * 2 + 1) {
        this.position = this.target;
        this.velocity = 0;
        this.motion = 'none';
        this.reached = true;
        return;
      }
    }
    if (this.drive.hand.stall) {
      if (this.motion !== 'none') this.fail(8, 'the motor is stalled');
      this.velocity = 0;
      return;
    }
    const change = (this.motion === 'none' ? 2000 : this.acceleration) * dt;
    this.velocity += Math.max(-change, Math.min(change, wanted - this.velocity));
    this.position += this.velocity * dt;
  }

  /** @param {number} code @param {string} text */
  fail(code, text) {
    this.faultCode = code;
    this.faultText = text;
    this.enabled = false;
    this.motion = 'none';
  }

  get moving() {
    return Math.abs(this.velocity) > 1e-6;
  }

  /** @returns {Axis['state']} */
  get state() {
    if (!this.drive.online) return 'not_ready_to_switch_on';
    if (this.faultCode) return 'fault';
    if (this.quickStopped) return 'quick_stop_active';
    return this.enabled ? 'operation_enabled' : 'switch_on_disabled';
  }

  /** @param {string} now */
  document(now) {
    const inc = this.spec.increments_per_unit;
    const round = (/** @type {number} */ v) => Math.round(v * inc);
    const unit = (/** @type {number} */ v) => round(v) / inc;
    const online = this.drive.online;
    const state = this.state;
    const words = { not_ready_to_switch_on: 0x0000, switch_on_disabled: 0x0270, ready_to_switch_on: 0x0231, switched_on: 0x0233, operation_enabled: 0x0237, quick_stop_active: 0x0217, fault_reaction_active: 0x021f, fault: 0x0218 };
    const simulated = this.drive.presence === 'twin';
    /** @type {Axis} */
    const a = {
      ...this.spec,
      line: this.drive.spec.line,
      family: this.drive.family,
      online,
      simulated,
      stale: online && this.drive.hand.silent === true,
      presence: this.drive.presence,
      state,
      statusword: words[state] | (simulated ? 0x100 : 0) | (this.reached ? 0x400 : 0) | (this.referenced ? 0x8000 : 0),
      controlword: 0,
      mode: this.motion === 'velocity' ? 'profile_velocity' : this.setpoints > 0 ? 'profile_position' : 'none',
      mode_number: 0,
      moving: online && this.moving,
      target_reached: online && this.reached && !this.moving,
      referenced: this.referenced,
      fault: this.faultCode !== 0,
      warning: false,
      internal_limit: false,
      position: online || this.setpoints > 0 ? unit(this.position) : null,
      demand_known: true, position_demand: unit(this.position),
      velocity: online ? unit(this.velocity) : null,
      target_position: this.setpoints > 0 ? unit(this.target) : null,
      target_velocity: 0,
      position_increments: round(this.position),
      position_demand_increments: round(this.position),
      velocity_increments: round(this.velocity),
      target_position_increments: round(this.target),
      error: { code: this.faultCode, text: this.faultCode ? (this.faultText ?? '') : '' },
      native: 0x41,
      authority: this.setpoints > 0 ? 'http' : 'none',
      setpoints_accepted: this.setpoints,
      at: now,
    };
    return a;
  }

  /** @param {any} c @returns {string} what was said beside */
  command(c) {
    const urgent = c.command === 'quick_stop' || c.command === 'halt' || c.command === 'disable';
    if (!this.drive.online) throw new Refusal(504, 'no_answer', 'the drive does not answer', { axis: this.spec.name });
    if (this.faultCode && !urgent && c.command !== 'reset_fault') {
      throw new Refusal(409, 'wrong_state', `the axis is in fault (drive's code ${this.faultCode}): reset the fault first`, { axis: this.spec.name, code: this.faultCode });
    }
    switch (c.command) {
      case 'enable':
        this.enabled = true;
        this.quickStopped = false;
        this.target = this.position;
        return '';
      case 'disable':
        this.enabled = this.quickStopped = false;
        this.motion = 'none';
        return '';
      case 'quick_stop':
        this.motion = 'none';
        this.reached = false;
        if (this.enabled) this.quickStopped = true;
        return '';
      case 'halt':
        this.motion = 'none';
        return '';
      case 'reset_fault':
        this.faultCode = 0;
        return '';
      case 'set_position':
        this.position = this.target = c.position;
        this.referenced = true;
        return '';
      case 'home':
        this.needEnabled();
        this.target = 0;
        this.referenced = true;
        break;
      case 'move_absolute':
      case 'move_relative': {
        this.needEnabled();
        const target = c.command === 'move_absolute' ? c.position : this.position + c.position;
        const { position_min: low, position_max: high } = this.spec;
        if ((low !== undefined && target < low) || (high !== undefined && target > high)) {
          throw new Refusal(422, 'out_of_range', `${target} is outside the limits ${low}..${high} ${this.spec.unit} of the axis`, { axis: this.spec.name });
        }
        this.target = target;
        break;
      }
      case 'move_velocity':
        this.needEnabled();
        this.wantedVelocity = c.velocity;
        this.motion = 'velocity';
        this.reached = false;
        this.setpoints += 1;
        return '';
      default:
        throw new Refusal(422, 'invalid', `there is no command ${c.command}`, { faults: [] });
    }
    if (c.velocity) this.speed = c.velocity;
    if (c.acceleration) this.acceleration = c.acceleration;
    this.motion = 'position';
    this.reached = false;
    this.setpoints += 1;
    return '';
  }

  needEnabled() {
    const words = this.state.replaceAll('_', ' ');
    if (!this.enabled || this.quickStopped) throw new Refusal(409, 'wrong_state', `the axis is ${words}: enable it first`, { axis: this.spec.name });
  }

  /** @param {string} id @returns {AxisParameter} */
  parameter(id) {
    const array = /^(\w+)\[(\d+)\]$/.exec(id);
    const p = catalogue.find((x) => x.id === id || x.name === id) ?? catalogue.find((x) => array && x.id === array[1] && x.count);
    if (!p) throw new Refusal(404, 'not_found', `axis ${this.spec.name} has no parameter ${id}`);
    const w = this.written.get(id);
    return {
      ...p,
      id,
      first: p.id === id ? p.first : null,
      count: p.id === id ? p.count : null,
      value: this.values.get(id) ?? null,
      quality: this.values.has(id) ? 'good' : 'unknown',
      at: this.values.has(id) ? new Date().toISOString() : null,
      stored: this.stored.get(id) ?? null,
      previous: null,
      written_at: w?.at ?? null,
      written_by: w?.by ?? null,
      written_through: w ? 'http' : null,
      text: '',
    };
  }

  /** @param {string} id */
  read(id) {
    const p = this.parameter(id);
    if (!this.drive.online) throw new Refusal(504, 'no_answer', 'the drive does not answer');
    const now = { TE: 36, VB: 23.9, ML: 'UIM342CA-IE 3.02' };
    if (!this.values.has(id)) this.values.set(id, now[/** @type {keyof typeof now} */ (id)] ?? p.default ?? 0);
    return this.parameter(id);
  }

  /** @param {string} id @param {any} value @param {string} who */
  write(id, value, who) {
    const p = this.parameter(id);
    if (!this.drive.online) throw new Refusal(504, 'no_answer', 'the drive does not answer');
    if (p.access === 'R') throw new Refusal(409, 'not_writable', `${id} is read only`);
    if (typeof value === 'number' && ((p.min !== null && value < p.min) || (p.max !== null && value > p.max))) {
      const text = `${id}: ${value} is outside ${p.min}..${p.max} ${p.unit ?? ''}`.trim();
      throw new Refusal(422, 'out_of_range', text, { faults: [{ document: 'body', pointer: '/value', text, remedy: 'write a value in the range' }] });
    }
    const old = this.values.get(id) ?? null;
    this.values.set(id, value);
    this.stored.set(id, value);
    this.written.set(id, { at: new Date().toISOString(), by: who });
    return old;
  }
}

class MockDrive {
  /** @param {DriveSpec} spec @param {string} family @param {boolean} twinLine */
  constructor(spec, family, twinLine) {
    this.spec = { address: 1, presence: /** @type {const} */ ('auto'), ...spec };
    this.family = family;
    /** @type {MockAxis[]} */
    this.axes = [];
    /** @type {'device' | 'twin' | 'offline'} */
    this.presence = this.spec.presence === 'twin' || (twinLine && this.spec.presence === 'auto') ? 'twin' : twinLine ? 'offline' : 'device';
    /** @type {Record<string, boolean | number>} */
    this.hand = { power: true, silent: false, stall: false, inputs: 0, limit_positive: false, limit_negative: false, home_switch: false, temperature: 36, inject_error: 0, load: 0.2 };
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
      },
    };
  }
}

const descriptions = {
  power: 'the drive has power', silent: 'hears, does not answer', stall: 'the shaft is held', inputs: 'digital inputs, one bit each',
  limit_positive: 'the positive limit switch is pressed', limit_negative: 'the negative limit switch is pressed', home_switch: 'the home switch is pressed',
  temperature: 'deg C', inject_error: 'an error code of the drive; 0 clears', load: 'share of the torque, 0 to 1',
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
    return Object.entries(this.hand(name)).map(([n, value]) => ({ name: n, value, writable: true, description: descriptions[/** @type {keyof typeof descriptions} */ (n)] ?? '' }));
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
