// Mock of the recipes: documents, a check of them, runs with their reports. In: requests; time in milliseconds, by the caller. Out: documents of the
// HTTP door. A stand-in for the page's author: every kind of step has its effect on the mock world or none; the checks are the few that the page shows.
import { MockRehearsals } from './rehearsal.mjs';
import { Refusal } from './world.mjs';

/** @typedef {import('../../src/api/types').RecipeReport} RecipeReport */
/** @typedef {import('./configure.mjs').Ask} Ask */
/** @typedef {import('./configure.mjs').Answer} Answer */
/** @typedef {{report: RecipeReport, work: Generator<() => boolean | string, void>, wait: (() => boolean | string) | null}} Run */

const kinds = ['set_parameter', 'read_parameter', 'enable', 'disable', 'home', 'command', 'action', 'write_register', 'wait_for', 'check', 'wait_s', 'if', 'repeat', 'message'];
const mostRuns = 20;
/** @param {any} step */
const kindOf = (step) => kinds.find((k) => k in step) ?? '';
/** @param {any} step @param {string} at @returns {[string, any[]][]} */
const listsOf = (step, at) => ['then', 'else', 'steps'].flatMap((l) => (Array.isArray(step[kindOf(step)]?.[l]) ? [/** @type {[string, any[]]} */ ([`${at}/${kindOf(step)}/${l}`, step[kindOf(step)][l]])] : []));

/** Another text, time or author is another tag. @param {{document: any, changed_at: string, changed_by: string}} recipe */
function tagOf({ document, changed_at, changed_by }) {
  let h = 2166136261;
  for (const c of JSON.stringify([document, changed_at, changed_by])) h = Math.imul(h ^ c.charCodeAt(0), 16777619) >>> 0;
  return `"${h.toString(16).padStart(8, '0')}"`;
}

export class Recipes {
  /** @param {import('./world.mjs').World} world */
  constructor(world) {
    this.world = world;
    this.now_ms = 0;
    /** @type {Map<string, {document: any, changed_at: string, changed_by: string}>} */
    this.all = new Map();
    /** @type {Map<string, Run[]>} newest first */
    this.runs = new Map();
    /** Told of each change of a report. @type {((report: RecipeReport) => void)[]} */
    this.listeners = [];
    this.rehearsals = new MockRehearsals(world);
  }

  /** @param {number} now_ms */
  step(now_ms) {
    this.now_ms = now_ms;
    this.rehearsals.step();
    for (const run of [...this.runs.values()].flat()) if (run.report.state === 'running') this.goOn(run);
  }

  /** @param {Run} run */
  goOn(run) {
    const before = JSON.stringify(run.report);
    try {
      for (let turns = 0; turns < 1000; turns += 1) {
        const held = run.wait ? run.wait() : true;
        if (typeof held === 'string') throw new Error(held);
        if (!held) break;
        const next = run.work.next();
        run.wait = next.done ? null : next.value;
        if (next.done) {
          this.end(run, 'done', '');
          break;
        }
      }
    } catch (error) {
      this.end(run, 'failed', /** @type {Error} */ (error).message);
    }
    if (JSON.stringify(run.report) !== before) for (const l of this.listeners) l(run.report);
  }

  /** @param {Run} run @param {'done' | 'failed' | 'cancelled'} state @param {string} text */
  end(run, state, text) {
    const r = run.report;
    r.state = state;
    r.text = text;
    r.ended_at = this.world.now();
    for (const s of r.steps) {
      if (s.state !== 'running') continue;
      s.state = state;
      s.ended_at = r.ended_at;
      s.text = text;
    }
    if (state === 'done') r.at_step = null;
    else r.stops = r.axes.map((axis) => ({ axis, stopped: this.say(axis, { command: 'halt' }) === '', text: '' }));
    this.world.event(state === 'failed' ? 'warning' : 'info', 'recipe', { who: r.started_by }, `recipe ${r.recipe} run ${r.n} ${state}`);
  }

  /** @param {string} axis @param {any} command @returns {string} why not */
  say(axis, command) {
    try {
      this.world.command(axis, command, 'recipe');
      return '';
    } catch (error) {
      return /** @type {Error} */ (error).message;
    }
  }

  /** @param {Ask} ask @returns {Answer | null} null: not one of these */
  answer(ask) {
    const { method, parts, q, text, who } = ask;
    const [kind, name, what, n, verb] = parts;
    if (kind !== 'recipes') return null;
    if (!name) return { body: [...this.all].map(([k, r]) => ({ name: k, etag: tagOf(r), description: r.document.description ?? '', parameters: r.document.parameters ?? {}, steps: this.flat(r.document.steps, '/steps').length, changed_at: r.changed_at, changed_by: r.changed_by, running: this.running(k)?.report.n ?? null })) };
    if (!what && method === 'PUT') return this.put(name, JSON.parse(text), q.get('dry_run') === '1', ask);
    const recipe = this.all.get(name);
    if (!recipe) throw new Refusal(404, 'not_found', `there is no recipe ${name}`);
    if (!what && method === 'GET') return { head: { etag: tagOf(recipe) }, body: this.shown(name, recipe) };
    if (!what && method === 'DELETE') {
      this.refuse(name, ask);
      const run = this.running(name);
      if (run) throw new Refusal(409, 'running', `recipe ${name} is running (run ${run.report.n}): cancel it first`);
      this.all.delete(name);
      this.world.event('info', 'recipe', { who, door: 'http' }, `recipe ${name} deleted`);
      return { status: 204 };
    }
    if (what === 'rehearsal') return this.rehearsals.answer(name, tagOf(recipe), ask);
    if (what === 'run') return this.start(name, recipe.document, text ? JSON.parse(text) : {}, who);
    const runs = this.runs.get(name) ?? [];
    if (!n) return { body: runs.map(({ report: { steps: _, ...head } }) => head) };
    const run = runs.find((r) => String(r.report.n) === n);
    if (!run) throw new Refusal(404, 'not_found', `recipe ${name} has no run ${n}`);
    if (verb === 'cancel') {
      if (run.report.state !== 'running') throw new Refusal(409, 'wrong_state', `run ${n} has ended already`);
      this.end(run, 'cancelled', 'cancelled by hand');
      for (const l of this.listeners) l(run.report);
    }
    return { body: run.report };
  }

  /** @param {string} name */
  running = (name) => (this.runs.get(name) ?? []).find((r) => r.report.state === 'running');

  /** @param {any[]} steps @param {string} at @returns {{pointer: string, step: any}[]} */
  flat(steps, at) {
    return steps.flatMap((step, i) => [{ pointer: `${at}/${i}`, step }, ...listsOf(step, `${at}/${i}`).flatMap(([p, l]) => this.flat(l, p))]);
  }

  /** @param {string} name @param {{document: any, changed_at: string, changed_by: string}} recipe */
  shown = (name, { document, changed_at, changed_by }) => ({ ...document, name, changed_at, changed_by });

  /** 412 with what is there now, if it is not what was asked for. @param {string} name @param {Ask} ask */
  refuse(name, { match, none = '' }) {
    const now = this.all.get(name);
    const tag = now ? tagOf(now) : null;
    const refused = (/** @type {string} */ words) => new Refusal(412, 'precondition_failed', words, { etag: tag, current: now ? this.shown(name, now) : null }, tag === null ? {} : { etag: tag });
    if (match && !now) throw refused(`there is no recipe ${name} any more: leave If-Match out to make it`);
    if (match && now && match !== '*' && match !== tag) throw refused(`recipe ${name} was changed by ${now.changed_by || 'somebody'} at ${now.changed_at}: read it again; its ETag is ${tag}, not ${match}`);
    if (none && now && (none === '*' || none === tag)) throw refused(`there is a recipe ${name} already: choose another name, or send If-Match: ${tag} to replace it`);
  }

  /** @param {string} name @param {any} document @param {boolean} dry @param {Ask} ask @returns {Answer} */
  put(name, document, dry, ask) {
    /** @type {any[]} */
    const faults = [];
    const fault = (/** @type {string} */ pointer, /** @type {string} */ words, /** @type {string} */ remedy) => faults.push({ document: 'body', pointer, text: words, remedy });
    if (!Array.isArray(document.steps) || document.steps.length === 0) fault('/steps', 'there is no step', 'add one');
    for (const [p, spec] of Object.entries(document.parameters ?? {})) {
      const { min, max, default: d } = /** @type {any} */ (spec);
      if (typeof d === 'number' && ((min !== undefined && d < min) || (max !== undefined && d > max))) fault(`/parameters/${p}/default`, `the default ${d} is not from ${min ?? '-'} to ${max ?? '-'}`, 'correct one of them');
    }
    for (const { pointer, step } of this.flat(document.steps ?? [], '/steps')) {
      const kind = kindOf(step);
      if (!kind) fault(pointer, `${Object.keys(step)[0] ?? 'nothing'} is no step`, `write one of ${kinds.join(', ')}`);
      const named = step[kind]?.axis;
      if (named === '') fault(`${pointer}/${kind}/axis`, 'the axis is missing', 'name an axis of the site');
      const c = step.check ?? step.wait_for ?? step.if?.condition;
      const first = this.world.axes.keys().next().value;
      if (c?.point && first !== undefined && c.point !== 'error_code' && !(c.point in this.world.axis(first))) fault(`${pointer}/${kind}/point`, `an axis has no point ${c.point}`, 'name a member of the axis document');
    }
    if (faults.length > 0) throw new Refusal(422, 'invalid', `${faults.length} faults`, { faults });
    this.refuse(name, ask);
    if (dry) return { body: { dry_run: true, steps: this.flat(document.steps, '/steps').length } };
    const made = !this.all.has(name);
    const kept = { document, changed_at: this.world.now(), changed_by: ask.who };
    this.all.set(name, kept);
    this.world.event('info', 'recipe', { who: ask.who, door: 'http' }, `recipe ${name} ${made ? 'made' : 'changed'}`);
    return { status: made ? 201 : 200, head: { etag: tagOf(kept), ...(made ? { location: `/api/v1/recipes/${encodeURIComponent(name)}` } : {}) }, body: this.shown(name, kept) };
  }

  /** @param {string} name @param {any} document @param {any} request @param {string} who @returns {Answer} */
  start(name, document, request, who) {
    /** @type {Record<string, any>} */
    const given = Object.fromEntries(Object.entries(document.parameters ?? {}).map(([k, p]) => [k, request.arguments?.[k] ?? /** @type {any} */ (p).default]));
    const missing = Object.keys(given).filter((k) => given[k] === undefined);
    if (missing.length > 0) throw new Refusal(422, 'invalid', `the argument ${missing[0]} is missing`);
    /** @param {any} j @returns {any} */
    const filled = (j) => {
      if (typeof j === 'string') return /^\$\{[\w.-]+\}$/.test(j) ? given[j.slice(2, -1)] : j.replace(/\$\{([\w.-]+)\}/g, (_, k) => String(given[k]));
      if (Array.isArray(j)) return j.map(filled);
      return j && typeof j === 'object' ? Object.fromEntries(Object.entries(j).map(([k, v]) => [k, filled(v)])) : j;
    };
    const steps = filled(document.steps);
    const flat = this.flat(steps, '/steps');
    const axes = [...new Set(flat.filter(({ step }) => ['enable', 'disable', 'home', 'command', 'action'].includes(kindOf(step))).map(({ step }) => String(step[kindOf(step)].axis)))];
    for (const a of axes) this.world.axisOf(a);
    if (request.dry_run) return { body: { dry_run: true, steps: flat.length, arguments: given, axes } };
    const now = this.running(name);
    if (now) throw new Refusal(409, 'running', `recipe ${name} is running already (run ${now.report.n}): wait for its end, or cancel it`);
    const runs = this.runs.get(name) ?? [];
    /** @type {RecipeReport} */
    const report = {
      recipe: name, n: (runs[0]?.report.n ?? 0) + 1, state: 'running', started_at: this.world.now(), ended_at: null, started_by: who, arguments: /** @type {any} */ (given), axes, at_step: null, begun: 0, of: flat.length, text: '', stops: [],
      steps: flat.map(({ pointer, step }) => ({ pointer, step: kindOf(step), axis: step[kindOf(step)]?.axis ?? step[kindOf(step)]?.condition?.axis ?? null, state: 'not_run', times: 0, started_at: null, ended_at: null, text: '', value: null, ...(step.comment ? { comment: step.comment } : {}) })),
    };
    const run = { report, work: this.carryOut(report, steps, '/steps'), wait: null };
    this.runs.set(name, [run, ...runs].slice(0, mostRuns));
    this.goOn(run);
    return { status: 202, body: report };
  }

  /** Yields what it waits for: true when it holds, a text when it never will. @param {RecipeReport} report @param {any[]} steps @param {string} at @returns {Generator<() => boolean | string, void>} */
  *carryOut(report, steps, at) {
    for (const [i, step] of steps.entries()) {
      const pointer = `${at}/${i}`;
      const row = report.steps.find((s) => s.pointer === pointer);
      if (!row) continue;
      if (row.times === 0) report.begun += 1;
      Object.assign(row, { state: 'running', times: row.times + 1, started_at: this.world.now() });
      report.at_step = pointer;
      yield* this.one(report, row, step, pointer);
      Object.assign(row, { state: 'done', ended_at: this.world.now() });
    }
  }

  /** @param {RecipeReport} report @param {RecipeReport['steps'][number]} row @param {any} step @param {string} at @returns {Generator<() => boolean | string, void>} */
  *one(report, row, step, at) {
    const kind = kindOf(step);
    const b = step[kind];
    const within = (/** @type {number} */ seconds, /** @type {() => boolean} */ holds, /** @type {string} */ words) => {
      const end = this.now_ms + seconds * 1000;
      return () => holds() || (this.now_ms > end ? `${words} within ${seconds} s` : false);
    };
    const say = (/** @type {any} */ command) => {
      const why = this.say(b.axis, command);
      if (why) throw new Error(why);
    };
    if (kind === 'message') row.text = String(b);
    else if (kind === 'wait_s') {
      const end = this.now_ms + Number(b) * 1000;
      yield () => this.now_ms >= end;
    } else if (kind === 'enable' || kind === 'disable' || kind === 'home' || kind === 'command') {
      const { axis, wait_s, command = kind, ...more } = b;
      say({ command, ...more });
      if (wait_s) yield within(Number(wait_s), () => !this.world.axis(axis).moving && this.world.axisOf(axis).motion === 'none', 'it was not done');
    } else if (kind === 'set_parameter') this.world.axisOf(b.axis).write(b.parameter, b.value, report.started_by);
    else if (kind === 'read_parameter') row.value = this.world.axisOf(b.axis).read(b.parameter).value;
    else if (kind === 'wait_for') yield within(Number(b.timeout_s ?? 30), () => this.holds(row, b), 'the condition did not hold');
    else if (kind === 'check') {
      if (!this.holds(row, b)) throw new Error(b.text || `${b.axis} ${b.point ?? b.parameter} is ${String(row.value)}`);
    } else if (kind === 'if') {
      const list = this.holds(row, b.condition) ? 'then' : 'else';
      row.text = list;
      yield* this.carryOut(report, b[list] ?? [], `${at}/if/${list}`);
    } else if (kind === 'repeat') {
      for (let i = 0; i < Number(b.times); i += 1) {
        yield* this.carryOut(report, b.steps ?? [], `${at}/repeat/steps`);
        if (b.until && this.holds(row, b.until)) break;
      }
    }
  }

  /** @param {{value?: any}} row @param {any} c */
  holds(row, c) {
    const axis = this.world.axis(c.axis);
    const value = c.parameter ? this.world.axisOf(c.axis).read(c.parameter).value : c.point === 'error_code' ? axis.error.code : /** @type {any} */ (axis)[c.point];
    row.value = value;
    const near = (/** @type {any} */ x) => value === x || (typeof value === 'number' && Math.abs(value - Number(x)) <= Number(c.tolerance ?? 0));
    if ('is' in c) return near(c.is);
    if ('is_not' in c) return !near(c.is_not);
    if ('at_least' in c) return value >= c.at_least;
    if ('at_most' in c) return value <= c.at_most;
    return 'above' in c ? value > c.above : value < c.below;
  }
}
