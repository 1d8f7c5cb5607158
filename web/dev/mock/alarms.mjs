// Mock of the alarms: what stands, what was acknowledged, what is on the shelf. In: the events and axes of the mock world, requests. Out: the list.
// A stand-in for the page's author: one alarm per axis and code.
import { Refusal } from './world.mjs';

/** @typedef {import('../../src/api/types').Alarm} Alarm */
/** @typedef {import('./configure.mjs').Ask} Ask */
/** @typedef {import('./configure.mjs').Answer} Answer */

const most = 1000;

export class Alarms {
  /** @param {import('./world.mjs').World} world */
  constructor(world) {
    this.world = world;
    /** @type {Alarm[]} newest first */
    this.list = [];
    this.dropped = 0;
    /** Counts changes, so that the stream need not compare. */
    this.change = 1;
    world.listeners.push((e) => {
      if (e.severity === 'alarm') this.raise(e);
    });
  }

  /** @param {import('../../src/api/types').GatewayEvent} e */
  raise(e) {
    const known = this.list.find((a) => a.axis === e.axis && a.code === e.code);
    if (!known && this.list.length >= most) {
      this.dropped += 1;
      return;
    }
    const fresh = { active: true, acknowledged: false, cleared_at: null, acknowledged_by: null, acknowledged_at: null, comment: null };
    if (known) Object.assign(known, fresh, { count: known.count + 1, text: e.text });
    else this.list.unshift({ id: e.id, axis: e.axis, drive: e.drive, line: e.line, kind: e.kind, code: e.code, text: e.text, severity: 'alarm', state: 'unacknowledged_active', since: e.at, shelved_until: null, shelved_by: null, reason: null, count: 1, ...fresh });
    this.settle();
  }

  /** Looks whether what was wrong still is. */
  look() {
    let changed = false;
    for (const a of this.list) {
      const still = a.axis !== null && this.world.axes.get(a.axis)?.faultCode === a.code;
      if (a.active && !still) {
        a.active = false;
        a.cleared_at = this.world.now();
        changed = true;
      }
      if (a.shelved_until && Date.parse(a.shelved_until) <= Date.now()) {
        a.shelved_until = a.shelved_by = a.reason = null;
        changed = true;
      }
    }
    if (changed) this.settle();
  }

  settle() {
    for (const a of this.list) a.state = a.shelved_until ? 'shelved' : a.active ? (a.acknowledged ? 'acknowledged_active' : 'unacknowledged_active') : a.acknowledged ? 'normal' : 'unacknowledged_cleared';
    this.list = this.list.filter((a) => a.state !== 'normal');
    this.change += 1;
  }

  document() {
    return { unacknowledged: this.list.filter((a) => !a.acknowledged && a.state !== 'shelved').length, dropped: this.dropped, alarms: this.list };
  }

  /** @param {number} id */
  find(id) {
    const a = this.list.find((x) => x.id === id);
    if (!a) throw new Refusal(404, 'not_found', `there is no alarm ${id}`);
    return a;
  }

  /** @param {Ask} ask @returns {Answer | null} null: not one of these */
  answer({ method, parts, text, who }) {
    if (parts[0] !== 'alarms') return null;
    if (method === 'GET') return { body: this.document() };
    const b = text ? JSON.parse(text) : {};
    const acknowledge = (/** @type {Alarm} */ a) => Object.assign(a, { acknowledged: true, acknowledged_by: who, acknowledged_at: this.world.now(), comment: b.comment || null });
    if (parts[1] === 'acknowledge') {
      const chosen = b.all ? this.list.filter((a) => !a.acknowledged && a.state !== 'shelved') : (b.ids ?? []).map((/** @type {number} */ id) => this.find(id));
      chosen.forEach(acknowledge);
      this.settle();
      return { body: { acknowledged: chosen.length } };
    }
    const a = this.find(Number(parts[1]));
    if (parts[2] === 'acknowledge') acknowledge(a);
    if (parts[2] === 'shelve') Object.assign(a, { shelved_until: new Date(Date.now() + (b.for_s ?? 3600) * 1000).toISOString(), shelved_by: who, reason: b.reason ?? '' });
    if (parts[2] === 'unshelve') a.shelved_until = a.shelved_by = a.reason = null;
    this.settle();
    return { body: a };
  }
}
