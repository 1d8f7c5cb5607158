// Report, site and wiring: lines, drives and axes of the commissioning report as tables. In: what was read for it, the axes as they are now. Out: tables.
import { useGateway } from '../gateway';
import { t } from '../language';
import type { WholeReport } from '../state/report';
import { markOf, unitOf } from '../text/axis';
import { formatExact } from '../text/number';
import { presenceText } from '../text/presence';
import { lineWord } from './lines';
import { Mark } from './pill';
import { ReportTable } from './report-table';

const limit = (v: number | null | undefined) => (v === null || v === undefined ? '–' : formatExact(v));

export function ReportSite({ whole: w, names }: { whole: WholeReport; names: readonly string[] }) {
  const { store } = useGateway();
  return (
    <>
      <h2>{t('Site and wiring')}</h2>
      <ReportTable head={[t('Line'), t('Port'), t('Families'), t('Bit rate'), t('State'), t('Drives')]}>
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
      </ReportTable>
      <ReportTable head={[t('Drive'), t('Line'), t('Family'), t('Address'), t('Presence'), t('Axes')]}>
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
      </ReportTable>
      <ReportTable head={[t('Axis'), t('Number'), t('Drive, channel'), t('Unit'), t('Increments per unit'), t('Limits of position'), t('Referenced'), t('Answered by')]}>
        {names.map((n) => {
          const a = store.axis(n)?.peek()?.data;
          if (!a) return null;
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
      </ReportTable>
    </>
  );
}
