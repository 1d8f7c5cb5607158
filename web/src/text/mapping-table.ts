// Mapping table: rows of a spreadsheet into mappings, each with its faults, also among one another. In: text, what is known, what is there.
// Out: rows in their order. A row with the id of a present mapping takes its place. Pure.
import { checkTexts, cellsOf, columns, conflictsOf, placeText, type Known, type Mapping, type MappingSpec, type Texts } from './mapping';
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
  let problem = tooMany ? `At most ${mostRows} rows are read; the rest is not.` : '';
  if (named) {
    const unknown = first.cells.filter((c) => c !== '' && nameOf(c) === null);
    if (unknown.length > 0) problem = `Column ${unknown.join(', ')} is not known and would be left out.`;
    const twice = heads.find((h, i) => h !== null && heads.indexOf(h) !== i);
    if (twice) problem = `Column ${twice} stands there twice.`;
  }
  const taken: Mapping[] = [];
  const ids = new Map<string, number>();
  const read = (named ? rows.slice(1) : rows).map(({ line, cells }): ReadRow => {
    const texts: ReadRow['texts'] = {};
    heads.forEach((h, i) => {
      if (h) texts[h] = h === 'scale' || h === 'offset' ? pointed(cells[i] ?? '', separator) : (cells[i] ?? '');
    });
    const { spec, faults } = checkTexts(texts, known);
    const words: string[] = Object.entries(faults).map(([f, why]) => `${f.replace('_', ' ')}: ${why}`);
    const id = texts.id?.trim() ?? '';
    if (cells.length > heads.length) words.push(`The row has ${cells.length} cells, the table ${heads.length} columns.`);
    if (id !== '') {
      if (!/^[A-Za-z0-9_.-]{1,64}$/.test(id)) words.push(`id: 1 to 64 letters, digits, - _ and .`);
      else if (ids.has(id)) words.push(`id: line ${ids.get(id)} has ${id} too.`);
      ids.set(id, line);
    }
    if (spec) {
      if (id !== '') spec.id = id;
      const whole = { type: 'i32', table: 'holding_registers', word_order: 'high_first', scale: 1, offset: 0, access: 'R', ...spec, id: id || `line ${line}` } as Mapping;
      for (const c of conflictsOf(whole, taken)) words.push(`Address: ${placeText(whole)} is taken by ${c.id} of this table.`);
      taken.push(whole);
    }
    return { line, texts, spec, faults: words };
  });
  // Against what is there, without the entries that the table replaces.
  const staying = present.filter((m) => !ids.has(m.id));
  for (const row of read) {
    if (!row.spec) continue;
    for (const c of conflictsOf({ type: 'i32', table: 'holding_registers', ...row.spec }, staying).slice(0, 2)) {
      row.faults.push(`Address: taken by ${c.id} (${c.point} of ${c.axis}, ${placeText(c)}).`);
    }
  }
  return { rows: read, problem };
}

export const csvOfSpecs = (specs: readonly MappingSpec[]): string => csvOf([columns, ...specs.map((s) => cellsOf(s as Partial<Mapping>))]);

/** What has to be known before rows can be called good: the points, and the parameters of an axis whose rows name none of them. Empty: all is there. */
export function catalogueMissing(specs: readonly MappingSpec[], known: Known): string {
  if (specs.length === 0) return '';
  if (known.points.length === 0) return 'Waiting for the list of points …';
  const simple = new Set(known.points.map((p) => p.point));
  const open = [...new Set(specs.filter((s) => !simple.has(s.point)).map((s) => s.axis ?? ''))].filter((a) => known.parameters(a) === null);
  return open.length > 0 ? `Waiting for the parameters of ${open.join(', ')} …` : '';
}
