// Parameter row: one parameter of an axis in the table: live, stored and default value, range, a field for a new one, who wrote last.
// In: the row's signals. Out: a row that keeps its height: each cell is drawn for itself, has room for the longest text that its value can have, and
// what has the keyboard is not drawn anew by a value that comes. Never asks the gateway: reading and writing are handed in.
import { gatewayText, t } from '../language';
import { isLongArray, type ParameterTable, type Row } from '../state/parameter-table';
import { fieldLines, helpText, longestText, rangeText, steppedText, unitText, valueText } from '../text/parameter';
import { isApart, isChanged } from '../text/transfer';
import { HelpButton } from './help-button';
import { memo } from './memo';
import { EditCell } from './parameter-edit';
import { Written } from './parameter-history';
import { Age, LiveValue, type Since } from './parameter-live';

interface RowProps {
  axis: string;
  row: Row;
  table: ParameterTable;
}

function RowView({ axis, row, table }: RowProps) {
  const p = row.data.peek(); // id, name and description never change
  return (
    <tr data-parameter={p.id}>
      <th scope="row">
        <span class="both">
          <span class="mono id">{p.id}</span>
          <span class="name">
            <span {...gatewayText}>{p.name.replaceAll('_', ' ')}</span> <HelpButton of={p.id}>{helpText(p)}</HelpButton>
          </span>
        </span>
      </th>
      <LiveCell row={row} since={table.since_ms} />
      <StoredCell row={row} />
      <RangeCells row={row} />
      <EditCell axis={axis} row={row} table={table} />
      <WrittenCell axis={axis} row={row} />
    </tr>
  );
}
export const ParameterRow = memo(RowView, (a, b) => a.row === b.row && a.table === b.table);

function LiveCell({ row, since }: { row: Row; since: Since }) {
  const p = row.data.value;
  if (isLongArray(p)) {
    return (
      <td class="num" data-label={t('Live')} data-field="live">
        <span class="where">{t('{count} elements', { count: p.count ?? 0 })}</span>
      </td>
    );
  }
  const differs = isChanged(p);
  const longest = longestText(p);
  return (
    <td class={`num${p.quality === 'good' ? '' : ' is-not-good'}`} data-label={t('Live')} data-field="live">
      <span class={longest ? 'roomy' : 'one-line'} data-longest={longest || undefined}>
        <span>
          <LiveValue p={p} since={since} differs={differs} />{' '}
          <span class="unit">{p.value !== null && !p.allowed ? `${unitText(p.unit)} ${steppedText(p.value, p.unit)}`.trim() : ''}</span>
        </span>
      </span>
      <span class="one-line about">
        {differs && (
          <span class="flag changed" title={t('Not the default of the family')}>
            {t('changed')}{' '}
          </span>
        )}
        {p.quality === 'stale' && <span class="flag">{t('stale')}{' '}</span>}
        {p.at === null ? <span class="age">{t('not read yet')}</span> : <Age p={p} />}
      </span>
      {(p.fields ?? []).map((f, i) => (
        <span key={f.name} class="part roomy" data-longest={`${f.name.replaceAll('_', ' ')}: ${longestOf(f.allowed?.map((a) => a.meaning) ?? [])}`}>
          <span {...gatewayText}>{fieldLines(p.value, p)[i] ?? `${f.name.replaceAll('_', ' ')}: –`}</span>
        </span>
      ))}
    </td>
  );
}
const longestOf = (texts: readonly string[]): string => texts.reduce((a, b) => (b.length > a.length ? b : a), '');

function StoredCell({ row }: { row: Row }) {
  const p = row.data.value;
  return (
    <td class="num mono" data-label={t('Stored')}>
      {valueText(p.stored, p)}
      {isApart(p) && (
        <span class="flag" title={t('The drive has another value than the one written last')}>
          {' '}
          {t('differs')}
        </span>
      )}
    </td>
  );
}

function RangeCells({ row }: { row: Row }) {
  const p = row.data.value;
  return (
    <>
      <td class="num mono" data-label={t('Default')}>
        {valueText(p.default, p)}
      </td>
      <td class="range" data-label={t('Range')}>
        <span class="mono">{rangeText(p)}</span> <span class="unit">{unitText(p.unit)}</span>
      </td>
    </>
  );
}

function WrittenCell({ axis, row }: { axis: string; row: Row }) {
  return (
    <td class="written" data-label={t('Last written')}>
      <Written axis={axis} p={row.data.value} />
    </td>
  );
}
