// Mapping paste: many mappings at once, from a spreadsheet's clipboard or a CSV file. In: text. Out: rows, each checked; then a dry run by the
// gateway; then all of them or none. The text stays until the gateway took it.
import { useSignal } from '@preact/signals';
import { marked } from './marked';
import { useMemo } from 'preact/hooks';
import { Problem } from '../api/problem';
import { useGateway } from '../gateway';
import { gatewayText, midSentence, t, theirs } from '../language';
import { emptied, persisted } from '../state/persisted';
import type { MappingBook } from '../state/mappings';
import { quiet, reportedOf, type Reported } from '../state/reported';
import { catalogueMissing, csvOfSpecs, readTable } from '../text/mapping-table';
import { placeText, tableOf, type Known } from '../text/mapping';
import { Tell } from './form';
import { TableHead } from './table-head';

const text = persisted('mappings.paste');
const mostShown = 200;
const largest = 2_000_000;

export function MappingPaste({ book, known }: { book: MappingBook; known: Known }) {
  useGateway();
  const replace = useSignal(false);
  const reported = useSignal<Reported>(quiet);
  const report = useSignal<{ for: string; differences: string[]; lines: Map<number, string> } | null>(null);
  const rows = book.rows.value;
  const read = useMemo(() => readTable(text.value, known, replace.value ? [] : rows), [text.value, known, replace.value, rows]);
  const bad = read.rows.filter((r) => r.faults.length > 0).length;
  const specs = read.rows.flatMap((r) => (r.spec && r.faults.length === 0 ? [r.spec] : []));
  // Before the catalogue is there a point that does not exist would pass as good.
  const waits = catalogueMissing(specs, known);
  const checked = report.value?.for === text.value && report.value.lines.size === 0;

  const take = async (file: File | undefined) => {
    if (!file) return;
    if (file.size > largest) {
      reported.value = { tone: 'refused', text: t('{file} has {n} bytes; at most {most} are read.', { file: file.name, n: file.size, most: largest }) };
      return;
    }
    text.value = await file.text();
    reported.value = { tone: 'good', text: t('{file} is in the field below. Nothing has been sent.', { file: file.name }) };
  };
  const dryRun = async () => {
    reported.value = { tone: 'busy', text: t('The gateway checks …') };
    const answer = await book.dryRun(csvOfSpecs(specs), replace.value);
    if (answer instanceof Problem) {
      report.value = { for: text.value, differences: [], lines: linesOf(answer, specs.length, read.rows.map((r) => r.line)) };
      reported.value = { tone: 'refused', text: answer.text };
    } else {
      report.value = { for: text.value, differences: answer.differences, lines: new Map() };
      reported.value = { tone: 'good', text: t('The gateway would take {rows}: {mappings} afterwards.', { rows: rowsText(specs.length), mappings: answer.mappings === 1 ? t('1 mapping') : t('{n} mappings', { n: answer.mappings }) }) };
    }
  };
  const send = async () => {
    reported.value = { tone: 'busy', text: t('Sending …') };
    const sent = text.value;
    const outcome = await book.table(csvOfSpecs(specs), replace.value);
    reported.value = reportedOf(outcome);
    if (!outcome.good) return;
    emptied(text, sent);
    report.value = null;
  };
  return (
    <div class="mapping-paste">
      <div class="form">
        <p class="where">
          {t('Columns in any order, named by the first line:')} <span class="mono">unit, table, address, axis, point, type, word_order, scale, offset, access, length, comment, on_overflow, id</span>.{' '}
          {t('Without such a line they are taken in this order:')} <span class="mono">unit, table, address, axis, point, type, scale, offset</span>. {t('Separated by tabs, commas or semicolons.')}
        </p>
        <label class="visually-hidden" for="mapping-table">
          {t('Table of mappings')}
        </label>
        <textarea
          id="mapping-table"
          class="mono"
          rows={6}
          spellcheck={false}
          placeholder={'unit\taddress\taxis\tpoint\ttype\n2\t0\tfeeder\tposition_units\tf32'}
          value={text.value}
          onInput={(e) => {
            text.value = e.currentTarget.value;
            reported.value = quiet;
          }}
        />
        <div class="form-foot">
          <label class="button">
            <input type="file" class="visually-hidden" accept=".csv,.tsv,.txt,text/csv,text/tab-separated-values" onChange={(e) => void take(e.currentTarget.files?.[0])} />
            {t('Choose a file')}
          </label>
          <label class="check">
            <input type="checkbox" checked={replace.value} onChange={(e) => (replace.value = e.currentTarget.checked)} /> {t('in place of all mappings')}
          </label>
          <button type="button" class="button" disabled={specs.length === 0 || bad > 0 || waits !== ''} onClick={() => void dryRun()}>
            {t('Check with the gateway')}
          </button>
          <button type="button" class="button primary" disabled={specs.length === 0 || bad > 0 || waits !== '' || !checked} onClick={() => void send()}>
            {replace.value ? t('Replace all by {rows}', { rows: rowsText(specs.length) }) : t('Add {rows}', { rows: rowsText(specs.length) })}
          </button>
          <Tell reported={reported.value} field="table-told" />
        </div>
        {read.rows.length > 0 && (
          <p class={`form-told${bad > 0 || read.problem ? ' is-fault' : ''}`} role="status" data-field="table-count">
            {read.problem || waits || (bad > 0 ? t('{bad} of {rows} must be mended before anything is sent.', { bad, rows: rowsText(read.rows.length) }) : t('{rows}, none of them with a fault that this page can see.', { rows: rowsText(read.rows.length) }))}
          </p>
        )}
        {report.value && report.value.for === text.value && report.value.differences.length > 0 && (
          <ul class="differences" aria-label={t('What would change')}>
            {report.value.differences.slice(0, mostShown).map((d) => (
              <li key={d} {...gatewayText}>{d}</li>
            ))}
          </ul>
        )}
        {read.rows.length > 0 && (
          <div class="table-scroll" tabIndex={0} role="region" aria-label={t('Rows of the table')}>
            <table class="table paste-table">
              <TableHead of={[t('Row'), t('Register place'), t('Point'), t('Verdict')]} />
              <tbody>
                {read.rows.slice(0, mostShown).map((r) => {
                  const gateway = report.value?.for === text.value ? report.value.lines.get(r.line) : undefined;
                  const faults = [...r.faults, ...(gateway ? [gateway] : [])];
                  return (
                    <tr key={r.line} data-line={r.line} class={faults.length > 0 ? 'is-bad' : ''}>
                      <th scope="row" class="mono">{r.line}</th>
                      <td data-label={t('Register place')}>{r.spec ? t('unit {unit}, {table} {place}', { unit: r.spec.unit ?? '', table: midSentence(tableOf(r.spec.table ?? 'holding_registers').short), place: placeText({ type: 'i32', table: 'holding_registers', ...r.spec }) }) : <span class="mono">{r.texts.address || '–'}</span>}</td>
                      <td data-label={t('Point')}>{[r.texts.axis, r.texts.point].filter(Boolean).join(' ') || '–'}</td>
                      <td data-label={t('Verdict')}>{faults.length > 0 ? <span class="fault-text">{marked(faults.join(' '))}</span> : waits !== '' ? <span class="where">{t('waits')}</span> : <span class="good-text">{t('good')}</span>}</td>
                    </tr>
                  );
                })}
              </tbody>
            </table>
            {read.rows.length > mostShown && <p class="where">{t('{n} more rows are checked but not shown.', { n: read.rows.length - mostShown })}</p>}
          </div>
        )}
      </div>
    </div>
  );
}

const rowsText = (n: number) => (n === 1 ? t('1 row') : t('{n} rows', { n }));

/** The gateway names lines of the table that was sent: a head line and then one per row. */
function linesOf(problem: Problem, rows: number, lines: readonly number[]): Map<number, string> {
  const found = new Map<number, string>();
  for (const f of problem.document.faults ?? []) {
    const at = Number(/^\/(\d+)/.exec(f.pointer)?.[1] ?? NaN);
    const line = lines[at - 2];
    if (Number.isFinite(at) && at >= 2 && at - 2 < rows && line !== undefined) found.set(line, theirs(`${f.text}; ${f.remedy}`));
  }
  if (found.size === 0) found.set(-1, problem.text);
  return found;
}
