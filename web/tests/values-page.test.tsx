// @vitest-environment happy-dom
// Values on their way, over the mock door: a register's type follows its point until it is set by hand, the printed list has units, a snapshot of
// another family is barred beforehand, what acts at once is restored only when it is asked for, events count in the unit of their axis.
import { afterEach, beforeEach, describe, expect, it } from 'vitest';
import { MockDoor } from '../dev/mock/door.mjs';
import { persisted } from '../src/state/persisted';
import { openPage, soon, type MockPage } from './mock-page';

let p: MockPage;
let door: MockDoor;
beforeEach(() => {
  door = new MockDoor();
  for (const f of ['point', 'axis', 'address', 'type_by_hand']) persisted(`mapping.${f}`).value = '';
  persisted('mapping.type').value = 'i32';
  persisted('mapping.unit').value = '2';
  persisted('mapping.table').value = 'holding_registers';
});
afterEach(() => p.close());
const open = async (path: string) => (p = await openPage(path, { door }));
const is = (value: string) => soon(() => expect(p.field('Type').value).toBe(value));

/** By the keyboard's Enter or a screen reader's press: a click without a pointer. */
const chooseEntry = async (id: string) => {
  await p.see(`[data-mapping=${id}]`, 'feeder');
  p.root.querySelector<HTMLElement>(`[data-mapping=${id}]`)!.click();
  await p.see('.map-panel', `Change ${id}`);
};

describe('the type of a mapping', () => {
  it('follows the point, of a parameter too, until it is set by hand; the next one follows again', async () => {
    await open('/mappings');
    await p.see('#mapping-form', 'gantry-x');
    p.type(p.field('Axis'), 'feeder');
    p.type(p.field('Point or parameter'), 'statusword');
    await is('u16');
    await p.see('#mapping-form', 'the point’s own type');
    p.type(p.field('Point or parameter'), 'position_units');
    await is('f32');
    const parameter = door.world.catalogue.find((c) => c.type === 'u32' || c.type === 'i32')!;
    p.type(p.field('Point or parameter'), parameter.id);
    await is(parameter.type);
    p.type(p.field('Type'), 'f64');
    p.type(p.field('Point or parameter'), 'statusword');
    await p.see('#mapping-form', 'the point’s own type is u16');
    await is('f64');
    p.type(p.field('Address'), '0');
    await p.press('Add');
    await p.see('[data-field=mapping-told]', 'Added statusword of feeder');
    p.type(p.field('Point or parameter'), 'moving');
    await is('bool');
  });
  it('of an entry that is changed follows only where it was its point’s own', async () => {
    door.world.site.mappings = [
      { id: 'm1', unit: 2, table: 'holding_registers', address: 0, axis: 'feeder', point: 'position', type: 'i32', word_order: 'high_first', scale: 1, offset: 0, access: 'R' },
      { id: 'm2', unit: 2, table: 'holding_registers', address: 4, axis: 'feeder', point: 'position', type: 'f64', word_order: 'high_first', scale: 1, offset: 0, access: 'R' },
    ];
    await open('/mappings');
    await chooseEntry('m1');
    p.type(p.field('Point or parameter'), 'statusword');
    await is('u16');
    await chooseEntry('m2');
    await is('f64');
    p.type(p.field('Point or parameter'), 'statusword');
    await p.see('#mapping-form', 'the point’s own type is u16');
    await is('f64');
  });
});

it('the printed list has the unit of each value, of parameters too', async () => {
  const parameter = door.world.catalogue.find((c) => c.unit)!;
  const m = { unit: 2, table: 'holding_registers', axis: 'feeder', type: 'i32', word_order: 'high_first', scale: 1, offset: 0, access: 'R' };
  door.world.site.mappings = [{ ...m, id: 'm1', address: 0, point: 'position_units' }, { ...m, id: 'm2', address: 4, point: parameter.id }, { ...m, id: 'm3', address: 8, point: 'statusword' }];
  await open('/mappings');
  await p.see('[data-mapping=m3]', 'statusword');
  dispatchEvent(new Event('beforeprint'));
  await p.see('.printed', 'Value in');
  const cells = () => [...p.root.querySelectorAll('.printed:not([data-field=printed-standard]) tbody tr')].map((r) => r.querySelectorAll('td')[6]?.textContent);
  await soon(() => expect(cells()).toEqual(['mm', parameter.unit?.replace('^2', '²'), '']));
});

describe('a snapshot', () => {
  it('of another family can be neither restored nor compared, and that is said beforehand', async () => {
    const one = (n: number, name: string, family: string | null) => ({ n, name, comment: '', at: '2026-03-01T10:11:12Z', who: 'bert', family, values: {} });
    door.configuration.snapshots.set('feeder', [one(1, 'theirs', 'mcode'), one(2, 'ours', 'uim342'), one(3, 'old', null)]);
    await open('/axes/feeder/parameters');
    await p.see('[data-snapshot="1"]', 'Taken of Schneider Electric Lexium MCode (mcode); the drive is UIROBOT UIM342 (uim342) now, so it is neither compared nor restored.');
    await p.see('[data-snapshot="3"]', 'family not known: taken by an older program');
    expect(['theirs', 'ours', 'old'].map((n) => p.button(`Restore ${n}`).disabled)).toEqual([true, false, false]);
    const offers = (name: string) => [...p.field(name).querySelectorAll('option')].filter((o) => /snapshot/.test(o.textContent ?? '')).map((o) => [o.textContent, o.disabled]);
    for (const f of ['Compare', 'with']) expect(offers(f)).toEqual([['snapshot theirs: of mcode, not comparable', true], ['snapshot ours', false], ['snapshot old', false]]);
  });
  it('is restored with what acts at once only when that is asked for, in words', async () => {
    await open('/axes/feeder/parameters');
    await p.see('main', 'No snapshot is kept.');
    const target = door.world.catalogue.find((c) => c.access === 'RW' && !c.count)!;
    expect(p.other('POST', '/axes/feeder/snapshots', { name: 'first' }).status).toBe(201);
    door.configuration.snapshots.get('feeder')![0].values[target.id] = Number(target.max ?? 5);
    p.go('/');
    await p.see('.tiles', 'feeder');
    p.go('/axes/feeder/parameters');
    const sent: unknown[] = [];
    const answer = door.answer.bind(door);
    door.answer = (r) => {
      if (/restore$/.test(r.target)) sent.push(JSON.parse(r.text));
      return answer(r);
    };
    await p.see('[data-field=restore-live]', 'act the moment they are written: switches, set-points, outputs');
    await p.press('Restore first');
    await p.see('.changes', target.id);
    const box = p.field('Restore also what acts at once');
    box.checked = true;
    box.dispatchEvent(new Event('change', { bubbles: true }));
    await soon(() => expect(sent).toHaveLength(2));
    await p.press('Write 1 value to the drive');
    await soon(() => expect(sent).toEqual([{ dry_run: true }, { dry_run: true, include_live: true }, { parameters: [target.id], dry_run: false, include_live: true }]));
  });
});

it('events count in the unit of their axis, and follow it', async () => {
  door.world.event('info', 'command', { axis: 'feeder', who: 'bert' }, 'move_relative 16000');
  await open('/events');
  await p.see('.events', /move by 5\.000 mm \(16\s000 increments\) by bert/);
});
