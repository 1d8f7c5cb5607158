// Commissioning report: one document to print and sign: the site and its wiring, parameters beside snapshot and default, the register list with its
// hash, captured curves, the fail-safe rehearsal with its times, versions, who and when. In: the gateway's documents, read once when the page is
// opened and again by the button. Out: a page that the browser prints or saves as PDF. A drive is read for it only when a button says so.
import { gatewayText, t } from '../language';
import { marked } from '../components/marked';
import { useSignal } from '@preact/signals';
import { useEffect, useMemo, useRef } from 'preact/hooks';
import { FailSafeDoor, type Rehearsal } from '../api/fail-safe';
import { MappingDoor, type MappingList } from '../api/mappings';
import { RecorderDoor } from '../api/recorder';
import type { AxisParameter, CaptureList, CaptureWithRows, Drive, Line } from '../api/types';
import { TextField } from '../components/form';
import { lineWord } from '../components/lines';
import { useLoaded } from '../components/loaded';
import { PrintedList } from '../components/mapping-list';
import { Mark } from '../components/pill';
import { Overlay } from '../components/recorder-captures';
import { useGateway } from '../gateway';
import { windowOf } from '../state/narrow';
import { persisted } from '../state/persisted';
import { readMissing } from '../state/read-missing';
import { markOf, unitOf } from '../text/axis';
import type { MappingPoint } from '../text/mapping';
import { formatExact } from '../text/number';
import { steppedText, unitText, valueText } from '../text/parameter';
import { presenceText } from '../text/presence';
import { captureAbout, triggerText } from '../text/recorder';
import { comparedSentence, parameterReport, type ParameterReport, type SnapshotValues } from '../text/report';
import { dateTime } from '../text/time';
import type { MaybeValue } from '../api/types';
import { CellOf } from '../components/fail-safe';
import { cellHeads } from '../text/fail-safe';

const fields = { machine: persisted('report.machine', '', 'browser'), place: persisted('report.place', '', 'browser'), who: persisted('report.who', '', 'browser'), notes: persisted('report.notes', '', 'browser') };
const mostCaptures = 3;

interface Whole {
  at: string;
  lines: Line[];
  drives: Drive[];
  mappings: MappingList;
  points: MappingPoint[];
  rehearsal: Rehearsal;
  captures: CaptureList;
  drawn: CaptureWithRows[];
  axes: { name: string; list: AxisParameter[]; snapshot: SnapshotValues | null; report: ParameterReport }[];
}

export function ReportPage() {
  const { client, store } = useGateway();
  const whole = useSignal<Whole | null>(null);
  const times = useSignal(0);
  const doors = useMemo(() => ({ fail: new FailSafeDoor(client), map: new MappingDoor(client), recorder: new RecorderDoor(client) }), [client]);
  const names = store.axisNames.value;
  const why = useLoaded(async () => {
    const [lines, drives, mappings, points, rehearsal, captures] = await Promise.all([client.lines(), client.drives(), doors.map.list(), doors.map.points(), doors.fail.rehearsal(), doors.recorder.captures()]);
    const axes = [];
    for (const name of names) {
      const path = `/axes/${encodeURIComponent(name)}/snapshots`;
      const [list, snapshots] = await Promise.all([client.parameters(name), client.call<{ n: number }[]>(path)]);
      const newest = snapshots.reduce<number | null>((n, s) => (n === null || s.n > n ? s.n : n), null);
      const snapshot = newest === null ? null : await client.call<SnapshotValues>(`${path}/${newest}`);
      axes.push({ name, list, snapshot, report: parameterReport(list, snapshot) });
    }
    const done = captures.captures.filter((c) => c.state === 'done' && !c.fault && c.bytes > 0).slice(0, mostCaptures);
    const drawn = await Promise.all(done.map((c) => doors.recorder.capture(c.name)));
    whole.value = { at: new Date().toISOString(), lines, drives, mappings, points, rehearsal, captures, drawn, axes };
  }, [doors, times.value, names.join()]);
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
  const about = store.about.value;
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
          <dl class="report-facts">
            <Fact name={t('Machine')} value={fields.machine.value} />
            <Fact name={t('Place')} value={fields.place.value} />
            <Fact name={t('Commissioned by')} value={fields.who.value} />
            <Fact name={t('Date')} value={dateTime(w.at)} />
            <Fact name="axisgate" value={t('{n}, page and API of the same program', { n: about?.version ?? '–' })} />
            <Fact name={t('Revision of the site')} value={String(store.siteRevision.value ?? '–')} />
            <Fact name={t('Doors')} value={about?.doors.map((d) => `${d.name} ${d.address}`).join(', ') ?? '–'} />
            <Fact name={t('Remarks')} value={fields.notes.value} />
          </dl>

          <h2>{t('Site and wiring')}</h2>
          <Table head={[t('Line'), t('Port'), t('Families'), t('Bit rate'), t('State'), t('Drives')]}>
            {w.lines.map((l) => (
              <tr key={l.name}>
                <th scope="row">{l.name}</th>
                <td class="mono">{l.uri}</td>
                <td>{l.status.families?.map((f) => f.family).join(', ') || l.family || ''}</td>
                <td>{l.bitrate ? formatExact(l.bitrate) : ''}</td>
                <td>{lineWord(l.status.state).text}</td>
                <td>{l.drives.join(', ')}</td>
              </tr>
            ))}
          </Table>
          <Table head={[t('Drive'), t('Line'), t('Family'), t('Address'), t('Presence'), t('Axes')]}>
            {w.drives.map((d) => (
              <tr key={d.name}>
                <th scope="row">{d.name}</th>
                <td>{d.line}</td>
                <td>{d.family}</td>
                <td class="mono">{String(d.address)}</td>
                <td>{presenceText(d.presence)}</td>
                <td>{d.axes.join(', ')}</td>
              </tr>
            ))}
          </Table>
          <Table head={[t('Axis'), t('Number'), t('Drive, channel'), t('Unit'), t('Increments per unit'), t('Limits of position'), t('Referenced'), t('Answered by')]}>
            {names.map((n) => {
              const a = store.axis(n)?.peek()?.data;
              if (!a) return null;
              const limit = (v: number | null | undefined) => (v === null || v === undefined ? '–' : formatExact(v));
              return (
                <tr key={n}>
                  <th scope="row">{n}</th>
                  <td>{a.number}</td>
                  <td>{`${a.drive}, ${a.channel}`}</td>
                  <td>{unitOf(a)}</td>
                  <td>{formatExact(a.increments_per_unit)}</td>
                  <td>{t('{position_min} to {position_max}', { position_min: limit(a.position_min), position_max: limit(a.position_max) })}</td>
                  <td>{a.referenced ? t('yes') : t('no')}</td>
                  <td>
                    <Mark mark={markOf(a)} />
                  </td>
                </tr>
              );
            })}
          </Table>

          <h2>{t('Parameters')}</h2>
          <div class="window" {...windowOf(t('Parameters'))}>
            {w.axes.map((a) => (
              <section key={a.name} aria-label={t('Parameters of {name}', { name: a.name })}>
                <h3>{a.name}</h3>
                <p>{comparedSentence(a.report, a.snapshot)}</p>
                {a.report.rows.length > 0 && (
                  <Table head={[t('Parameter'), t('Name'), t('Now'), t('Default'), a.snapshot ? [t('Snapshot {n}, {at}', { n: a.snapshot.n, at: dateTime(a.snapshot.at) }), ...(a.snapshot.who ? [a.snapshot.who] : [])].join(', ') : t('Snapshot'), t('Unit')]}>
                    {a.report.rows.map((r) => (
                      <tr key={r.id}>
                        <th scope="row" class="mono">{r.id}</th>
                        <td {...gatewayText}>{r.name.replaceAll('_', ' ')}</td>
                        <td>{shown(r.now, r.unit)}</td>
                        <td>{shown(r.otherwise, r.unit)}</td>
                        <td>{r.snapshot === undefined ? '–' : shown(r.snapshot, r.unit)}</td>
                        <td>{unitText(r.unit || null)}</td>
                      </tr>
                    ))}
                  </Table>
                )}
              </section>
            ))}
          </div>

          <h2>{t('Register list')}</h2>
          <p>
            {t('Hash of the mapping:')}{' '}<span class="mono">{w.mappings.hash || t('not told by this gateway')}</span>{' '}{t('(registers 18 and 19 of each axis show it). Unit 1 has 64 registers for each axis, from (number − 1) · 64 on.')}
          </p>
          <div class="report-registers window" tabIndex={0} role="region" aria-label={t('Register map')}>
            <PrintedList rows={w.mappings.rows} known={{ ...plainKnown, axes: names, points: w.points }} hash={w.mappings.hash} />
          </div>

          <h2>{t('Curves')}</h2>
          {w.drawn.length === 0 ? <p>{t('No capture is kept.')}</p> : null}
          <div class="window" {...(w.drawn.length > 0 ? windowOf(t('Curves')) : {})}>
            {w.drawn.map((c) => (
              <div key={c.name} class="report-curve">
                <p>
                  <b>{c.name}</b>, {c.triggered_at ? dateTime(c.triggered_at) : ''}, {captureAbout(c)}, {triggerText(c.trigger, c.axes[0]?.unit)}
                  {c.who ? `, ${t('by {who}', { who: c.who })}` : ''}
                </p>
                <Overlay captures={[c]} />
              </div>
            ))}
          </div>

          <h2>{t('Loss of command')}</h2>
          {w.rehearsal.report ? (
            <>
              <p>
                {t('Rehearsed {ended_at} by {who}, revision {site_revision} of the site, on {on}.', { ended_at: dateTime(w.rehearsal.report.ended_at), who: w.rehearsal.report.who, site_revision: w.rehearsal.report.site_revision, on: w.rehearsal.report.on })}{String(w.rehearsal.report.site_revision) !== String(store.siteRevision.value) && <> {t('The site has changed since: rehearse again.')}</>}
              </p>
              <Table head={cellHeads()}>
                {w.rehearsal.report.cells.map((c) => (
                  <CellOf key={`${c.axis} ${c.cause}`} cell={c} unit={store.axis(c.axis)?.peek()?.data.unit ?? ''} />
                ))}
              </Table>
            </>
          ) : (
            <p>
              {t('Not rehearsed with this program’s present run.')}{' '}<a href="/site">{t('Rehearse it')}</a>{' '}{t('before this is signed.')}
            </p>
          )}

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

const plainKnown = { drafts: new Map(), base: '0' as const, received: new Map(), parameters: () => null };
const shown = (v: MaybeValue, unit: string) => (v === null ? '–' : `${valueText(v, { allowed: null })} ${steppedText(v, unit || null)}`.trim());

function Fact({ name, value }: { name: string; value: string }) {
  return (
    <div>
      <dt>{name}</dt>
      <dd>{value || '–'}</dd>
    </div>
  );
}

function Table({ head, children }: { head: readonly string[]; children: preact.ComponentChildren }) {
  return (
    <div class="scroll" tabIndex={0} role="region" aria-label={head[0]}>
      <table class="report-table">
        <thead>
          <tr>
            {head.map((h) => (
              <th key={h} scope="col">
                {h}
              </th>
            ))}
          </tr>
        </thead>
        <tbody>{children}</tbody>
      </table>
    </div>
  );
}
