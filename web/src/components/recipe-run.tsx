// A run of a recipe: arguments, start, live progress, cancel, and its report. In: the recipe's parameters, reports of the stream and of REST.
// Out: requests to the gateway. What was typed stays, whatever becomes of the run. Never starts a run by itself.
import { gatewayText, t } from '../language';
import { marked } from './marked';
import { useBarred, Why } from './gate';
import { useSignal, type Signal } from '@preact/signals';
import { useEffect } from 'preact/hooks';
import type { RecipeReport, RecipeReportHead } from '../api/types';
import { useGateway } from '../gateway';
import { capital } from '../state/commander';
import { windowOf } from '../state/narrow';
import { plain } from '../text/plain';
import { doneOf, runWord, stepLabel, stepWhat, tookText, typedOf, valueOf, type Json, type RecipeDocument } from '../text/recipe';
import { clockTime, duration } from '../text/time';
import { Icon } from './icon';
import { useLoaded } from './loaded';
import { AxisName, SimulatedMark, useNamed } from './name';
import { Pill } from './pill';
import { Section } from './section';
import { refusal } from './reported';

const begun = (n: number) => t('Run {n} has begun.', { n });
const isOver = (state: string) => state !== 'running' && state !== 'stopping';

export interface Run {
  parameters: NonNullable<RecipeDocument['parameters']>;
  typed: Signal<Record<string, string>>;
  report: Signal<RecipeReport | null>;
  runs: Signal<RecipeReportHead[]>;
  result: Signal<{ tone: 'none' | 'good' | 'refused'; text: string }>;
  start: (dryRun: boolean) => Promise<void>;
  cancel: (n: number) => Promise<void>;
  look: (n: number) => void;
}

/** One recipe's runs: what is under way, those that were, and the ways to begin and to end one. */
export function useRun(name: string, parameters: NonNullable<RecipeDocument['parameters']>, typed: Signal<Record<string, string>>): Run {
  const gateway = useGateway();
  const named = useNamed();
  const { client } = gateway;
  const report: Signal<RecipeReport | null> = useSignal(null);
  const runs: Signal<RecipeReportHead[]> = useSignal([]);
  const result = useSignal<{ tone: 'none' | 'good' | 'refused'; text: string }>({ tone: 'none', text: '' });
  const refresh = () => client.recipeRuns(name).then((r) => (runs.value = r), () => undefined);

  const take = (r: RecipeReport) => {
    report.value = r;
    // "Run 1 has begun." is no news any more: its report says how it ended.
    if (isOver(r.state) && result.peek().text === begun(r.n)) result.value = { tone: 'none', text: '' };
  };

  // With each connection anew: what ended while this page was away is told by no message any more.
  useLoaded(async () => {
    const list = await client.recipeRuns(name);
    runs.value = list;
    const shown = report.peek();
    const n = shown ? (isOver(shown.state) ? null : shown.n) : list[0]?.n;
    if (n === null || n === undefined) return;
    const whole = await client.recipeRun(name, n);
    if (report.peek() === shown) take(whole);
  }, [client, name]);
  useEffect(() => {
    const end = gateway.follow('recipes', 100, (m) => {
      const r = m.data as RecipeReport;
      if (r?.recipe !== name) return;
      take(r);
      if (isOver(r.state)) void refresh();
    });
    return end;
  }, [gateway, name]);

  const given = () => {
    const out: Record<string, Json> = {};
    for (const [key, p] of Object.entries(parameters)) {
      const entered = typed.peek()[key];
      if (entered === undefined || entered === '') continue;
      out[key] = p.type === 'text' || p.type === 'axis' ? entered : (valueOf(entered) ?? entered);
    }
    return out;
  };
  const start = async (dryRun: boolean) => {
    result.value = { tone: 'none', text: dryRun ? t('Checking…') : t('Starting…') };
    try {
      if (dryRun) {
        const c = await client.checkRun(name, given());
        result.value = { tone: 'good', text: t('Can run: {steps} steps, commands {n}.', { steps: c.steps, n: c.axes?.map(named).join(', ') || t('no axis') }) };
      } else {
        const first = await client.runRecipe(name, given());
        // A short run may have ended before its beginning was answered: what the stream has told of it is newer.
        if ((report.peek()?.n ?? 0) < first.n) report.value = first;
        result.value = { tone: 'good', text: isOver(report.peek()?.state ?? '') ? '' : begun(report.peek()?.n ?? 0) };
      }
    } catch (error) {
      result.value = refusal(error);
    }
  };
  const cancel = async (n: number) => {
    try {
      await client.cancelRun(name, n);
    } catch (error) {
      result.value = refusal(error);
    }
  };
  const look = (n: number) => void client.recipeRun(name, n).then((w) => (report.value = w), () => undefined);
  return { parameters, typed, report, runs, result, start, cancel, look };
}

/** In the head of the page: what it is run with, the buttons, and how far it is. */
export function RunHead({ run, saved }: { run: Run; saved: boolean }) {
  const no = useBarred('operator');
  const { parameters, typed, result, start, cancel } = run;
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
            <button type="button" class="button primary" disabled={!saved || running} {...no} onClick={() => void start(false)}>
              <Icon name="play" />{' '}{t('Run')}
            </button>
            <button type="button" class="button" disabled={!saved || running} {...no} onClick={() => void start(true)}>
              {t('Check only')}
            </button>
            {running && (
              <button type="button" class="stop" {...no} onClick={() => void cancel(r.n)}>
                <Icon name="stop" />{' '}{t('Cancel run {n}', { n: r.n })}
              </button>
            )}
          </div>
          <p class={`result result-${result.value.tone}`} role="status">
            <span>{marked(saved ? result.value.text : t('Save the recipe to run it.'))}</span>
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

export function RunReports({ run }: { run: Run }) {
  const r = run.report.value;
  const { runs } = run;
  return (
    <>
      {r && (
        <Section title={t('Report of run {n}', { n: r.n })} id="report">
          <Report report={r} />
        </Section>
      )}
      {runs.value.length > 0 && (
        <Section title={t('Runs')} fold={runs.value.length}>
          <ol class="card run-list" aria-label={t('Runs, newest first')}>
            {runs.value.map((x) => (
              <li key={x.n} class="row">
                <div class="row-head">
                  <button type="button" class="button quiet small" onClick={() => run.look(x.n)}>
                    {t('Run {n}', { n: x.n })}
                  </button>
                  <span class="where">
                    {clockTime(x.started_at)} · {x.started_by}
                  </span>
                  <Pill word={runWord(x.state)} label={t('State')} />
                </div>
                {x.text && <p class="why" {...gatewayText}>{capital(plain(x.text))}</p>}
              </li>
            ))}
          </ol>
        </Section>
      )}
    </>
  );
}

type StepReport = RecipeReport['steps'][number];
const hasValue = (s: StepReport): boolean => s.value !== null && s.value !== undefined;
/** What a step read, wrote or looked at: a condition names what it wanted, so what there was is said as such. */
const valuePublished = (s: StepReport): string => {
  const value = typedOf(typeof s.value === 'number' ? Number(s.value.toPrecision(9)) : s.value);
  if (s.step === 'read_parameter') return `= ${value}`;
  return s.step === 'set_parameter' ? t('taken as {value}', { value }) : t('it was {value}', { value });
};

export function Report({ report: r }: { report: RecipeReport }) {
  const took = r.ended_at ? duration(Date.parse(r.ended_at) - Date.parse(r.started_at)) : '';
  return (
    <div class="card recipe-report" data-run={r.n}>
      <div class="row">
        <div class="row-head">
          <Pill word={runWord(r.state)} label={t('State of the run')} id="run-state" />
          <progress max={r.of} value={doneOf(r)} aria-label={t('Steps done')} />
          <span class="where">
            {clockTime(r.started_at)}
            {took && `, ${took}`} · {r.started_by}
          </span>
        </div>
        {r.text && (
          <p class="step-fault" data-field="run-text">
            {r.at_label || r.at_step ? `${r.at_label || r.at_step}: ` : ''}
            <span {...gatewayText}>{capital(plain(r.text))}</span>
          </p>
        )}
        {r.stops.map((s) => (
          <p key={s.axis} class="why">
            <AxisName name={s.axis} plain />: {s.left_alone ? s.text : `${s.stopped ? t('stopped') : t('NOT stopped')}${s.text && `: ${s.text}`}`}
          </p>
        ))}
      </div>
      <div class="window" {...windowOf(t('Steps of the run'))}>
        <ol class="report-steps" aria-label={t('Steps of the run')}>
          {r.steps.map((s) => {
            const word = runWord(s.state);
            return (
              <li key={s.pointer} class={`report-step tone-${word.tone}`} data-report={s.pointer} data-state={s.state}>
                <Icon name={word.icon} size={14} />
                <span class="report-word">{word.text}</span>
                <span class="report-what">
                  <b>{stepLabel(s.step)}</b> {s.axis && <SimulatedMark of={s.axis} lead="" />} <span {...gatewayText}>{plain(stepWhat(s))}</span>
                  {s.times > 1 && ` × ${s.times}`}
                  {hasValue(s) && <span class="mono" data-field="step-value">{' '}{valuePublished(s)}</span>}
                  {s.text && <span {...gatewayText}> {plain(s.text)}</span>}
                  {s.comment && <i> {s.comment}</i>}
                </span>
                <span class="report-at mono">
                  {s.started_at && (
                    <>
                      <time dateTime={s.started_at}>{clockTime(s.started_at)}</time>
                      {s.ended_at && <span data-field="step-took">{' '}{tookText(Date.parse(s.ended_at) - Date.parse(s.started_at))}</span>}
                    </>
                  )}
                </span>
              </li>
            );
          })}
        </ol>
      </div>
    </div>
  );
}
