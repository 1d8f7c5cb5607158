// A recipe that two people change: what goes with a save, and what becomes of what was typed.
import { beforeEach, expect, it } from 'vitest';
import { Problem } from '../src/api/problem';
import { RecipeFile } from '../src/state/recipe-file';
import { recipeDifferences } from '../src/text/recipe';

let there: { text: object; tag: string } | null;
let sent: Record<string, string>[];
let tags: boolean;
const client = {
  whole: async (_path: string, o: { method?: string; body?: object; headers?: Record<string, string> } = {}) => {
    const head = () => new Headers(tags && there ? { etag: there.tag } : {});
    if (o.method === undefined) {
      if (!there) throw new Problem('answered', 'there is none', 404);
      return { status: 200, head: head(), text: JSON.stringify({ ...there.text, name: 'r', changed_by: 'anna' }) };
    }
    sent.push(o.headers ?? {});
    const match = o.headers?.['if-match'];
    if (tags && ((o.headers?.['if-none-match'] && there) || (match && there?.tag !== match))) throw new Problem('answered', 'it is another', 412);
    there = o.method === 'DELETE' ? null : { text: o.body as object, tag: `"${JSON.stringify(o.body).length}-${sent.length}"` };
    return { status: 200, head: head(), text: '' };
  },
};
const file = () => new RecipeFile(client as never, 'r');
const steps = (n: number) => ({ steps: [{ wait_s: n }] });
beforeEach(() => [there, sent, tags] = [{ text: steps(1), tag: '"a"' }, [], true]);

it('is saved against the state that was read, and the next time against the one that was saved', async () => {
  const f = file();
  expect(await f.read()).toEqual(steps(1));
  expect(await f.save(steps(2))).toEqual({ good: true });
  expect(await f.save(steps(3))).toEqual({ good: true });
  expect(sent[0]).toEqual({ 'if-match': '"a"' });
  expect(sent[1]?.['if-match']).not.toBe('"a"');
});
it('changed by somebody else is shown, and mine can be saved all the same', async () => {
  const f = file();
  await f.read();
  there = { text: steps(9), tag: '"b"' };
  const o = await f.save(steps(2));
  expect(o).toMatchObject({ good: false, clash: { now: steps(9), text: 'Somebody else has changed r meanwhile.' } });
  expect(there.text).toEqual(steps(9));
  expect(recipeDifferences(steps(9), steps(2))).toEqual(['/steps/0/wait_s: 9 → 2']);
  expect(await f.save(steps(2))).toEqual({ good: true });
});
it('that is new does not take the place of one that somebody else has made', async () => {
  const now = there;
  there = null;
  const f = file();
  expect(await f.read()).toBeNull();
  there = now;
  expect(await f.save(steps(2))).toMatchObject({ clash: { now: steps(1), text: 'Somebody else has made a recipe r meanwhile.' } });
  expect(sent).toEqual([{ 'if-none-match': '*' }]);
});
it('deleted meanwhile, or not to be deleted because it was changed, is said', async () => {
  const f = file();
  await f.read();
  there = { text: steps(9), tag: '"b"' };
  expect(await f.remove()).toMatchObject({ good: false, clash: { now: steps(9) } });
  there = null;
  expect(await f.save(steps(2))).toMatchObject({ clash: { now: null, text: 'Somebody else has deleted r meanwhile.' } });
  expect(await f.save(steps(2))).toEqual({ good: true });
});
it('at a gateway that names no states is saved as ever', async () => {
  tags = false;
  const f = file();
  await f.read();
  expect(await f.save(steps(2))).toEqual({ good: true });
  expect(sent).toEqual([{}]);
});
