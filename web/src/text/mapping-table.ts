// Mapping table: rows of a spreadsheet into mappings, each with its faults, also among one another. In: text, what is known, what is there.
// Out: rows in their order. A row with the id of a present mapping takes its place. Pure.
import { t } from '../language';
import { checkTexts } from './mapping-check';
import { cellsOf, columns, columnText, conflictsOf, placeText, type Known, type Mapping, type MappingSpec, type Texts } from './mapping';
import { csvOf, mostRows, pointed, rowsOf, separatorOf } from './table-text';

export interface ReadRow {
  line: number;
  texts: Partial<Texts> & { id?: string };
  spec: MappingSpec | null;
  faults: string[];
}

type Column = (typeof columns)[number];
const plain: Column[] = ['unit', 'table', 'address', 'axis', 'point', 'type', 'scale', 'offset', 'access', 'comment'];
const nameOf = (cell: string): Column | null => {
  const n = cell.trim().toLowerCase().replaceAll(' ', '_');
  return (columns as readonly string[]).includes(n) ? (n as Column) : null;
};

export function readTable(text: string, known: Known, present: readonly Mapping[]): { rows: ReadRow[]; problem: string } {
  const separator = separatorOf(text);
  const { rows, tooMany } = rowsOf(text, separator);
  const first = rows[0];
  if (!first) return { rows: [], problem: '' };
  const named = first.cells.filter((c) => nameOf(c) !== null).length >= 2;
  const heads: (Column | null)[] = named ? first.cells.map(nameOf) : plain;
  let problem = tooMany ? t('At most {n} rows are read; the rest is not.', { n: mostRows }) : '';
  if (named) {
    const unknown = first.cells.filter((c) => c !== '' && nameOf(c) === null);
    if (unknown.length > 0) problem = t('Column {name} is not known and would be left out.', { name: unknown.join(', ') });
    const twice = heads.find((h, i) => h !== null && heads.indexOf(h) !== i);
    if (twice) problem = t('Column {name} stands there twice.', { name: twice });
  }
  const taken: Mapping[] = [];
  const ids = new Map<string, number>();
  const read = (named ? rows.slice(1) : rows).map(({ line, cells }): ReadRow => {
    const texts: ReadRow['texts'] = {};
    heads.forEach((h, i) => {
      if (h) texts[h] = h === 'scale' || h === 'offset' ? pointed(cells[i] ?? '', separator) : (cells[i] ?? '');
    });
    const { spec, faults } = checkTexts(texts, known);
    const parts: string[] = Object.entries(faults).map(([f, why]) => t('{field}: {why}', { field: columnText[f as Column], why }));
    const id = texts.id?.trim() ?? '';
    if (cells.length > heads.length) parts.push(t('The row has {cells} cells, the table {columns} columns.', { cells: cells.length, columns: heads.length }));
    if (id !== '') {
      if (!/^[A-Za-z0-9_.-]{1,64}$/.test(id)) parts.push(t('id: 1 to 64 letters, digits, - _ and .'));
      else if (ids.has(id)) parts.push(t('id: line {line} has {id} too.', { line: ids.get(id) ?? '', id }));
      ids.set(id, line);
    }
    if (spec) {
      if (id !== '') spec.id = id;
      const whole = { type: 'i32', table: 'holding_registers', word_order: 'high_first', scale: 1, offset: 0, access: 'R', ...spec, id: id || t('line {line}', { line }) } as Mapping;
      for (const c of conflictsOf(whole, taken)) parts.push(t('Address: {place} is taken by {id} of this table.', { place: placeText(whole), id: c.id }));
      taken.push(whole);
    }
    return { line, texts, spec, faults: parts };
  });
  // Against what is there, without the entries that the table replaces.
  const staying = present.filter((m) => !ids.has(m.id));
  for (const row of read) {
    if (!row.spec) continue;
    for (const c of conflictsOf({ type: 'i32', table: 'holding_registers', ...row.spec }, staying).slice(0, 2)) {
      row.faults.push(t('Address: taken by {id} ({point} of {axis}, {place}).', { id: c.id, point: c.point, axis: c.axis, place: placeText(c) }));
    }
  }
  return { rows: read, problem };
}

export const csvOfSpecs = (specs: readonly MappingSpec[]): string => csvOf([columns, ...specs.map((s) => cellsOf(s as Partial<Mapping>))]);

/** What has to be known before rows can be called good: the points, and the parameters of an axis whose rows name none of them. Empty: all is there. */
export function catalogueMissing(specs: readonly MappingSpec[], known: Known): string {
  if (specs.length === 0) return '';
  if (known.points.length === 0) return t('Waiting for the list of points …');
  const simple = new Set(known.points.map((p) => p.point));
  const open = [...new Set(specs.filter((s) => !simple.has(s.point)).map((s) => s.axis ?? ''))].filter((a) => known.parameters(a) === null);
  return open.length > 0 ? t('Waiting for the parameters of {axes} …', { axes: open.join(', ') }) : '';
}
