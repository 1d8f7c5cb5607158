// Recipe report: how a run of a recipe went, step by step, and the list of those that were. In: the runs. Out: a report of the one that is looked at; another one
// when it is pressed. Nothing is commanded from here.
import type { RecipeReport } from '../api/types';
import { gatewayText, t } from '../language';
import { capital } from '../state/commander';
import { windowOf } from '../state/narrow';
import type { RecipeRuns } from '../state/recipe-runs';
import { plain } from '../text/plain';
import { doneOf, runWord, stepLabel, stepWhat, tookText, typedOf } from '../text/recipe';
import { clockTime, duration } from '../text/time';
import { Icon } from './icon';
import { AxisName, SimulatedMark } from './name';
import { Pill } from './pill';
import { Section } from './section';

export function RunReports({ run }: { run: RecipeRuns }) {
  const r = run.report.value;
  const runs = run.runs.value;
  return (
    <>
      {r && (
        <Section title={t('Report of run {n}', { n: r.n })} id="report">
          <Report report={r} />
        </Section>
      )}
      {runs.length > 0 && (
        <Section title={t('Runs')} fold={runs.length}>
          <ol class="card run-list" aria-label={t('Runs, newest first')}>
            {runs.map((x) => (
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

function Report({ report: r }: { report: RecipeReport }) {
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
