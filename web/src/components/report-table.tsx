// Report table: one table and one fact of the commissioning report. In: heads, rows, words. Out: what is drawn and printed.
import type { ComponentChildren } from 'preact';
import { TableHead } from './table-head';

export function Fact({ name, value }: { name: string; value: string }) {
  return (
    <div>
      <dt>{name}</dt>
      <dd>{value || '–'}</dd>
    </div>
  );
}

export function ReportTable({ head, children }: { head: readonly string[]; children: ComponentChildren }) {
  return (
    <div class="scroll" tabIndex={0} role="region" aria-label={head[0]}>
      <table class="report-table">
        <TableHead of={head} />
        <tbody>{children}</tbody>
      </table>
    </div>
  );
}
