// The parameters of one axis as rows: which a filter shows, what is read again and when, what becomes of what was typed when it is written.
import { beforeEach, describe, expect, it, vi } from 'vitest';
import { Problem } from '../src/api/problem';
import type { AxisParameter } from '../src/api/types';
import { isLongArray, matching, newRow, ParameterTable, type Row } from '../src/state/parameter-table';

const parameter = (id: string, change: Partial<AxisParameter> = {}): AxisParameter =>
  ({ id, name: `name_of_${id}`, description: '', group: 'g', type: 'i32', access: 'RW', unit: null, min: null, max: null, allowed: null, fields: null, alternate: null, count: null, default: 0, value: 1, stored: 1, quality: 'good', at: new Date(1000).toISOString(), text: '', addressing: false, ...change }) as unknown as AxisParameter;

let list: AxisParameter[];
let now_ms: number;
let client: { parameters: ReturnType<typeof vi.fn>; parameter: ReturnType<typeof vi.fn>; writeParameter: ReturnType<typeof vi.fn> };
let table: ParameterTable;
const end = new AbortController().signal;
const row = (id: string): Row => table.rows.value.find((r) => r.data.value.id === id)!;
const refused = () => Promise.reject(new Problem('answered', 'the drive refuses it', 409));
beforeEach(async () => {
  list = [parameter('A'), parameter('B', { access: 'W' }), parameter('C', { group: 'h', value: 5 }), parameter('D', { count: 20 } as never)];
  now_ms = 100_000;
  client = {
    parameters: vi.fn(async (_axis: string, o: { array?: string; first?: number } = {}) => (o.array ? [parameter(`${o.array}[${o.first}]`)] : list)),
    parameter: vi.fn(async (_axis: string, id: string) => parameter(id, { value: 9, at: new Date(now_ms).toISOString() })),
    writeParameter: vi.fn(async (_axis: string, _id: string, value: unknown) => ({ value })),
  };
  table = new ParameterTable(client as never, 'feeder', () => now_ms);
  await table.load(end);
});

describe('the list', () => {
  it('keeps a row and what is typed in it when it is listed again; without one it says why', async () => {
    const a = row('A');
    a.typed.value = '7';
    list = [parameter('A', { value: 3 }), parameter('E')];
    await table.load(end);
    expect(row('A')).toBe(a);
    expect([a.data.value.value, a.typed.value, table.rows.value.length]).toEqual([3, '7', 2]);
    client.parameters.mockImplementation(refused);
    await table.load(end);
    expect(table.loaded.value).toBe('there');
    const other = new ParameterTable(client as never, 'x', () => 0);
    await other.load(end);
    expect(other.loaded.value).toBe('The drive refuses it');
  });
  it('has the elements of an array below it, the next ones each time', async () => {
    await table.open(row('D'));
    await table.open(row('D'));
    expect(table.rows.value.map((r) => r.data.value.id)).toEqual(['A', 'B', 'C', 'D', 'D[0]', 'D[1]']);
    expect(row('D').note.value.text).toBe('2 of 20 elements are listed below.');
    expect([isLongArray(list[3]!), isLongArray(parameter('D[0]', { count: 20 } as never)), isLongArray(list[0]!)]).toEqual([true, false, false]);
  });
  it('is filtered by words, group and mark; the best fit comes first', () => {
    const rows = [parameter('X9', { name: 'speed_limit' }), parameter('speed'), parameter('Z', { group: 'h', name: 'speed' })].map(newRow);
    const ids = (search: string, group: string) => matching(rows, { search, group }, 'all').map((r) => r.data.value.id);
    expect(ids('', '')).toEqual(['X9', 'speed', 'Z']);
    expect(ids('speed', '')[0]).toBe('speed');
    expect(ids('speed', 'h')).toEqual(['Z']);
    expect(ids('nothing of it', '')).toEqual([]);
  });
});

describe('reading', () => {
  it('goes one by one over what can be read, can be ended, and says how far it is', async () => {
    const seen: unknown[] = [];
    table.progress.subscribe((p) => seen.push(p));
    client.parameter.mockImplementation(async (_axis: string, id: string) => {
      if (id === 'A') table.endReading();
      return parameter(id);
    });
    await table.readAll(table.rows.value);
    expect(client.parameter).toHaveBeenCalledTimes(1);
    expect(seen).toEqual([null, { done: 0, of: 2 }, { done: 1, of: 2 }, null]);
  });
  it('says why it was refused', async () => {
    client.parameter.mockImplementation(refused);
    await table.read(row('A'));
    expect(row('A').note.value).toEqual({ tone: 'refused', text: 'The drive refuses it' });
  });
  it('again, without being asked: one on the screen that is old; a refusal leaves what is there and the row alone', async () => {
    expect(await table.rereadDue(new Set(['B', 'D']), end)).toBe(false); // not to be read, and an array
    expect(await table.rereadDue(new Set(['A']), end)).toBe(true);
    expect(row('A').data.value.value).toBe(9);
    expect(await table.rereadDue(new Set(['A']), end)).toBe(false); // just read
    client.parameter.mockImplementation(refused);
    expect(await table.rereadDue(new Set(['C']), end)).toBe(true);
    expect([row('C').data.value.value, row('C').note.value.tone]).toEqual([5, 'none']);
    expect(await table.rereadDue(new Set(['C']), end)).toBe(false);
    expect(client.parameter).toHaveBeenCalledTimes(2);
  });
  it('a command of this axis makes everything old, that of another none', async () => {
    await table.rereadDue(new Set(['A']), end);
    now_ms += 10;
    table.heard({ axis: 'other', kind: 'command', parameter: null });
    expect(await table.rereadDue(new Set(['A']), end)).toBe(false);
    table.heard({ axis: 'feeder', kind: 'command', parameter: null });
    expect(table.since_ms.value).toBe(now_ms);
    expect(await table.rereadDue(new Set(['A']), end)).toBe(true);
  });
  it('what anybody wrote is looked at again, with what hangs on it', async () => {
    list = [parameter('A'), parameter('C', { alternate: { parameter: 'A' } } as never), parameter('E')];
    await table.load(end);
    table.heard({ axis: 'feeder', kind: 'parameter', parameter: 'A' });
    await vi.waitFor(() => expect(row('C').data.value.value).toBe(9));
    expect(client.parameter.mock.calls.map((c) => [c[1], c[2]])).toEqual([['A', { cached: true }], ['C', { cached: true }]]);
  });
});

describe('writing', () => {
  it('empties the field when the drive took it; what was typed since then stays', async () => {
    const a = row('A');
    a.typed.value = '4';
    const written = table.write(a);
    a.typed.value = '45';
    await written;
    expect([client.writeParameter.mock.calls, a.typed.value, a.note.value]).toEqual([[['feeder', 'A', 4]], '45', { tone: 'good', text: 'Written.' }]);
    a.typed.value = '4';
    await table.write(a);
    expect(a.typed.value).toBeNull();
  });
  it('says what the drive took instead, and keeps what was typed when it was refused', async () => {
    const a = row('A');
    client.writeParameter.mockImplementation(async () => ({ value: 3 }));
    a.typed.value = '4';
    await table.write(a);
    expect(a.note.value.text).toBe('Written; the drive took 3.');
    client.writeParameter.mockImplementation(refused);
    a.typed.value = '5';
    await table.write(a);
    expect([a.note.value.tone, a.typed.value]).toEqual(['refused', '5']);
  });
  it('sends nothing that is no value', async () => {
    row('A').typed.value = 'x';
    await table.write(row('A'));
    expect([row('A').note.value.tone, client.writeParameter.mock.calls.length]).toEqual(['refused', 0]);
  });
  it('asks first where the drive is reached by it, and again when another value is typed', async () => {
    list = [parameter('N', { addressing: true } as never)];
    await table.load(end);
    const n = row('N');
    n.typed.value = '4';
    await table.write(n);
    expect([n.asked.value, client.writeParameter.mock.calls.length]).toEqual(['4', 0]);
    n.typed.value = '5';
    await table.write(n);
    expect([n.asked.value, client.writeParameter.mock.calls.length]).toEqual(['5', 0]);
    await table.write(n);
    expect([n.asked.value, client.writeParameter.mock.calls]).toEqual([null, [['feeder', 'N', 5]]]);
  });
});
