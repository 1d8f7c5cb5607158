// A site in words and forms: entries from what was typed, differences, changes put on top of another's. All pure.
import { describe, expect, it } from 'vitest';
import { checkEntry, differenceOf, differenceText, freeName, freeNumber, placeOf, readSite, rebase, sameDocument, textsOfEntry, withEntry, withoutEntry, type Entry, type Room, type Site, type Texts } from '../src/text/site';

const site: Site = {
  lines: [{ name: 'can0', uri: 'twin', family: 'uim342', bitrate: 1000000 }, { name: 'rs', uri: 'pty:/tmp/x', family: 'mcode' }],
  drives: [{ name: 'feeder', line: 'can0', address: 5, presence: 'auto' }, { name: 'lift', line: 'rs', address: 'A' }],
  axes: [{ name: 'feeder', drive: 'feeder', channel: 1, number: 1, unit: 'mm', increments_per_unit: 3200 }, { name: 'lift', drive: 'lift', number: 2 }],
  mappings: [{ id: 'm1', unit: 2, address: 0, axis: 'feeder', point: 'position' }],
};
const entry = (room: Room, name: string) => site[room]!.find((e) => e.name === name) as Entry;
const check = (room: Room, change: Texts, own: Entry | null = null) => checkEntry(room, { ...textsOfEntry(room, own), ...change }, site, own);

describe('an entry', () => {
  it('comes back as it was, with members that the page does not know', () => {
    for (const room of ['lines', 'drives', 'axes'] as const) {
      for (const e of site[room]!) {
        const extra = { ...e, future: { a: 1 } } as Entry;
        const back = checkEntry(room, textsOfEntry(room, extra), site, extra).entry;
        expect(back).toEqual(room === 'drives' ? { presence: 'auto', ...extra } : extra);
      }
    }
  });
  it('leaves out what is empty, and takes numbers and options for what they are', () => {
    expect(check('lines', { name: 'a', uri: 'twin', family: 'uim342', 'options.check': 'on', 'options.t': '', 'timing.retries': '-1' }).entry).toEqual({ name: 'a', uri: 'twin', family: 'uim342', options: { check: 'on' }, timing: { retries: -1 } });
    expect(check('drives', { name: 'a', line: 'rs', address: 'B' }).entry).toEqual({ name: 'a', line: 'rs', address: 'B', presence: 'auto' });
    expect(check('lines', { bitrate: '' }, entry('lines', 'can0')).entry).toEqual({ name: 'can0', uri: 'twin', family: 'uim342' });
  });
  it('has a switch as true or false, and leaves out what was never switched', () => {
    const feeder = entry('axes', 'feeder')!;
    const on = check('axes', { trend_on_disk: 'true' }, feeder).entry!;
    expect(on.trend_on_disk).toBe(true);
    expect(textsOfEntry('axes', on).trend_on_disk).toBe('true');
    expect(check('axes', { trend_on_disk: '' }, on).entry).toEqual(feeder);
    expect(check('axes', {}, { ...feeder, trend_on_disk: false }).entry!.trend_on_disk).toBe(false);
  });
  it.each([
    ['lines', { name: 'a b', uri: 'twin', family: 'x' }, 'name', 'letters'],
    ['lines', { name: 'can0', uri: 'twin', family: 'x' }, 'name', 'already a line can0'],
    ['lines', { name: 'a', uri: '', family: 'x' }, 'uri', 'needed'],
    ['lines', { name: 'a', uri: 'twin', family: 'x', 'timing.retries': '21' }, 'timing.retries', 'From −1 to 20'],
    ['drives', { name: 'a', line: 'nowhere' }, 'line', 'no line nowhere'],
    ['drives', { name: 'a', line: 'can0', address: '5' }, 'address', 'feeder'],
    ['axes', { name: 'a', drive: 'feeder', number: '1', channel: '2' }, 'number', 'feeder'],
    ['axes', { name: 'a', drive: 'feeder', number: '9', channel: '' }, 'channel', 'feeder'],
    ['axes', { name: 'a', drive: 'feeder', number: '0', channel: '2' }, 'number', 'From 1 to 1024'],
    ['axes', { name: 'a', drive: 'feeder', number: '1.5', channel: '2' }, 'number', 'whole'],
    ['axes', { name: 'a', drive: 'feeder', number: '9', channel: '2', increments_per_unit: '0' }, 'increments_per_unit', 'Above 0'],
    ['axes', { name: 'a', drive: 'feeder', number: '9', channel: '2', unit: 'mm', increments_per_unit: '' }, 'increments_per_unit', 'How many increments make one mm?'],
    ['axes', { name: 'a', drive: 'feeder', number: '9', channel: '2', position_min: '5', position_max: '5' }, 'position_max', 'above the lowest'],
    ['axes', { name: 'a', drive: 'feeder', number: '9', channel: '2', velocity_max: '1,5' }, 'velocity_max', 'point'],
  ] as [Room, Texts, string, string][])('%s %o is refused at its field', (room, change, key, why) => {
    const r = check(room, change);
    expect(r.entry).toBeNull();
    expect(r.faults[key]).toContain(why);
  });
});

describe('a site', () => {
  it('follows a new name', () => {
    const next = withEntry(withEntry(site, 'lines', { ...entry('lines', 'can0'), name: 'can1' }, 'can0'), 'axes', { ...entry('axes', 'feeder'), name: 'x' }, 'feeder');
    expect(next.drives![0]!.line).toBe('can1');
    expect(next.mappings![0]!.axis).toBe('x');
    expect(site.drives![0]!.line).toBe('can0');
  });
  it('loses with a line what hangs on it', () => {
    const next = withoutEntry(site, 'lines', 'can0');
    expect([next.lines!.length, next.drives!.map((d) => d.name), next.axes!.map((a) => a.name), next.mappings]).toEqual([1, ['lift'], ['lift'], []]);
  });
  it('tells differences, in words', () => {
    const next = withEntry(withoutEntry(site, 'axes', 'lift'), 'axes', { ...entry('axes', 'feeder'), unit: 'deg' }, 'feeder');
    expect(differenceOf(site, next).map(differenceText)).toEqual(['axis lift: drive lift, number 2', 'axis feeder: unit mm → deg']);
    expect(differenceOf(site, { ...structuredClone(site) })).toEqual([]);
  });
  it('does not see a difference in the order of members or in what is left out', () => expect(sameDocument({ a: 1, b: { c: 2 } }, { b: { c: 2 }, a: 1, d: undefined })).toBe(true));
  it('takes my changes on top of those of somebody else', () => {
    const mine = withEntry(site, 'axes', { ...entry('axes', 'feeder'), unit: 'deg' }, 'feeder');
    const theirs = withEntry(withoutEntry(site, 'drives', 'lift'), 'lines', { name: 'new', uri: 'twin', family: 'mcode' }, null);
    const r = rebase(site, mine, theirs);
    expect(r.clashes).toEqual([]);
    expect(r.site.axes).toEqual([{ ...entry('axes', 'feeder'), unit: 'deg' }]);
    expect(r.site.lines!.map((l) => l.name)).toEqual(['can0', 'rs', 'new']);
  });
  it('names what both changed; mine stand', () => {
    const mine = withEntry(site, 'axes', { ...entry('axes', 'feeder'), unit: 'deg' }, 'feeder');
    const theirs = withEntry(site, 'axes', { ...entry('axes', 'feeder'), unit: 'inch' }, 'feeder');
    const r = rebase(site, mine, theirs);
    expect(r.clashes.map((c) => c.what)).toEqual(['axes/feeder']);
    expect(r.site.axes![0]!.unit).toBe('deg');
    expect(rebase(site, mine, mine).clashes).toEqual([]);
  });
  it('keeps how Modbus units answer through every change, and tells what became of it', () => {
    const refusing = { ...site, modbus_units: [{ unit: 7, gaps: 'refuse' }] };
    expect(withoutEntry(refusing, 'axes', 'feeder').modbus_units).toEqual(refusing.modbus_units);
    expect(readSite(JSON.stringify(refusing))).toMatchObject({ modbus_units: refusing.modbus_units });
    expect(rebase(site, site, refusing).site.modbus_units).toEqual(refusing.modbus_units);
    expect(rebase(site, refusing, site).site.modbus_units).toEqual(refusing.modbus_units);
    expect(rebase(site, site, site).site).not.toHaveProperty('modbus_units');
    expect(differenceOf(site, refusing).map(differenceText)).toEqual(['Modbus unit 7: unit 7, gaps refuse']);
  });
  it('finds the place of a fault', () => {
    expect(placeOf('/axes/1/number', site)).toEqual({ room: 'axes', name: 'lift', key: 'number' });
    expect(placeOf('/lines/0/timing/retries', site)?.key).toBe('timing.retries');
    expect(placeOf('/axes/9/number', site)).toBeNull();
    expect(placeOf('', site)).toBeNull();
  });
  it('gives names and numbers that are free', () => {
    expect(freeName(site.lines, 'can0')).toBe('can02');
    expect(freeName(site.lines, 'a b')).toBe('a-b');
    expect(freeNumber(site)).toBe(3);
  });
  it.each([['{', 'not JSON'], ['[]', 'object'], ['{"lines":5}', 'no list'], ['{"others":[]}', 'no list'], ['{"axes":[{}]}', 'no name']])('%s is no site', (text, why) => expect(readSite(text)).toContain(why));
  it('is read, with what is left out as empty', () => expect(readSite('{"lines":null,"axes":[]}')).toEqual({ lines: [], drives: [], axes: [], mappings: [] }));
});
