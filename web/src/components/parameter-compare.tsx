// Parameter compare: two sets of values of an axis side by side: what is known now or a snapshot, beside the defaults, what is stored, the drive,
// another snapshot, another axis. In: the HTTP door. Out: a table of what differs; everything on demand. What an axis has not told yet is read first,
// one value at a time, with the progress; that can be ended, and what was not read is said to be not compared.
import { t } from '../language';
import { useSignal } from '@preact/signals';
import { useEffect, useMemo, useRef } from 'preact/hooks';
import type { AxisParameter } from '../api/types';
import { SnapshotDoor, type Snapshot } from '../api/snapshots';
import { useGateway } from '../gateway';
import { capital } from '../state/commander';
import { readMissing } from '../state/read-missing';
import { quiet, refusal, type Reported } from '../state/reported';
import { steppedText, unitText, valueText } from '../text/parameter';
import { axisChoice, differentFamilies, snapshotChoice } from '../text/snapshot';
import { comparedText, compareWith, type Compared } from '../text/transfer';
import { Choice, Tell } from './form';
import { Empty } from './lines';
import { SimulatedMark, useNamed } from './name';
import { Section } from './section';
import { TableHead } from './table-head';

const plain = { allowed: null };

export function ParameterCompare({ axis, family, snapshots }: { axis: string; family: string; snapshots: readonly Snapshot[] }) {
  const { client, store } = useGateway();
  const door = useMemo(() => new SnapshotDoor(client, axis), [client, axis]);
  const base = useSignal('now');
  const other = useSignal('default');
  const all = useSignal(false);
  const reported = useSignal<Reported>(quiet);
  const result = useSignal<{ title: string; rows: Compared[] } | null>(null);
  const others = store.axisNames.value.filter((n) => n !== axis);
  const fromSnapshot = base.value !== 'now';
  const named = useNamed();
  const familyOfAxis = (n: string) => store.axis(n)?.peek().data.family ?? family;
  const choices = [
    { value: 'default', text: t('the defaults of the family') },
    { value: 'stored', text: t('what the gateway has stored') },
    ...(fromSnapshot ? [{ value: 'device', text: t('the drive, read now') }] : []),
    ...snapshots.filter((s) => !fromSnapshot || String(s.n) !== base.value).map((s) => snapshotChoice(s, `snapshot:${s.n}`, family)),
    ...others.map((n) => axisChoice(n, familyOfAxis(n), family, named(n))),
  ];

  const reading = useRef<AbortController | null>(null);
  useEffect(() => () => reading.current?.abort(), []);
  const busy = useSignal(false);
  const valuesOf = (of: string, end: AbortSignal) => readMissing(client, of, end, (done, n) => (reported.value = { tone: 'busy', text: t('Reading {of}: {done} of {n} …', { of, done, n }) }));
  const comparable = (list: readonly AxisParameter[]) => list.filter((p) => p.access !== 'W' && !p.count).length;

  const compare = async () => {
    if (busy.peek()) return;
    const end = (reading.current = new AbortController());
    busy.value = true;
    await compareNow(end.signal);
    busy.value = false;
  };
  const compareNow = async (end: AbortSignal) => {
    const theirs = other.value.startsWith('axis:') ? familyOfAxis(other.value.slice('axis:'.length)) : family;
    if (theirs !== family) {
      result.value = null;
      reported.value = { tone: 'refused', text: differentFamilies(axis, family, other.value.slice('axis:'.length), theirs, store.familyTitles.peek()) };
      return;
    }
    reported.value = { tone: 'busy', text: t('Comparing …') };
    result.value = null;
    try {
      const title = choices.find((c) => c.value === other.value)?.text ?? other.value;
      let rows: Compared[];
      let missing = '';
      let of = 0;
      if (fromSnapshot || other.value.startsWith('snapshot:')) {
        // The gateway compares a snapshot with something; with the values known now it is the drive that counts.
        const n = Number(fromSnapshot ? base.value : other.value.slice('snapshot:'.length));
        const answer = await door.diff(n, fromSnapshot ? other.value : 'device');
        rows = answer.rows.map((r) => ({ id: r.parameter, name: r.name, unit: r.unit, mine: fromSnapshot ? r.snapshot : r.other, other: fromSnapshot ? r.other : r.snapshot, same: r.same, known: r.other_known !== false, writable: r.writable }));
        missing = answer.text ?? '';
      } else {
        const list = await valuesOf(axis, end);
        of = comparable(list);
        if (other.value.startsWith('axis:')) {
          const theirs = new Map((await valuesOf(other.value.slice('axis:'.length), end)).map((p) => [p.id, p.value]));
          rows = compareWith(list, (p) => theirs.get(p.id) ?? null);
        } else {
          rows = compareWith(list, (p) => (other.value === 'stored' ? p.stored : p.default));
        }
      }
      result.value = { title, rows };
      reported.value = { tone: 'good', text: `${comparedText(rows, of)}${missing ? ` ${capital(missing)}.` : ''}` };
    } catch (error) {
      reported.value = refusal(error);
    }
  };
  const rows = (result.value?.rows ?? []).filter((r) => all.value || (!r.same && (r.known !== false || fromSnapshot)));
  return (
    <Section title={t('Compare')} class="compare" beside={<SimulatedMark of={axis} />}>
      <form
        class="card form"
        noValidate
        aria-label={t('Compare')}
        onSubmit={(e) => {
          e.preventDefault();
          void compare();
        }}
      >
        <div class="form-grid">
          <Choice label={t('Compare')} class="wide" value={base.value} onChoice={(v) => { base.value = v; result.value = null; reported.value = quiet; if (v === 'now' && other.value === 'device') other.value = 'default'; }} choices={[{ value: 'now', text: t('the values known now') }, ...snapshots.map((s) => snapshotChoice(s, String(s.n), family))]} />
          <Choice label={t('with')} class="wide" value={other.value} onChoice={(v) => { other.value = v; result.value = null; reported.value = quiet; }} choices={choices} />
        </div>
        <div class="form-foot">
          {busy.value ? (
            <button type="button" class="button" onClick={() => reading.current?.abort()}>
              {t('End reading')}
            </button>
          ) : (
            <button type="submit" class="button primary">
              {t('Compare')}
            </button>
          )}
          <label class="check">
            <input type="checkbox" checked={all.value} onChange={(e) => (all.value = e.currentTarget.checked)} />{' '}{t('equal ones too')}
          </label>
          <Tell reported={reported.value} field="compare-told" />
        </div>
        {result.value && result.value.rows.length > 0 && rows.length === 0 && <Empty text={t('Nothing differs.')} />}
        {result.value && rows.length > 0 && (
          <div class="table-scroll" tabIndex={0} role="region" aria-label={t('Comparison')}>
            <table class="table compare-table">
              <TableHead of={[t('Parameter'), fromSnapshot ? t('Snapshot') : t('Now'), capital(result.value.title), t('Verdict')]} figures={[1, 2]} />
              <tbody>
                {rows.slice(0, 500).map((r) => (
                  <tr key={r.id} data-compared={r.id}>
                    <th scope="row">
                      <span class="both">
                        <span class="mono id">{r.id}</span>
                        <span class="name">{r.name.replaceAll('_', ' ')}</span>
                      </span>
                    </th>
                    <td class="num mono" data-label={fromSnapshot ? t('Snapshot') : t('Now')}>{valueText(r.mine, plain)} <span class="unit">{unitText(r.unit)} {steppedText(r.mine, r.unit)}</span></td>
                    <td class="num mono" data-label={capital(result.value?.title ?? '')}>{valueText(r.other, plain)} <span class="unit">{unitText(r.unit)} {steppedText(r.other, r.unit)}</span></td>
                    <td data-label={t('Verdict')}>{r.same ? t('equal') : r.known === false ? t('not known') : <span class="flag">{r.writable ? t('differs') : t('differs, read only')}</span>}</td>
                  </tr>
                ))}
              </tbody>
            </table>
          </div>
        )}
      </form>
    </Section>
  );
}
