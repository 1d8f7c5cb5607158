// @vitest-environment happy-dom
// Sentences that stand on the page under a condition only: the whole page over the mock door, brought into that condition.
// Each is looked for where it must stand, and looked for in vain while the condition does not hold.
import { afterEach, beforeEach, describe, expect, it, vi } from 'vitest';
import { MockDoor } from '../dev/mock/door.mjs';
import type { Role } from '../src/api/types';
import { persisted } from '../src/state/persisted';
import { openPage, soon, type MockPage } from './mock-page';

let p: MockPage;
let door: MockDoor;
beforeEach(() => void (door = new MockDoor()));
afterEach(() => {
  p.close();
  vi.restoreAllMocks();
});
const open = async (path: string) => (p = await openPage(path, { door }));
const say = (method: string, target: string, body?: unknown) => door.answer({ method, target: `/api/v1${target}`, head: {}, text: body === undefined ? '' : JSON.stringify(body), peer: '127.0.0.1:1' }).status;
/** A door that does not have what is below this path. */
const without = (path: string, status = 404) => {
  const answer = door.answer.bind(door);
  vi.spyOn(door, 'answer').mockImplementation((r) => (r.target.startsWith(`/api/v1${path}`) ? { status, head: { 'content-type': 'application/problem+json' }, text: JSON.stringify({ detail: `there is nothing at ${path}` }) } : answer(r)));
};

describe('events', () => {
  const many = (n: number) => {
    while (door.world.events.length < n) door.world.event(door.world.events.length % 2 ? 'warning' : 'info', 'input', { axis: 'feeder' }, `number ${door.world.events.length}`);
  };
  const files = () => {
    const saved: Blob[] = [];
    vi.spyOn(URL, 'createObjectURL').mockImplementation((b) => (saved.push(b as Blob), 'blob:x'));
    vi.spyOn(URL, 'revokeObjectURL').mockImplementation(() => undefined);
    return saved;
  };
  it('of which there are more than are shown say so, and how to reach further back; the file has exactly what is shown', async () => {
    persisted('events.text').value = '';
    many(1200);
    const saved = files();
    await open('/events');
    await p.see('[data-field=more-events]', /^There are more than 1000: these are the newest 1000\. Choose severity, axis or kind to reach further back, or ask the API for pages \(GET \/api\/v1\/events\?before=\)\.$/);
    await p.see('.event-files', 'Save 1000 as CSV');
    await p.press('Save 1000 as CSV');
    const rows = (await saved[0]!.text()).trim().split(/\r?\n/);
    expect([rows.length, rows[1]?.split(',')[0], rows.at(-1)?.split(',')[0]]).toEqual([1001, '201', '1200']);
    p.type(p.field('Text in the event'), 'number 1199');
    await p.see('[data-field=more-events]', 'these are what fits among the newest 1000');
    await p.press('Save 1 as CSV');
    expect((await saved[1]!.text()).trim().split(/\r?\n/)).toHaveLength(2);
    await p.press('Save 1 as text');
    expect(await saved[2]!.text()).toMatch(/^\S+ warning +input +feeder +number 1199\n$/);
    p.type(p.field('Text in the event'), '');
    p.type(p.field('Severity'), 'warning');
    await p.see('.event-files', 'Save 600 as CSV');
    expect(p.text('[data-field=more-events]')).toBe('');
    p.type(p.field('Severity'), 'info');
  });
  it('of which all are shown say nothing of more', async () => {
    many(999);
    await open('/events');
    await p.see('.event-files', 'Save 999 as text');
    expect(p.text('[data-field=more-events]')).toBe('');
  });
});

describe('a role that may not', () => {
  const as = async (role: Role, path: string) => {
    door = new MockDoor({ localRole: role });
    door.recipes.all.set('r', { document: { steps: [{ wait_s: 1 }] }, changed_at: door.world.now(), changed_by: 'anna' });
    door.world.setHand('gantry', { inject_error: 8 });
    door.world.step(0.01);
    await open(path);
  };
  it.each([
    ['viewer', '/', 'Every command but a stop needs the role operator. Yours is viewer.'],
    ['viewer', '/axes/feeder', 'Every command but a stop needs the role operator. Yours is viewer.'],
    ['operator', '/axes/feeder/parameters', 'Writing a parameter needs the role engineer. Yours is operator.'],
    ['operator', '/axes/feeder/drive', 'This needs the role engineer. Yours is operator.'],
    ['operator', '/axes/feeder/parameters', 'Saving, restoring and removing a snapshot needs the role engineer. Yours is operator.'],
    ['operator', '/axes/feeder/parameters', 'Writing what is imported needs the role engineer. Yours is operator.'],
    ['operator', '/lines/can0', 'Looking for drives needs the role engineer. Yours is operator.'],
    ['operator', '/mappings', 'Changing the mappings needs the role engineer. Yours is operator.'],
    ['operator', '/site', 'Changing the site needs the role engineer. Yours is operator.'],
    ['engineer', '/site', 'A backup of everything, its restore, and whether one waits for the next start needs the role administrator. Yours is engineer.'],
    ['operator', '/recipes', 'Making a recipe needs the role engineer. Yours is operator.'],
    ['operator', '/recipes/r', 'This needs the role engineer. Yours is operator.'],
    ['viewer', '/recipes/r', 'Running and cancelling needs the role operator. Yours is viewer.'],
    ['viewer', '/events', 'Acknowledging and shelving needs the role operator. Yours is viewer.'],
    ['operator', '/gateway', 'Making the door read-only, or not, needs the role engineer. Yours is operator.'],
    ['engineer', '/users', 'This needs the role administrator. Yours is engineer.'],
  ] as const)('%s on %s is told why, in sight', async (role, path, text) => {
    await as(role, path);
    await p.see('main', text);
  });
  it('an administrator is told nothing of the kind anywhere', async () => {
    for (const path of ['/axes/feeder', '/axes/feeder/drive', '/site', '/recipes/r', '/gateway', '/events']) {
      await as('administrator', path);
      await soon(() => expect(p.text('[data-field=connection]')).toBe('Live'));
      await p.drawn();
      expect(p.text('main')).not.toContain('needs the role');
      if (path !== '/events') p.close();
    }
  });
});

describe('lines and drives', () => {
  it.each([
    ['bus_off', 'Bus off', 'The CAN controller has left the bus'], ['down', 'Down', 'The line is down'], ['opening', 'Opening', 'The line is being opened'], ['closed', 'Closed', 'The line is closed'], ['up', 'Up', 'The line is up'],
  ] as const)('%s is %s', async (state, word, long) => {
    const line = door.world.line.bind(door.world);
    vi.spyOn(door.world, 'line').mockImplementation((n) => ({ ...line(n), status: { ...line(n).status, state, text: 'no carrier' } }));
    await open('/lines');
    await p.see('[data-line=can0]', word);
    expect(p.root.querySelector('[data-line=can0] [title]')?.outerHTML).toContain(long);
    expect(p.text('[data-line=can0]')).toContain('no carrier');
  });
  it('who may serve a drive is told, and how long a silent one is left alone', async () => {
    door.world.driveOf('feeder').presence = 'offline';
    await open('/lines');
    await p.see('[data-drive=feeder]', 'real, else simulated');
    expect(p.text('[data-drive=feeder]')).toContain('silent 41 times, next try within 5000 ms');
    expect([p.text('[data-drive=lift]'), p.text('[data-drive=gantry]')]).toEqual([expect.stringContaining('real only'), expect.stringContaining('simulated only')]);
  });
  it('no axis matches the filter: said, with what was typed', async () => {
    await open('/');
    await p.see('[data-axis=feeder]', 'feeder');
    p.type(p.field('Filter axes by name, family, line, drive or state'), 'nothing');
    await p.see('main', 'No axis matches “nothing”; 6 in all.');
    p.type(p.field('Filter axes by name, family, line, drive or state'), '');
  });
});

describe('registers', () => {
  const map = (id: string, address: number, more: object = {}) => say('POST', '/mappings', { id, unit: 2, address, axis: 'feeder', point: 'position', type: 'i32', ...more });
  it('a demand that nobody tells is not known, whatever the register holds; with an order it is', async () => {
    map('d', 0, { point: 'position_demand' });
    map('e', 2, { point: 'following_error' });
    await open('/mappings');
    await p.see('[data-mapping=d] [data-field=in-register]', '0000 0000');
    expect([p.text('[data-mapping=d] [data-field=value]'), p.text('[data-mapping=e] [data-field=value]')]).toEqual(['not known', 'not known']);
    door.world.command('feeder', { command: 'enable' }, 'x');
    door.world.command('feeder', { command: 'move_relative', position: 100, velocity: 50 }, 'x');
    for (let i = 0; i < 50; i += 1) door.world.step(0.01);
    p.wire.turn();
    await p.see('[data-mapping=e] [data-field=value]', /^3.?200 inc$/);
  });
  it('are said to be not read yet, written only, or an exception', async () => {
    map('a', 0);
    map('w', 2, { access: 'W', point: 'target_position' });
    vi.spyOn(door.configuration, 'registers').mockImplementation(() => ({ unit: 2, table: 'holding_registers', address: 0, words: [], exception: { code: 2, text: 'illegal data address' }, decoded: [] }));
    await open('/mappings');
    await p.see('[data-mapping=a] [data-field=in-register]', 'exception 2: illegal data address');
    without('/registers');
    p.go('/');
    await p.see('.tiles', 'feeder');
    p.go('/mappings');
    await p.see('.register-grid', 'This gateway does not offer a look at its registers: parameters show no live value here.');
    expect([p.text('[data-mapping=a] [data-field=in-register]'), p.text('[data-mapping=w] [data-field=in-register]')]).toEqual(['not read yet', 'written only']);
  });
  it('of 450 entries draw those in sight, count all, and draw the rest where one scrolls', async () => {
    door.world.site.mappings = Array.from({ length: 450 }, (_, i) => ({ id: `m${i}`, unit: 2, table: 'holding_registers', address: i, axis: 'feeder', point: 'statusword', type: 'u16', word_order: 'high_first', scale: 1, offset: 0, access: 'R' }));
    await open('/mappings');
    await p.see('[data-mapping=m0]', 'statusword');
    const map = p.root.querySelector<HTMLElement>('.register-map')!;
    expect(p.root.querySelectorAll('[data-mapping]').length).toBeLessThan(200);
    expect(p.root.querySelector('[data-mapping=m449]')).toBeNull();
    expect(map.getAttribute('aria-rowcount')).toBe('59'); // 57 rows of eight, one behind them, and the rest folded
    map.scrollTop = 50 * 78;
    map.dispatchEvent(new Event('scroll'));
    await p.see('[data-mapping=m449]', 'statusword');
    expect(p.root.querySelector('[data-mapping=m0]')).toBeNull();
  });
  it('a form that is sent with faults says so, and a table that is too long for the page', async () => {
    await open('/mappings');
    await p.see('.register-grid', 'Nothing is mapped yet.');
    p.root.querySelector<HTMLFormElement>('#mapping-form')!.requestSubmit();
    await p.see('[data-field=mapping-told]', 'Mend the fields that are marked.');
    expect(p.text('#mapping-form')).toContain('Choose an axis.');
    const rows = Array.from({ length: 301 }, (_, i) => `2,${i},feeder,statusword,u16`);
    await p.press('Paste or import');
    await p.see('[role=dialog]', 'Columns in any order');
    p.type(p.root.querySelector<HTMLTextAreaElement>('#mapping-table')!, ['unit,address,axis,point,type', ...rows].join('\n'));
    await p.see('.mapping-paste', '1 more rows are checked but not shown.');
    p.field('in place of all mappings').click();
    p.type(p.root.querySelector<HTMLTextAreaElement>('#mapping-table')!, '');
  });
});

describe('what a gateway does not offer is said in words', () => {
  it.each([
    ['/site/stage', '/site', '[data-field=stage]', 'This gateway does not offer staging: an applied change stays, there is no roll back by itself.'],
    ['/site/history', '/site', '[data-field=history]', 'This gateway does not offer a history of applied states.'],
    ['/axes/feeder/snapshots', '/axes/feeder/parameters', 'main', 'This gateway does not offer snapshots.'],
    ['/mappings/list', '/mappings', '[data-field=lists]', 'This gateway does not offer generated lists (CSV, PLC structure).'],
    ['/modbus', '/gateway', '[data-field=modbus-door]', 'This gateway does not say more about its Modbus door.'],
  ])('%s', async (path, page, where, text) => {
    without(path);
    await open(page);
    if (path === '/site/stage') {
      await p.see('[data-entry="axes/feeder"]', 'feeder');
      p.type(await soon(async () => (p.button('Change axis feeder').click(), await p.drawn(), p.field('Unit'))), 'cm');
      await p.press('Save to draft');
      await p.press('Check');
    }
    await p.see(where, text);
    p.close();
    vi.restoreAllMocks();
    await open(page);
    await soon(() => expect(p.text('[data-field=connection]')).toBe('Live'));
    await p.drawn();
    expect(p.text(where)).not.toContain(text);
  });
  it('a backup, and a registers look of the HMI view', async () => {
    door = new MockDoor({ localRole: 'administrator' });
    without('/backup', 501);
    await open('/site');
    await p.see('[data-entry="axes/feeder"]', 'feeder');
    await p.press('Backup of everything');
    await p.see('[data-field=files-told]', 'This gateway does not offer a backup through the page.');
    vi.restoreAllMocks();
    without('/registers');
    p.go('/mappings');
    await soon(() => p.button('What the HMI sees'));
    await p.press('What the HMI sees');
    await p.press('Look');
    await p.see('[data-field=hmi-told]', 'This gateway does not offer a look at its registers.');
    await p.press('Map');
  });
});
