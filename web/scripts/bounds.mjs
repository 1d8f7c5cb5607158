// Bounds: is each part of the page small enough to be read at once? By TypeScript's own tree. In: web/src. Out: what is over a bound, and a failure.
// A branch is an if, a case, a loop, a catch, a ?:, && || or ??; those of a function within another one are counted there alone. Lines are counted whole.
import { readFileSync } from 'node:fs';
import { relative, resolve } from 'node:path';
import { fileURLToPath } from 'node:url';
import ts from 'typescript';

export const bounds = {
  /** A file of components or of a page, and a component in it: what it draws stands in one piece. */
  component_lines: 200,
  file_lines: 500,
  function_lines: 80,
  function_branches: 40,
};

/** @typedef {{ name: string, line: number, lines: number, branches: number, component: boolean }} Measured */

const { SyntaxKind } = ts;
const operators = new Set([SyntaxKind.AmpersandAmpersandToken, SyntaxKind.BarBarToken, SyntaxKind.QuestionQuestionToken]);
const isBranch = (/** @type {ts.Node} */ n) =>
  ts.isIfStatement(n) || ts.isConditionalExpression(n) || ts.isCaseClause(n) || ts.isCatchClause(n) || ts.isIterationStatement(n, false) || (ts.isBinaryExpression(n) && operators.has(n.operatorToken.kind));

/** @param {ts.Node} of @returns {number} */
function branchesOf(of) {
  let n = 0;
  const visit = (/** @type {ts.Node} */ node) => {
    if (isBranch(node)) n += 1;
    if (!ts.isFunctionLike(node)) ts.forEachChild(node, visit);
  };
  ts.forEachChild(of, visit);
  return n;
}

/** Its own name, or that of what it is kept in. @param {ts.SignatureDeclaration} f */
function nameOf(f) {
  const { parent } = f;
  const named = f.name ?? (ts.isVariableDeclaration(parent) || ts.isPropertyDeclaration(parent) || ts.isPropertyAssignment(parent) ? parent.name : undefined);
  return named?.getText() ?? '';
}

/**
 * The functions of a file, outer ones before those within them. A component is a function of a .tsx file whose name begins with a capital letter.
 * @param {string} file @param {string} text @returns {Measured[]}
 */
export function functionsOf(file, text) {
  const tsx = file.endsWith('.tsx');
  const source = ts.createSourceFile(file, text, ts.ScriptTarget.ES2022, true, tsx ? ts.ScriptKind.TSX : ts.ScriptKind.TS);
  const line = (/** @type {number} */ at) => source.getLineAndCharacterOfPosition(at).line + 1;
  /** @type {Measured[]} */
  const found = [];
  const visit = (/** @type {ts.Node} */ n) => {
    if (ts.isFunctionLike(n) && 'body' in n && n.body) {
      const name = nameOf(n);
      const first = line(n.getStart(source));
      found.push({ name, line: first, lines: line(n.end) - first + 1, branches: branchesOf(n), component: tsx && /^[A-Z]/.test(name) });
    }
    ts.forEachChild(n, visit);
  };
  visit(source);
  return found;
}

/** What of a file is over a bound. @param {string} file from web/src on @param {string} text @returns {string[]} */
export function faultsOf(file, text) {
  const over = (/** @type {string} */ what, /** @type {number} */ n, /** @type {string} */ unit, /** @type {number} */ most) => (n > most ? [`${what} has ${n} ${unit}; the bound is ${most}`] : []);
  const drawn = /^(components|pages)\//.test(file);
  const lines = text.split('\n').length - (text.endsWith('\n') ? 1 : 0);
  return [
    ...over(file, lines, 'lines', drawn ? bounds.component_lines : bounds.file_lines),
    ...functionsOf(file, text).flatMap((f) => {
      const what = `${file}:${f.line}: ${f.name || 'a function'}`;
      return [...over(what, f.lines, 'lines', f.component ? bounds.component_lines : bounds.function_lines), ...over(what, f.branches, 'branches', bounds.function_branches)];
    }),
  ];
}

/** @param {string} root @returns {{ files: number, faults: string[] }} */
export function faultsIn(root) {
  const files = ts.sys.readDirectory(root, ['.ts', '.tsx'], ['**/*.d.ts']); // what is generated is not read
  return { files: files.length, faults: files.flatMap((f) => faultsOf(relative(root, f).replaceAll('\\', '/'), readFileSync(f, 'utf8'))) };
}

if (process.argv[1] === fileURLToPath(import.meta.url)) {
  const at = process.argv.indexOf('--src');
  const { files, faults } = faultsIn(at > 0 ? resolve(process.argv[at + 1] ?? '') : fileURLToPath(new URL('../src', import.meta.url)));
  for (const f of faults) console.error(`bounds: ${f}`);
  console.log(`bounds: ${files} files, ${faults.length} over a bound`);
  process.exit(files === 0 || faults.length > 0 ? 1 : 0);
}
