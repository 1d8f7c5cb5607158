// Mock axis: one axis of the mock world: a plan in simple ramps, a shaft that follows a little behind it, and its parameters.
// In: commands, writes, seconds. Out: the axis' document, a parameter's document, or a Refusal in words.
// A stand-in for the page's author; time is given by the caller, so that tests need not wait.

/** @typedef {import('../../src/api/types').Axis} Axis */
/** @typedef {import('../../src/api/types').AxisParameter} AxisParameter */
/** @typedef {import('./world.mjs').AxisSpec} AxisSpec */
/** @typedef {import('./world.mjs').MockDrive} MockDrive */

/** How far the shaft is behind the plan, as time. */
const lag_s = 0.02;
/** A drive notices after this that its shaft is held. */
const stallAfter_s = 0.5;
/** Whose word the demand is, by family, so that the page's author sees every kind. @type {Record<string, Axis['demand_source']>} */
const sources = { uim342: 'computed', mcode: 'drive', pacontrol: 'open_loop' };

/** What a drive answered that did not go well. */
export class Refusal extends Error {
  /** @param {number} status @param {string} reason @param {string} detail @param {Record<string, unknown>} more @param {Record<string, string>} head */
  constructor(status, reason, detail, more = {}, head = {}) {
    super(detail);
    this.status = status;
    this.reason = reason;
    this.more = more;
    this.head = head;
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
    fields: null, meanings: null, alternate: null, choice: [], meaning: null,
    first: first ?? null, count: count ?? null, selector: null,
  };
});

export class MockAxis {
  /** @param {AxisSpec} spec @param {MockDrive} drive */
  constructor(spec, drive) {
    this.spec = { channel: 1, unit: '', increments_per_unit: 1, ...spec };
    this.drive = drive;
    this.position = 0;
    this.velocity = 0;
    this.planned = 0;
    this.plannedVelocity = 0;
    /** A command since it was enabled: from then on the plan says where it should be. */
    this.ordered = false;
    this.held_s = 0;
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
    this.plan(dt);
    if (this.drive.hand.stall) {
      this.velocity = 0;
      this.held_s = this.motion === 'none' ? 0 : this.held_s + dt;
      if (this.held_s > stallAfter_s) this.fail(8, 'the motor is stalled');
      if (this.motion === 'none') [this.planned, this.plannedVelocity] = [this.position, 0];
      return;
    }
    this.held_s = 0;
    this.velocity = this.plannedVelocity;
    this.position = this.planned - this.plannedVelocity * lag_s;
  }

  /** Where it should be. @param {number} dt seconds */
  plan(dt) {
    let wanted = 0;
    if (this.motion === 'velocity') wanted = this.wantedVelocity;
    if (this.motion === 'position') {
      const left = this.target - this.planned;
      const braking = Math.sqrt(2 * this.acceleration * Math.abs(left));
      wanted = Math.sign(left) * Math.min(this.speed, braking, Math.abs(left) / Math.max(dt, 1e-3));
      if (Math.abs(left) < Math.max(1e-3, Math.abs(this.plannedVelocity) * dt) && Math.abs(this.plannedVelocity) < this.acceleration * dt * 2 + 1) {
        this.planned = this.target;
        this.plannedVelocity = 0;
        // A shaft that is held has not arrived: the drive will notice.
        if (this.drive.hand.stall) return;
        this.motion = 'none';
        this.reached = true;
        return;
      }
    }
    const change = (this.motion === 'none' ? 2000 : this.acceleration) * dt;
    this.plannedVelocity += Math.max(-change, Math.min(change, wanted - this.plannedVelocity));
    this.planned += this.plannedVelocity * dt;
  }

  /** Nobody has ordered anything since it went off; it stands where it stands. */
  forget() {
    this.ordered = false;
    this.planned = this.position;
    this.plannedVelocity = this.velocity;
  }

  /** @returns {{source: Axis['demand_source'], demand: number | null}} */
  get demand() {
    const own = sources[this.drive.family] ?? 'computed';
    if (!this.drive.online) return { source: null, demand: null };
    if (own === 'open_loop') return { source: own, demand: this.position };
    return this.enabled && (own === 'drive' || this.ordered) ? { source: own, demand: this.planned } : { source: null, demand: null };
  }

  /** @param {number} code @param {string} text */
  fail(code, text) {
    this.faultCode = code;
    this.faultText = text;
    this.enabled = false;
    this.motion = 'none';
    this.forget();
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
    const { source, demand } = this.demand;
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
      modes: [1, 3, 6],
      set_points: { streaming: false, mode: null, taken: 0, refused: 0, reason: null },
      moving: online && this.moving,
      target_reached: online && this.reached && !this.moving,
      referenced: this.referenced,
      fault: this.faultCode !== 0,
      warning: false,
      internal_limit: false, fail_safe_cause: null, stop_latch: 0, stop_latch_by: null, stop_latch_text: null,
      position: online || this.setpoints > 0 ? unit(this.position) : null,
      demand_known: demand !== null,
      demand_source: source,
      position_demand: demand === null ? null : unit(demand),
      following_error: demand === null ? null : (round(demand) - round(this.position)) / inc,
      velocity: online ? unit(this.velocity) : null,
      target_position: this.setpoints > 0 ? unit(this.target) : null,
      target_velocity: 0,
      position_increments: round(this.position),
      position_demand_increments: demand === null ? null : round(demand),
      following_error_increments: demand === null ? null : round(demand) - round(this.position),
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
        if (!this.enabled) this.forget();
        this.enabled = true;
        this.quickStopped = false;
        this.target = this.position;
        return '';
      case 'disable':
        this.enabled = this.quickStopped = false;
        this.motion = 'none';
        this.forget();
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
        this.position = this.planned = this.target = c.position;
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
        this.ordered = true;
        this.setpoints += 1;
        return '';
      default:
        throw new Refusal(422, 'invalid', `there is no command ${c.command}`, { faults: [] });
    }
    if (c.velocity) this.speed = c.velocity;
    if (c.acceleration) this.acceleration = c.acceleration;
    this.motion = 'position';
    this.reached = false;
    this.ordered = true;
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
