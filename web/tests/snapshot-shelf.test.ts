// Snapshots of an axis: nothing is restored before its changes have been told, only what is chosen goes, and what was not written is said.
import { signal } from '@preact/signals';
import { beforeEach, expect, it, vi } from 'vitest';
import { Problem } from '../src/api/problem';
import { SnapshotShelf } from '../src/state/snapshot-shelf';

const s = { n: 3, name: 'as delivered' };
const changes = [{ parameter: 'A', from: 1, to: 2 }, { parameter: 'B', from: 5, to: 6 }];
let door: { list: ReturnType<typeof vi.fn>; save: ReturnType<typeof vi.fn>; restore: ReturnType<typeof vi.fn>; remove: ReturnType<typeof vi.fn> };
let listed: unknown[];
let shelf: SnapshotShelf;
beforeEach(() => {
  listed = [];
  door = { list: vi.fn(async () => [s]), save: vi.fn(async () => s), remove: vi.fn(async () => undefined), restore: vi.fn(async (_n: number, o: { dry_run: boolean }) => (o.dry_run ? { changes } : { changed: changes })) };
  shelf = new SnapshotShelf(door as never, async () => [{ id: 'A' }] as never, (list) => listed.push(list));
});

it('is saved under what was typed; what is typed meanwhile stays', async () => {
  const name = signal(' first ');
  const comment = signal('x');
  const saved = shelf.save(name, comment, 'stored');
  expect(shelf.reported.value).toEqual({ tone: 'busy', text: 'Saving …' });
  comment.value = 'xy';
  await saved;
  expect(door.save).toHaveBeenCalledWith({ name: 'first', comment: 'x', from: 'stored' });
  expect([name.value, comment.value, shelf.reported.value.text, listed]).toEqual(['', 'xy', 'Saved as 3.', [[s]]]);
});
it('is done although the list cannot be read after it', async () => {
  door.list.mockImplementation(() => Promise.reject(new Problem('unreachable', 'nobody')));
  await shelf.remove(s);
  expect(shelf.reported.value).toEqual({ tone: 'good', text: 'as delivered is deleted.' });
});
it('is looked at without writing, and restored with what is chosen alone', async () => {
  await shelf.restore();
  expect(door.restore).not.toHaveBeenCalled(); // nothing has been looked at
  await shelf.look(s);
  expect(door.restore).toHaveBeenCalledWith(3, { dry_run: true });
  expect([shelf.reported.value.text, [...shelf.restoring.value!.chosen], shelf.shapes.value.has('A')]).toEqual(['Nothing has been changed yet.', ['A', 'B'], true]);
  shelf.choose('A');
  await shelf.restore();
  expect(door.restore).toHaveBeenLastCalledWith(3, { parameters: ['B'], dry_run: false });
  expect([shelf.restoring.value, shelf.reported.value.text]).toEqual([null, '2 parameters restored from as delivered.']);
});
it('writes nothing when nothing is chosen', async () => {
  await shelf.look(s);
  shelf.choose('A');
  shelf.choose('B');
  await shelf.restore();
  expect(door.restore).toHaveBeenCalledTimes(1);
});
it('is looked at again when what acts at once is to go with it, and then restored with it', async () => {
  shelf.setLive(true);
  expect(door.restore).not.toHaveBeenCalled();
  await shelf.look(s);
  expect(door.restore).toHaveBeenLastCalledWith(3, { dry_run: true, include_live: true });
  shelf.setLive(false);
  await vi.waitFor(() => expect(door.restore).toHaveBeenLastCalledWith(3, { dry_run: true }));
  shelf.setLive(true);
  await shelf.restore();
  expect(door.restore).toHaveBeenCalledWith(3, { parameters: ['A', 'B'], dry_run: false, include_live: true });
});
it('says what was not written', async () => {
  await shelf.look(s);
  door.restore.mockImplementation(async () => ({ changed: [changes[0]], failed: [{ parameter: 'B', reason: 'busy' }] }));
  await shelf.restore();
  expect(shelf.reported.value).toEqual({ tone: 'refused', text: '1 written; NOT written: B (busy)' });
});
