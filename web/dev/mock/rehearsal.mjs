// Mock of the rehearsals of recipes against specimens. In: requests of the recipes' mock, the time. Out: documents of the HTTP door. A stand-in: nothing is
// played; `weak` and each seventh seed fail at the recipe's second step.
import { Refusal } from './world.mjs';

/** @typedef {import('../../src/api/types').RecipeRehearsal} RecipeRehearsal */
/** @typedef {{report: RecipeRehearsal, wanted: string[], tag: string}} Kept */

const perStep = 5;
const most = 1000;
const extremes = ['slow', 'sparse', 'strict', 'chatty', 'weak', 'old'];

/** @param {string} text @returns {string[]} */
function specimensOf(text) {
  const wrong = (/** @type {string} */ part) => new Refusal(422, 'invalid', `specimen = ${part}: write a seed from 0 to 1000000000, or ${extremes.join(', ')}`);
  const all = text.split(',').flatMap((part) => {
    const range = /^(\d+)\.\.(\d+)$/.exec(part);
    if (!range) {
      if (!/^\d+$/.test(part) && !extremes.includes(part)) throw wrong(part);
      return [part];
    }
    const [from, to] = [Number(range[1]), Number(range[2])];
    if (from > to || to - from >= most) throw wrong(part);
    return Array.from({ length: to - from + 1 }, (_, i) => String(from + i));
  });
  return [...new Set(all)];
}

export class MockRehearsals {
  /** @param {import('./world.mjs').World} world */
  constructor(world) {
    this.world = world;
    /** @type {Map<string, Kept>} */
    this.kept = new Map();
  }

  running = () => [...this.kept.values()].find((k) => k.report.state === 'running' || k.report.state === 'cancelling');

  step() {
    const now = this.running();
    if (!now) return;
    const { report } = now;
    for (let i = 0; i < perStep && report.state === 'running' && now.wanted.length > 0; i += 1) this.play(report, now.wanted.shift() ?? '');
    if (report.state === 'running' && now.wanted.length > 0) return;
    report.state = report.state === 'running' ? 'done' : 'cancelled';
    report.ended_at = this.world.now();
  }

  /** @param {RecipeRehearsal} report @param {string} specimen */
  play(report, specimen) {
    const passed = specimen !== 'weak' && (Number.isNaN(Number(specimen)) || Number(specimen) % 7 !== 0);
    report.specimens.push({ specimen, passed, seconds: 2.5, ...(passed ? { step: null, pointer: null, text: null, event: null } : { step: 'Step 2: wait', pointer: '/steps/1', text: 'not done within 30 s', event: 'feeder: following error' }) });
    report.done += 1;
    report[passed ? 'passed' : 'failed'] += 1;
  }

  /** @param {string} name @param {string} tag @param {import('./configure.mjs').Ask} ask @returns {import('./configure.mjs').Answer} */
  answer(name, tag, { method, text, who, q }) {
    const kept = this.kept.get(name);
    if (method === 'POST') return { status: 202, body: this.start(name, tag, text ? JSON.parse(text) : {}, who) };
    if (method === 'DELETE') {
      if (kept?.report.state !== 'running') throw new Refusal(409, 'wrong_state', `recipe ${name} is not being rehearsed`);
      kept.report.state = 'cancelling';
      return { status: 202, body: kept.report };
    }
    if (!kept) return { body: { recipe: name, state: 'none', total: 0, done: 0, passed: 0, failed: 0, began_at: null, ended_at: null, who: null, site_revision: null, outdated: false, families: {}, arguments: {}, specimens: [] } };
    return { body: { ...kept.report, outdated: kept.tag !== tag, specimens: kept.report.specimens.slice(Number(q.get('first') ?? 0)) } };
  }

  /** @param {string} name @param {string} tag @param {any} order @param {string} who @returns {RecipeRehearsal} */
  start(name, tag, order, who) {
    const other = this.running();
    if (other) throw new Refusal(409, 'running', `a rehearsal of recipe ${other.report.recipe} is under way: wait for its end, or end it with DELETE /api/v1/recipes/${other.report.recipe}/rehearsal`);
    const wanted = specimensOf(order.specimens ?? '1..100');
    /** @type {RecipeRehearsal} */
    const report = { recipe: name, state: 'running', total: wanted.length, done: 0, passed: 0, failed: 0, began_at: this.world.now(), ended_at: null, who, site_revision: 1, outdated: false, families: order.families ?? {}, arguments: order.arguments ?? {}, specimens: [] };
    this.kept.set(name, { report, wanted, tag });
    return { ...report, specimens: [] };
  }
}
