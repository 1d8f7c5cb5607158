// @vitest-environment happy-dom
// The rehearsal of a recipe against specimens: begun with what is typed, followed row by row, ended, and each specimen in words.
import { afterEach, beforeEach, describe, expect, it, vi } from 'vitest';
import { MockDoor } from '../dev/mock/door.mjs';
import { Problem } from '../src/api/problem';
import type { RecipeRehearsal } from '../src/api/types';
import { RecipeRehearsing } from '../src/state/recipe-rehearsal';
import { namesIn } from '../src/text/recipe';
import { openPage, soon, type MockPage } from './mock-page';

const row = (specimen: string, passed = true) => ({ specimen, passed, step: null, pointer: null, text: null, event: null, seconds: 1 });
const report = (state: string, rows: object[], began_at = 'monday') => ({ state, total: 3, done: rows.length, began_at, families: {}, specimens: rows }) as unknown as RecipeRehearsal;

describe('the rehearsal', () => {
  const client = { recipeRehearsal: vi.fn(), rehearseRecipe: vi.fn(), cancelRehearsal: vi.fn(), specimen: vi.fn() };
  let of: RecipeRehearsing;
  beforeEach(() => {
    vi.resetAllMocks();
    of = new RecipeRehearsing(client as never, 'r');
  });

  it('asks for the rows that it does not have', async () => {
    client.rehearseRecipe.mockResolvedValue(report('running', []));
    of.typed.value = ' 1..3 ';
    await of.start({ way: 2 });
    expect(client.rehearseRecipe).toHaveBeenCalledWith('r', { specimens: '1..3', arguments: { way: 2 } });
    client.recipeRehearsal.mockResolvedValueOnce(report('running', [row('1'), row('2')]));
    await of.look();
    client.recipeRehearsal.mockResolvedValueOnce(report('done', [row('3', false)]));
    await of.look();
    expect(client.recipeRehearsal.mock.calls.map((c) => c[1])).toEqual([0, 2]);
    expect([of.report.value?.state, of.report.value?.specimens.map((s) => s.specimen)]).toEqual(['done', ['1', '2', '3']]);
  });
  it('begins anew with the rows of another one that somebody else has begun', async () => {
    of.report.value = report('running', [row('1'), row('2')]);
    client.recipeRehearsal.mockResolvedValueOnce(report('running', [row('9')], 'tuesday')).mockResolvedValueOnce(report('running', [row('7'), row('8'), row('9')], 'tuesday'));
    await of.look();
    expect(of.report.value?.specimens.map((s) => s.specimen)).toEqual(['7', '8', '9']);
  });
  it('keeps its rows when it is ended or the gateway does not answer', async () => {
    of.report.value = report('running', [row('1')]);
    client.recipeRehearsal.mockRejectedValueOnce(new Problem('unreachable', 'nobody answers', 0));
    await of.look();
    expect(of.report.value?.specimens.length).toBe(1);
    client.cancelRehearsal.mockResolvedValueOnce(report('cancelling', [row('1')]));
    await of.cancel();
    expect(of.report.value?.state).toBe('cancelling');
  });
  it('tells why it is refused', async () => {
    client.rehearseRecipe.mockRejectedValueOnce(new Problem('answered', 'the recipe uses no axis', 422));
    await of.start({});
    expect(of.reported.value).toEqual({ tone: 'refused', text: 'The recipe uses no axis' });
  });
  it('tells a specimen in words, in each family, the fixed ones as what they are', async () => {
    of.report.value = { ...report('done', [row('7')]), families: { mcode: '0' } };
    client.specimen.mockImplementation(async (family: string, specimen: string) => ({ family, specimen, words: [`${family} ${specimen}`] }));
    await of.open('7', ['uim342', 'mcode']);
    expect(of.words.value.map((w) => w.words[0])).toEqual(['uim342 7', 'mcode 0']);
    await of.open('7', ['uim342']);
    expect([of.opened.value, of.words.value]).toEqual(['', []]);
  });
  it('finds the names in a recipe', () => {
    expect([...namesIn([{ enable: { axis: 'feeder' } }, { if: { then: [{ home: { axis: 'lift' } }] } }, 5, null])].sort()).toEqual(['feeder', 'lift']);
  });
});

describe('on the page', () => {
  let p: MockPage;
  const door = () => {
    const d = new MockDoor();
    d.answer({ method: 'PUT', target: '/api/v1/recipes/r', head: {}, text: JSON.stringify({ steps: [{ enable: { axis: 'feeder' } }, { wait_s: 1 }] }), peer: '127.0.0.1:1' });
    return d;
  };
  const rows = () => [...p.root.querySelectorAll('[data-specimen]')].map((r) => `${r.getAttribute('data-specimen')} ${r.getAttribute('data-passed')}`);
  afterEach(() => p.close());

  it('a row for each specimen, with step and reason; its words on demand', async () => {
    const d = door();
    p = await openPage('/recipes/r', { door: d });
    await soon(() => p.field('Specimens to rehearse'));
    p.type(p.field('Specimens to rehearse'), '5..8');
    await p.press('Rehearse');
    await p.see('[data-field=rehearsal-sum]', '0 of 4 specimens played');
    d.step(0.1, 1);
    await soon(() => expect(rows()).toEqual(['5 true', '6 true', '7 false', '8 true']));
    await p.see('[data-field=rehearsal-sum]', '3 of 4 specimens passed');
    await p.see('[data-specimen="7"]', 'not done within 30 s');
    (p.root.querySelector('[data-specimen="7"] button') as HTMLButtonElement).click();
    await p.see('[data-field=specimen-words]', 'as specimen 7');
  });
  it('is ended, and what cannot be rehearsed is told', async () => {
    const d = door();
    p = await openPage('/recipes/r', { door: d });
    await soon(() => p.field('Specimens to rehearse'));
    p.type(p.field('Specimens to rehearse'), 'fast');
    await p.press('Rehearse');
    await p.see('[data-field=rehearsal-told]', 'write a seed from 0');
    p.type(p.field('Specimens to rehearse'), '1..100');
    await p.press('Rehearse');
    await p.see('[data-field=rehearsal-sum]', '0 of 100');
    d.step(0.1, 1);
    await p.press('End the rehearsal');
    await soon(() => expect(d.recipes.rehearsals.running()?.report.state).toBe('cancelling'));
    d.step(0.1, 2);
    await p.see('[data-field=rehearsal-sum]', 'Ended after 5 of 100 specimens');
  });
});
