// Table text: rows from what a spreadsheet puts on the clipboard (tabs) or into a file (commas or semicolons), and back to CSV.
// In: text. Out: rows of cells with the number of their line. A quoted cell may hold separators, quotes (doubled) and line breaks.
// At most 5000 rows are taken; the reader is told. Never guesses values.

export interface TextRow {
  /** Line of the text where the row begins, from 1. */
  line: number;
  cells: string[];
}
export const mostRows = 5000;

/** The separator that the first line uses: a tab if there is one, else whichever of ; and , is more frequent outside quotes. */
export function separatorOf(text: string): string {
  const first = (text.split(/\r?\n/).find((l) => l.trim() !== '') ?? '').replace(/"[^"]*"/g, '');
  if (first.includes('\t')) return '\t';
  return first.split(';').length > first.split(',').length ? ';' : ',';
}

export function rowsOf(text: string, separator = separatorOf(text)): { rows: TextRow[]; tooMany: boolean } {
  const rows: TextRow[] = [];
  let cells: string[] = [];
  let cell = '';
  let line = 1;
  let begun = 1;
  let quoted = false;
  const source = text.replace(/^\uFEFF/, '');
  const endRow = () => {
    cells.push(cell);
    if (cells.some((c) => c.trim() !== '')) rows.push({ line: begun, cells: cells.map((c) => c.trim()) });
    cells = [];
    cell = '';
  };
  for (let i = 0; i < source.length; i += 1) {
    const c = source[i] as string;
    if (quoted) {
      if (c === '"' && source[i + 1] === '"') {
        cell += '"';
        i += 1;
      } else if (c === '"') quoted = false;
      else {
        cell += c;
        if (c === '\n') line += 1;
      }
    } else if (c === '"' && cell.trim() === '') {
      quoted = true;
      cell = '';
    } else if (c === separator) {
      cells.push(cell);
      cell = '';
    } else if (c === '\n') {
      endRow();
      line += 1;
      begun = line;
      if (rows.length > mostRows) return { rows: rows.slice(0, mostRows), tooMany: true };
    } else if (c !== '\r') cell += c;
  }
  endRow();
  return { rows: rows.slice(0, mostRows), tooMany: rows.length > mostRows };
}

/** One cell as CSV: quoted where it must be. */
export const csvCell = (value: string): string => (/[",;\r\n]|^\s|\s$/.test(value) ? `"${value.replaceAll('"', '""')}"` : value);
export const csvOf = (rows: readonly (readonly string[])[]): string => rows.map((r) => `${r.map(csvCell).join(',')}\n`).join('');

/** "1,5" as 1.5 in a table whose cells are separated by something else than commas; with a point beside it, it is left to be refused. */
export const pointed = (cell: string, separator: string): string => (separator !== ',' && /^\s*[+\-\u2212]?\d*,\d+(e[+-]?\d+)?\s*$/i.test(cell) ? cell.replace(',', '.') : cell);
