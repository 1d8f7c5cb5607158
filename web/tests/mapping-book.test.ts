// The book of mappings against a small gateway in memory: changes against a revision, clashes, undo.
import { beforeEach, describe, expect, it } from 'vitest';
import { Client } from '../src/api/client';
import { MappingDoor } from '../src/api/mappings';
import { MappingBook } from '../src/state/mappings';
import { columns, type Mapping } from '../src/text/mapping';
import { rowsOf } from '../src/text/table-text';

let rows: Mapping[];
let revision: number;
let published: string[];
let book: MappingBook;
const spec = { unit: 2, address: 0, axis: 'feeder', point: 'position' };
const whole = (s: Partial<Mapping>): Mapping => ({ id: `m${revision}`, unit: 2, table: 'holding_registers', address: 0, axis: '', point: '', type: 'i32', word_order: 'high_first', scale: 1, offset: 0, access: 'R', ...s });
const answer = (status: number, body: unknown) => new Response(status === 204 ? null : JSON.stringify(body), { status, headers: { 'site-revision': String(revision), 'mapping-revision': '0xABCD', 'content-type': status < 300 ? 'application/json' : 'application/problem+json' } });

const gateway: typeof fetch = async (input, init) => {
  const path = String(input).replace('/api/v1', '');
  const method = init?.method ?? 'GET';
  published.push(`${method} ${path}`);
  if (path === '/mapping-points') return answer(200, []);
  if (method === 'GET') return answer(200, rows);
  const match = (init?.headers as Record<string, string>)['if-match'];
  if (match && match !== `"${revision}"`) return answer(412, { detail: `the site has the revision ${revision}`, status: 412 });
  revision += 1;
  if (path === '/mappings.csv') {
    const table = rowsOf(String(init?.body)).rows.slice(1).map((r) => Object.fromEntries(columns.map((c, i) => [c, r.cells[i]])));
    rows = table.map((t) => whole({ id: t.id as string, unit: Number(t.unit), address: Number(t.address), axis: t.axis as string, point: t.point as string, scale: Number(t.scale) }));
    return answer(200, { dry_run: false, rows: rows.length, mappings: rows.length, differences: [] });
  }
  const id = path.split('/')[2];
  if (method === 'POST') rows = [...rows, whole(JSON.parse(String(init?.body)))];
  if (method === 'PUT') rows = rows.map((r) => (r.id === id ? whole(JSON.parse(String(init?.body))) : r));
  if (method === 'DELETE') rows = rows.filter((r) => r.id !== id);
  return answer(method === 'DELETE' ? 204 : 200, rows.at(-1));
};

beforeEach(async () => {
  [rows, revision, published] = [[], 1, []];
  book = new MappingBook(new MappingDoor(new Client('/api/v1', gateway)));
  await book.load();
});

describe('the book', () => {
  it('loads rows, points and the hash', () => {
    expect(book.hash.value).toBe('0xABCD');
  });
  it('says why the list is not there', async () => {
    const other = new MappingBook(new MappingDoor(new Client('/api/v1', async () => new Response('{"detail":"the store is shut"}', { status: 503, headers: { 'content-type': 'application/problem+json' } }))));
    await expect(other.load()).rejects.toThrow('the store is shut');
  });
  it('undoes an addition, a change and a removal, in this order backwards', async () => {
    await book.add(spec);
    const id = rows[0]!.id;
    await book.replace(id, { ...spec, scale: 2 }, book.rows.value[0]!);
    await book.remove(id);
    expect(rows).toEqual([]);
    expect((await book.undo()).text).toBe(`Undone: removed ${id}.`);
    expect(rows[0]).toMatchObject({ id, scale: 2 });
    await book.undo();
    expect(rows[0]).toMatchObject({ id, scale: 1 });
    await book.undo();
    expect(rows).toEqual([]);
    expect((await book.undo()).good).toBe(false);
  });
  it('does not undo over the work of somebody else', async () => {
    await book.add(spec);
    rows = [{ ...rows[0]!, scale: 7 }];
    const r = await book.undo();
    expect(r.good).toBe(false);
    expect(r.text).toContain('somebody else has changed');
    expect(r.text).toContain('scale 1 → 7');
    expect(rows[0]?.scale).toBe(7);
  });
  it('keeps entries of others when it undoes its own', async () => {
    await book.add(spec);
    rows = [...rows, whole({ id: 'theirs', address: 9, axis: 'feeder', point: 'velocity' })];
    revision += 1;
    await book.undo();
    expect(rows.map((r) => r.id)).toEqual(['theirs']);
  });
  it('shows the difference when the entry was changed meanwhile, and sends nothing', async () => {
    await book.add(spec);
    const opened = book.rows.value[0]!;
    rows = [{ ...opened, address: 8 }];
    published = [];
    const r = await book.replace(opened.id, { ...spec, scale: 3 }, opened);
    expect(r.good).toBe(false);
    expect(r.good ? undefined : r.clash?.text).toContain('address 0 → 8');
    expect(published.some((s) => s.startsWith('PUT'))).toBe(false);
    expect((await book.replace(opened.id, { ...spec, scale: 3 }, null)).good).toBe(true);
    expect(rows[0]?.scale).toBe(3);
  });
  it('does not take a change of others into its own way back', async () => {
    const slow = new MappingBook(new MappingDoor(new Client('/api/v1', async (i, init) => {
      const r = await gateway(i, init);
      if (init?.method === 'POST') revision += 1; // somebody else, right behind
      return r;
    })));
    await slow.add(spec);
    expect(slow.changes.value).toEqual([]);
  });
});
