// Recipe rehearsal: the stored recipe against many specimens of the drives: which ones, begin, progress, end, and a row for each specimen with the step at which
// it failed, the reason, and the specimen in words. In: the rehearsal, the arguments that are typed for a run. Out: requests. No machine moves.
import { Fragment } from 'preact';
import { useMemo } from 'preact/hooks';
import type { RehearsedSpecimen } from '../api/types';
import { useGateway } from '../gateway';
import { gatewayText, t } from '../language';
import { isUnderWay, RecipeRehearsing, type Words } from '../state/recipe-rehearsal';
import { useRepeated } from '../state/repeated';
import type { RecipeRuns } from '../state/recipe-runs';
import { formatNumber } from '../text/number';
import { plain } from '../text/plain';
import { argumentsOf, namesIn, type RecipeDocument } from '../text/recipe';
import { dateTime } from '../text/time';
import { TextField } from './form';
import { useBarred, Why } from './gate';
import { useLoaded } from './loaded';
import { Section } from './section';
import { TableHead } from './table-head';

const look_ms = 500;
const offers = ['1..100', '1..1000', 'slow', 'sparse', 'strict', 'chatty', 'weak', 'old'].map((value) => ({ value }));
const heads = () => [t('Specimen'), t('Result'), t('Time, s'), t('Step'), t('Reason'), t('Newest warning')];
/** Columns that have figures. */
const figures = [2];

/** The families of the axes that the recipe names itself or by an argument. */
function useFamilies(d: RecipeDocument, run: RecipeRuns): string[] {
  const { store } = useGateway();
  const named = namesIn([d.steps, run.typed.value, Object.values(d.parameters ?? {}).map((p) => p.default)]);
  const families = store.axisNames.value.filter((axis) => named.has(axis)).map((axis) => store.axis(axis)?.value.data.family ?? '');
  return [...new Set(families.filter((f) => f !== ''))];
}

export function RecipeRehearsalPart({ name, document: d, run, saved }: { name: string; document: RecipeDocument; run: RecipeRuns; saved: boolean }) {
  const { client } = useGateway();
  const rehearsing = useMemo(() => new RecipeRehearsing(client, name), [client, name]);
  const no = useBarred('operator');
  const absent = useLoaded(rehearsing.load, [rehearsing, saved], () => '');
  const r = rehearsing.report.value;
  const running = isUnderWay(r);
  useRepeated(rehearsing.look, look_ms, running, [rehearsing]);
  const families = useFamilies(d, run);
  const reported = rehearsing.reported.value;
  return (
    <Section title={t('Rehearsal against specimens')} help="specimens" fold={running ? false : (r?.total ?? 0)}>
      <div class="card form rehearsal recipe-rehearsal">
        <p class="where">
          {t('A rehearsal runs the saved recipe against many simulated drives, in virtual time. No machine moves.')}
        </p>
        <Why need="operator" what={t('Rehearsing')} />
        <div class="form-foot">
          <TextField label={t('Specimens to rehearse')} value={rehearsing.typed.value} onText={(text) => (rehearsing.typed.value = text)} offers={offers} disabled={Boolean(no.disabled) || running} />
          <button type="button" class="button" {...no} disabled={Boolean(no.disabled) || running || !saved} onClick={() => void rehearsing.start(argumentsOf(d.parameters ?? {}, run.typed.peek()))}>
            {t('Rehearse')}
          </button>
          {running && (
            <button type="button" class="button" {...no} disabled={Boolean(no.disabled) || r?.state === 'cancelling'} onClick={() => void rehearsing.cancel()}>
              {t('End the rehearsal')}
            </button>
          )}
          {running && <progress max={r?.total} value={r?.done} aria-label={t('Specimens played')} />}
        </div>
        <p class={`result result-${reported.tone}`} role="status" data-field="rehearsal-told">
          <span>{reported.text || (saved ? absent : t('Save the recipe to rehearse it.'))}</span>
        </p>
        {r && r.state !== 'none' && <Report rehearsing={rehearsing} families={families} />}
      </div>
    </Section>
  );
}

function Report({ rehearsing, families }: { rehearsing: RecipeRehearsing; families: readonly string[] }) {
  const r = rehearsing.report.value!;
  const opened = rehearsing.opened.value;
  return (
    <>
      <p data-field="rehearsal-sum" data-state={r.state} role="status">
        {isUnderWay(r) && t('{done} of {total} specimens played, {failed} failed.', { done: r.done, total: r.total, failed: r.failed })}
        {r.state === 'done' && t('{passed} of {total} specimens passed, {ended_at}, by {who}.', { passed: r.passed, total: r.total, ended_at: dateTime(r.ended_at ?? ''), who: r.who ?? '' })}
        {r.state === 'cancelled' && t('Ended after {done} of {total} specimens: {passed} passed, {failed} failed.', { done: r.done, total: r.total, passed: r.passed, failed: r.failed })}{' '}
        {r.outdated && t('The recipe or the site has changed since: rehearse again.')}
      </p>
      <div class="table-scroll" tabIndex={0} role="region" aria-label={t('Rehearsed specimens')}>
        <table class="table">
          <TableHead of={heads()} figures={figures} />
          <tbody>
            {r.specimens.map((s) => (
              <Fragment key={s.specimen}>
                <Row of={s} opened={opened === s.specimen} open={() => void rehearsing.open(s.specimen, families)} />
                {opened === s.specimen && <InWords of={rehearsing.words.value} />}
              </Fragment>
            ))}
          </tbody>
        </table>
      </div>
    </>
  );
}

function Row({ of: s, opened, open }: { of: RehearsedSpecimen; opened: boolean; open: () => void }) {
  return (
    <tr data-specimen={s.specimen} data-passed={s.passed}>
      <td>
        <button type="button" class="link" aria-expanded={opened} title={t('Specimen {specimen} in words', { specimen: s.specimen })} onClick={open}>
          {s.specimen}
        </button>
      </td>
      <td class={s.passed ? 'tone-good' : 'tone-fault'}>{s.passed ? t('passed') : t('failed')}</td>
      <td class="num mono">{formatNumber(s.seconds, 1)}</td>
      <td {...gatewayText}>{plain(s.step ?? '')}</td>
      <td {...gatewayText}>{plain(s.text ?? '')}</td>
      <td {...gatewayText}>{plain(s.event ?? '')}</td>
    </tr>
  );
}

function InWords({ of }: { of: Words }) {
  return (
    <tr data-field="specimen-words">
      <td colSpan={heads().length}>
        {of.map((one) => (
          <div key={one.family}>
            <b>{t('{family} as specimen {specimen}', { family: one.family, specimen: one.specimen })}</b>
            {one.words.length === 0 ? (
              <p class="where">{t('as its manual shows it')}</p>
            ) : (
              <ul class="where" {...gatewayText}>
                {one.words.map((w) => (
                  <li key={w}>{w}</li>
                ))}
              </ul>
            )}
          </div>
        ))}
      </td>
    </tr>
  );
}
