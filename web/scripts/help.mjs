// Makes the handbook's pages: docs/handbook/README.md names the chapters and their order, each becomes dist/help/NAME.html, with a search index.
// In: Markdown of docs/, adapters/ and gateway/doors/, statements of twins (matrix.mjs). Out: dist/help/. Ends with a failure where a link, an anchor or a picture leads nowhere.
// Nothing inline and nothing from elsewhere, as the content security policy has it; the chapters can be read without any script.
import { copyFileSync, existsSync, mkdirSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { basename, dirname, join, normalize, relative } from 'node:path';
import { fileURLToPath } from 'node:url';
import MarkdownIt from 'markdown-it';
import { familyOf, matrixText } from './matrix.mjs';

const web = fileURLToPath(new URL('..', import.meta.url));
const top = join(web, '..');
const out = join(web, 'dist/help');
const book = 'docs/handbook/README.md';
/** @type {string[]} */
const faults = [];

const md = new MarkdownIt({ html: false, linkify: false, typographer: false });
/** @typedef {{ file: string, name: string, part: string, title: string, tokens: any[], headings: { level: number, text: string, id: string }[] }} Chapter */

/** @param {string} s */
const escape = (s) => s.replace(/[&<>"]/g, (c) => ({ '&': '&amp;', '<': '&lt;', '>': '&gt;', '"': '&quot;' })[c] ?? c);
/** Address of a file's page: docs/handbook/access.md is access, adapters/mcode/README.md is adapters-mcode, adapters/mcode/twin/matrix.json is adapters-mcode-matrix. @param {string} file */
const nameOf = (file) => (file === book ? 'index' : file.replace(/^docs\/(handbook\/)?/, '').replace(/(\/README)?\.md$|\/twin(?=\/matrix\.json$)|\.json$/g, '').replaceAll('/', '-'));
/** The words of an inline token, without marks. @param {any} token @returns {string} */
const words = (token) => (token.children ?? []).map((/** @type {any} */ t) => (t.type === 'softbreak' ? ' ' : t.content)).join('');
/** As GitHub makes anchors of headings. @param {string} text */
const slug = (text) => text.toLowerCase().replace(/[^\p{L}\p{N}\s_-]/gu, '').trim().replace(/\s/g, '-');

/** @param {string} file @param {string} part @returns {Chapter} */
function read(file, part) {
  const family = familyOf(file);
  const tokens = md.parse(family ? matrixText(top, family) : readFileSync(join(top, file), 'utf8'), {});
  const headings = [];
  const taken = new Set();
  for (let i = 0; i < tokens.length; ++i) {
    const t = tokens[i];
    if (t?.type !== 'heading_open') continue;
    const text = words(tokens[i + 1]);
    const base = slug(text);
    let id = base;
    for (let n = 1; taken.has(id); ++n) id = `${base}-${n}`;
    taken.add(id);
    t.attrSet('id', id);
    headings.push({ level: Number(t.tag.slice(1)), text, id });
  }
  const title = headings.find((h) => h.level === 1)?.text;
  if (!title) faults.push(`${file} has no title`);
  return { file, name: nameOf(file), part, title: title ?? file, tokens, headings };
}

/** The chapters in the order of the contents page; its second-level headings are the parts of the book. */
function chaptersOf(/** @type {Chapter} */ contents) {
  const list = [contents];
  let part = '';
  contents.tokens.forEach((t, i) => {
    if (t.type === 'heading_open' && t.tag === 'h2') part = words(contents.tokens[i + 1]);
    for (const c of t.children ?? []) {
      if (c.type !== 'link_open' || part === '') continue;
      const file = normalize(join(dirname(book), String(c.attrGet('href')).split('#')[0] ?? ''));
      if (!(file.endsWith('.md') || familyOf(file)) || list.some((x) => x.file === file)) continue;
      if (!existsSync(join(top, file))) faults.push(`${book} names ${file}, which is not there`);
      else list.push(read(file, part));
    }
  });
  return list;
}

const contents = read(book, '');
const chapters = chaptersOf(contents);
const byFile = new Map(chapters.map((c) => [c.file, c]));

/** Where a link of a chapter leads: a page of the book, an address of the gateway, or a file of the sources, which has no page. */
function target(/** @type {Chapter} */ c, /** @type {string} */ href) {
  if (href.startsWith('/')) return href;
  if (/^[a-z]+:/.test(href)) return (faults.push(`${c.file} links to ${href}: the gateway may stand where there is no other host`), null);
  const [path = '', anchor] = href.split('#');
  const file = path === '' ? c.file : relative(top, join(top, dirname(c.file), path)).replace(/\/$/, '');
  if (!existsSync(join(top, file))) return (faults.push(`${c.file} links to ${href}, which is not there`), null);
  const to = byFile.get(file);
  if (!to) return null;
  if (anchor && !to.headings.some((h) => h.id === anchor)) faults.push(`${c.file} links to ${href}: there is no such heading`);
  return `${to === c && anchor ? '' : `/help/${to.name === 'index' ? '' : `${to.name}.html`}`}${anchor ? `#${anchor}` : ''}`;
}

/** @type {Record<string, any>} */
const rules = md.renderer.rules;
rules.link_open = (/** @type {any} */ tokens, /** @type {number} */ i, /** @type {any} */ _o, /** @type {any} */ env) => {
  const href = target(env.chapter, String(tokens[i]?.attrGet('href')));
  env.open.push(href !== null);
  return href === null ? '<span class="source">' : `<a href="${escape(href)}">`;
};
rules.link_close = (/** @type {any} */ _t, /** @type {any} */ _i, /** @type {any} */ _o, /** @type {any} */ env) => (env.open.pop() ? '</a>' : '</span>');
// Alignment is a class, not a style; a wide table is scrolled by itself, by keyboard too.
for (const tag of ['th', 'td']) {
  rules[`${tag}_open`] = (/** @type {any} */ tokens, /** @type {number} */ i) => `<${tag}${/right/.test(tokens[i]?.attrGet('style') ?? '') ? ' class="right"' : ''}>`;
}
/** The pictures that chapters show, by their files. @type {Set<string>} */
const pictures = new Set();
/** Width and height of a drawing; pictures of the page have all the same. @param {string} file */
const sizeOf = (file) => (/^<svg [^>]*width="\d+" height="\d+"/.exec(file.endsWith('.svg') && existsSync(file) ? readFileSync(file, 'utf8') : '')?.[0].match(/(?<=(?:width|height)=")\d+/g) ?? ['1200', '760']);
/** NAME-light.webp or .svg has NAME-dark beside it; the styles show the one of the theme, and what is not shown is not fetched. */
rules.image = (/** @type {any} */ tokens, /** @type {number} */ i, /** @type {any} */ _o, /** @type {any} */ env) => {
  const src = String(tokens[i]?.attrGet('src'));
  return ['light', 'dark']
    .map((theme) => {
      const file = join(top, dirname(env.chapter.file), src.replace(/-light(?=\.\w+$)/, `-${theme}`));
      if (!/^[\w./-]+-light\.(webp|svg)$/.test(src) || !existsSync(file)) faults.push(`${env.chapter.file} shows ${src}: there is no such picture for ${theme}`);
      else pictures.add(file);
      const [width, height] = sizeOf(file);
      return `<img class="picture ${theme}" src="/help/${escape(basename(file))}" alt="${escape(words(tokens[i]))}" width="${width}" height="${height}" loading="lazy">`;
    })
    .join('');
};
let tables = 0;
rules.table_open = () => `<div class="table" tabindex="0" role="group" aria-label="Table ${++tables}"><table>`;
rules.table_close = () => '</table></div>';
rules.fence = rules.code_block = (/** @type {any} */ tokens, /** @type {number} */ i) => `<pre tabindex="0"><code>${escape(tokens[i]?.content ?? '')}</code></pre>\n`;

/** @param {Chapter} c */
const link = (c) => `/help/${c.name === 'index' ? '' : `${c.name}.html`}`;
function navigation(/** @type {Chapter} */ here) {
  const parts = [...new Set(chapters.map((c) => c.part))].filter((p) => p !== '');
  const item = (/** @type {Chapter} */ c) => `<li><a href="${link(c)}"${c === here ? ' aria-current="page"' : ''}>${escape(c.title)}</a></li>`;
  return parts.map((p) => `<h2>${escape(p)}</h2>\n<ul>\n${chapters.filter((c) => c.part === p).map(item).join('\n')}\n</ul>`).join('\n');
}

function page(/** @type {Chapter} */ c) {
  tables = 0;
  const body = md.renderer.render(c.tokens, md.options, { chapter: c, open: [] });
  const inside = c.headings.filter((h) => h.level === 2);
  const at = chapters.indexOf(c);
  const before = chapters[at - 1];
  const next = chapters[at + 1];
  const list = inside.length < 3 || c === contents ? '' : `<nav class="inside" aria-label="In this chapter"><ul>${inside.map((h) => `<li><a href="#${h.id}">${escape(h.text)}</a></li>`).join('')}</ul></nav>\n`;
  const [head = '', ...rest] = body.split('</h1>');
  // Lines use two names that the first page sets.
  const uses = c.tokens.some((t) => t.type === 'fence' && t.info === 'sh' && /\$api|\$json/.test(t.content)) && !c.tokens.some((t) => t.type === 'fence' && /^api=/m.test(t.content));
  const note = uses ? '<p class="note">Lines with <code>$api</code> and <code>$json</code> need the two names that <a href="/help/">the first page</a> sets.</p>\n' : '';
  return `<!doctype html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta name="color-scheme" content="light dark">
<title>${escape(c === contents ? 'Handbook' : c.title)} · axisgate</title>
<link rel="icon" href="/favicon.svg" type="image/svg+xml">
<link rel="stylesheet" href="/help/help.css">
<script src="/help/help.js" defer></script>
</head>
<body>
<a class="skip" href="#content">To the content</a>
<header class="head"><a class="brand" href="/help/">axisgate handbook</a><div id="search" class="search" role="search"></div><a class="back" href="/">To the gateway</a></header>
<div class="columns">
<nav class="book" aria-label="Chapters"><details open><summary>Chapters</summary>
${navigation(c)}
</details></nav>
<main id="content">
${head}</h1>
${list}${note}${rest.join('</h1>')}
<nav class="turn" aria-label="Previous and next chapter">${before ? `<a rel="prev" href="${link(before)}">← ${escape(before.title)}</a>` : '<span></span>'}${next ? `<a rel="next" href="${link(next)}">${escape(next.title)} →</a>` : ''}</nav>
</main>
</div>
</body>
</html>
`;
}

/** One entry for each heading with the words below it: what the search looks through. */
function index() {
  const entries = [];
  for (const c of chapters) {
    let at = 0;
    let entry = null;
    for (let i = 0; i < c.tokens.length; ++i) {
      const t = c.tokens[i];
      if (t.type === 'heading_open') {
        const h = c.headings[at++];
        entry = { to: `${link(c)}${h && h.level > 1 ? `#${h.id}` : ''}`, chapter: c.title, heading: h?.text ?? '', text: '' };
        entries.push(entry);
        i += 1;
      } else if (entry && (t.type === 'inline' || t.type === 'fence')) {
        entry.text += `${t.type === 'inline' ? words(t) : t.content} `;
      }
    }
  }
  for (const e of entries) e.text = e.text.replace(/\s+/g, ' ').trim();
  return entries;
}

rmSync(out, { recursive: true, force: true });
mkdirSync(out, { recursive: true });
for (const c of chapters) {
  const html = page(c);
  if (/<style|\sstyle=|\son\w+=|<script(?![^>]*\bsrc=)/i.test(html.replace(/<code>[^]*?<\/code>/g, ''))) faults.push(`${c.file}: something inline`);
  writeFileSync(join(out, `${c.name}.html`), html);
}
for (const file of pictures) copyFileSync(file, join(out, basename(file)));
writeFileSync(join(out, 'help.css'), ['src/styles/tokens.css', 'help/help.css'].map((f) => readFileSync(join(web, f), 'utf8')).join('\n'));
writeFileSync(join(out, 'help.js'), readFileSync(join(web, 'help/help.js')));
writeFileSync(join(out, 'search.json'), JSON.stringify(index()));
console.log(`handbook: ${chapters.length} chapters`);
for (const f of faults) console.error(`handbook: ${f}`);
process.exit(faults.length > 0 ? 1 : 0);
