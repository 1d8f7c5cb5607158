// Assembly table: the assemblies of the site as a file, and many at once from one or from a spreadsheet's clipboard. In: text. Out: what the gateway
// would make of it, or each faulty line; then all rows or none. The gateway reads the table: what it takes, it shows first.
import { useSignal } from '@preact/signals';
import { marked } from './marked';
import { assembliesAddress, type AssemblyDoor } from '../api/assemblies';
import { asProblem, type Problem } from '../api/problem';
import { gatewayText, t, theirs } from '../language';
import { emptied, persisted } from '../state/persisted';
import { quiet, type Reported } from '../state/reported';
import { Tell } from './form';
import { useBarred } from './gate';

const text = persisted('assemblies.table');
const largest = 1_000_000;

interface Report {
  /** What was tried, with the choice: another text or choice is to be tried again. */
  of: string;
  differences: string[];
  faults: { line: string; text: string }[];
}
const faultsOf = (p: Problem) => (p.document.faults ?? []).map((f) => ({ line: /^\/(\d+)/.exec(f.pointer)?.[1] ?? '', text: theirs(f.text) }));

export function AssemblyTable({ door, taken }: { door: AssemblyDoor; taken: () => Promise<void> }) {
  const replace = useSignal(false);
  const reported = useSignal<Reported>(quiet);
  const report = useSignal<Report | null>(null);
  const no = useBarred('engineer');
  const what = `${replace.value}\n${text.value}`;
  const shown = report.value?.of === what ? report.value : null;
  const empty = text.value.trim() === '';

  const take = async (file: File | undefined) => {
    if (!file) return;
    if (file.size > largest) {
      reported.value = { tone: 'refused', text: t('{file} has {n} bytes; at most {most} are read.', { file: file.name, n: file.size, most: largest }) };
      return;
    }
    text.value = await file.text();
    reported.value = { tone: 'good', text: t('{file} is in the field below. Nothing has been sent.', { file: file.name }) };
  };
  const send = async (dryRun: boolean) => {
    const sent = text.value;
    reported.value = { tone: 'busy', text: dryRun ? t('The gateway checks …') : t('Sending …') };
    try {
      const answer = await door.table(sent, { replace: replace.value, dryRun });
      if (dryRun) {
        report.value = { of: what, differences: answer.differences, faults: [] };
        reported.value = { tone: 'good', text: t('The gateway would take the table: {n} of its assemblies afterwards.', { n: answer.assemblies }) };
        return;
      }
      reported.value = { tone: 'good', text: t('The table is taken: {n} of its assemblies now.', { n: answer.assemblies }) };
      emptied(text, sent);
      report.value = null;
      await taken();
    } catch (error) {
      const problem = asProblem(error);
      report.value = { of: what, differences: [], faults: faultsOf(problem) };
      reported.value = { tone: 'refused', text: problem.text };
    }
  };
  return (
    <details class="card profile" data-field="assembly-table">
      <summary>{t('Paste or import a table')}</summary>
      <div class="form">
        <p class="where">
          {t('Columns in any order, named by the first line:')} <span class="mono">instance, direction, unit, table, address, registers, byte_order, comment</span>. {t('Separated by tabs, commas or semicolons.')}
        </p>
        <label class="visually-hidden" for="assembly-table">
          {t('Table of assemblies')}
        </label>
        <textarea id="assembly-table" class="mono" rows={6} spellcheck={false} placeholder={'instance\tdirection\tunit\taddress\tregisters\n300\tinput\t40\t0\t8'} value={text.value} onInput={(e) => (text.value = e.currentTarget.value)} />
        <div class="form-foot">
          <label class="button">
            <input type="file" class="visually-hidden" accept=".csv,.tsv,.txt,text/csv,text/tab-separated-values" onChange={(e) => void take(e.currentTarget.files?.[0])} />
            {t('Choose a file')}
          </label>
          <label class="check">
            <input type="checkbox" checked={replace.value} onChange={(e) => (replace.value = e.currentTarget.checked)} /> {t('in place of all of its own')}
          </label>
          <button type="button" class="button" {...no} disabled={no.disabled || empty} onClick={() => void send(true)}>
            {t('Check with the gateway')}
          </button>
          <button type="button" class="button primary" {...no} disabled={no.disabled || empty || !shown || shown.faults.length > 0 || reported.value.tone !== 'good'} onClick={() => void send(false)}>
            {t('Take the table')}
          </button>
          <a class="button" href={assembliesAddress} download="assemblies.csv">
            {t('Export CSV')}
          </a>
          <Tell reported={reported.value} field="assembly-table-told" />
        </div>
        {shown && shown.differences.length > 0 && (
          <ul class="differences" aria-label={t('What would change')}>
            {shown.differences.map((d) => (
              <li key={d} {...gatewayText}>{d}</li>
            ))}
          </ul>
        )}
        {shown && shown.faults.length > 0 && (
          <ul class="differences" aria-label={t('What is wrong with the table')}>
            {shown.faults.map((f, i) => (
              <li key={i} class="fault-text" data-line={f.line}>
                {marked(f.line === '' ? f.text : t('Line {n}: {text}', { n: f.line, text: f.text }))}
              </li>
            ))}
          </ul>
        )}
      </div>
    </details>
  );
}
