// @vitest-environment happy-dom
// The components over a store that is fed by hand: what a person sees of an axis, and what the page does with what is typed.
import './all-pages';
import { render } from 'preact';
import { afterEach, beforeEach, describe, expect, it, vi } from 'vitest';
import type { Client } from '../src/api/client';
import { Problem } from '../src/api/problem';
import type { StreamState } from '../src/api/stream';
import type { Drive } from '../src/api/types';
import { App } from '../src/app';
import { Gateway, GatewayProvider } from '../src/gateway';
import { route } from '../src/router';
import { draftOf } from '../src/state/site-draft';
import { Store } from '../src/state/store';
import { axis, event, world } from './fixtures';

const live = (epoch = 1): StreamState => ({ phase: 'live', epoch, lastLiveAt: 1, retryAt: 0, attempts: 0, why: '' });
let root: HTMLElement;
let gateway: Gateway;
let client: Record<string, ReturnType<typeof vi.fn>>;
const tell = (change: object = {}, at_ms = 1000) => gateway.store.take({ topic: 'axes/feeder', at: at_ms * 1e6, data: axis({ name: 'feeder', number: 1, ...change }) });
const tick = () => new Promise((r) => setTimeout(r, 40));
const text = (selector: string) => root.querySelector(selector)?.textContent?.replace(/\s+/g, ' ').trim() ?? '';
const button = (name: string) => [...root.querySelectorAll('button')].find((b) => (b.getAttribute('aria-label') ?? b.textContent ?? '').trim() === name) as HTMLButtonElement;
const field = (name: string) => root.querySelector<HTMLInputElement>(`input[aria-label="${name}"]`) as HTMLInputElement;
const type = (input: HTMLInputElement, value: string) => {
  input.value = value;
  input.dispatchEvent(new Event('input', { bubbles: true }));
};

beforeEach(async () => {
  sessionStorage.clear();
  route.value = { page: 'overview' };
  root = document.createElement('div');
  document.body.append(root);
  client = { command: vi.fn(() => new Promise(() => undefined)), dropWaitingCommands: vi.fn(), parameters: vi.fn(async () => []), whole: vi.fn(async () => { throw new Problem('answered', 'the store is shut', 503); }), call: vi.fn(async () => { throw new Problem('answered', 'there is nothing', 404); }), hand: vi.fn(async () => []), events: vi.fn(async () => []), modbus: vi.fn(async () => { throw new Problem('answered', 'there is nothing', 404); }), specimen: vi.fn(async () => ({ words: [] })) };
  gateway = new Gateway({ client: client as unknown as Client, store: new Store(), url: 'ws://nowhere/' });
  gateway.store.setConnection(live());
  gateway.store.setLists({ axes: [axis({ name: 'feeder', number: 1 })], drives: [world().driveOf('feeder').document() as Drive], lines: [] }, 1);
  tell({ position: 100 });
  render(<GatewayProvider value={gateway}><App /></GatewayProvider>, root);
  await tick();
});
afterEach(() => {
  render(null, root);
  root.remove();
});

describe('tile', () => {
  it('shows name, mark, position with unit, state and motion in words', () => {
    expect(text('[data-axis=feeder] h3')).toBe('feeder');
    expect(text('[data-axis=feeder] [data-field=mark]')).toBe('SIMULATED');
    expect(text('[data-axis=feeder] [data-field=position]')).toBe('Position: 100.000mm');
    expect(text('[data-axis=feeder] [data-field=state]')).toContain('Enabled');
    expect(text('[data-axis=feeder] [data-field=motion]')).toContain('At rest');
  });
  it('follows the stream', async () => {
    tell({ position: 123.4567, velocity: 50, moving: true }, 1100);
    await tick();
    expect(text('[data-field=position]')).toContain('123.457');
    expect(text('[data-field=motion]')).toContain('Moving');
    expect(text('[data-field=strip]')).toContain('1 moving');
  });
  it('never shows an old value as live', async () => {
    gateway.store.setConnection({ ...live(), phase: 'waiting', retryAt: 1e9, why: 'the gateway has stopped' });
    await tick();
    expect(text('[data-field=position]')).toContain('Last known position, not live');
    expect(root.querySelector('[data-field=position]')?.getAttribute('data-live')).toBe('false');
    expect(text('[data-field=state]')).toContain('Was enabled');
    expect(text('[data-field=notice]')).toMatch(/^Not live: last known .* ago$/);
    expect(text('[data-field=strip]')).toContain('Connection lost.');
    expect(text('[data-field=connection]')).toBe('Not connected');
    gateway.store.setConnection(live(2));
    await tick();
    expect(text('[data-field=position]')).toContain('Last known'); // connected again, but nothing was heard of this axis yet
    tell({ position: 5 }, 2000);
    await tick();
    expect(text('[data-field=position]')).toBe('Position: 5.000mm');
  });
  it('shows a fault with code and text', async () => {
    tell({ fault: true, state: 'fault', error: { code: 8, text: 'the motor is stalled' } }, 1100);
    await tick();
    expect(text('[data-axis=feeder] [data-field=notice]')).toBe('Fault 8: the motor is stalled');
    expect(root.querySelector('[data-axis=feeder]')?.getAttribute('data-condition')).toBe('fault');
  });
});

describe('controls', () => {
  it('send what is typed', () => {
    type(field('Target of feeder'), '12.5');
    type(field('Speed of feeder'), '30');
    button('Move to target of feeder').click();
    expect(client.command).toHaveBeenCalledWith('feeder', { command: 'move_absolute', position: 12.5, velocity: 30 }, false);
  });
  it('leave the speed to the drive when the field is empty', () => {
    type(field('Distance of feeder'), '-2');
    type(field('Speed of feeder'), '');
    button('Move by distance of feeder').click();
    expect(client.command).toHaveBeenCalledWith('feeder', { command: 'move_relative', position: -2 }, false);
  });
  it('keep what was typed when it is refused, and show the reason', async () => {
    client.command!.mockRejectedValueOnce(new Problem('answered', 'the axis is disabled: enable it first', 409, { reason: 'wrong_state', result: 'refused' }));
    type(field('Target of feeder'), '77');
    button('Move to target of feeder').click();
    await tick();
    expect(text('#result-feeder')).toBe('Move to 77 mm: refused. The axis is disabled: enable it first');
    expect(field('Target of feeder').value).toBe('77');
  });
  it('send nothing for what is no number, and mark the field', async () => {
    type(field('Target of feeder'), '1,5');
    button('Move to target of feeder').click();
    await tick();
    expect(client.command).not.toHaveBeenCalled();
    expect(field('Target of feeder').getAttribute('aria-invalid')).toBe('true');
    expect(text('#result-feeder')).toContain('decimal sign');
  });
  it('keep what is typed through a storm of readings', async () => {
    const f = field('Target of feeder');
    type(f, '4');
    for (let i = 0; i < 20; i += 1) tell({ position: i }, 1100 + i);
    await tick();
    expect(field('Target of feeder')).toBe(f);
    expect(f.value).toBe('4');
  });
  it('stop by button and by Escape, from inside a field too', () => {
    button('Stop feeder').click();
    expect(client.command).toHaveBeenLastCalledWith('feeder', { command: 'quick_stop' }, true);
    field('Target of feeder').dispatchEvent(new KeyboardEvent('keydown', { key: 'Escape', bubbles: true }));
    expect(client.command).toHaveBeenCalledTimes(2);
    field('Target of feeder').dispatchEvent(new KeyboardEvent('keydown', { key: 'Escape', bubbles: true, repeat: true }));
    expect(client.command).toHaveBeenCalledTimes(2); // a held key says it once
  });
  it('Escape takes back what is being typed first, and the button says so; what was sent or only stands there is not being typed', async () => {
    const f = field('Target of feeder');
    const escape = () => f.dispatchEvent(new KeyboardEvent('keydown', { key: 'Escape', bubbles: true }));
    const published = () => document.querySelector('.stop-all kbd')!.textContent;
    const stops = () => client.command!.mock.calls.filter((c) => (c[1] as { command: string }).command === 'quick_stop').length;
    f.focus();
    type(f, '12');
    await tick();
    expect(published()).toBe('Esc Esc');
    escape();
    await tick();
    expect([f.value, stops(), published()]).toEqual(['', 0, 'Esc']);
    escape();
    expect(stops()).toBe(1);
    type(f, '12');
    f.dispatchEvent(new KeyboardEvent('keydown', { key: 'Enter', bubbles: true }));
    escape();
    expect([f.value, stops()]).toEqual(['12', 2]);
    type(f, '13');
    f.blur();
    f.focus();
    escape();
    expect([f.value, stops()]).toEqual(['13', 3]);
  });
  it('jog only with a speed above zero', () => {
    type(field('Speed of feeder'), '0');
    button('Jog feeder forward while held').dispatchEvent(new PointerEvent('pointerdown', { button: 0, bubbles: true }));
    expect(client.command).not.toHaveBeenCalled();
    expect(gateway.commander.note('feeder').value.text).toContain('greater than 0');
  });
  it('jog while held, and halt when the pointer lets go or the window loses the keyboard', async () => {
    client.command!.mockImplementation(async () => ({ result: 'accepted', reason: '', text: '' }));
    type(field('Speed of feeder'), '3');
    const jog = button('Jog feeder backward while held');
    jog.dispatchEvent(new PointerEvent('pointerdown', { button: 0, bubbles: true }));
    expect(client.command).toHaveBeenLastCalledWith('feeder', { command: 'move_velocity', velocity: -3, hold_ms: 1000 }, false);
    await tick();
    jog.dispatchEvent(new PointerEvent('pointerup', { bubbles: true }));
    expect(client.command).toHaveBeenLastCalledWith('feeder', { command: 'halt' }, true);
    await tick();
    jog.dispatchEvent(new KeyboardEvent('keydown', { key: ' ', bubbles: true }));
    await tick();
    globalThis.dispatchEvent(new Event('blur'));
    expect(client.command).toHaveBeenCalledTimes(4);
    expect(client.command).toHaveBeenLastCalledWith('feeder', { command: 'halt' }, true);
  });
});

describe('a role', () => {
  const as = async (role: 'viewer' | 'operator' | 'engineer', user: string | null = 'vera') => {
    gateway.session.info.value = { user, role, via: user ? 'cookie' : 'local', csrf: null, expires_at: null, ended: null, first_sign_in: false, roles: ['viewer', 'operator', 'engineer', 'administrator'] };
    await tick();
  };
  it('that may not command sends nothing by Enter either, and is told why; its stops pass', async () => {
    await as('viewer');
    expect(button('Move to target of feeder').disabled).toBe(true);
    expect(button('Enable feeder').title).toBe('This needs the role operator. Yours is viewer.');
    expect(text('[data-field=barred]')).toContain('needs the role operator');
    type(field('Target of feeder'), '5');
    field('Target of feeder').dispatchEvent(new KeyboardEvent('keydown', { key: 'Enter', bubbles: true }));
    await tick();
    expect(client.command).not.toHaveBeenCalled();
    expect(text('#result-feeder')).toBe('Move to 5 mm: not sent. This needs the role operator. Yours is viewer.');
    button('Jog feeder forward while held').dispatchEvent(new PointerEvent('pointerdown', { button: 0, bubbles: true }));
    expect(client.command).not.toHaveBeenCalled();
    button('Halt feeder').click();
    expect(client.command).toHaveBeenCalledWith('feeder', { command: 'halt' }, true);
  });
  it('that may is not barred', async () => {
    await as('operator');
    expect(button('Move to target of feeder').disabled).toBe(false);
    expect(root.querySelector('[data-field=barred]')).toBeNull();
  });
  it('decides who can keep a site on trial: the one who applied it; anybody who may change it can take it back; all see it', async () => {
    const { draft } = draftOf(gateway.client);
    draft.stage.value = { state: 'applied', by: 'anna 10.0.0.7', confirm_by: new Date(gateway.store.gatewayNow_ms() + 42_000).toISOString() };
    await as('viewer');
    expect(text('[data-field=trial-rest]')).toMatch(/^Site on trial: 4[12] s$/);
    const buttons = () => [button('Keep the applied site'), button('Roll back the applied site')].map((b) => b.disabled);
    expect(buttons()).toEqual([true, true]);
    await as('engineer', 'anne');
    expect(buttons()).toEqual([true, false]);
    expect(button('Keep the applied site').title).toBe('Only anna, who applied it, can keep it.');
    await as('engineer', 'anna');
    expect(buttons()).toEqual([false, false]);
    draft.stage.value = { ...draft.stage.value, client: 'anna 10.0.0.7 page-000000' };
    await tick();
    expect(buttons()).toEqual([true, false]);
    expect(button('Keep the applied site').title).toBe('Only the page of anna that applied it can keep it; take it back and apply it from here if need be.');
    draft.stage.value = { ...draft.stage.value, client: `anna ${gateway.tab.name.value}` };
    await tick();
    expect(buttons()).toEqual([false, false]);
    route.value = { page: 'gateway' };
    await tick();
    expect(text('[data-field=trial-rest]')).toContain('Site on trial');
    draft.stage.value = { state: 'none' };
    await tick();
    expect(root.querySelector('[data-field=trial]')).toBeNull();
  });
});

describe('a gateway that has never had a site', () => {
  it('is told from one that has not answered yet: its revision is 0', async () => {
    for (const list of ['axes', 'drives', 'lines', 'events']) client[list] = vi.fn(async () => []);
    client.about = vi.fn(async () => ({ families: [], doors: [] }));
    vi.spyOn(gateway.stream, 'start').mockImplementation(() => undefined);
    gateway.start();
    await tick();
    expect(client.axes).not.toHaveBeenCalled();
    gateway.store.take({ topic: 'site', at: 1, data: { revision: 0 } });
    await vi.waitFor(() => expect(text('[data-field=no-axis]')).toContain('No axis is configured.'));
    expect(root.querySelector('[data-field=no-axis] a')?.getAttribute('href')).toBe('/site');
    gateway.session.info.value = { user: 'vera', role: 'viewer', via: 'cookie', csrf: null, expires_at: null, ended: null, first_sign_in: false, roles: [] };
    await tick();
    expect(text('[data-field=no-axis]')).toContain('needs the role engineer');
  });
});

describe('what is small', () => {
  it('a target is typed in decimal: 0x10 is refused in words, and nothing is sent', async () => {
    type(field('Target of feeder'), '0x10');
    button('Move to target of feeder').click();
    await tick();
    expect(text('.tile [id^=result]')).toContain('is a hexadecimal number');
    expect(client.command).not.toHaveBeenCalled();
    type(field('Target of feeder'), '');
  });
  it('the line under the name of an axis begins with its number, and is whole in its title', () => {
    expect(text('[data-axis=feeder] .tile-where')).toContain('no. 1 · ');
    expect(root.querySelector('[data-axis=feeder] .tile-where[title^=Axis]')?.getAttribute('title')).toMatch(/^Axis number 1, family .*, line .*, drive /);
  });
  it('what may be entered for the twin is text that can be unfolded, not only a tooltip', async () => {
    client.hand = vi.fn(async () => [{ name: 'inject_error', value: 0, writable: true, description: '0 or one of 2, 8, 11', options: [] }]);
    route.value = { page: 'axis', name: 'feeder', tab: 'simulation' };
    await vi.waitFor(() => expect(text('[data-hand=inject_error] details summary')).toBe('What may be entered: Inject error'));
    expect(text('[data-hand=inject_error] details')).toContain('0 or one of 2, 8, 11');
  });
  it('demand and following error say whose word they are while one of them is shown, and are never barred', async () => {
    route.value = { page: 'axis', name: 'feeder', tab: 'move' };
    tell({ position: 1 }, 5000);
    await vi.waitFor(() => expect(button('Following error')).toBeDefined());
    const line = () => text('[data-field=demand-source]');
    expect([button('Demand'), button('Following error')].map((b) => [b.disabled, b.getAttribute('aria-pressed')])).toEqual([[false, 'false'], [false, 'false']]);
    expect(line()).toBe('');
    button('Following error').click();
    await vi.waitFor(() => expect(line()).toMatch(/not known now. The axis is off/));
    for (const [demand_source, shown] of [['computed', /computed by the gateway from the order, not measured by the drive/], ['drive', /from the drive\.$/], ['open_loop', /nothing measures whether the shaft follows/]] as const) {
      tell({ position: 1, demand_known: true, demand_source, position_demand: 2, following_error: 1 });
      await vi.waitFor(() => expect(line()).toMatch(shown));
    }
    gateway.store.setConnection({ ...live(), phase: 'waiting', retryAt: 1e9, why: 'gone' });
    await vi.waitFor(() => expect(line()).toContain('not known now'));
    button('Following error').click();
    await vi.waitFor(() => expect(line()).toBe(''));
    const mode = root.querySelector<HTMLSelectElement>('.scope-trigger select')!;
    mode.value = 'single';
    mode.dispatchEvent(new Event('change', { bubbles: true }));
    await tick();
    const when = root.querySelectorAll<HTMLSelectElement>('.scope-trigger select')[1]!;
    expect([...when.options].map((o) => [o.value, o.disabled])).toEqual(['position', 'demand', 'velocity', 'error', 'target'].map((c) => [c, false]));
    when.value = 'error';
    when.dispatchEvent(new Event('change', { bubbles: true }));
    await vi.waitFor(() => expect(line()).toContain('not known now'));
  });
});

describe('what appears later', () => {
  it('is noticed by who asked for it before', async () => {
    route.value = { page: 'axis', name: 'later', tab: 'simulation' };
    await tick();
    expect(text('main')).toContain('There is no axis later.');
    gateway.store.take({ topic: 'axes/later', at: 2e9, data: axis({ name: 'later', number: 9, drive: 'late-drive', position: 1 }) });
    await tick();
    expect(text('main h1')).toBe('Simulation of later');
    expect(text('main')).toContain('not simulated now');
    gateway.store.take({ topic: 'drives/late-drive', at: 2e9, data: { ...world().driveOf('feeder').document(), name: 'late-drive' } });
    await tick();
    expect(text('main')).not.toContain('not simulated now');
  });
});

describe('alarms and pages', () => {
  it('speaks alarms, not infos', async () => {
    gateway.store.take({ topic: 'events', at: 1, data: event(1, { severity: 'info', text: 'nothing' }) });
    await tick();
    expect(text('[data-field=spoken]')).toBe('');
    gateway.store.take({ topic: 'events', at: 1, data: event(2, { severity: 'alarm', text: 'the motor is stalled' }) });
    await tick();
    expect(text('[data-field=spoken]')).toBe('Alarm. feeder: the motor is stalled');
  });
  it('says that a page or an axis is not there', async () => {
    route.value = { page: 'axis', name: 'nobody', tab: 'move' };
    await tick();
    expect(text('main')).toContain('There is no axis nobody.');
    route.value = { page: 'unknown', path: '/x' };
    await tick();
    expect(text('main')).toContain('names no page');
  });
  it('says what went wrong where a list should be, and what this gateway does not offer', async () => {
    route.value = { page: 'mappings' };
    await vi.waitFor(() => expect(text('main')).toContain('The store is shut'));
    route.value = { page: 'site' };
    await vi.waitFor(() => expect(text('main')).toMatch(/^Site.*The store is shut/));
    route.value = { page: 'parameters', name: 'feeder' };
    await vi.waitFor(() => expect(text('main')).toContain('This gateway does not offer snapshots.'));
  });
  it.each([{ page: 'axis', name: 'feeder', tab: 'move' }, { page: 'axis', name: 'feeder', tab: 'drive' }, { page: 'axis', name: 'feeder', tab: 'events' }, { page: 'lines' }, { page: 'line', name: 'can0' }, { page: 'events' }, { page: 'gateway' }, { page: 'mappings' }, { page: 'parameters', name: 'feeder' }, { page: 'site' }] as const)('draws %o with one heading', async (r) => {
    route.value = r;
    await vi.waitFor(() => expect(root.querySelectorAll('main h1')).toHaveLength(1)); // its code may have yet to come
  });
});
