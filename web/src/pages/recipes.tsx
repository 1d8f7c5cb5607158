// Recipes: the list of them, and the name of a new one. In: the gateway's list, with each change that it tells of. Out: a page.
import { useSignal, type Signal } from '@preact/signals';
import { useEffect } from 'preact/hooks';
import type { RecipeEntry } from '../api/types';
import { useBarred, Why } from '../components/gate';
import { Empty } from '../components/lines';
import { useLoaded } from '../components/loaded';
import { marked } from '../components/marked';
import { Pill } from '../components/pill';
import { Section } from '../components/section';
import { useGateway } from '../gateway';
import { t } from '../language';
import { go, recipePath } from '../router';
import { runWord } from '../text/recipe';
import { clockTime } from '../text/time';

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
