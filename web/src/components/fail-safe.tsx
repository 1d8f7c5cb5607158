// Fail-safe: what happens to each axis when who commands it is lost, by cause; and the rehearsal on models, with its report. In: the HTTP door.
// Out: a section. One change at a time, in force at once. Never moves anything: the rehearsal plays on models of the drives.
import { midSentence, t } from '../language';
import { marked } from './marked';
import { useSignal } from '@preact/signals';
import { FailSafeDoor, type Cell, type Choice as Wish, type FailSafeRow, type Matrix, type Rehearsal, type Step } from '../api/fail-safe';
import { useDoor, useGateway } from '../gateway';
import { useRepeated } from '../state/repeated';
import { quiet, refusal, tellOf, type Reported } from '../state/reported';
import { actionChoices, causeHint, causeText, cellHeads, cellRow, changed, failSafeHint, limitsText, namedText, readWatchdog, steps, watchdogText } from '../text/fail-safe';
import { dateTime } from '../text/time';
import { Choice, notOffered, Tell, TextField } from './form';
import { useBarred } from './gate';
import { useLoaded } from './loaded';
import { Section } from './section';
import { TableHead } from './table-head';

const look_ms = 1_000;

/** The report alone on paper; the mark goes when the browser has done. */
function printReport() {
  const root = document.documentElement;
  addEventListener('afterprint', () => delete root.dataset.print, { once: true });
  root.dataset.print = 'rehearsal';
  print();
}

export function FailSafe({ revision }: { revision: unknown }) {
  const door = useDoor(FailSafeDoor);
  const matrix = useSignal<Matrix | null>(null);
  const reported = useSignal<Reported>(quiet);
  const no = useBarred('engineer');
  const load = async () => void (matrix.value = await door.matrix());
  const why = useLoaded(load, [door, revision], (p) => (p.status === 404 ? notOffered(t('fail-safe actions')) : p.text));
  if (!matrix.value) return why ? <Section title={t('Loss of command')}>{<p class="where">{marked(why)}</p>}</Section> : null;
  const { causes, axes } = matrix.value;
  const put = (row: FailSafeRow, choice: Wish, what: string) => tellOf(reported, t('Changing …'), () => door.put(row.axis, choice).then(load), t('{axis}: {what} is in force as chosen.', { axis: row.axis, what }));
  return (
    <Section title={t('Loss of command')} class="fail-safe" id="fail-safe" help="fail-safe">
      <p class="where">
        {t('What the gateway does to an axis when its controller, scanner or script is gone: {rule}. A drive that cannot be reached, and a gateway without supply, need the drive\'s own watchdog and the safety circuit.', { rule: failSafeHint })}
      </p>
      <Tell reported={reported.value} field="fail-safe-told" />
      {axes.map((row) => (
        <details key={row.axis} class="card profile" data-fail-safe={row.axis}>
          <summary>
            <strong>{row.axis}</strong>: {namedText(row)}
            {row.last_cause && <span class="where">{' '}{t('stopped last: {n}', { n: midSentence(causeText(row.last_cause)) })}</span>}
          </summary>
          <div class="form-grid">
            {causes.map((c) => (
              <Choice key={c.cause} label={causeText(c.cause)} value={row.fail_safe[c.cause] ?? ''} choices={actionChoices(c)} disabled={Boolean(no.disabled)} onChoice={(v) => void put(row, changed(row, c.cause, v), causeText(c.cause))} hint={causeHint(c)} />
            ))}
          </div>
          <p class="where" data-field="drive-watchdog">
            {marked(watchdogText(row))}
          </p>
          <p class="where" data-field="drive-limits">
            {marked(limitsText(row))}
          </p>
          <Watchdog row={row} put={(value) => void put(row, { ...row.fail_safe, watchdog_ms: value }, t('the time of a silent Modbus client'))} />
        </details>
      ))}
      <RehearsalPart door={door} />
    </Section>
  );
}

/** How long a Modbus client of this axis may ask nothing. */
function Watchdog({ row, put }: { row: FailSafeRow; put: (value: number | null) => void }) {
  const no = useBarred('engineer');
  const typed = useSignal<string | null>(null);
  const read = readWatchdog(typed.value ?? '');
  const own = row.fail_safe.watchdog_ms ?? null;
  const inForce = row.watchdog_ms_in_force;
  return (
    <form
      class="form-grid"
      noValidate
      aria-label={t('Silent Modbus client of {axis}', { axis: row.axis })}
      onSubmit={(e) => {
        e.preventDefault();
        if (typed.value === null || !read.good) return;
        put(read.value);
        typed.value = null;
      }}
    >
      <TextField
        label={t('Silent after, ms')}
        number
        disabled={Boolean(no.disabled)}
        value={typed.value ?? (own === null ? '' : String(own))}
        placeholder={t('default: {inForce}', { inForce })}
        onText={(entered) => (typed.value = entered)}
        fault={read.good ? undefined : read.why}
        hint={inForce === 0 ? t('Modbus clients are not watched now.') : t('In force: {inForce} ms. 0: never; empty: as the gateway is set.', { inForce })}
      />
      <div class="form-foot">
        <button type="submit" class="button" disabled={Boolean(no.disabled) || typed.value === null || !read.good} title={no.title}>
          {t('Set')}
        </button>
      </div>
    </form>
  );
}

function RehearsalPart({ door }: { door: FailSafeDoor }) {
  const { store } = useGateway();
  const now = useSignal<Rehearsal | null>(null);
  const reported = useSignal<Reported>(quiet);
  const chosen = useSignal(Object.keys(steps) as Step[]);
  const no = useBarred('engineer');
  useLoaded(async () => void (now.value = await door.rehearsal()), [door], () => '');
  const running = now.value?.state === 'running';
  useRepeated(() => door.rehearsal().then((r) => void (now.value = r), () => undefined), look_ms, running, [door]);
  const start = async () => {
    reported.value = quiet;
    try {
      now.value = await door.rehearse(chosen.value);
    } catch (error) {
      reported.value = refusal(error);
    }
  };
  const report = now.value?.report ?? null;
  const unit = (axis: string) => store.axis(axis)?.value.data.unit ?? '';
  return (
    <div class="card form rehearsal">
      <div class="form-foot">
        <button type="button" class="button" disabled={Boolean(no.disabled) || running} title={no.title} onClick={() => void start()}>
          {t('Rehearse on models')}
        </button>
        <span class="where" role="status" data-field="rehearsal-state">
          {running ? t('Playing {done} of {total} …', { done: now.value!.done, total: now.value!.total }) : t('Plays every cause for every axis on models of the drives, and measures. No machine moves.')}
        </span>
        {report && (
          <button type="button" class="button" onClick={printReport}>
            {t('Print the report')}
          </button>
        )}
        <Tell reported={reported.value} field="rehearsal-told" />
      </div>
      <fieldset class="choices">
        <legend>{t('Beside the loss')}</legend>
        {(Object.keys(steps) as Step[]).map((s) => (
          <label key={s} class="check">
            <input type="checkbox" checked={chosen.value.includes(s)} onChange={(e) => (chosen.value = e.currentTarget.checked ? [...chosen.value, s] : chosen.value.filter((x) => x !== s))} /> {steps[s]}
          </label>
        ))}
      </fieldset>
      {report && (
        <>
          <h3 class="print-only">{t('Fail-safe rehearsal')}</h3>
          <p data-field="rehearsal-report">
            {t('Rehearsed {ended_at} by {who}, revision {site_revision} of the site, on {on}.', { ended_at: dateTime(report.ended_at), who: report.who, site_revision: report.site_revision, on: report.on })}{' '}
            {report.without_figures > 0 ? t('{n} cells, {without_figures} without figures.', { n: report.cells.length, without_figures: report.without_figures }) : t('{n} cells.', { n: report.cells.length })}{' '}
            {report.without_set_points.length > 0 && t('Follow no streamed set-points: {n}.', { n: report.without_set_points.join(', ') })}
          </p>
          <div class="table-scroll" tabIndex={0} role="region" aria-label={t('Report of the rehearsal')}>
            <table class="table">
              <TableHead of={cellHeads()} figures={figures} />
              <tbody>
                {report.cells.map((c) => (
                  <CellOf key={`${c.axis} ${c.cause}`} cell={c} unit={unit(c.axis)} />
                ))}
              </tbody>
            </table>
          </div>
        </>
      )}
    </div>
  );
}

/** Columns of the report that have figures. */
const figures = [3, 4, 5, 6];

/** One cell of the rehearsal as a row, on the page and in the commissioning report. */
export function CellOf({ cell, unit }: { cell: Cell; unit: string }) {
  const r = cellRow(cell, unit);
  return (
    <tr title={cell.text}>
      <th scope="row">{r.axis}</th>
      {[r.cause, r.action, r.acted, r.slower, r.stood, r.way, r.ended].map((text, i) => (
        <td key={i} class={figures.includes(i + 1) ? 'num' : undefined}>{text}</td>
      ))}
    </tr>
  );
}
