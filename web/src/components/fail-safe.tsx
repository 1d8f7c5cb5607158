// Fail-safe: what happens to each axis when who commands it is lost, by cause; and the rehearsal on models, with its report. In: the HTTP door.
// Out: a section. One change at a time, in force at once. Never moves anything: the rehearsal plays on models of the drives.
import { useSignal } from '@preact/signals';
import { useEffect, useMemo } from 'preact/hooks';
import { asProblem } from '../api/problem';
import { FailSafeDoor, type FailSafeRow, type Matrix, type Rehearsal } from '../api/fail-safe';
import { useGateway } from '../gateway';
import { actionChoices, causeHint, causeText, cellRow, changed, namedWords } from '../text/fail-safe';
import { clockTime } from '../text/time';
import { Choice, notOffered, quiet, Tell, type Told } from './form';
import { useBarred } from './gate';
import { useLoaded } from './loaded';
import { Section } from './section';

const look_ms = 1_000;

export function FailSafe({ revision }: { revision: unknown }) {
  const { client } = useGateway();
  const door = useMemo(() => new FailSafeDoor(client), [client]);
  const matrix = useSignal<Matrix | null>(null);
  const told = useSignal<Told>(quiet);
  const no = useBarred('engineer');
  const load = async () => void (matrix.value = await door.matrix());
  const why = useLoaded(load, [door, revision], (p) => (p.status === 404 ? notOffered('fail-safe actions') : p.words));
  if (!matrix.value) return why ? <Section title="When who commands is lost">{<p class="where">{why}</p>}</Section> : null;
  const { causes, axes } = matrix.value;
  const put = async (row: FailSafeRow, cause: Matrix['causes'][number]['cause'], action: string) => {
    told.value = { tone: 'busy', text: 'Changing …' };
    try {
      await door.put(row.axis, changed(row, cause, action));
      await load();
      told.value = { tone: 'good', text: `${row.axis}: ${causeText(cause)} is in force as chosen.` };
    } catch (error) {
      told.value = { tone: 'refused', text: asProblem(error).words };
    }
  };
  return (
    <Section title="When who commands is lost" class="fail-safe" id="fail-safe">
      <p class="where">
        What the gateway does to an axis when its controller, scanner or script is gone. By default a motion without an end is halted, and a motion to a target goes on. What is chosen holds for every motion. A drive that cannot be reached, and a gateway without
        supply, need the drive's own watchdog and the safety circuit.
      </p>
      <Tell told={told.value} field="fail-safe-told" />
      {axes.map((row) => (
        <details key={row.axis} class="card profile" data-fail-safe={row.axis}>
          <summary>
            <strong>{row.axis}</strong>: {namedWords(row)}
            {row.last_cause && <span class="where"> stopped last: {causeText(row.last_cause).toLowerCase()}</span>}
          </summary>
          <div class="form-grid">
            {causes.map((c) => (
              <Choice key={c.cause} label={causeText(c.cause)} value={row.fail_safe[c.cause] ?? ''} choices={actionChoices(c)} disabled={Boolean(no.disabled)} onChoice={(v) => void put(row, c.cause, v)} hint={causeHint(c)} />
            ))}
          </div>
          <p class="where">Modbus clients count as silent after {row.watchdog_ms_in_force === 0 ? 'no time at all: they are not watched' : `${row.watchdog_ms_in_force} ms`}.</p>
        </details>
      ))}
      <RehearsalPart door={door} />
    </Section>
  );
}

function RehearsalPart({ door }: { door: FailSafeDoor }) {
  const { store } = useGateway();
  const now = useSignal<Rehearsal | null>(null);
  const told = useSignal<Told>(quiet);
  const no = useBarred('engineer');
  useLoaded(async () => void (now.value = await door.rehearsal()), [door], () => '');
  const running = now.value?.state === 'running';
  useEffect(() => {
    if (!running) return;
    const timer = setInterval(() => void door.rehearsal().then((r) => (now.value = r), () => undefined), look_ms);
    return () => clearInterval(timer);
  }, [door, running]);
  const start = async () => {
    told.value = quiet;
    try {
      now.value = await door.rehearse();
    } catch (error) {
      told.value = { tone: 'refused', text: asProblem(error).words };
    }
  };
  const report = now.value?.report ?? null;
  const unit = (axis: string) => store.axis(axis)?.value.data.unit ?? '';
  return (
    <div class="card form rehearsal">
      <div class="form-foot">
        <button type="button" class="button" disabled={Boolean(no.disabled) || running} title={no.title} onClick={() => void start()}>
          Rehearse on models
        </button>
        <span class="where" role="status" data-field="rehearsal-state">
          {running ? `Playing ${now.value!.done} of ${now.value!.total} …` : 'Plays every cause for every axis on models of the drives, and measures. No machine moves.'}
        </span>
        <Tell told={told.value} field="rehearsal-told" />
      </div>
      {report && (
        <>
          <p data-field="rehearsal-report">
            Rehearsed {clockTime(report.ended_at)} by {report.who}, revision {report.site_revision} of the site, on {report.on}. {report.cells.length} cells
            {report.without_figures > 0 ? `, ${report.without_figures} without figures` : ''}.{report.without_set_points.length > 0 && ` Follow no streamed set-points: ${report.without_set_points.join(', ')}.`}
          </p>
          <div class="table-scroll" tabIndex={0} role="region" aria-label="Report of the rehearsal">
            <table class="table">
              <thead>
                <tr>
                  <th scope="col">Axis</th>
                  <th scope="col">Cause</th>
                  <th scope="col">Action</th>
                  <th scope="col" class="num">Gateway acted</th>
                  <th scope="col" class="num">Motor slower</th>
                  <th scope="col" class="num">Stood</th>
                  <th scope="col" class="num">Way</th>
                </tr>
              </thead>
              <tbody>
                {report.cells.map((c) => {
                  const r = cellRow(c, unit(c.axis));
                  return (
                    <tr key={r.key} title={c.text}>
                      <th scope="row">{r.axis}</th>
                      <td>{r.cause}</td>
                      <td>{r.action}</td>
                      <td class="num">{r.acted}</td>
                      <td class="num">{r.slower}</td>
                      <td class="num">{r.stood}</td>
                      <td class="num">{r.way}</td>
                    </tr>
                  );
                })}
              </tbody>
            </table>
          </div>
        </>
      )}
    </div>
  );
}
