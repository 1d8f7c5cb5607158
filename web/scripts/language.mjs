// Language: is every word that a person reads said through t(), and does each table have every sentence? By TypeScript's own tree and types.
// In: web/src. Out: faults in words and a failure; --keys: the sentences with their files as JSON; --missing de: those that a table lacks.
// Never changes a file. What is no text for people is listed beside it, each with its reason; nothing else is let through.
import { readFileSync, writeFileSync } from 'node:fs';
import { dirname, join, relative, resolve } from 'node:path';
import { fileURLToPath } from 'node:url';
import ts from 'typescript';

/** @typedef {{ key: string, file: string, line: number, values: string[] | undefined }} Use */
/** @typedef {{ file: string, line: number, text: string, start: number }} Fault */

/** Attributes whose texts are for machines: names, addresses, looks. All others are read by people. */
const machineAttributes = new Set(
  ('class className id for name type role href src rel target fill autocomplete autocapitalize inputMode inputmode key d viewBox stroke transform style points width height ' +
    'lang field tone icon need accept method download list form x y x1 x2 y1 y2 cx cy r rx ry dx dy preserveAspectRatio offset side value popover popovertarget scope xmlns help kind as').split(' '),
);
const isMachineAttribute = (/** @type {string} */ name) =>
  machineAttributes.has(name) || name.startsWith('data-') || /^stroke-|^text-|^dominant-|^font-/.test(name) || /^aria-(?!label$|description$|roledescription$|valuetext$|placeholder$)/.test(name);

/** Elements that show what is typed or printed as it stands: code, and the names on keys. */
const machineElements = new Set(['code', 'kbd', 'samp', 'pre']);

/** Functions whose texts are names, patterns or addresses. */
const machineCalls = new Set(
  ('addEventListener removeEventListener querySelector querySelectorAll getElementById getElementsByClassName closest matches setAttribute getAttribute hasAttribute removeAttribute createElement ' +
    'createElementNS split join startsWith endsWith includes indexOf lastIndexOf replace replaceAll match matchAll test search localeCompare padStart padEnd persisted getItem setItem removeItem call json ' +
    'get set has delete postMessage follow subscribe BroadcastChannel matchMedia fetch toggle add remove contains getPropertyValue setProperty encodeURIComponent toLocaleString NumberFormat DateTimeFormat ' +
    'RegExp URL Blob go useGateway hasOwn getContext normalize toISOString formatToParts open dispatchEvent CustomEvent Event getEntriesByType measure mark').split(' '),
);

/** Members whose texts are for machines wherever they stand. */
const machineMembers = new Set('path icon tone name value type kind field key id class method href unit mode role cache credentials headers event help language'.split(' '));
/** Members that are read by people, so that one small word is text as well. */
const readMembers = new Set('text long label title hint heading words what word yes no why placeholder told said about note message caption summary description'.split(' '));

/** A word of this shape is a name of the API, a unit or a look: not asked about unless it stands where only text can. */
const looksLikeText = (/** @type {string} */ s) => {
  const plain = s.replaceAll(hole, ' x ').trim();
  if (!/\p{L}{2}/u.test(s.replaceAll(hole, ' '))) return false;
  if (/^[./#?&@:]|^https?:|^\w+\/[\w/.*-]+$|^[a-z]+:\S*$/.test(plain)) return false;
  if (/^[A-Z]\p{Ll}+/u.test(plain) && !/^[A-Z][a-z]+[A-Z]/.test(plain)) return true;
  return /[\p{L}\d,;:)“”"'…{}] +[\p{L}(“"{]/u.test(plain) && /\p{L}{2,}/u.test(plain);
};
const hole = '\u0000';

/**
 * Reads the sources. `files`: absolute names; `exempt`: texts that are none for people, by file.
 * @param {{ root: string, files: string[], options?: ts.CompilerOptions, exempt?: Record<string, RegExp[]> }} what
 * @returns {{ uses: Use[], faults: Fault[] }}
 */
export function examine({ root, files, options = {}, exempt = {} }) {
  const program = ts.createProgram(files, { noEmit: true, allowJs: false, target: ts.ScriptTarget.ES2022, module: ts.ModuleKind.ESNext, moduleResolution: ts.ModuleResolutionKind.Bundler, jsx: ts.JsxEmit.ReactJSX, jsxImportSource: 'preact', strict: true, skipLibCheck: true, ...options });
  const checker = program.getTypeChecker();
  /** @type {Use[]} */
  const uses = [];
  /** @type {Fault[]} */
  const faults = [];
  const wanted = new Set(files.map((f) => resolve(f)));
  for (const source of program.getSourceFiles()) {
    const name = relative(root, source.fileName).replaceAll('\\', '/');
    if (!wanted.has(resolve(source.fileName)) || /^language\/|\.d\.ts$/.test(name)) continue;
    const allowed = exempt[name] ?? [];
    const line = (/** @type {ts.Node} */ n) => source.getLineAndCharacterOfPosition(n.getStart(source)).line + 1;
    const fault = (/** @type {ts.Node} */ n, /** @type {string} */ text) => faults.push({ file: name, line: line(n), text, start: n.getStart(source) });
    const unsaid = (/** @type {ts.Node} */ n, /** @type {string} */ text) => {
      const shown = text.replaceAll(hole, '{…}').trim();
      if (!allowed.some((a) => a.test(shown))) fault(n, `not said through t(): ${JSON.stringify(shown)}`);
    };

    /** @param {ts.CallExpression} call */
    const sayer = (call) => {
      const symbol = checker.getSymbolAtLocation(call.expression);
      if (!symbol) return '';
      const real = symbol.flags & ts.SymbolFlags.Alias ? checker.getAliasedSymbol(symbol) : symbol;
      const at = real.declarations?.[0]?.getSourceFile().fileName ?? '';
      return /[/\\]language[/\\]index\.ts$/.test(at) && (real.name === 't' || real.name === 'rich') ? real.name : '';
    };

    /** @param {ts.Node} n */
    const visit = (n) => {
      if (ts.isImportDeclaration(n) || ts.isExportDeclaration(n) || ts.isTypeNode(n) || ts.isTypeAliasDeclaration(n) || ts.isInterfaceDeclaration(n)) return;
      if (ts.isCallExpression(n) && sayer(n)) return said(n);
      if (ts.isJsxText(n)) {
        const text = n.text.replace(/\s+/g, ' ');
        if (/\p{L}{2}/u.test(text.replace(/&\w+;/g, '')) && !inMachineElement(n)) unsaid(n, text);
        return;
      }
      if (ts.isStringLiteral(n) || ts.isNoSubstitutionTemplateLiteral(n)) return literal(n, n.text);
      if (ts.isTemplateExpression(n)) {
        literal(n, n.head.text + n.templateSpans.map((s) => hole + s.literal.text).join(''));
        for (const s of n.templateSpans) visit(s.expression);
        return;
      }
      ts.forEachChild(n, visit);
    };

    /** @param {ts.CallExpression} call */
    const said = (call) => {
      const [first, second] = call.arguments;
      if (!first || !(ts.isStringLiteral(first) || ts.isNoSubstitutionTemplateLiteral(first))) {
        fault(call, 't() of something that is no literal: the sentence cannot be found in a table');
        if (first) visit(first);
      } else {
        /** @type {string[] | undefined} */
        let values;
        if (second && ts.isObjectLiteralExpression(second) && second.properties.every((p) => !ts.isSpreadAssignment(p))) values = second.properties.map((p) => p.name?.getText(source).replace(/^['"]|['"]$/g, '') ?? '');
        const places = placeholders(first.text);
        if (values) {
          for (const p of places) if (!values.includes(p)) fault(call, `${JSON.stringify(first.text)} has no value for {${p}}`);
          for (const v of values) if (!places.includes(v)) fault(call, `${JSON.stringify(first.text)} has no place for the value ${v}`);
        } else if (!second && places.length > 0) fault(call, `${JSON.stringify(first.text)} has no value for {${places[0]}}`);
        if (first.text.trim() !== first.text || first.text === '') fault(call, `${JSON.stringify(first.text)} begins or ends with a blank: a piece of a sentence cannot be translated`);
        uses.push({ key: first.text, file: name, line: line(call), values });
      }
      if (second) visit(second);
    };

    /** @param {ts.Node} n */
    const inMachineElement = (n) => {
      for (let p = n.parent; p; p = p.parent) if (ts.isJsxElement(p) && machineElements.has(p.openingElement.tagName.getText(source))) return true;
      return false;
    };

    /** The place of a literal behind ?:, ||, ??, &&, + and brackets. @param {ts.Node} n @returns {{ node: ts.Node, in: ts.Node }} */
    const placeOf = (n) => {
      let at = n;
      for (;;) {
        const p = at.parent;
        const through =
          ts.isParenthesizedExpression(p) || ts.isAsExpression(p) || ts.isSatisfiesExpression(p) || ts.isTemplateSpan(p) || ts.isTemplateExpression(p) || (ts.isConditionalExpression(p) && p.condition !== at) ||
          (ts.isBinaryExpression(p) && [ts.SyntaxKind.BarBarToken, ts.SyntaxKind.QuestionQuestionToken, ts.SyntaxKind.AmpersandAmpersandToken, ts.SyntaxKind.PlusToken].includes(p.operatorToken.kind));
        if (!through) return { node: at, in: p };
        at = p;
      }
    };

    /** Whether only certain words fit where the literal stands: then it is a name, no text. @param {ts.Expression} n */
    const oneOfSome = (n) => {
      const type = checker.getContextualType(n);
      if (!type) return false;
      const parts = type.isUnion() ? type.types : [type];
      if (parts.some((t) => t.flags & (ts.TypeFlags.String | ts.TypeFlags.Any | ts.TypeFlags.Unknown))) return false;
      return parts.some((t) => t.flags & (ts.TypeFlags.StringLiteral | ts.TypeFlags.TemplateLiteral | ts.TypeFlags.Index));
    };

    /** @param {ts.Expression} n @param {string} text */
    const literal = (n, text) => {
      if (!/\p{L}{2}/u.test(text.replaceAll(hole, ' ')) || inMachineElement(n)) return;
      const place = placeOf(n);
      const at = place.in;
      if (ts.isPropertyAssignment(at) && at.name === place.node) return;
      if (ts.isElementAccessExpression(at) || ts.isCaseClause(at) || ts.isLiteralTypeNode(at) || ts.isComputedPropertyName(at) || ts.isEnumMember(at)) return;
      if (ts.isBinaryExpression(at) && at.operatorToken.kind !== ts.SyntaxKind.EqualsToken && at.operatorToken.kind !== ts.SyntaxKind.PlusEqualsToken) return; // ===, in
      if ((ts.isCallExpression(at) || ts.isNewExpression(at)) && machineCalls.has(calledName(at.expression))) return;
      if (oneOfSome(n)) return;
      let small = false;
      if (ts.isJsxAttribute(at) || (ts.isJsxExpression(at) && ts.isJsxAttribute(at.parent))) {
        const attribute = ts.isJsxAttribute(at) ? at : /** @type {ts.JsxAttribute} */ (at.parent);
        if (isMachineAttribute(attribute.name.getText(source))) return;
        small = true;
      } else if (ts.isJsxExpression(at)) small = true;
      else if (ts.isPropertyAssignment(at)) {
        const member = at.name.getText(source).replace(/^['"]|['"]$/g, '');
        if (machineMembers.has(member)) return;
        small = readMembers.has(member);
      } else if (ts.isArrayLiteralExpression(at) && at.parent && ts.isCallExpression(at.parent.parent ?? at) && calledName(/** @type {ts.CallExpression} */ (at.parent.parent).expression) === 'join') return;
      if (small ? !/^[./#]/.test(text.replaceAll(hole, 'x')) && /\p{L}{2}/u.test(text) : looksLikeText(text)) unsaid(n, text);
    };

    visit(source);
  }
  return { uses, faults };
}

const calledName = (/** @type {ts.Expression} */ e) => (ts.isPropertyAccessExpression(e) ? e.name.text : ts.isIdentifier(e) ? e.text : '');
export const placeholders = (/** @type {string} */ s) => [...new Set([...s.matchAll(/\{(\w+)\}/g)].map((m) => m[1] ?? ''))].sort();

/**
 * What is wrong between the sentences and a table: missing, not used, other placeholders, empty, or said with a blank too many.
 * @param {string} language @param {Iterable<string>} keys @param {Readonly<Record<string, string>>} table @returns {string[]}
 */
export function compare(language, keys, table) {
  const out = [];
  const wanted = new Set(keys);
  for (const key of wanted) {
    const said = table[key];
    if (said === undefined) out.push(`${language}: no sentence for ${JSON.stringify(key)}`);
    else if (said.trim() !== said || said === '') out.push(`${language}: ${JSON.stringify(key)} is said with nothing, or with a blank at an end`);
    else if (placeholders(said).join() !== placeholders(key).join()) out.push(`${language}: ${JSON.stringify(key)} has {${placeholders(key).join('}, {')}}, its translation {${placeholders(said).join('}, {')}}`);
  }
  for (const key of Object.keys(table)) if (!wanted.has(key)) out.push(`${language}: nothing says ${JSON.stringify(key)} any more`);
  return out;
}

/** The pairs of a table's file and of those that it spreads, as they stand; a sentence that stands twice is a fault. @param {string} file */
export function tableOf(file) {
  /** @type {Record<string, string>} */
  const table = {};
  /** @type {string[]} */
  const faults = [];
  const read = (/** @type {string} */ path) => {
    const source = ts.createSourceFile(path, readFileSync(path, 'utf8'), ts.ScriptTarget.ES2022, true);
    const visit = (/** @type {ts.Node} */ n) => {
      if (ts.isImportDeclaration(n) && ts.isStringLiteral(n.moduleSpecifier) && !n.importClause?.isTypeOnly) read(`${join(dirname(path), n.moduleSpecifier.text)}.ts`);
      if (ts.isPropertyAssignment(n) && ts.isStringLiteralLike(n.initializer)) {
        const key = ts.isStringLiteralLike(n.name) || ts.isIdentifier(n.name) ? n.name.text : '';
        if (Object.hasOwn(table, key)) faults.push(`${path}: ${JSON.stringify(key)} stands twice`);
        table[key] = n.initializer.text;
      }
      ts.forEachChild(n, visit);
    };
    visit(source);
  };
  read(file);
  return { table, faults };
}

if (process.argv[1] === fileURLToPath(import.meta.url)) {
  const { derived, exempt } = await import('./language-lists.mjs');
  const at = process.argv.indexOf('--src');
  const root = at > 0 ? resolve(process.argv[at + 1] ?? '') : fileURLToPath(new URL('../src', import.meta.url));
  const files = ts.sys.readDirectory(root, ['.ts', '.tsx'], ['**/*.d.ts']);
  const { uses, faults } = examine({ root, files, exempt, options: { types: ['vite/client'], exactOptionalPropertyTypes: true, noUncheckedIndexedAccess: true } });
  const keys = new Set([...uses.map((u) => u.key), ...derived]);
  if (process.argv.includes('--keys')) {
    writeFileSync(1, JSON.stringify(uses));
    process.exit(0);
  }
  const tables = ['de', 'zh'].map((l) => ({ l, ...tableOf(join(root, 'language', `${l}.ts`)) }));
  const all = [
    ...faults.map((f) => `${f.file}:${f.line}: ${f.text}`),
    ...tables.flatMap((t) => [...t.faults, ...compare(t.l, keys, t.table)]),
  ];
  for (const f of all) console.error(`language: ${f}`);
  console.log(`language: ${keys.size} sentences in ${new Set(uses.map((u) => u.file)).size} files`);
  process.exit(all.length > 0 ? 1 : 0);
}
