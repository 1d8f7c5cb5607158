// A run of a recipe: arguments, start, live progress, cancel, and its report. In: the recipe's parameters, reports of the stream and of REST.
// Out: requests to the gateway. What was typed stays, whatever becomes of the run. Never starts a run by itself.
import { t } from '../language';
import { useBarred, Why } from './gate';
import { useSignal, type Signal } from '@preact/signals';
import { useEffect } from 'preact/hooks';
import { asProblem } from '../api/problem';
import type { RecipeReport, RecipeReportHead } from '../api/types';
import { useGateway } from '../gateway';
import { capital } from '../state/commander';
import { plain } from '../text/plain';
import { doneOf, runWord, stepLabel, typedOf, valueOf, type Json, type RecipeDocument } from '../text/recipe';
import { clockTime, duration } from '../text/time';
import { Icon } from './icon';
import { useLoaded } from './loaded';
import { AxisName, SimulatedMark, useNamed } from './name';
import { Pill } from './pill';
import { Section } from './section';

const begun = (n: number) => t('Run {n} has begun.', { n });
const isOver = (state: string) => state !== 'running' && state !== 'stopping';

export function RunSection({ name, parameters, saved, typed }: { name: string; parameters: NonNullable<RecipeDocument['parameters']>; saved: boolean; typed: Signal<Record<string, string>> }) {
  const gateway = useGateway();
  const no = useBarred('operator');
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
        report.value = await client.runRecipe(name, given());
        result.value = { tone: 'good', text: isOver(report.peek()?.state ?? '') ? '' : begun(report.peek()?.n ?? 0) };
      }
    } catch (error) {
      result.value = { tone: 'refused', text: capital(asProblem(error).words) };
    }
  };
  const cancel = async (n: number) => {
    try {
      await client.cancelRun(name, n);
    } catch (error) {
      result.value = { tone: 'refused', text: capital(asProblem(error).words) };
    }
  };
  const r = report.value;
  const running = r !== null && !isOver(r.state);
  return (
    <>
      <Section title={t('Run')}>
        <div class="card recipe-run">
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
                  placeholder={p.default === undefined ? 'needed' : typedOf(p.default)}
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
            <span>{saved ? result.value.text : t('Save the recipe to run it.')}</span>
          </p>
        </div>
      </Section>
      {r && (
        <Section title={t('Report of run {n}', { n: r.n })}>
          <Report report={r} />
        </Section>
      )}
      {runs.value.length > 0 && (
        <Section title={t('Runs')}>
          <ol class="card run-list" aria-label={t('Runs, newest first')}>
            {runs.value.map((x) => (
              <li key={x.n} class="row">
                <div class="row-head">
                  <button type="button" class="button quiet small" onClick={() => void client.recipeRun(name, x.n).then((w) => (report.value = w), () => undefined)}>
                    {t('Run {n}', { n: x.n })}
                  </button>
                  <span class="where">
                    {clockTime(x.started_at)} · {x.started_by}
                  </span>
                  <Pill word={runWord(x.state)} label={t('State')} />
                </div>
                {x.text && <p class="why">{capital(plain(x.text))}</p>}
              </li>
            ))}
          </ol>
        </Section>
      )}
    </>
  );
}

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
            {capital(plain(r.text))}
          </p>
        )}
        {r.stops.map((s) => (
          <p key={s.axis} class="why">
            <AxisName name={s.axis} plain />: {s.left_alone ? s.text : `${s.stopped ? t('stopped') : t('NOT stopped')}${s.text && `: ${s.text}`}`}
          </p>
        ))}
      </div>
      <ol class="report-steps" aria-label={t('Steps of the run')}>
        {r.steps.map((s) => {
          const word = runWord(s.state);
          return (
            <li key={s.pointer} class={`report-step tone-${word.tone}`} data-report={s.pointer} data-state={s.state}>
              <Icon name={word.icon} size={14} />
              <span class="report-word">{word.text}</span>
              <span class="report-what">
                <b>{stepLabel(s.step)}</b> {s.axis && <AxisName name={s.axis} plain />}
                {s.times > 1 && ` × ${s.times}`}
                {s.value !== null && s.value !== undefined && <span class="mono"> = {typedOf(typeof s.value === 'number' ? Number(s.value.toPrecision(9)) : s.value)}</span>}
                {s.text && <span> {plain(s.text)}</span>}
                {s.comment && <i> {s.comment}</i>}
              </span>
              <span class="report-at mono">{s.pointer}</span>
            </li>
          );
        })}
      </ol>
    </div>
  );
}
