// Drive comparison: the real drive of an axis beside its twin, value by value, and the twin's adoption of what the drive holds. In: the newest report of the
// gateway. Out: a comparison, which only reads the drive; an adoption, which changes the memory of the twin.
import { gatewayText, t } from '../language';
import { useSignal } from '@preact/signals';
import { useEffect, useMemo } from 'preact/hooks';
import { ComparisonDoor, type ComparedValue, type DriveComparison } from '../api/comparison';
import type { MaybeValue } from '../api/types';
import { useGateway } from '../gateway';
import { quiet, refusal, type Reported } from '../state/reported';
import { unitText, valueText } from '../text/parameter';
import { Tell } from './form';
import { useBarred } from './gate';
import { TableHead } from './table-head';

const plain = { allowed: null };
const shown = (value: unknown) => valueText((value ?? null) as MaybeValue, plain);

function verdict(row: ComparedValue): string {
  switch (row.kind) {
    case 'value': return t('differs');
    case 'changed': return t('changes while it is compared: {value}', { value: shown(row.drive_again) });
    case 'measured': return t('measured, not counted');
    case 'missing': return t('the drive refuses it');
    case 'extra': return t('the twin refuses it');
  }
}

function Rows({ report }: { report: DriveComparison }) {
  const late = report.replies.outside;
  return (
    <>
      {report.rows.length > 0 && (
        <div class="table-scroll" tabIndex={0} role="region" aria-label={t('Comparison with the twin')}>
          <table class="table compare-table">
            <TableHead of={[t('Parameter'), t('Drive'), t('Twin'), t('Verdict')]} figures={[1, 2]} />
            <tbody>
              {report.rows.slice(0, 500).map((r) => (
                <tr key={r.parameter} data-compared={r.parameter}>
                  <th scope="row">
                    <span class="both">
                      <span class="mono id">{r.parameter}</span>
                      <span class="name">{r.name.replaceAll('_', ' ')}</span>
                    </span>
                  </th>
                  <td class="num mono" data-label={t('Drive')}>{shown(r.drive)} <span class="unit">{unitText(r.unit)}</span></td>
                  <td class="num mono" data-label={t('Twin')}>{shown(r.twin)} <span class="unit">{unitText(r.unit)}</span></td>
                  <td data-label={t('Verdict')} title={r.text}>{verdict(r)}</td>
                </tr>
              ))}
            </tbody>
          </table>
        </div>
      )}
      {late.length > 0 && (
        <ul class="where" data-field="compared-late" aria-label={t('Answers outside the range of reply times')} {...gatewayText}>
          {late.slice(0, 20).map((d, i) => (
            <li key={i}>
              {d.request} <b>{d.reply_ms}</b> {t('{from} to {to} {unit}.', { from: d.least_ms, to: d.most_ms, unit: 'ms' })}
            </li>
          ))}
        </ul>
      )}
      {report.adoption.not_adopted.length > 0 && (
        <details>
          <summary>{t('{n} values that the twin cannot adopt', { n: report.adoption.not_adopted.length })}</summary>
          <ul class="where" data-field="not-adopted" {...gatewayText}>
            {report.adoption.not_adopted.map((f) => (
              <li key={f.parameter}>{`${f.parameter}: ${f.reason}`}</li>
            ))}
          </ul>
        </details>
      )}
    </>
  );
}

export function DriveCompare({ axis }: { axis: string }) {
  const { client } = useGateway();
  const door = useMemo(() => new ComparisonDoor(client, axis), [client, axis]);
  const report = useSignal<DriveComparison | null>(null);
  const reported = useSignal<Reported>(quiet);
  const no = useBarred('engineer');
  const busy = reported.value.tone === 'busy';
  useEffect(() => {
    let here = true;
    door.newest().then((r) => here && (report.value = r), () => undefined);
    return () => void (here = false);
  }, [door]);
  const summary = (r: DriveComparison) => r.fault ?? t('{read} values read, differences: {differences}, specimen {specimen}', { read: r.read, differences: r.differences, specimen: r.specimen });
  const compare = async () => {
    reported.value = { tone: 'busy', text: t('Checking…') };
    try {
      const r = await door.compare((done, of) => (reported.value = { tone: 'busy', text: t('Reading the drive: {done} of {of} …', { done, of }) }));
      report.value = r;
      reported.value = { tone: r.fault ? 'refused' : 'good', text: summary(r) };
    } catch (error) {
      reported.value = refusal(error);
    }
  };
  const adopt = async () => {
    reported.value = { tone: 'busy', text: t('Checking…') };
    try {
      const a = await door.adopt();
      reported.value = { tone: 'good', text: t('The twin starts as this drive when the drive is away; {n} values were adopted.', { n: a.adopted.length }) };
    } catch (error) {
      reported.value = refusal(error);
    }
  };
  return (
    <div class="card form" data-field="drive-comparison">
      <p class="where">{t('A comparison reads the drive twice and writes nothing. Nothing moves.')}</p>
      <div class="form-foot">
        <button type="button" class="button" {...no} disabled={Boolean(no.disabled) || busy} onClick={() => void compare()}>
          {t('Compare with the twin')}
        </button>
        <button type="button" class="button" {...no} disabled={Boolean(no.disabled) || busy || !report.value || report.value.fault !== null} onClick={() => void adopt()}>
          {t('Adopt in the twin')}
        </button>
        <Tell reported={reported.value} field="compare-drive-told" />
      </div>
      {report.value && <Rows report={report.value} />}
    </div>
  );
}
