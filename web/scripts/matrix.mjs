// Makes a family's chapter of statements: what its manual says about the drive, what the twin does, and which test shows it.
// In: adapters/<family>/twin/matrix.json, and the freedoms in schema/families/<family>.json. Out: Markdown of the chapter.
// tests/tidy/matrix.py checks the data: fields, numbers, and that every named test exists.
import { existsSync, readFileSync } from 'node:fs';
import { join } from 'node:path';

const kinds = { as_printed: 'as printed', choice: 'a choice', not_modelled: 'not modelled' };
/** @typedef {{ number: string, statement: string, source: string, kind: keyof typeof kinds, note?: string, tests?: string[] }} Statement */
/** @typedef {{ name: string, unit?: string, min?: number, max?: number, default?: number, description: string, source: string, values?: Record<string, string>, named?: Record<string, number> }} Freedom */

/** The family of a path, if the path is such a file. @param {string} file */
export const familyOf = (file) => /^adapters\/([a-z0-9]+)\/twin\/matrix\.json$/.exec(file)?.[1];

/** A cell of a table: one line, with bars and marks of Markdown as they stand. @param {string} s */
const cell = (s) => s.replace(/\s+/g, ' ').replace(/[\\|*_<>[\]]/g, (c) => `\\${c}`);
/** @param {Statement} s */
const remark = (s) => `${kinds[s.kind]}${s.note ? `: ${s.note}` : ''}`;
/** Tests by their program: it is said once for the tests that follow. @param {string[]} tests */
function shown(tests) {
  let before = '';
  return tests
    .map((t) => {
      const [program = '', name = ''] = t.split(': ');
      const text = program === before ? `\`${name}\`` : `${cell(program)}: \`${name}\``;
      before = program;
      return text;
    })
    .join(', ');
}

/** @param {Freedom} f */
const range = (f) => (f.values ? Object.entries(f.values).map(([n, meaning]) => `${n}: ${meaning}`).join('; ') : `${f.min} to ${f.max}${f.unit ? ` ${f.unit.replaceAll('_', ' ')}` : ''}`);

/** @param {Freedom[]} freedoms */
function freedomsText(freedoms) {
  if (freedoms.length === 0) return '';
  const rows = freedoms.map((f) => {
    const named = Object.entries(f.named ?? {}).map(([name, value]) => `${name} ${value}`).join(', ');
    return `| \`${f.name}\` | ${cell(f.description)} | ${cell(range(f))} | ${f.default ?? 0} | ${cell(named)} | ${cell(f.source)} |`;
  });
  return `
## Freedoms

The manual leaves these choices to the drive, or says nothing about them. The default is specimen 0, to which the statements above apply. The twin's
option \`specimen\` chooses other values, and each freedom is a twin option of its own as well.

| Freedom | Meaning | Values | Default | Named specimens | Source |
|---|---|---|---|---|---|
${rows.join('\n')}
`;
}

/** @param {string} top folder of the sources @param {string} family */
export function matrixText(top, family) {
  const data = JSON.parse(readFileSync(join(top, `adapters/${family}/twin/matrix.json`), 'utf8'));
  const page = join(top, `schema/families/${family}.json`);
  const about = existsSync(page) ? JSON.parse(readFileSync(page, 'utf8')) : {};
  /** @type {Statement[]} */
  const all = data.statements;
  const count = (/** @type {keyof typeof kinds} */ kind) => all.filter((s) => s.kind === kind).length;
  const sections = Object.entries(data.sections).map(([number, title]) => {
    const rows = all.filter((s) => s.number.split('.')[0] === number);
    const lines = rows.map((s) => `| ${s.number} | ${cell(s.statement)} | ${cell(s.source)} | ${cell(remark(s))} | ${shown(s.tests ?? [])} |`);
    return `## ${number}. ${cell(title)}\n\n| No. | Statement | Source | The twin | Shown by |\n|---|---|---|---|---|\n${lines.join('\n')}\n`;
  });
  return `# ${cell(about.title ?? family)}: manual and twin, statement by statement

Source of the statements: ${cell(data.manual)}.

Of ${all.length} statements the twin does ${count('as_printed')} *as printed*; ${count('choice')} are *a choice*, because the manual is silent, contradicts itself or leaves
the point to the drive; ${count('not_modelled')} are *not modelled*. [Drives and twins](../../../docs/handbook/drives-and-twins.md#the-printed-matrix) tells how to read
this chapter.

${sections.join('\n')}${freedomsText(about.freedoms ?? [])}`;
}
