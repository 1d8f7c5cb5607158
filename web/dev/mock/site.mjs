// Mock of the site: the document, its history, and the stage: staged, applied on trial, kept or rolled back. In: requests. Out: documents of the HTTP
// door, and its refusals in the order in which the program makes them: another client's stage, another revision, faults, a stage that is another one.
// A stand-in for the page's author: the checks of a document are the few that the page shows.
import { Refusal } from './world.mjs';

/** @typedef {import('./configure.mjs').Ask} Ask */
/** @typedef {import('./configure.mjs').Answer} Answer */
/** @typedef {{id: string, state: 'staged' | 'applied', document: any, by: string, stager: string, applier: string, staged_at: string, base: number, confirm_by: number}} Staged */

/** "local 127.0.0.1" of "local 127.0.0.1:50012": another connection is the same person. @param {string} who */
const identityOf = (who) => who.replace(/:\d+$/, '');

export class SiteDesk {
  /** @param {import('./world.mjs').World} world */
  constructor(world) {
    this.world = world;
    /** @type {Staged | null} */
    this.stage = null;
    /** @type {any} */
    this.previous = null;
    /** @type {any[]} */
    this.history = [];
    this.serial = 0;
  }

  changed() {
    this.world.revision += 1;
    for (const l of this.world.siteListeners) l();
  }
  get tag() {
    return `"${this.world.revision}"`;
  }

  /** Another revision than the one that is meant. @param {{match: string}} ask */
  precondition({ match }) {
    if (match && match !== this.tag) throw new Refusal(412, 'precondition_failed', `the site has the revision ${this.tag} by now, not ${match}: read it again`, { current: this.world.site }, { etag: this.tag });
  }

  /** What changes the site otherwise than by its stage asks here first. @param {{match: string}} ask */
  mayChange(ask) {
    this.look();
    if (this.stage?.state === 'applied') throw new Refusal(409, 'conflict', 'a staged site is on trial: confirm it or roll it back before the site is changed otherwise');
    this.precondition(ask);
  }

  /** @param {Ask} ask @returns {Answer} */
  answer(ask) {
    const { method, parts, q, text, who } = ask;
    const site = this.world.site;
    const [, what, third, fourth] = parts;
    this.look();
    if (!what && method === 'GET') return { head: { etag: this.tag }, body: site };
    if (!what && method === 'PUT') {
      this.mayChange(ask);
      const next = JSON.parse(text);
      const faults = this.faults(next);
      const dry = q.get('dry_run') === '1';
      if (!dry && faults.length > 0) throw new Refusal(422, 'invalid', faults[0].text, { faults });
      const differences = differ(site, next).map((d) => `${d.what} ${d.kind}`);
      if (!dry) this.apply(next, who);
      return { head: { etag: this.tag }, body: { dry_run: dry, valid: faults.length === 0, revision: this.world.revision, differences, faults } };
    }
    if (what === 'history') {
      const before = Number(q.get('before') ?? 0) || Infinity;
      if (!third) return { body: this.history.filter((h) => h.revision < before).slice(0, Number(q.get('limit') ?? 100)).map(({ revision, at, who: w, bytes }) => ({ revision, at, who: w, bytes })) };
      const h = this.history.find((x) => String(x.revision) === third);
      if (!h) throw new Refusal(404, 'not_found', `there is no revision ${third}`);
      return fourth === 'restore' ? this.setStage(h.document, ask) : { body: h.document };
    }
    if (what !== 'stage') throw new Refusal(404, 'not_found', 'there is no such thing');
    if (!third && method === 'GET') return this.told();
    if (!third && method === 'POST') return this.setStage(JSON.parse(text), ask);
    if (!third && method === 'DELETE') {
      if (this.stage?.state === 'applied') throw new Refusal(409, 'conflict', `the site that ${this.stage.by} applied is on trial: roll it back instead`);
      this.stage = null;
      return { status: 204 };
    }
    if (third === 'apply') return this.applyStage(text ? JSON.parse(text) : {}, ask);
    const stage = this.stage;
    if (stage?.state !== 'applied') throw new Refusal(409, 'conflict', `no applied site waits to be confirmed${third === 'roll-back' ? ': there is nothing to roll back' : ''}`);
    const own = identityOf(who) === stage.by && stage.applier === (ask.client ?? '');
    if (third === 'confirm' && !own && ask.role !== 'administrator') throw new Refusal(409, 'conflict', `only ${stage.by}${stage.applier ? ` (client ${stage.applier})` : ''}, who applied the site, can confirm it, or an administrator`);
    if (third === 'roll-back') this.apply(this.previous, who);
    this.stage = null;
    return this.told();
  }

  /** The stage as it is now. @returns {Answer} */
  told() {
    const s = this.stage;
    const diff = s?.state === 'staged' ? differ(this.world.site, s.document) : [];
    const none = { state: 'none', id: null, by: null, client: null, staged_at: null, base_revision: null };
    const some = s && { state: s.state, id: s.id, by: s.by, client: (s.applier || s.stager) || null, staged_at: s.staged_at, base_revision: s.base };
    return {
      head: { etag: this.tag },
      body: { ...none, ...some, revision: this.world.revision, faults: [], diff, disturbs: diff.filter((d) => d.kind !== 'added' && d.what.startsWith('axes/')).map((d) => d.what.slice(5)), closes: [], confirm_by: s?.confirm_by ? new Date(s.confirm_by / 1e6).toISOString() : null },
    };
  }

  /** @param {any} document @param {Ask} ask @returns {Answer} */
  setStage(document, ask) {
    const { q, who, client = '' } = ask;
    const s = this.stage;
    if (s?.state === 'staged' && s.stager !== client && !['1', 'true'].includes(q.get('replace') ?? '')) {
      const stager = `${s.by}${s.stager ? ` (client ${s.stager})` : ''} at ${s.staged_at}`;
      throw new Refusal(409, 'stage_taken', `${stager} has staged a site that is not applied yet: wait for it, or replace it with ?replace=true`, { stage: s.id });
    }
    this.precondition(ask);
    const faults = this.faults(document);
    if (faults.length > 0) throw new Refusal(422, 'invalid', faults[0].text, { faults });
    if (s?.state === 'applied') throw new Refusal(409, 'conflict', `a site that ${s.by} applied is on trial: confirm it or roll it back first`);
    this.stage = { id: `mock-${(this.serial += 1)}`, state: 'staged', document, by: identityOf(who), stager: client, applier: '', staged_at: this.world.now(), base: this.world.revision, confirm_by: 0 };
    return this.told();
  }

  /** @param {{confirm_within_s?: number, stage?: string}} body @param {Ask} ask @returns {Answer} */
  applyStage(body, ask) {
    const s = this.stage;
    const within = body.confirm_within_s ?? 60;
    if (within !== 0 && !(within >= 5 && within <= 600)) throw new Refusal(422, 'invalid', 'confirm_within_s must be 0 or 5 to 600', { faults: [{ document: 'body', pointer: '/confirm_within_s', text: 'confirm_within_s must be 0 or 5 to 600', remedy: '0: for good, without a roll back' }] });
    this.precondition(ask);
    if (body.stage !== undefined && body.stage !== s?.id) {
      const words = s ? `the staged site is another than ${body.stage}: ${s.by} staged it; nothing was applied, look at it first` : `${body.stage} is not staged any more: it was applied or discarded; nothing was applied`;
      throw new Refusal(409, 'stage_replaced', words, { stage: s?.id ?? null });
    }
    if (!s) throw new Refusal(409, 'conflict', 'nothing is staged: stage a site first');
    if (s.state === 'applied') throw new Refusal(409, 'conflict', `the site that ${s.by} applied is on trial already: confirm it or roll it back first`);
    if (s.base !== this.world.revision) throw new Refusal(409, 'conflict', `the site has changed since this was staged: it is revision ${this.world.revision} now, not ${s.base}; stage it again`);
    this.previous = structuredClone(this.world.site);
    this.apply(s.document, ask.who);
    this.stage = within === 0 ? null : { ...s, state: 'applied', by: identityOf(ask.who), applier: ask.client ?? '', confirm_by: (Date.now() + within * 1000) * 1e6 };
    return this.told();
  }

  /** Takes back what nobody has kept in time. */
  look() {
    if (this.stage?.state === 'applied' && Date.now() * 1e6 > this.stage.confirm_by) {
      this.stage = null;
      this.apply(this.previous, 'the gateway');
      this.world.event('warning', 'site', {}, 'the site was rolled back: nobody confirmed it in time');
    }
  }

  /** @param {any} d */
  faults(d) {
    /** @type {any[]} */
    const faults = [];
    const f = (/** @type {string} */ pointer, /** @type {string} */ text, /** @type {string} */ remedy) => faults.push({ document: 'body', pointer, text, remedy });
    for (const [i, l] of (d.lines ?? []).entries()) if (!l.uri) f(`/lines/${i}/uri`, 'uri is missing', 'write "uri": "twin"');
    for (const [i, r] of (d.drives ?? []).entries()) if (!(d.lines ?? []).some((/** @type {any} */ l) => l.name === r.line)) f(`/drives/${i}/line`, `there is no line ${r.line}`, 'name a line of the site');
    for (const [i, a] of (d.axes ?? []).entries()) {
      if (!(d.drives ?? []).some((/** @type {any} */ r) => r.name === a.drive)) f(`/axes/${i}/drive`, `there is no drive ${a.drive}`, 'name a drive of the site');
      if (d.axes.findIndex((/** @type {any} */ o) => o.number === a.number) !== i) f(`/axes/${i}/number`, `number ${a.number} is taken`, 'choose another number');
    }
    return faults;
  }
  /** @param {any} next @param {string} who */
  apply(next, who) {
    const text = JSON.stringify(this.world.site);
    this.history.unshift({ revision: this.world.revision, at: new Date().toISOString(), who, bytes: text.length, document: JSON.parse(text) });
    this.world.reload(structuredClone(next));
    this.changed();
  }
}

/** @param {any} a @param {any} b */
function differ(a, b) {
  /** @type {{kind: string, what: string, before: any, after: any}[]} */
  const diff = [];
  for (const room of ['lines', 'drives', 'axes', 'mappings']) {
    const key = room === 'mappings' ? 'id' : 'name';
    const before = new Map((a[room] ?? []).map((/** @type {any} */ x) => [x[key], x]));
    const after = new Map((b[room] ?? []).map((/** @type {any} */ x) => [x[key], x]));
    for (const [n, x] of after) {
      if (!before.has(n)) diff.push({ kind: 'added', what: `${room}/${n}`, before: null, after: x });
      else if (JSON.stringify(before.get(n)) !== JSON.stringify(x)) diff.push({ kind: 'changed', what: `${room}/${n}`, before: before.get(n), after: x });
    }
    for (const [n, x] of before) if (!after.has(n)) diff.push({ kind: 'removed', what: `${room}/${n}`, before: x, after: null });
  }
  return diff;
}
