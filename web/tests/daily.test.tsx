// @vitest-environment happy-dom
// What a shift sees and presses all day: what is wrong, filters, the stops, jog, roles, the hand of a twin: the whole page over the mock door.
// Each case is one that would mislead somebody at a machine if it went wrong.
import { afterEach, beforeEach, describe, expect, it, vi } from 'vitest';
import { MockDoor } from '../dev/mock/door.mjs';
import { axesFilter, axisMatches } from '../src/state/axes-filter';
import { persisted } from '../src/state/persisted';
import { axis } from './fixtures';
import { openPage, type MockPage } from './mock-page';

let p: MockPage;
let door: MockDoor;
beforeEach(() => {
  door = new MockDoor();
  axesFilter.value = '';
  persisted('axes.view').value = '';
});
afterEach(() => {
  p.close();
  vi.restoreAllMocks();
});
const open = async (path = '/') => {
  p = await openPage(path, { door });
  return p;
};
const asked = (method: string, path: string | RegExp) => p.wire.asked.filter((a) => a.startsWith(`${method} `) && (typeof path === 'string' ? a === `${method} ${path}` : path.test(a)));
const tell = (name: string, change: object) => p.gateway.store.take({ topic: `axes/${name}`, at: Date.now() * 1e6, data: { ...door.axis(name), ...change } });
const off = { online: false, presence: 'offline', simulated: false };
const count = (selector: string) => p.root.querySelectorAll(selector).length;

describe('an axis that is offline while its drive answers', () => {
  beforeEach(async () => {
    await open();
    await p.see('[data-axis=gantry-y]', 'gantry-y');
    tell('gantry-y', off);
  });
  it('stands under what is wrong with a link, and its tile gives its own reason', async () => {
    await p.see('[data-wrong="offline gantry-y"]', /^Axis offline ?gantry-y ?the drive answers, this axis does not$/);
    expect(p.root.querySelector('[data-wrong="offline gantry-y"]')?.getAttribute('href')).toBe('/axes/gantry-y');
    await p.see('[data-axis=gantry-y] [data-field=notice]', /^Offline: the drive answers, this axis does not$/);
    expect(p.text('[data-axis=gantry-y] [data-field=notice]')).not.toContain('embedded model');
    p.gateway.store.alarms.value = { unacknowledged: 1, dropped: 0, alarms: [{ id: 1, axis: 'gantry-y', drive: 'gantry', line: null, active: true, since: '2026-01-02T03:04:05Z', text: 'the encoder is gone' }] } as never;
    await p.see('[data-axis=gantry-y] [data-field=notice]', 'Offline: the encoder is gone');
  });
  it('is found from the count in the strip; the filter is said, and taken away by one press', async () => {
    await p.see('[data-field=strip]', '1 offline');
    const link = [...p.root.querySelectorAll<HTMLAnchorElement>('.strip a')].find((a) => a.textContent?.includes('offline'))!;
    link.click();
    await p.see('[data-field=filtered]', '1 of 6 axes shown, filter: offline');
    expect(count('.tile')).toBe(1);
    tell('gantry-x', off);
    await p.see('[data-field=filtered]', '2 of 6 axes shown');
    await p.press('Show all');
    await vi.waitFor(() => expect(count('.tile')).toBe(6));
    expect(count('[data-field=filtered]')).toBe(0);
  });
});

it('the events page says that all is acknowledged only while it is told so', async () => {
  await open('/events');
  p.gateway.store.alarms.value = { unacknowledged: 0, dropped: 0, alarms: [] } as never;
  await vi.waitFor(() => expect(p.root.textContent).toContain('No alarm. Everything that was is acknowledged.'));
  p.gateway.store.connection.value = { ...p.gateway.store.connection.value, phase: 'waiting' };
  await vi.waitFor(() => expect(p.root.textContent).toContain('Not connected: what is wrong now is not known.'));
  expect(p.root.textContent).not.toContain('Everything that was is acknowledged');
});

it('more than there is room for under what is wrong is shown by a press', async () => {
  const site = structuredClone(door.world.site);
  for (let i = 0; i < 15; i += 1) {
    site.drives.push({ name: `d${i}`, line: 'can0', address: 20 + i, presence: 'device' });
    site.axes.push({ name: `a-rather-long-name-of-an-axis-${i}`, drive: `d${i}`, number: 10 + i });
  }
  door = new MockDoor({ site });
  await open();
  await p.see('[data-field=wrong-more]', 'and 3 more');
  expect(count('[data-wrong]')).toBe(12);
  await p.press('and 3 more');
  await vi.waitFor(() => expect(count('[data-wrong]')).toBe(15));
  // So many axes stand in rows, whole names and a stop each, until somebody wants tiles.
  expect([count('.axis-row'), count('.tile')]).toEqual([21, 0]);
  expect(p.button('Stop a-rather-long-name-of-an-axis-14')).toBeDefined();
  await p.press('List');
  await vi.waitFor(() => expect([count('.axis-row'), count('.tile')]).toEqual([0, 21]));
});

it('the filter knows what an axis does', () => {
  const matching = (text: string) => [axis({ name: 'a', moving: true, velocity: 1 }), axis({ name: 'b', fault: true, state: 'fault' }), axis({ name: 'c', online: false, moving: true, simulated: false, presence: 'offline' }), axis({ name: 'd', simulated: false, presence: 'device' })].filter((a) => axisMatches(a, a.online ? 'live' : 'offline', text)).map((a) => a.name);
  expect([matching('moving'), matching('fault'), matching('in fault'), matching('Offline '), matching('simulated'), matching('real'), matching('enabled')]).toEqual([['a'], ['b'], ['b'], ['c'], ['a', 'b'], ['d'], ['a', 'd']]);
});

describe('while nobody is signed in', () => {
  beforeEach(async () => {
    door = new MockDoor({ localRole: null });
    await open();
  });
  it('the stop is barred in sight, with the reason and what to press instead; Escape pretends nothing', async () => {
    await p.see('[data-field=stop-barred]', 'Nobody is signed in here: the gateway refuses a stop from this page. Use the machine’s own emergency stop.');
    expect(p.button('No stop from hereEsc').disabled).toBe(true);
    dispatchEvent(new KeyboardEvent('keydown', { key: 'Escape' }));
    await p.see('[data-field=strip]', 'NOT stopped.');
    expect(p.text('[data-field=strip]')).not.toContain('no axis to stop');
    expect(asked('POST', /commands/)).toEqual([]);
  });
});

describe('a role', () => {
  it('a viewer stops and halts, but does not switch off', async () => {
    door = new MockDoor({ localRole: 'viewer' });
    await open();
    await vi.waitFor(() => expect(p.button('Disable feeder').title).toBe('This needs the role operator. Yours is viewer.'));
    expect([p.button('Disable feeder'), p.button('Halt feeder'), p.button('Stop feeder')].map((b) => b.disabled)).toEqual([true, false, false]);
    p.go('/axes/feeder');
    await vi.waitFor(() => expect([p.button('Disable'), p.button('Halt'), p.button('Quick stop')].map((b) => b.disabled)).toEqual([true, false, false]));
  });
  it('of a user is chosen, then saved; until then it is the old one', async () => {
    door = new MockDoor({ localRole: 'administrator' });
    await open('/users');
    for (const name of ['anna', 'vera']) expect(p.other('POST', '/users', { name, role: name === 'anna' ? 'administrator' : 'viewer', password: 'a long enough phrase' }).status).toBeLessThan(300);
    p.go('/gateway');
    await p.see('main', 'Users and tokens');
    expect(p.root.querySelector('main a[href="/users"]')?.textContent).toBe('Users and tokens');
    p.go('/users');
    await p.see('[data-user=vera]', 'vera');
    const choice = p.field('Role of vera');
    choice.value = 'engineer';
    choice.dispatchEvent(new Event('change', { bubbles: true }));
    await p.see('[data-user=vera]', 'still viewer');
    expect(asked('PATCH', /users/)).toEqual([]);
    await p.press('Save the role of vera: engineer in place of viewer');
    await p.see('[data-field=users-told]', 'Role of vera: engineer: done.');
    expect(asked('PATCH', '/users/vera')).toHaveLength(1);
    expect(p.text('[data-user=vera]')).not.toContain('still');
  });
  it('nobody has an account: said, with the way to the first', async () => {
    await open('/users');
    await p.see('[data-field=no-account]', /^Nobody has an account yet\. The gateway printed a one-time sign-in code on its standard output at its first start/);
  });
});

it('a filter of the events that hides all says so, with how many there are, and is cleared', async () => {
  // More than the page has of its own.
  while (door.world.events.length < 300) door.world.event('info', 'input', { axis: 'feeder' }, 'something');
  persisted('events.text').value = 'no such words';
  persisted('events.severity').value = 'alarm';
  await open('/events');
  await p.see('[data-field=filtered]', 'No event matches the filter; 300 in all.');
  await p.press('Clear the filter');
  await vi.waitFor(() => expect(count('.event')).toBe(300));
  expect(count('[data-field=filtered]')).toBe(0);
});

it('a value that the twin refuses stays in its field, with the reason beside it, until one is taken', async () => {
  await open('/axes/feeder/simulation');
  await p.see('[data-hand=temperature]', 'Temperature');
  const set = vi.spyOn(p.gateway.client, 'setHand').mockRejectedValueOnce(new (await import('../src/api/problem')).Problem('answered', 'temperature goes from -40 to 150', 422));
  p.type(p.field('Temperature'), '999');
  await p.press('Set Temperature of the twin');
  await p.see('[data-hand=temperature] [data-field=hand-wrong]', 'Temperature goes from -40 to 150');
  expect(p.field('Temperature').value).toBe('999');
  expect(p.field('Temperature').getAttribute('aria-invalid')).toBe('true');
  p.type(p.field('Temperature'), '40');
  await p.press('Set Temperature of the twin');
  await vi.waitFor(() => expect(count('[data-field=hand-wrong]')).toBe(0));
  expect(set).toHaveBeenCalledTimes(2);
  expect(p.field('Temperature').value).toBe('40');
});

describe('jog', () => {
  const pointer = (type: string, x: number, y: number, pointerId = 1) => new PointerEvent(type, { button: 0, bubbles: true, pointerId, clientX: x, clientY: y });
  const held = async () => {
    await open();
    await p.see('[data-axis=feeder] [data-field=position]', 'Position:');
    const b = p.button('Jog feeder forward while held');
    b.getBoundingClientRect = () => ({ left: 100, right: 200, top: 100, bottom: 140 }) as DOMRect;
    return b;
  };
  const halts = (command: { mock: { calls: unknown[][] } }) => command.mock.calls.filter((c) => (c[1] as { command: string }).command === 'halt').length;
  it('ends when the finger slides off the button, and does not begin anew when it comes back', async () => {
    const b = await held();
    const command = vi.spyOn(p.gateway.client, 'command').mockResolvedValue({ result: 'accepted', reason: '', text: '' } as never);
    b.dispatchEvent(pointer('pointerdown', 150, 120));
    await p.drawn();
    b.dispatchEvent(pointer('pointermove', 208, 145)); // not still, but on it
    b.dispatchEvent(pointer('pointermove', 400, 400, 2)); // another finger
    expect([halts(command), b.classList.contains('is-held')]).toEqual([0, true]);
    b.dispatchEvent(pointer('pointermove', 213, 120));
    expect([halts(command), b.classList.contains('is-held')]).toEqual([1, false]);
    b.dispatchEvent(pointer('pointermove', 150, 120));
    b.dispatchEvent(pointer('pointerup', 150, 120));
    await p.drawn();
    expect(command.mock.calls.filter((c) => (c[1] as { command: string }).command === 'move_velocity')).toHaveLength(1);
  });
  it('is over, and nothing green is left, as soon as the gateway is silent; values are not live', async () => {
    const b = await held();
    vi.spyOn(p.gateway.client, 'command').mockImplementation(async (_a, c) => (c.command === 'halt' ? new Promise(() => undefined) : ({ result: 'accepted', reason: '', text: '' } as never)));
    b.dispatchEvent(pointer('pointerdown', 150, 120));
    await p.see('#result-feeder', 'accepted');
    p.gateway.commander.tell('turntable', 'good', 'Move to 5 deg: accepted');
    await p.see('#result-turntable', 'accepted');
    (p.gateway.stream as unknown as { tell: (s: object) => void }).tell({ phase: 'silent', why: 'the gateway has fallen silent' });
    await p.see('#result-feeder', 'Jog: ended, the connection to the gateway is lost.');
    expect(count('.result-good')).toBe(0);
    await p.see('[data-field=strip]', 'No answer from the gateway.');
    expect(p.text('[data-field=connection]')).toBe('No answer');
    expect(count('[data-live=true]')).toBe(0);
  });
});

it('the Modbus door says where its rules are set, and that a stop passes a read-only door', async () => {
  await open('/gateway');
  await p.see('[data-field=modbus-where]', /TOML file, section \[modbus\]: bind, allow, functions/);
  await p.press('Make it read-only');
  await p.see('[data-field=modbus-writing]', 'no write is taken but a quick stop or switching off by the control word alone');
});

it('an event names what it is about once', async () => {
  door.world.event('warning', 'drive', { drive: 'drive' }, 'drive drive is silent: no answer');
  await open('/events');
  await p.see('.event', /drive is silent: no answer/);
  expect(p.text('.event')).not.toContain('drive drive');
});
