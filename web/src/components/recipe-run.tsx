// A run of a recipe: arguments, start, live progress, cancel, and its report. In: the recipe's parameters, reports of the stream and of REST.
// Out: requests to the gateway. What was typed stays, whatever becomes of the run. Never starts a run by itself.
import { useEffect, useMemo, useRef } from 'preact/hooks';
import type { RecipeReport } from '../api/types';
import { useGateway } from '../gateway';
import { t } from '../language';
import { RecipeRuns } from '../state/recipe-runs';
import { plain } from '../text/plain';
import { doneOf, isOver, runWord, typedOf, type RecipeDocument } from '../text/recipe';
import { clockTime } from '../text/time';
import { useBarred, Why } from './gate';
import { Icon } from './icon';
import { useLoaded } from './loaded';
import { marked } from './marked';
import { SimulatedMark, useNamed } from './name';
import { Pill } from './pill';

type Parameters = NonNullable<RecipeDocument['parameters']>;

export function useRuns(name: string, parameters: Parameters): RecipeRuns {
  const gateway = useGateway();
  const { client } = gateway;
  const named = useNamed();
  const now = useRef(parameters);
  now.current = parameters;
  const runs = useMemo(() => new RecipeRuns(client, name, () => now.current, named), [client, name]);
  useLoaded(runs.load, [runs]);
  useEffect(() => gateway.follow('recipes', 100, (m) => runs.heard(m.data as RecipeReport)), [gateway, runs]);
  return runs;
}

/** In the head of the page: what it is run with, the buttons, and how far it is. */
export function RunHead({ run, parameters, saved }: { run: RecipeRuns; parameters: Parameters; saved: boolean }) {
  const no = useBarred('operator');
  const { typed } = run;
  const result = run.result.value;
  const r = run.report.value;
  const running = r !== null && !isOver(r.state);
  return (
    <section class="card recipe-run" aria-label={t('Run')}>
      <Why need="operator" what={t('Running and cancelling')} />
      <div class="step-fields">
        {Object.entries(parameters).map(([key, p]) => (
          <label class="step-field" key={key}>
            <span>
              {key}
              {p.unit ? `, ${p.unit}` : ''}
            </span>
            {p.type === 'axis' && <SimulatedMark of={typed.value[key] || String(p.default ?? '')} />}
            <input
              type="text"
              autocomplete="off"
              spellcheck={false}
              aria-label={t('Argument {key}', { key })}
              title={p.description}
              list={p.type === 'axis' ? 'recipe-axes' : undefined}
              placeholder={p.default === undefined ? t('needed') : typedOf(p.default)}
              value={typed.value[key] ?? ''}
              onInput={(e) => (typed.value = { ...typed.peek(), [key]: e.currentTarget.value })}
            />
          </label>
        ))}
      </div>
      <div class="recipe-buttons">
        <button type="button" class="button primary" disabled={!saved || running} {...no} onClick={() => void run.start(false)}>
          <Icon name="play" />{' '}{t('Run')}
        </button>
        <button type="button" class="button" disabled={!saved || running} {...no} onClick={() => void run.start(true)}>
          {t('Check only')}
        </button>
        {running && (
          <button type="button" class="stop" {...no} onClick={() => void run.cancel(r.n)}>
            <Icon name="stop" />{' '}{t('Cancel run {n}', { n: r.n })}
          </button>
        )}
      </div>
      <p class={`result result-${result.tone}`} role="status">
        <span>{marked(saved ? result.text : t('Save the recipe to run it.'))}</span>
      </p>
      {r && (
        <p class="run-now where" data-field="run-now">
          <Pill word={runWord(r.state)} label={t('State of the newest run')} />
          {running && <progress max={r.of} value={doneOf(r)} aria-label={t('Steps done')} />}
          <span>{running && r.at_label ? plain(r.at_label) : t('Run {n}, {at}', { n: r.n, at: clockTime(r.started_at) })}</span>
          <a href="#report">{t('To its report')}</a>
        </p>
      )}
    </section>
  );
}
