// Report, values: the parameters of each axis beside snapshot and default, the register list, the curves, the rehearsal of the commissioning report. In: what was read
// for it. Out: tables and curves.
import type { MaybeValue } from '../api/types';
import { useGateway } from '../gateway';
import { gatewayText, t } from '../language';
import { windowOf } from '../state/narrow';
import type { WholeReport } from '../state/report';
import { cellHeads } from '../text/fail-safe';
import { steppedText, unitText, valueText } from '../text/parameter';
import { captureAbout, triggerText } from '../text/recorder';
import { comparedSentence } from '../text/report';
import { dateTime } from '../text/time';
import { Overlay } from './capture-overlay';
import { CellOf } from './fail-safe';
import { PrintedList } from './mapping-list';
import { ReportTable } from './report-table';

const plainKnown = { drafts: new Map(), base: '0' as const, received: new Map(), parameters: () => null };
const shown = (v: MaybeValue, unit: string) => (v === null ? '–' : `${valueText(v, { allowed: null })} ${steppedText(v, unit || null)}`.trim());
interface PartProps {
  whole: WholeReport;
}

export function ReportParameters({ whole: w }: PartProps) {
  return (
    <>
      <h2>{t('Parameters')}</h2>
      <div class="window" {...windowOf(t('Parameters'))}>
        {w.axes.map((a) => (
          <section key={a.name} aria-label={t('Parameters of {name}', { name: a.name })}>
            <h3>{a.name}</h3>
            <p>{comparedSentence(a.report, a.snapshot)}</p>
            {a.report.rows.length > 0 && (
              <ReportTable head={[t('Parameter'), t('Name'), t('Now'), t('Default'), a.snapshot ? [t('Snapshot {n}, {at}', { n: a.snapshot.n, at: dateTime(a.snapshot.at) }), ...(a.snapshot.who ? [a.snapshot.who] : [])].join(', ') : t('Snapshot'), t('Unit')]}>
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
              </ReportTable>
            )}
          </section>
        ))}
      </div>
    </>
  );
}

export function ReportRegisters({ whole: w, names }: PartProps & { names: readonly string[] }) {
  return (
    <>
      <h2>{t('Register list')}</h2>
      <p>
        {t('Hash of the mapping:')}{' '}<span class="mono">{w.mappings.hash || t('not told by this gateway')}</span>{' '}{t('(registers 18 and 19 of each axis show it). Unit 1 has 64 registers for each axis, from (number − 1) · 64 on.')}
      </p>
      <div class="report-registers window" tabIndex={0} role="region" aria-label={t('Register map')}>
        <PrintedList rows={w.mappings.rows} known={{ ...plainKnown, axes: names, points: w.points }} hash={w.mappings.hash} />
      </div>
    </>
  );
}

export function ReportCurves({ whole: w }: PartProps) {
  return (
    <>
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
    </>
  );
}

export function ReportLoss({ whole: w }: PartProps) {
  const { store } = useGateway();
  const report = w.rehearsal.report;
  return (
    <>
      <h2>{t('Loss of command')}</h2>
      {report ? (
        <>
          <p>
            {t('Rehearsed {ended_at} by {who}, revision {site_revision} of the site, on {on}.', { ended_at: dateTime(report.ended_at), who: report.who, site_revision: report.site_revision, on: report.on })}{String(report.site_revision) !== String(store.siteRevision.value) && <> {t('The site has changed since: rehearse again.')}</>}
          </p>
          <ReportTable head={cellHeads()}>
            {report.cells.map((c) => (
              <CellOf key={`${c.axis} ${c.cause}`} cell={c} unit={store.axis(c.axis)?.peek()?.data.unit ?? ''} />
            ))}
          </ReportTable>
        </>
      ) : (
        <p>
          {t('Not rehearsed with this program’s present run.')}{' '}<a href="/site">{t('Rehearse it')}</a>{' '}{t('before this is signed.')}
        </p>
      )}
    </>
  );
}
