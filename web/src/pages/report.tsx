// Commissioning report: one document to print and sign: the site and its wiring, parameters beside snapshot and default, the register list with its
// hash, captured curves, the fail-safe rehearsal with its times, versions, who and when. In: the gateway's documents, read once when the page is
// opened and again by the button. Out: a page that the browser prints or saves as PDF. A drive is read for it only when a button says so.
import { useSignal } from '@preact/signals';
import { useEffect, useRef } from 'preact/hooks';
import { TextField } from '../components/form';
import { useLoaded } from '../components/loaded';
import { marked } from '../components/marked';
import { ReportSite } from '../components/report-site';
import { Fact } from '../components/report-table';
import { ReportCurves, ReportLoss, ReportParameters, ReportRegisters } from '../components/report-values';
import { useGateway } from '../gateway';
import { t } from '../language';
import { persisted } from '../state/persisted';
import { readMissing } from '../state/read-missing';
import { readReport, type WholeReport } from '../state/report';
import { dateTime } from '../text/time';

const fields = { machine: persisted('report.machine', '', 'browser'), place: persisted('report.place', '', 'browser'), who: persisted('report.who', '', 'browser'), notes: persisted('report.notes', '', 'browser') };

export function ReportPage() {
  const { client, store } = useGateway();
  const whole = useSignal<WholeReport | null>(null);
  const times = useSignal(0);
  const names = store.axisNames.value;
  const why = useLoaded(async () => void (whole.value = await readReport(client, names)), [client, times.value, names.join()]);
  /** How far it is; empty: nothing is being read. */
  const reading = useSignal('');
  const end = useRef<AbortController | null>(null);
  useEffect(() => () => end.current?.abort(), []);
  const readAll = async () => {
    const { signal } = (end.current = new AbortController());
    for (const of of names) {
      await readMissing(client, of, signal, (done, n) => (reading.value = t('Reading {of}: {done} of {n} …', { of, done, n }))).catch(() => undefined);
      if (signal.aborted) break;
    }
    reading.value = '';
    times.value += 1;
  };
  const w = whole.value;
  const missing = w?.axes.reduce((sum, a) => sum + a.report.unknown, 0) ?? 0;
  return (
    <main class="page report-page">
      <h1 tabIndex={-1}>{t('Commissioning report')}</h1>
      <div class="card form form-grid report-form">
        <TextField label={t('Machine')} value={fields.machine.value} onText={(entered) => (fields.machine.value = entered)} />
        <TextField label={t('Place')} value={fields.place.value} onText={(entered) => (fields.place.value = entered)} />
        <TextField label={t('Commissioned by')} value={fields.who.value} onText={(entered) => (fields.who.value = entered)} />
        <TextField label={t('Remarks')} value={fields.notes.value} onText={(entered) => (fields.notes.value = entered)} />
        <div class="form-foot">
          <button type="button" class="button primary" disabled={!w} onClick={() => print()}>
            {t('Print')}
          </button>
          <button type="button" class="button" onClick={() => (times.value += 1)}>
            {t('Read it again')}
          </button>
          {reading.value ? (
            <button type="button" class="button" onClick={() => end.current?.abort()}>
              {t('End reading')}
            </button>
          ) : (
            <button type="button" class="button" disabled={missing === 0} onClick={() => void readAll()}>
              {t('Read what is missing')}
            </button>
          )}
          <span class="where" role="status" data-field="report-read">
            {reading.value || (missing === 0 ? t('Values are those that the gateway knows.') : t('Values are those that the gateway knows; {n} are not read yet.', { n: missing }))}
          </span>
        </div>
      </div>
      {!w && <p class="where" role="status">{marked(why)}</p>}
      {w && (
        <article class="report" data-field="report">
          <Facts at={w.at} />
          <ReportSite whole={w} names={names} />
          <ReportParameters whole={w} />
          <ReportRegisters whole={w} names={names} />
          <ReportCurves whole={w} />
          <ReportLoss whole={w} />
          <h2>{t('Signatures')}</h2>
          <div class="report-signatures">
            {[t('Commissioned by, date'), t('Checked by, date'), t('Taken over by, date')].map((text) => (
              <p key={text}>
                <span />
                {text}
              </p>
            ))}
          </div>
        </article>
      )}
    </main>
  );
}

function Facts({ at }: { at: string }) {
  const { store } = useGateway();
  const about = store.about.value;
  return (
    <dl class="report-facts">
      <Fact name={t('Machine')} value={fields.machine.value} />
      <Fact name={t('Place')} value={fields.place.value} />
      <Fact name={t('Commissioned by')} value={fields.who.value} />
      <Fact name={t('Date')} value={dateTime(at)} />
      <Fact name="axisgate" value={t('{n}, page and API of the same program', { n: about?.version ?? '–' })} />
      <Fact name={t('Revision of the site')} value={String(store.siteRevision.value ?? '–')} />
      <Fact name={t('Doors')} value={about?.doors.map((d) => `${d.name} ${d.address}`).join(', ') ?? '–'} />
      <Fact name={t('Remarks')} value={fields.notes.value} />
    </dl>
  );
}
