// Recipes: the list, and one recipe: forms and JSON side by side, checked by the gateway as it is typed; below it its runs.
// In: the documents of the gateway. Out: changed documents, only when they are saved. The forms always show the last text that was JSON.
import { gatewayText, t } from '../language';
import { marked } from '../components/marked';
import { DeleteButton } from '../components/ask';
import { Gate, useBarred, Why } from '../components/gate';
import { useSignal, type Signal } from '@preact/signals';
import { useEffect, useMemo } from 'preact/hooks';
import { Problem } from '../api/problem';
import type { RecipeEntry } from '../api/types';
import { Empty } from '../components/lines';
import { useLoaded } from '../components/loaded';
import { Pill } from '../components/pill';
import { RecordPart } from '../components/recipe-record';
import { RunHead, RunReports, useRun } from '../components/recipe-run';
import { StepEditor, type Fault } from '../components/recipe-steps';
import { RecipeParameters } from '../components/recipe-parameters';
import { Section } from '../components/section';
import { Typed } from '../components/typed';
import { useGateway } from '../gateway';
import { go, recipePath } from '../router';
import { capital } from '../state/commander';
import { RecipeFile, type RecipeClash } from '../state/recipe-file';
import { axisMeant, documentOf, recipeDifferences, runWord, unknownAxes, unknownText, valueOf, type RecipeDocument } from '../text/recipe';
import { unitOf } from '../text/axis';
import { clockTime } from '../text/time';

const checkAfter_ms = 300;
const goodName = /^[A-Za-z0-9_.-]{1,64}$/;

export function RecipesPage() {
  const gateway = useGateway();
  const no = useBarred('engineer');
  const list: Signal<RecipeEntry[] | null> = useSignal(null);
  const fault = useSignal('');
  const name = useSignal('');
  const changes = useSignal(0);
  const why = useLoaded(async () => void (list.value = await gateway.client.recipes()), [changes.value]);
  useEffect(() => {
    let last = '';
    const noRuns = gateway.follow('recipes', 500, (m) => {
      const r = m.data as { recipe: string; state: string; n: number };
      const now = `${r?.recipe} ${r?.n} ${r?.state}`;
      if (now !== last) changes.value += 1;
      last = now;
    });
    // Made, changed, deleted: by this page or by anybody else.
    const noEvents = gateway.store.onEvent((e) => {
      if (e.kind === 'recipe') changes.value += 1;
    });
    return () => {
      noRuns();
      noEvents();
    };
  }, [gateway]);
  const make = () => {
    const n = name.peek().trim();
    if (!goodName.test(n)) fault.value = t('A name has 1 to 64 letters, digits, - _ .');
    else go(recipePath(n));
  };
  return (
    <main class="page narrow">
      <h1 tabIndex={-1}>{t('Recipes')}</h1>
      <p class="where">{t('Named sequences of steps: set parameters, move, wait, check, repeat. Each can be run from here or by one request.')}</p>
      <Section title={t('All recipes')}>
        <div class="card">
          {why && <Empty text={why} />}
          {list.value?.length === 0 && <Empty text={t('There is no recipe yet. Give the first one a name.')} />}
          <ul aria-label={t('Recipes')}>
            {(list.value ?? []).map((r) => (
              <li key={r.name} class="row" data-recipe={r.name}>
                <div class="row-head">
                  <h3>
                    <a href={recipePath(r.name)}>{r.name}</a>
                  </h3>
                  {r.running !== null && <Pill word={runWord('running')} label={t('State')} />}
                  <span class="where">
                    {t('{steps} steps · {changed_at}', { steps: r.steps, changed_at: clockTime(r.changed_at) })}
                  </span>
                </div>
                {r.description && <p class="why">{r.description}</p>}
              </li>
            ))}
          </ul>
        </div>
      </Section>
      <Why need="engineer" what={t('Making a recipe')} />
      <form
        class="recipe-buttons"
        onSubmit={(e) => {
          e.preventDefault();
          make();
        }}
      >
        <input class="search" type="text" aria-label={t('Name of the new recipe')} placeholder={t('name')} autocomplete="off" spellcheck={false} value={name.value} onInput={(e) => (name.value = e.currentTarget.value)} />
        <button type="submit" class="button primary" {...no}>
          {t('New recipe')}
        </button>
      </form>
      <p class="result result-refused" role="status">
        <span>{marked(fault.value)}</span>
      </p>
    </main>
  );
}

const textOf = (d: RecipeDocument) => JSON.stringify(d, null, 2);

export function RecipePage({ name }: { name: string }) {
  const gateway = useGateway();
  const no = useBarred('engineer');
  const { client, store } = gateway;
  const text = useSignal('');
  const document = useSignal<RecipeDocument | null>(null);
  const textFault = useSignal('');
  const faults: Signal<Fault[]> = useSignal([]);
  const stored = useSignal('');
  const result = useSignal<{ tone: 'none' | 'good' | 'partly' | 'refused'; text: string }>({ tone: 'none', text: '' });
  const file = useMemo(() => new RecipeFile(client, name), [client, name]);
  const clash: Signal<(RecipeClash & { act: 'save' | 'remove' }) | null> = useSignal(null);
  const put = (d: RecipeDocument) => {
    document.value = d;
    text.value = textOf(d);
    textFault.value = '';
  };
  const why = useLoaded(async () => {
    // Once only: after that, what is typed stands against the state that was read, and the gateway tells whether it still is the one.
    if (document.peek()) return;
    const d = await file.read();
    put(d ?? { description: '', steps: [] });
    if (d) stored.value = text.peek();
  }, [file]);

  // The gateway says what is wrong, shortly after the last change.
  const present = text.value;
  useEffect(() => {
    const d = document.peek();
    if (!d || d.steps.length === 0 || textFault.peek() || no.disabled) return;
    let here = true;
    const timer = setTimeout(() => {
      client.checkRecipe(name, d).then(
        () => here && (faults.value = []),
        (e) => here && (faults.value = e instanceof Problem ? ((e.document.faults ?? []) as Fault[]) : []),
      );
    }, checkAfter_ms);
    return () => {
      here = false;
      clearTimeout(timer);
    };
  }, [present, no.disabled]);

  const save = async () => {
    const d = document.peek();
    if (!d || textFault.peek()) return;
    const sent = text.peek();
    const outcome = await file.save(d);
    clash.value = outcome.good || !outcome.clash ? null : { ...outcome.clash, act: 'save' };
    if (outcome.good) {
      stored.value = sent;
      faults.value = [];
      const nobody = store.listed.peek() ? unknownAxes(d, store.axisNames.peek()) : [];
      result.value = nobody.length > 0 ? { tone: 'partly', text: t('Saved. But {nobody}', { nobody: unknownText(nobody) }) } : { tone: 'good', text: t('Saved.') };
    } else if (!outcome.clash) {
      faults.value = (outcome.problem.document.faults ?? []) as Fault[];
      result.value = { tone: 'refused', text: capital(outcome.problem.text) };
    }
  };
  /** Goes on from what somebody else has made of it. */
  const adopt = () => {
    const now = clash.peek()?.now ?? null;
    clash.value = null;
    put(now ?? { description: '', steps: [] });
    stored.value = now ? text.peek() : '';
    result.value = { tone: 'none', text: t('In view is what the gateway has now.') };
  };
  const remove = async () => {
    const outcome = file.there ? await file.remove() : ({ good: true } as const);
    if (outcome.good) return go('/recipes');
    clash.value = outcome.clash ? { ...outcome.clash, act: 'remove' } : null;
    result.value = { tone: 'refused', text: capital(outcome.problem.text) };
  };
  const d = document.value;
  const given: Signal<Record<string, string>> = useSignal({});
  const run = useRun(name, d?.parameters ?? {}, given);
  const unitMeant = (named: string) => {
    const axis = axisMeant(named, d?.parameters, given.value);
    const entry = axis === null ? undefined : store.axis(axis);
    return entry ? unitOf(entry.peek().data) : null;
  };
  const unsaved = d !== null && text.value !== stored.value;
  return (
    <main class="page">
      <p class="crumbs">
        <a href="/recipes">{t('Recipes')}</a>
      </p>
      <h1 tabIndex={-1}>{name}</h1>
      {!d && why && <Empty text={why} />}
      {d && (
        <>
          <Gate need="engineer">
            <div class="recipe-bar">
              <Typed
                class="recipe-description"
                aria-label={t('Description')}
                placeholder={t('What it does')}
                value={typeof d.description === 'string' ? d.description : ''}
                onDone={(entered) => put({ ...d, description: entered })}
              />
              <label class="select">
                {t('If it fails')}
                <select aria-label={t('If it fails')} value={d.on_failure ?? 'halt'} onChange={(e) => put({ ...d, on_failure: e.currentTarget.value as 'halt' | 'quick_stop' })}>
                  <option value="halt">{t('halt its axes')}</option>
                  <option value="quick_stop">{t('quick stop its axes')}</option>
                </select>
              </label>
              <label class="select">
                {t('At most, s')}
                <Typed
                  class="recipe-limit"
                  inputMode="decimal"
                  aria-label={t('Longest time of a run, s')}
                  placeholder="3600"
                  value={typeof d.timeout_s === 'number' ? String(d.timeout_s) : ''}
                  onDone={(entered) => {
                    const { timeout_s: _, ...rest } = d;
                    const typed = valueOf(entered);
                    put(typed === undefined ? { ...rest } : ({ ...rest, timeout_s: typed } as RecipeDocument));
                  }}
                />
              </label>
              <button type="button" class="button primary" disabled={!unsaved || textFault.value !== '' || clash.value !== null} {...no} onClick={() => void save()}>
                {t('Save')}
              </button>
              <DeleteButton name={name} class="" no={no} onYes={() => void remove()} />
            </div>
          </Gate>
          <p class={`result result-${result.value.tone}`} role="status">
            <span>{clash.value ? t('{text} What you typed is kept.', { text: clash.value.text }) : unsaved && result.value.tone !== 'refused' ? t('Not saved yet.') : marked(result.value.text)}</span>
          </p>
          {clash.value && (
            <div class="theirs card form" role="group" aria-label={t('Somebody else\'s change')} data-field="recipe-clash">
              <p class="where">{t('From what the gateway has now to what you typed:')}</p>
              <ul class="differences" aria-label={t('What differs')}>
                {recipeDifferences(clash.value.now ?? {}, d)
                  .slice(0, 50)
                  .map((entered) => (
                    <li key={entered} class="mono">
                      {entered}
                    </li>
                  ))}
              </ul>
              <div class="form-foot">
                <button type="button" class="button" {...no} onClick={() => void (clash.value?.act === 'remove' ? remove() : save())}>
                  {clash.value.act === 'remove' ? t('Delete it all the same') : t('Save mine all the same')}
                </button>
                <button type="button" class="button" onClick={adopt}>
                  {t('Take theirs')}
                </button>
              </div>
            </div>
          )}
          <RunHead run={run} saved={!unsaved && stored.value !== ''} />
          <div class="recipe-sides">
            <Gate need="engineer" silent>
              <div>
                <Section title={t('Parameters')} fold={!faults.value.some((f) => f.pointer.startsWith('/parameters/')) && Object.keys(d.parameters ?? {}).length}>
                  <div class="card recipe-card">
                    <RecipeParameters document={d} change={put} faults={faults.value} />
                  </div>
                </Section>
                <Section title={t('Steps')}>
                  <div class="card recipe-card">
                    <RecordPart recipe={name} persisted={!unsaved || d.steps.length === 0} add={(steps) => put({ ...d, steps: [...d.steps, ...steps] })} />
                    <StepEditor document={d} change={put} axes={store.axisNames.value} listed={store.listed.value} unitOf={unitMeant} faults={faults.value} />
                    {faults.value
                      .filter((f) => !f.pointer.startsWith('/steps/') && !Object.keys(d.parameters ?? {}).some((p) => f.pointer === `/parameters/${p}` || f.pointer.startsWith(`/parameters/${p}/`)))
                      .map((f) => (
                        <p key={f.pointer + f.text} class="step-fault" {...gatewayText}>
                          {f.pointer}: {f.text}. {f.remedy}.
                        </p>
                      ))}
                  </div>
                </Section>
              </div>
            </Gate>
            <Section title={t('JSON')} fold={textFault.value === ''}>
              <div class="card recipe-card">
                <textarea
                  class="recipe-json mono"
                  aria-label={t('The recipe as JSON')}
                  aria-invalid={textFault.value !== '' || undefined}
                  spellcheck={false}
                  readOnly={no.disabled ?? false}
                  value={text.value}
                  onInput={(e) => {
                    const typed = e.currentTarget.value;
                    const read = documentOf(typed);
                    if ('document' in read) document.value = read.document;
                    textFault.value = 'fault' in read ? read.fault : '';
                    text.value = typed;
                  }}
                />
                <p class="step-fault" role="status">
                  {textFault.value || (faults.value.length > 0 ? (faults.value.length === 1 ? t('1 place is not right yet.') : t('{n} places are not right yet.', { n: faults.value.length })) : '')}
                </p>
              </div>
            </Section>
          </div>
          <RunReports run={run} />
        </>
      )}
    </main>
  );
}
