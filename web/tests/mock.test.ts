// The mock gateway's own parts, as far as the page's author relies on them: roles and sessions, who holds an axis, alarms, recipes, a scan.
import { readFileSync } from 'node:fs';
import { beforeEach, describe, expect, it } from 'vitest';
import { Access, needed } from '../dev/mock/access.mjs';
import { Alarms } from '../dev/mock/alarms.mjs';
import { Configuration } from '../dev/mock/configure.mjs';
import { MockDoor } from '../dev/mock/door.mjs';
import { Recipes } from '../dev/mock/recipes.mjs';
import { Refusal, World } from '../dev/mock/world.mjs';

const ask = (method: string, path: string, body?: unknown, more: { who?: string; client?: string } = {}) => {
  const url = new URL(path, 'http://mock/');
  return { method, parts: url.pathname.split('/').slice(1), q: url.searchParams, text: body === undefined ? '' : JSON.stringify(body), who: 'anna', match: '', ...more };
};
const refusal = (act: () => unknown): number => {
  try {
    act();
  } catch (error) {
    if (error instanceof Refusal) return error.status;
    throw error;
  }
  return 0;
};

describe('access', () => {
  const password = 'a long enough phrase';
  let access: InstanceType<typeof Access>;
  beforeEach(() => (access = new Access(null)));
  const signIn = (user: string) => {
    const a = access.answer(ask('POST', '/session', { user, password }), access.identify({}))!;
    return { ...access.identify({ cookie: a.head!['set-cookie']!.split(';')[0] }), body: a.body };
  };
  it('knows nobody, makes the first administrator by the code alone, and never a second one', () => {
    expect(access.info(access.identify({}))).toMatchObject({ role: null, via: 'none', first_sign_in: true });
    expect(refusal(() => access.answer(ask('POST', '/session/first', { code: 'x', user: 'anna', password }), access.identify({})))).toBe(401);
    access.answer(ask('POST', '/session/first', { code: access.code, user: 'anna', password }), access.identify({}));
    expect(refusal(() => access.answer(ask('POST', '/session/first', { code: access.code, user: 'eve', password }), access.identify({})))).toBe(409);
    expect(signIn('anna')).toMatchObject({ user: 'anna', role: 'administrator', via: 'cookie' });
  });
  it.each([
    ['GET', '/site', {}, 'viewer'], ['PUT', '/site', {}, 'engineer'], ['GET', '/backup', {}, 'administrator'], ['POST', '/axes/a/commands', { command: 'enable' }, 'operator'],
    ['POST', '/axes/a/commands', { command: 'halt' }, 'viewer'], ['PUT', '/axes/a/authority', { take_over: true }, 'engineer'], ['POST', '/alarms/1/shelve', {}, 'operator'], ['POST', '/recipes/r/run', {}, 'operator'],
    ['PUT', '/recipes/r', {}, 'engineer'], ['GET', '/users', {}, 'administrator'], ['POST', '/session', {}, null],
  ])('%s %s with %j needs %s', (method, path, body, role) => expect(needed(method, ask(method, path).parts, body)).toBe(role));
  it('refuses by role, by a missing CSRF token, and takes what is allowed', () => {
    access.answer(ask('POST', '/session/first', { code: access.code, user: 'anna', password }), access.identify({}));
    access.answer(ask('POST', '/users', { name: 'vera', role: 'viewer', password }), signIn('anna'));
    const vera = signIn('vera');
    expect(refusal(() => access.check(vera, 'GET', ['site'], {}, ''))).toBe(0);
    expect(refusal(() => access.check(vera, 'PUT', ['site'], {}, String(vera.csrf)))).toBe(403);
    expect(refusal(() => access.check(vera, 'POST', ['axes', 'a', 'commands'], { command: 'halt' }, ''))).toBe(403);
    expect(refusal(() => access.check(vera, 'POST', ['axes', 'a', 'commands'], { command: 'halt' }, String(vera.csrf)))).toBe(0);
    expect(refusal(() => access.check(access.identify({}), 'GET', ['site'], {}, ''))).toBe(401);
    expect(refusal(() => access.answer(ask('DELETE', '/users/anna'), signIn('anna')))).toBe(409); // the last one
  });
  it('lets one hold an axis: others are refused, stops pass, a taker-over takes', () => {
    const put = (client: string, body: object) => access.answer(ask('PUT', '/axes/feeder/authority', body, { client }), access.identify({}));
    put('local page-a', { ttl_s: 30 });
    expect(access.withHolder({ name: 'feeder' })).toMatchObject({ authority_holder: 'local page-a' });
    expect(refusal(() => put('local page-b', { ttl_s: 30 }))).toBe(409);
    expect(refusal(() => access.mayCommand('feeder', 'local page-b', { command: 'enable' }))).toBe(409);
    expect(refusal(() => access.mayCommand('feeder', 'local page-b', { command: 'quick_stop' }))).toBe(0);
    put('local page-b', { ttl_s: 30, take_over: true });
    expect(refusal(() => access.mayCommand('feeder', 'local page-b', { command: 'enable' }))).toBe(0);
  });
});

describe('alarms', () => {
  it('come, are acknowledged, clear and leave; one on the shelf does not count', () => {
    const world = new World();
    const alarms = new Alarms(world);
    const axis = world.axisOf('gantry-x');
    world.setHand('gantry', { inject_error: 8 });
    world.step(0.01);
    expect(alarms.document()).toMatchObject({ unacknowledged: 2, alarms: [{ state: 'unacknowledged_active', code: 8 }, {}] });
    const [a, b] = alarms.list;
    alarms.answer(ask('POST', `/alarms/${a!.id}/shelve`, { for_s: 60, reason: 'known' }));
    expect(alarms.document().unacknowledged).toBe(1);
    alarms.answer(ask('POST', `/alarms/${a!.id}/unshelve`));
    expect(alarms.answer(ask('POST', '/alarms/acknowledge', { ids: [a!.id, b!.id], comment: 'seen' }))!.body).toEqual({ acknowledged: 2 });
    expect(a).toMatchObject({ state: 'acknowledged_active', acknowledged_by: 'anna', comment: 'seen' });
    world.setHand('gantry', { inject_error: 0 });
    for (const x of axis.drive.axes) x.faultCode = 0;
    alarms.look();
    expect(alarms.document()).toMatchObject({ unacknowledged: 0, alarms: [] });
    expect(refusal(() => alarms.answer(ask('POST', '/alarms/99/acknowledge')))).toBe(404);
  });
});

describe('recipes', () => {
  let world: World;
  let recipes: InstanceType<typeof Recipes>;
  let now = 0;
  const go = (seconds: number) => {
    for (let i = 0; i < seconds * 100; i += 1) {
      world.step(0.01);
      recipes.step((now += 10));
    }
  };
  const document = {
    parameters: { far: { type: 'number', default: 5 } },
    steps: [
      { enable: { axis: 'gantry-x' } },
      { repeat: { times: 2, steps: [{ command: { axis: 'gantry-x', command: 'move_relative', position: '${far}', velocity: 50, wait_s: 20 } }] } },
      { if: { condition: { axis: 'gantry-x', point: 'fault', is: false }, then: [{ message: 'moved ${far}' }], else: [] } },
      { check: { axis: 'gantry-x', point: 'position', is: 10, tolerance: 0.1 } },
    ],
  };
  beforeEach(() => {
    world = new World();
    recipes = new Recipes(world);
  });
  it('are kept, listed, run step by step, and report', () => {
    expect(recipes.answer(ask('PUT', '/recipes/r', document))!.status).toBe(201);
    expect(recipes.answer(ask('GET', '/recipes'))!.body).toMatchObject([{ name: 'r', steps: 6, running: null }]);
    const reported: string[] = [];
    recipes.listeners.push((r) => reported.push(`${r.state} ${r.at_step}`));
    expect(recipes.answer(ask('POST', '/recipes/r/run', {}))!.status).toBe(202);
    expect(refusal(() => recipes.answer(ask('POST', '/recipes/r/run', {})))).toBe(409);
    go(5);
    const r = recipes.answer(ask('GET', '/recipes/r/runs/1'))!.body;
    expect([r.state, r.text]).toEqual(['done', '']);
    expect(r.steps.map((s: { state: string; times: number }) => `${s.state} ${s.times}`)).toEqual(['done 1', 'done 1', 'done 2', 'done 1', 'done 1', 'done 1']);
    expect(r.steps[4].text).toBe('moved 5');
    expect(reported.at(-1)).toBe('done null');
  });
  it('fail in words, are cancelled with their axes stopped, and are checked before they are kept', () => {
    recipes.answer(ask('PUT', '/recipes/r', document));
    recipes.answer(ask('POST', '/recipes/r/run', { arguments: { far: 7 } }));
    go(5);
    expect(recipes.answer(ask('GET', '/recipes/r/runs'))!.body[0]).toMatchObject({ state: 'failed', text: 'gantry-x position is 14', stops: [{ axis: 'gantry-x', stopped: true }] });
    recipes.answer(ask('PUT', '/recipes/w', { steps: [{ wait_s: 600 }] }));
    recipes.answer(ask('POST', '/recipes/w/run', {}));
    expect(recipes.answer(ask('POST', '/recipes/w/runs/1/cancel'))!.body).toMatchObject({ state: 'cancelled', steps: [{ state: 'cancelled' }] });
    expect(refusal(() => recipes.answer(ask('PUT', '/recipes/x', { steps: [] })))).toBe(422);
    expect(refusal(() => recipes.answer(ask('PUT', '/recipes/x', { steps: [{ check: { axis: 'gantry-x', point: 'colour', is: 1 } }] })))).toBe(422);
    expect(refusal(() => recipes.answer(ask('PUT', '/recipes/x', { parameters: { p: { type: 'number', default: 9, max: 5 } }, steps: [{ wait_s: 1 }] })))).toBe(422);
  });
});

describe('a scan', () => {
  it('was never, runs, is ended by hand, refuses a range the wrong way round', () => {
    const configuration = new Configuration(new World());
    const scan = (method: string, body?: unknown) => configuration.answer(ask(method, '/lines/bench/scan', body))!.body;
    expect(scan('GET')).toMatchObject({ state: 'none', of: 0, found: [] });
    expect(scan('POST', { from: '1', to: '4' })).toMatchObject({ state: 'running', of: 4 });
    expect(scan('DELETE')).toMatchObject({ state: 'cancelled' });
    expect(refusal(() => scan('POST', { from: 5, to: 4 }))).toBe(422);
  });
});

describe('the door', () => {
  let door: MockDoor;
  beforeEach(() => void (door = new MockDoor()));
  const say = (client: string, method: string, target: string, body?: unknown, head: Record<string, string> = {}) => {
    const a = door.answer({ method, target: `/api/v1${target}`, head: { 'x-client': client, ...head }, text: body === undefined ? '' : JSON.stringify(body), peer: '127.0.0.1:50001' });
    return { status: a.status, head: a.head, body: a.text ? JSON.parse(a.text) : null };
  };
  const without = (axis: string) => ({ ...door.world.site, axes: door.world.site.axes.filter((a) => a.name !== axis) });

  it('tells a stage as the description of the HTTP door has it, staged and applied', () => {
    const reported = /^ {4}Stage:\n.*\n {6}required: \[(.*)\]/m.exec(readFileSync(new URL('../../schema/openapi.yaml', import.meta.url), 'utf8'))?.[1]?.split(', ').sort();
    expect(reported?.length).toBeGreaterThan(5);
    const none = say('a', 'GET', '/site/stage');
    const one = say('a', 'POST', '/site/stage', without('gantry-y'));
    const applied = say('a', 'POST', '/site/stage/apply', { confirm_within_s: 60, stage: one.body.id });
    for (const r of [none, one, applied]) expect(Object.keys(r.body).sort()).toEqual(reported);
    expect([none, one, applied].map((r) => [r.body.state, r.body.client, r.body.diff.length, r.body.confirm_by === null])).toEqual([['none', null, 0, true], ['staged', '127.0.0.1 a', 1, true], ['applied', '127.0.0.1 a', 0, false]]);
    expect(applied.head.etag).toBe('"2"');
  });
  it('lets no client replace or apply what it has not seen', () => {
    const one = say('a', 'POST', '/site/stage', without('gantry-y')).body.id;
    const taken = say('b', 'POST', '/site/stage', without('lift'));
    expect([taken.status, taken.body.reason, taken.body.stage]).toEqual([409, 'stage_taken', one]);
    const two = say('b', 'POST', '/site/stage?replace=true', without('lift')).body.id;
    const replaced = say('a', 'POST', '/site/stage/apply', { stage: one });
    expect([replaced.status, replaced.body.reason, replaced.body.stage]).toEqual([409, 'stage_replaced', two]);
    say('b', 'DELETE', '/site/stage');
    expect(say('a', 'POST', '/site/stage/apply', { stage: two }).body).toMatchObject({ status: 409, reason: 'stage_replaced', stage: null });
    expect(door.world.site.axes).toHaveLength(6);
    const late = say('a', 'POST', '/site/stage', without('lift'), { 'if-match': '"9"' });
    expect([late.status, late.body.reason, late.head.etag, late.body.current.axes.length]).toEqual([412, 'precondition_failed', '"1"', 6]);
    expect(say('a', 'POST', '/site/stage', { ...door.world.site, drives: [] })).toMatchObject({ status: 422, body: { reason: 'invalid' } });
  });
  it('names the states of a recipe, and refuses another one than was meant', () => {
    const steps = (n: number) => ({ steps: [{ wait_s: n }] });
    const made = say('a', 'PUT', '/recipes/r', steps(1), { 'if-none-match': '*' });
    expect([made.status, made.head.location, made.body.name]).toEqual([201, '/api/v1/recipes/r', 'r']);
    expect(say('a', 'GET', '/recipes').body[0].etag).toBe(made.head.etag);
    expect(say('a', 'GET', '/recipes/r').head.etag).toBe(made.head.etag);
    const again = say('b', 'PUT', '/recipes/r', steps(2), { 'if-none-match': '*' });
    expect([again.status, again.body.reason, again.body.etag, again.body.current.steps]).toEqual([412, 'precondition_failed', made.head.etag, steps(1).steps]);
    const next = say('b', 'PUT', '/recipes/r', steps(2), { 'if-match': made.head.etag! });
    expect([next.status, next.head.etag === made.head.etag]).toEqual([200, false]);
    for (const [method, body, query] of [['PUT', steps(3), ''], ['PUT', steps(3), '?dry_run=1'], ['DELETE', undefined, '']] as const) expect(say('a', method, `/recipes/r${query}`, body, { 'if-match': made.head.etag! }).status).toBe(412);
    expect(say('a', 'DELETE', '/recipes/r', undefined, { 'if-match': next.head.etag! }).status).toBe(204);
    expect(say('a', 'PUT', '/recipes/r', steps(3), { 'if-match': next.head.etag! })).toMatchObject({ status: 412, body: { etag: null, current: null } });
  });
  it('tells the end of a session once, and takes the cookie away', () => {
    const first = say('a', 'POST', '/session/first', { code: door.access.code, user: 'anna', password: 'a long enough phrase' });
    const cookie = first.head['set-cookie']!.split(';')[0]!;
    expect(say('a', 'GET', '/axes', undefined, { cookie }).status).toBe(200);
    door.access.sessions.clear();
    const refused = say('a', 'GET', '/axes', undefined, { cookie });
    expect([refused.status, refused.body.reason, refused.head['set-cookie']]).toEqual([401, 'session_ended', expect.stringContaining('Max-Age=0')]);
    expect(say('a', 'GET', '/session', undefined, { cookie })).toMatchObject({ status: 200, body: { role: null, via: 'none', ended: expect.stringContaining('this session has ended') } });
    expect([door.serves({ cookie }), door.serves({})]).toEqual([false, true]);
    expect(say('a', 'GET', '/session').body).toMatchObject({ role: 'engineer', via: 'local', ended: null });
  });
});
