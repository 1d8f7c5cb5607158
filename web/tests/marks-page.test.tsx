// @vitest-environment happy-dom
// What stands beside a name, and what the page says of its own state, over the mock door: whose conditions the hand of a twin changes, that an axis
// is simulated, where a scan opens, who is signed in, what an answer belongs to.
import { afterEach, beforeEach, describe, expect, it } from 'vitest';
import { MockDoor } from '../dev/mock/door.mjs';
import { openPage, soon, type MockPage } from './mock-page';

let p: MockPage;
let door: MockDoor;
beforeEach(() => void (door = new MockDoor()));
afterEach(() => p.close());
const open = async (path: string) => void (p = await openPage(path, { door }));
const handOf = (drive: string) => door.world.driveOf(drive).hand;

describe('the hand', () => {
  it('on the page of the second axis changes the second axis, not the first', async () => {
    await open('/axes/gantry-y/simulation');
    await p.see('[data-hand-group="gantry-y"]', 'Limit positive');
    await p.press('Limit positive');
    await soon(() => expect(handOf('gantry')['axis2.limit_positive']).toBe(true));
    expect(handOf('gantry').limit_positive).toBe(false);
    await p.see('.hand .result', 'gantry-y: Limit positive: set to on');
    await p.press('Stall, gantry-x');
    await soon(() => expect(handOf('gantry').stall).toBe(true));
    expect(handOf('gantry')['axis2.stall']).toBe(false);
  });
  it('on the page of the first one changes the first one, and says its position in its unit', async () => {
    await open('/axes/gantry-x/simulation');
    await p.see('[data-hand-group="gantry-x"]', 'Limit positive');
    expect([...p.root.querySelectorAll('[data-hand-group]')].map((e) => e.getAttribute('data-hand-group'))).toEqual(['gantry-x', 'The whole drive', 'gantry-y']);
    p.type(p.field('Position'), '12500');
    await p.see('[data-hand-group="gantry-x"] [data-hand=position]', '= 12.500 mm');
  });
});

it('a name has the mark of what is simulated beside it while it is, and only then', async () => {
  await open('/site');
  await p.see('[data-entry="axes/gantry-x"] h3', 'SIM');
  expect([p.text('[data-entry="axes/lift"] h3'), p.text('[data-entry="drives/gantry"] h3'), p.text('[data-entry="drives/lift"] h3')]).toEqual(['lift', 'gantry SIM', 'lift']);
  door.world.driveOf('gantry').presence = 'device';
  p.wire.turn();
  await soon(() => expect(p.text('[data-entry="axes/gantry-x"] h3')).toBe('gantry-x'));
});

it('a scan opens under its line, with its name, and the keyboard goes there', async () => {
  await open('/site');
  await p.see('[data-entry="lines/bench"]', 'bench');
  await p.press('Scan bench');
  await p.see('[data-entry="lines/bench"] .scan-head', 'Scan of line bench');
  await soon(() => expect(document.activeElement?.textContent).toBe('Scan of line bench'));
});

it('who one is is not said while the head says that nobody is signed in', async () => {
  await open('/');
  await p.see('[data-field=who]', 'local access, engineer');
  p.gateway.session.ended.value = 'Your session has ended.';
  await p.see('[data-field=connection]', 'Not signed in');
  await soon(() => expect(p.root.querySelector('[data-field=who]')).toBeNull());
});

it('an answer of the registers goes, or is called the former one, when the fields say something else', async () => {
  await open('/mappings');
  await p.press('What the HMI sees');
  await p.press('Look');
  await p.see('.hmi-map', 'statusword');
  p.type(p.field('Count'), '8');
  await p.see('[data-field=hmi-former]', 'This is the former answer: unit 1, holding registers from 0 on.');
  p.type(p.field('Count'), '0');
  await p.press('Look');
  await soon(() => expect(p.root.querySelector('.hmi-map')).toBeNull());
  await p.see('[data-field=hmi-told]', 'Mend the fields that are marked; nothing was asked.');
  p.type(p.field('Count'), '16');
  await p.press('Map');
});

it('a recipe that names no axis of the site is saved, and the step is named', async () => {
  await open('/recipes/lost');
  const json = await soon(() => p.field('The recipe as JSON'));
  p.type(json, '{"steps":[{"enable":{"axis":"lift"}},{"enable":{"axis":"nobody"}}]}');
  await p.see('[data-step="/steps/1"] [data-field=no-axis]', 'Step 2 names nobody, which is no axis of this site. A run would be refused.');
  await p.press('Save');
  await p.see('.result', 'Saved. But Step 2 names nobody, which is no axis of this site. A run would be refused.');
});

it('the applied state that is in force is marked, and nobody else', async () => {
  door.world.revision = 3;
  door.configuration.site.history = [3, 2, 1].map((revision) => ({ revision, at: '2026-03-01T10:11:12Z', who: 'bert', bytes: 100, document: door.world.site }));
  await open('/site');
  await soon(() => expect([...p.root.querySelectorAll('[data-field=in-force]')].map((e) => e.closest<HTMLElement>('[data-revision]')?.dataset.revision)).toEqual(['3']));
  expect(p.text('[data-revision="3"] [data-field=in-force]')).toBe('in force');
});

it('a restore names each parameter with its unit, and says in the words of the form what it leaves out', async () => {
  const target = door.world.catalogue.find((c) => c.access === 'RW' && !c.count && c.unit && !c.allowed)!;
  expect(p0(door, '/axes/feeder/snapshots', { name: 'first' })).toBe(201);
  door.configuration.snapshots.get('feeder')![0].values[target.id] = Number(target.max ?? 5);
  const answer = door.answer.bind(door);
  door.answer = (r) => {
    const a = answer(r);
    if (!/restore$/.test(r.target)) return a;
    return { ...a, text: JSON.stringify({ ...JSON.parse(a.text), skipped: [{ parameter: target.id, why: `it acts at once and is no setting (${target.name}): it is written only with include_live` }] }) };
  };
  await open('/axes/feeder/parameters');
  await p.see('[data-field=snapshots]', 'first');
  await p.press('Restore first');
  await p.see('.changes legend', /^Restoring first changes 1 parameter of feeder( SIM)?$/);
  const name = target.name.replaceAll('_', ' ');
  await p.see('.changes label', name);
  const left = p.text('[data-field=left-out]');
  expect(left).toContain('Left out: 1 parameter (1: acts at once and is no setting; written with “Restore also what acts at once”)');
  expect(left).toContain(name);
  expect(left).not.toMatch(/include_live|_/);
});
const p0 = (to: MockDoor, path: string, body: object) => to.answer({ method: 'POST', target: `/api/v1${path}`, head: { 'x-client': 'bert' }, text: JSON.stringify(body), peer: '10.0.0.9:1' }).status;

it('a value that is counted in steps says what it comes to, also while it is typed; the field takes the steps', async () => {
  const entry = door.world.catalogue.find((c) => c.access === 'RW' && !c.count && !c.allowed && c.type !== 'bool' && c.type !== 'text')!;
  const { unit } = entry;
  try {
    entry.unit = '0.1 A';
    door.world.axisOf('feeder').write(entry.id, 10, 'x');
    await open('/axes/feeder/parameters');
    await p.see(`[data-parameter="${entry.id}"] [data-field=live]`, '10 × 0.1 A = 1.0 A');
    p.type(p.field(`New value of ${entry.id}`), '12');
    await p.see(`[data-parameter="${entry.id}"] .row-note`, '12 × 0.1 A = 1.2 A');
    await p.press(`Write ${entry.id}`);
    await soon(() => expect(door.world.axisOf('feeder').values.get(entry.id)).toBe(12));
  } finally {
    entry.unit = unit;
  }
});
