// Mock of who may do what: local access, sign-in by name and password, tokens, roles, and who holds an axis. In: requests. Out: documents of the
// HTTP door and its refusals. A stand-in for the page's author: passwords are kept as they are, nothing is kept over a restart.
import { Refusal } from './world.mjs';

/** @typedef {import('../../src/api/types').Role} Role */
/** @typedef {import('../../src/api/types').SessionInfo} SessionInfo */
/** @typedef {{user: string | null, role: Role | null, via: SessionInfo['via'], csrf: string | null, cookie?: string, ended?: boolean}} Identity */
/** @typedef {import('./configure.mjs').Ask} Ask */
/** @typedef {import('./configure.mjs').Answer} Answer */

/** @type {Role[]} */
export const roles = ['viewer', 'operator', 'engineer', 'administrator'];
const mostSessions = 100;
const endedText = 'this session has ended: it was signed out, has expired, or the gateway was restarted; sign in again, or go on without a sign-in';
/** The browser forgets the session. */
const noCookie = { 'set-cookie': 'axisgate_session=; Path=/; Max-Age=0' };
const random = () => Math.random().toString(36).slice(2, 12);

/** The least role for a request; null: anybody. @param {string} method @param {string[]} parts @param {any} body @returns {Role | null} */
export function needed(method, parts, body) {
  const [kind, , what] = parts;
  if (kind === 'session') return null;
  if (kind === 'backup') return 'administrator';
  if (kind === 'users') return what === 'password' ? 'viewer' : 'administrator';
  if (kind === 'tokens' || method === 'GET') return 'viewer';
  if (kind === 'axes' && what === 'commands') return ['halt', 'quick_stop', 'disable'].includes(body?.command) ? 'viewer' : 'operator';
  if (kind === 'axes' && what === 'authority') return body?.take_over ? 'engineer' : 'operator';
  if (kind === 'alarms' || (kind === 'recipes' && (what === 'run' || what === 'runs' || what === 'rehearsal'))) return 'operator';
  return 'engineer';
}

export class Access {
  /** @param {Role | null} localRole what somebody on this machine may do without a sign-in */
  constructor(localRole = 'engineer') {
    this.localRole = localRole;
    this.code = 'MOCK-CODE';
    /** @type {Map<string, {name: string, role: Role, enabled: boolean, created_at: string, last_sign_in_at: string | null, password: string}>} */
    this.users = new Map();
    /** @type {Map<string, {user: string, csrf: string}>} */
    this.sessions = new Map();
    /** @type {any[]} */
    this.tokens = [];
    /** @type {Map<string, {holder: string, until: number, since: number}>} */
    this.held = new Map();
  }

  /** @param {Record<string, string | string[] | undefined>} head @returns {Identity} */
  identify(head) {
    const nobody = { user: null, role: null, via: /** @type {const} */ ('none'), csrf: null };
    const cookie = /axisgate_session=([^;]+)/.exec(String(head.cookie ?? ''))?.[1];
    const session = cookie === undefined ? undefined : this.sessions.get(cookie);
    const user = session && this.users.get(session.user);
    if (cookie !== undefined && session && user?.enabled) return { user: user.name, role: user.role, via: 'cookie', csrf: session.csrf, cookie };
    if (head.authorization !== undefined) {
      const token = this.tokens.find((t) => `Bearer ${t.token}` === head.authorization);
      return token ? { user: token.owner, role: token.role, via: 'token', csrf: null } : nobody;
    }
    // Who was signed in does not become this machine by the end of the session.
    if (cookie !== undefined) return { ...nobody, ended: true };
    return this.localRole ? { user: null, role: this.localRole, via: 'local', csrf: null } : { user: null, role: null, via: 'none', csrf: null };
  }

  /** @param {Identity} who @param {string} method @param {string[]} parts @param {any} body @param {string} csrf */
  check(who, method, parts, body, csrf) {
    const least = needed(method, parts, body);
    if (least && who.ended) throw new Refusal(401, 'session_ended', endedText, {}, noCookie);
    if (least && !who.role) throw new Refusal(401, 'sign_in', `sign in first: this needs the role ${least}`);
    if (least && who.role && roles.indexOf(who.role) < roles.indexOf(least)) throw new Refusal(403, 'role', `this needs the role ${least}, yours is ${who.role}`);
    if (who.via === 'cookie' && method !== 'GET' && parts[0] !== 'session' && csrf !== who.csrf) throw new Refusal(403, 'csrf', 'the header X-CSRF-Token is missing or wrong');
  }

  /** @param {Ask} ask @param {Identity} who @returns {Answer | null} null: not one of these */
  answer(ask, who) {
    const [kind, name, what] = ask.parts;
    if (kind === 'session') return this.session(ask, who);
    if (kind === 'users') return this.user(ask, who);
    if (kind === 'tokens') return this.token(ask, who);
    if (kind === 'axes' && name && what === 'authority') return this.authority(ask, name);
    return null;
  }

  /** @param {Identity} who @returns {SessionInfo} */
  info = (who) => ({ user: who.user, role: who.role, via: who.via, csrf: who.csrf, expires_at: null, ended: who.ended ? endedText : null, first_sign_in: this.users.size === 0, roles });

  /** @param {Ask} ask @param {Identity} who @returns {Answer} */
  session({ method, parts, text }, who) {
    if (method === 'GET') return { head: who.ended ? noCookie : {}, body: this.info(who) };
    if (method === 'DELETE') {
      this.sessions.delete(who.cookie ?? '');
      return { status: 204, head: noCookie };
    }
    const b = JSON.parse(text);
    if (parts[1] === 'first') {
      if (this.users.size > 0) throw new Refusal(409, 'conflict', 'there are users already: sign in');
      if (b.code !== this.code) throw new Refusal(401, 'wrong_sign_in', 'the code is wrong: it was printed when the gateway started for the first time');
      this.add({ name: b.user, role: 'administrator', password: b.password });
    }
    const user = this.users.get(b.user);
    if (!user || user.password !== b.password || !user.enabled) throw new Refusal(401, 'wrong_sign_in', 'the user or the password is wrong');
    user.last_sign_in_at = new Date().toISOString();
    const [cookie, csrf] = [random(), random()];
    this.sessions.set(cookie, { user: user.name, csrf });
    const oldest = this.sessions.keys().next().value;
    if (this.sessions.size > mostSessions && oldest !== undefined) this.sessions.delete(oldest);
    return { status: parts[1] === 'first' ? 201 : 200, head: { 'set-cookie': `axisgate_session=${cookie}; Path=/; HttpOnly; SameSite=Strict` }, body: this.info({ user: user.name, role: user.role, via: 'cookie', csrf }) };
  }

  /** @param {{name: string, role: Role, password: string}} u */
  add(u) {
    if (this.users.has(u.name)) throw new Refusal(409, 'conflict', `there is a user ${u.name} already`);
    if (String(u.password).length < 12) throw new Refusal(422, 'invalid', 'a password has at least 12 characters');
    this.users.set(u.name, { ...u, enabled: true, created_at: new Date().toISOString(), last_sign_in_at: null });
  }

  /** @param {Ask} ask @param {Identity} who @returns {Answer} */
  user({ method, parts, text }, who) {
    const shown = (/** @type {any} */ { password: _, ...u }) => u;
    const name = parts[1];
    if (!name && method === 'GET') return { body: [...this.users.values()].map(shown) };
    if (!name) {
      const b = JSON.parse(text);
      this.add(b);
      return { status: 201, body: shown(this.users.get(b.name)) };
    }
    const user = this.users.get(name);
    if (!user) throw new Refusal(404, 'not_found', `there is no user ${name}`);
    if (parts[2] === 'password') {
      const b = JSON.parse(text);
      if (who.user !== name || b.old !== user.password) throw new Refusal(403, 'role', 'the old password is wrong');
      user.password = b.new;
      for (const [cookie, s] of this.sessions) if (s.user === name) this.sessions.delete(cookie);
      return { status: 204 };
    }
    const last = user.role === 'administrator' && [...this.users.values()].filter((u) => u.role === 'administrator' && u.enabled).length === 1;
    if (method === 'DELETE') {
      if (last) throw new Refusal(409, 'conflict', `${name} is the last administrator`);
      this.users.delete(name);
      return { status: 204 };
    }
    if (method === 'PATCH') {
      const b = JSON.parse(text);
      if (last && ((b.role && b.role !== 'administrator') || b.enabled === false)) throw new Refusal(409, 'conflict', `${name} is the last administrator`);
      Object.assign(user, b);
    }
    return { body: shown(user) };
  }

  /** @param {Ask} ask @param {Identity} who @returns {Answer} */
  token({ method, parts, text }, who) {
    const mine = this.tokens.filter((t) => who.role === 'administrator' || t.owner === who.user);
    const shown = (/** @type {any} */ { token: _, ...t }) => t;
    if (method === 'GET') return { body: mine.map(shown) };
    if (method === 'DELETE') {
      if (!mine.some((t) => t.id === parts[1])) throw new Refusal(404, 'not_found', `there is no token ${parts[1]}`);
      this.tokens = this.tokens.filter((t) => t.id !== parts[1]);
      return { status: 204 };
    }
    if (who.via !== 'cookie') throw new Refusal(403, 'role', 'a token belongs to a user: sign in with a password');
    const b = JSON.parse(text);
    const expires_at = b.expires_in_s ? new Date(Date.now() + b.expires_in_s * 1000).toISOString() : null;
    const made = { id: random(), name: b.name, role: b.role, owner: who.user, created_at: new Date().toISOString(), expires_at, last_used_at: null, token: `agt_${random()}${random()}` };
    this.tokens.push(made);
    return { status: 201, body: made };
  }

  /** @param {string} axis @returns {{holder: string, until: number, since: number} | null} */
  holderOf(axis) {
    const h = this.held.get(axis);
    if (h && h.until > Date.now()) return h;
    this.held.delete(axis);
    return null;
  }

  /** Who holds the axis, beside what the axis itself says. @template {{name: string}} T @param {T} document */
  withHolder(document) {
    const h = this.holderOf(document.name);
    return { ...document, authority_holder: h?.holder ?? '', authority_until: h ? new Date(h.until).toISOString() : null };
  }

  /** Stops pass; everything else asks who holds the axis. @param {string} axis @param {string} client @param {any} command */
  mayCommand(axis, client, command) {
    const h = this.holderOf(axis);
    if (h && h.holder !== client && !['halt', 'quick_stop', 'disable'].includes(command?.command)) throw new Refusal(409, 'authority', `axis ${axis} is held by ${h.holder}`, { result: 'refused', command: command?.command });
  }

  /** @param {Ask} ask @param {string} axis @returns {Answer} */
  authority({ method, text, client = '' }, axis) {
    const h = this.holderOf(axis);
    if (method === 'PUT') {
      const b = text ? JSON.parse(text) : {};
      if (h && h.holder !== client && !b.take_over) throw new Refusal(409, 'authority', `axis ${axis} is held by ${h.holder}`);
      this.held.set(axis, { holder: client, until: Date.now() + (b.ttl_s ?? 30) * 1000, since: Date.now() });
    }
    if (method === 'DELETE') {
      if (h && h.holder !== client) throw new Refusal(409, 'authority', `axis ${axis} is held by ${h.holder}`);
      this.held.delete(axis);
      return { status: 204 };
    }
    const now = this.holderOf(axis);
    return { body: { axis, door: now ? 'http' : 'none', holder: now?.holder ?? '', mode: now ? 'lease' : 'free', expires_in_s: now ? (now.until - Date.now()) / 1000 : null, since: now ? new Date(now.since).toISOString() : null, last_commander: '' } };
  }
}
