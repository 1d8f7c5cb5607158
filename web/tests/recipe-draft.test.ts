// A recipe as forms and JSON at once, and its runs: what is typed on one side stands on the other, what the gateway finds stands at its place, a run's news is told once.
import { afterEach, beforeEach, describe, expect, it, vi } from 'vitest';
import { Problem } from '../src/api/problem';
import type { RecipeReport } from '../src/api/types';
import { RecipeDraft } from '../src/state/recipe-draft';
import { RecipeRuns } from '../src/state/recipe-runs';
import { argumentsOf, faultsElsewhere, faultsOfStep, kindOf, placesOf, type RecipeDocument } from '../src/text/recipe';

const document = (n: number): RecipeDocument => ({ description: '', steps: [{ wait_s: n }] });
const fault = (pointer: string) => ({ pointer, text: `wrong at ${pointer}`, remedy: 'mend it' });

describe('the draft', () => {
  let there: RecipeDocument | null;
  let wrong: object[];
  let status: number;
  const check = vi.fn(async () => (wrong.length > 0 ? Promise.reject(new Problem('answered', 'faults', 422, { faults: wrong as never })) : {}));
  const client = {
    checkRecipe: check,
    whole: vi.fn(async (_path: string, o: { method?: string; body?: object } = {}) => {
      if (o.method === undefined && !there) throw new Problem('answered', 'none', 404);
      if (o.method && status !== 200) throw new Problem('answered', 'it is refused', status, { faults: wrong as never });
      if (o.method) there = o.method === 'DELETE' ? null : (o.body as RecipeDocument);
      return { status: 200, head: new Headers(), text: JSON.stringify(there) };
    }),
  };
  let draft: RecipeDraft;
  beforeEach(async () => {
    vi.useFakeTimers();
    [there, wrong, status] = [document(1), [], 200];
    check.mockClear();
    draft = new RecipeDraft(client as never, 'r', () => ['feeder']);
    await draft.load();
  });
  afterEach(() => void vi.useRealTimers());

  it('is read once: what is typed stands against that state', async () => {
    draft.put(document(2));
    expect(draft.unsaved.value).toBe(true);
    await draft.load();
    expect(draft.document.value).toEqual(document(2));
  });
  it('has the last text that was JSON in its forms, and says what is none', () => {
    draft.type('{"steps": [{"wait_s": 3}]}');
    expect([draft.document.value, draft.textFault.value]).toEqual([{ steps: [{ wait_s: 3 }] }, '']);
    draft.type('{"steps": [');
    expect([draft.document.value, draft.text.value]).toEqual([{ steps: [{ wait_s: 3 }] }, '{"steps": [']);
    expect(draft.textFault.value).not.toBe('');
  });
  it('is checked shortly after the last change, unless it is no JSON, has no step, or is over', async () => {
    wrong = [fault('/steps/0')];
    draft.checkSoon()!();
    draft.checkSoon();
    await vi.advanceTimersByTimeAsync(300);
    expect([check.mock.calls.length, draft.faults.value]).toEqual([1, wrong]);
    draft.type('{');
    expect(draft.checkSoon()).toBeUndefined();
    draft.put({ steps: [] });
    expect(draft.checkSoon()).toBeUndefined();
  });
  it('is saved with what was typed until then; an axis that is not there is said', async () => {
    draft.put({ steps: [{ enable: { axis: 'nobody' } }] });
    const saved = draft.save();
    draft.put(document(5));
    await saved;
    expect([draft.result.value.tone, draft.unsaved.value, there?.steps[0]]).toEqual(['partly', true, { enable: { axis: 'nobody' } }]);
    await draft.save();
    expect([draft.result.value, draft.unsaved.value]).toEqual([{ tone: 'good', text: 'Saved.' }, false]);
  });
  it('refused keeps what was typed, with the faults', async () => {
    [status, wrong] = [422, [fault('/steps/0')]];
    draft.put(document(7));
    await draft.save();
    expect([draft.result.value.tone, draft.faults.value, draft.document.value, draft.unsaved.value]).toEqual(['refused', wrong, document(7), true]);
    expect(await draft.remove()).toBe(false);
  });
  it('goes on from what somebody else has made of it, when that is chosen', async () => {
    status = 412;
    there = document(9);
    draft.put(document(2));
    await draft.save();
    expect([draft.clash.value?.act, draft.clash.value?.now, draft.document.value]).toEqual(['save', document(9), document(2)]);
    draft.adopt();
    expect([draft.clash.value, draft.document.value, draft.unsaved.value]).toEqual([null, document(9), false]);
  });
});

describe('its runs', () => {
  const report = (n: number, state: string, recipe = 'r') => ({ n, state, recipe }) as RecipeReport;
  const client = {
    recipeRuns: vi.fn(async () => [{ n: 4, state: 'done' }]),
    recipeRun: vi.fn(async (_name: string, n: number) => report(n, 'done')),
    checkRun: vi.fn(async () => ({ steps: 2, axes: ['feeder'] })),
    runRecipe: vi.fn(async () => report(5, 'running')),
    cancelRun: vi.fn(async () => Promise.reject(new Problem('answered', 'it is over', 409))),
  };
  let runs: RecipeRuns;
  beforeEach(() => {
    vi.clearAllMocks();
    runs = new RecipeRuns(client as never, 'r', () => ({ n: { type: 'number' }, axis: { type: 'axis' } }), (a) => `${a}!`);
  });
  it('show the newest; of what is under way what became of it while nobody told', async () => {
    await runs.load();
    expect(runs.report.value).toMatchObject({ n: 4 });
    await runs.load();
    expect(client.recipeRun).toHaveBeenCalledTimes(1); // it is over: nothing new can be told of it
    runs.heard(report(5, 'running'));
    await runs.load();
    expect(runs.report.value).toEqual(report(5, 'done'));
  });
  it('begin with what is typed; "has begun" is no news when it has ended, even before it was answered', async () => {
    runs.typed.value = { n: '2.5', axis: 'feeder', other: 'x' };
    await runs.start(false);
    expect(client.runRecipe).toHaveBeenCalledWith('r', { n: 2.5, axis: 'feeder' });
    expect(runs.result.value.text).toBe('Run 5 has begun.');
    runs.heard(report(5, 'done'));
    expect(runs.result.value.text).toBe('');
    client.runRecipe.mockImplementationOnce(async () => {
      runs.heard(report(6, 'done'));
      return report(6, 'running');
    });
    await runs.start(false);
    expect([runs.report.value?.state, runs.result.value]).toEqual(['done', { tone: 'good', text: '' }]);
  });
  it('can be checked alone, and a cancel that is refused says why; other recipes are none of theirs', async () => {
    await runs.start(true);
    expect(runs.result.value).toEqual({ tone: 'good', text: 'Can run: 2 steps, commands feeder!.' });
    await runs.cancel(1);
    expect(runs.result.value).toEqual({ tone: 'refused', text: 'It is over' });
    runs.heard(report(8, 'running', 'other'));
    expect(runs.report.value).toBeNull();
  });
});

describe('the text of a recipe', () => {
  const d: RecipeDocument = { parameters: { n: { type: 'number' } }, steps: [{ repeat: { times: 2, steps: [{ wait_s: 1 }] } }, { wait_s: 1 }] };
  it('leaves to its default what is not typed', () => expect(argumentsOf({ a: { type: 'text' }, b: { type: 'number' } }, { a: '5', b: '' })).toEqual({ a: '5' }));
  it('knows the places of all its steps', () => expect(placesOf(d, ['steps'])).toEqual(['/steps/0', '/steps/0/repeat/steps/0', '/steps/1']));
  it('has each fault at its step, at its parameter, or at neither', () => {
    const faults = [fault('/steps/0/repeat/times'), fault('/steps/0/repeat/steps/0'), fault('/steps/10'), fault('/parameters/n/type'), fault('/parameters/nn'), fault('/timeout_s')];
    const at = faultsOfStep(faults, '/steps/0', kindOf(d.steps[0]!));
    expect([at.mine.map((f) => f.pointer), at.any]).toEqual([['/steps/0/repeat/times'], true]);
    expect(faultsOfStep(faults, '/steps/1', kindOf(d.steps[1]!))).toEqual({ mine: [], any: false });
    expect(faultsElsewhere(faults, d).map((f) => f.pointer)).toEqual(['/parameters/nn', '/timeout_s']);
  });
});
