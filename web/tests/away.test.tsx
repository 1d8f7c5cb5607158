// @vitest-environment happy-dom
// A part that is opened while the gateway is away says why there is nothing, and loads by itself when the connection is back: the whole page over the
// mock door. Lists that others change follow without a word from this page.
import { afterEach, beforeEach, describe, expect, it, vi } from 'vitest';
import { openPage, soon, type MockPage } from './mock-page';

let p: MockPage;
/** First as it ended, then as the next attempt found it. */
const away = /Not connected: the gateway (has stopped|cannot be reached)\. This is loaded by itself when the gateway is back\./;
beforeEach(async () => {
  p = await openPage('/');
  await p.see('[data-axis=feeder]', 'feeder');
  for (const [method, path, body] of [['PUT', '/recipes/r', { steps: [{ wait_s: 1 }] }], ['POST', '/mappings', { unit: 2, address: 0, axis: 'feeder', point: 'position', type: 'i32' }], ['POST', '/axes/feeder/snapshots', { name: 'first' }]] as const) {
    expect(p.other(method, path, body).status).toBe(201);
  }
});
afterEach(() => {
  p.close();
  vi.useRealTimers();
});
const leave = async () => {
  p.wire.goAway();
  await p.see('[data-field=connection]', 'Not connected');
};
const comeBack = async () => {
  p.wire.away = false;
  p.gateway.stream.retryNow();
  await p.see('[data-field=connection]', 'Live');
};

describe('opened while the gateway is away', () => {
  it.each([
    ['/mappings', '.register-grid', '[data-mapping=m1]', 'feeder'],
    ['/mappings', '[data-field=lists]', '[data-field=lists]', 'Register list, CSV'],
    ['/site', 'main', '[data-entry="axes/feeder"]', 'feeder'],
    ['/recipes', 'main', '[data-recipe=r]', '1 steps'],
    ['/recipes/r', 'main', '[data-step="/steps/0"]', 'Step 1'],
    ['/axes/feeder/parameters', 'main', '[data-snapshot]', 'first'],
    ['/users', 'main', '.access-list', 'There are no tokens.'],
    ['/gateway', '[data-field=modbus-door]', '[data-field=modbus-door]', '127.0.0.1:1502'],
  ])('%s says in %s why, and has %s afterwards', async (path, where, there, text) => {
    await leave();
    const before = p.wire.asked.length;
    p.go(path);
    await p.see(where, away);
    expect(p.text(there)).not.toContain(text);
    expect(p.wire.asked.slice(before).filter((a) => !/\/session$|parameters/.test(a))).toEqual([]); // nothing is asked of nobody
    await comeBack();
    await p.see(there, text);
    expect(p.text('main')).not.toContain('Not connected:');
  });
  it('a site has its history afterwards, too', async () => {
    expect(p.other('PUT', '/site', { ...p.door.world.site, axes: p.door.world.site.axes.slice(1) }).status).toBe(200);
    await leave();
    p.go('/site');
    await p.see('main', away);
    await comeBack();
    await p.see('[data-field=history]', 'Revision');
  });
  it('what is there already stays, and is not asked for twice over what is typed', async () => {
    p.go('/recipes/r');
    const json = await soon(() => p.field('The recipe as JSON'));
    p.type(json, '{"steps":[{"wait_s":2}]}');
    await leave();
    expect(p.text('main')).not.toContain('Not connected:');
    p.other('PUT', '/recipes/r', { steps: [{ wait_s: 9 }] });
    await comeBack();
    await soon(() => expect(p.wire.asked.at(-1)).toBeDefined());
    expect(p.field('The recipe as JSON').value).toBe('{"steps":[{"wait_s":2}]}');
    await p.press('Save');
    await p.see('[data-field=recipe-clash]', '/steps/0/wait_s: 9 → 2');
  });
});

it('what nobody answered is asked again while the connection lives; what was refused keeps its words', async () => {
  vi.useFakeTimers({ toFake: ['setTimeout', 'clearTimeout'] });
  const asks = () => p.wire.asked.filter((a) => a === 'GET /mappings').length;
  const fetch = vi.spyOn(p.door, 'answer').mockImplementation(() => ({ status: 503, head: { 'content-type': 'application/problem+json' }, text: '{"detail":"the store is shut"}' }));
  p.go('/mappings');
  await soon(() => expect(p.text('.register-grid')).toContain('The store is shut'));
  expect(asks()).toBe(1);
  fetch.mockRestore();
  await vi.advanceTimersByTimeAsync(2000);
  await soon(() => expect(p.text('[data-mapping=m1]')).toContain('feeder'));
  expect(asks()).toBe(2);
  vi.spyOn(p.door, 'answer').mockImplementation(() => ({ status: 404, head: { 'content-type': 'application/problem+json' }, text: '{"detail":"there is nothing"}' }));
  p.go('/recipes');
  await soon(() => expect(p.text('main')).toContain('There is nothing'));
  const n = p.wire.asked.filter((a) => a === 'GET /recipes').length;
  await vi.advanceTimersByTimeAsync(60_000);
  expect(p.wire.asked.filter((a) => a === 'GET /recipes').length).toBe(n);
});

describe('the list of recipes', () => {
  it('follows what anybody makes, changes and deletes, and what happened while it was away', async () => {
    p.go('/recipes');
    await p.see('[data-recipe=r]', '1 steps');
    p.other('PUT', '/recipes/s', { steps: [{ wait_s: 1 }, { wait_s: 2 }] });
    await p.see('[data-recipe=s]', '2 steps');
    p.other('PUT', '/recipes/s', { steps: [{ wait_s: 1 }, { wait_s: 2 }, { wait_s: 3 }] });
    await p.see('[data-recipe=s]', '3 steps');
    p.other('DELETE', '/recipes/r');
    await soon(() => expect(p.text('[data-recipe=r]')).toBe(''));
    await leave();
    p.other('DELETE', '/recipes/s');
    p.other('PUT', '/recipes/t', { steps: [{ wait_s: 1 }] });
    expect(p.text('[data-recipe=s]')).toContain('3 steps');
    await comeBack();
    await p.see('[data-recipe=t]', '1 steps');
    expect(p.text('[data-recipe=s]')).toBe('');
  });
  it('has what this page has saved and deleted itself', async () => {
    p.go('/recipes/mine');
    p.type(await soon(() => p.field('The recipe as JSON')), '{"steps":[{"wait_s":2}]}');
    await p.press('Save');
    await p.see('.result', 'Saved.');
    p.go('/recipes');
    await p.see('[data-recipe=mine]', '1 steps');
    p.go('/recipes/mine');
    await p.see('[data-step="/steps/0"]', 'Step 1');
    await p.press('Delete mine');
    await p.press('Delete');
    await p.see('[data-recipe=r]', '1 steps');
    expect(p.text('[data-recipe=mine]')).toBe('');
  });
});

it('a run that ended while the page was away is told by its report', async () => {
  p.go('/recipes/r');
  await p.see('[data-step="/steps/0"]', 'Step 1');
  await p.press('Run');
  await p.see('[data-field=run-state]', 'Running');
  await p.see('.recipe-run .result', 'Run 1 has begun.');
  await leave();
  p.door.step(0.01, 10);
  p.door.recipes.step(60_000);
  expect(p.text('[data-field=run-state]')).toContain('Running');
  await comeBack();
  await p.see('[data-field=run-state]', 'Done');
  expect(p.text('.recipe-run .result')).toBe('');
});

it('a scan that ran on while the gateway was away is told to its end', async () => {
  p.go('/lines/bench');
  await p.press('Look for drives');
  await p.see('[data-field=scan]', 'asked, running');
  const scan = p.door.configuration.scans.get('bench');
  scan.begun = Date.now() + 60_000; // it takes as long as the test wants
  await leave();
  const asked = () => p.wire.asked.filter((a) => a === 'GET /lines/bench/scan').length;
  const before = asked();
  await soon(() => expect(asked()).toBeGreaterThan(before)); // and nobody answered
  await comeBack();
  scan.begun = 0;
  await soon(() => expect(p.text('[data-field=scan]')).toContain('asked, done'));
});
