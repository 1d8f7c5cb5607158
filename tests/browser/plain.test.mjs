// Words of the API never reach people: no part of the page says a word with an underscore, in text, label, title or choice.
// What is the drive's, the site's or the API's own name stands in a fixed-width face (code, .mono), and is no text.
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { launch, open } from './lib/browser.mjs';
import { arrive, furnish, parts } from './lib/parts.mjs';
import { Program } from './lib/program.mjs';

let program, browser, page;
before(async () => {
  program = await Program.start();
  await furnish(program);
  browser = await launch();
  page = await open(browser, program.url);
});
after(async () => {
  await browser?.close();
  await program?.end();
});

const underscored = () =>
  page.evaluate(() => {
    const found = [];
    const look = (text, where) => {
      for (const m of (text ?? '').match(/\b[a-z0-9]+(?:_[a-z0-9]+)+\b/g) ?? []) found.push(`${m} in ${where}`);
    };
    for (const e of document.querySelectorAll('body *')) {
      if (e.closest('code, pre, kbd, textarea, script, style, .mono')) continue;
      const where = `${e.tagName.toLowerCase()}.${e.className.baseVal ?? e.className}`;
      for (const n of e.childNodes) if (n.nodeType === Node.TEXT_NODE) look(n.data, `${where}: ${n.data.trim().slice(0, 80)}`);
      for (const a of ['aria-label', 'title', 'placeholder', 'alt', 'aria-description']) look(e.getAttribute(a), `${a} of ${where}`);
    }
    return [...new Set(found)];
  });

for (const part of parts) {
  test(`${part.name}: no word of the API`, async () => {
    await arrive(page, program, part);
    await page.evaluate(() => document.querySelectorAll('details').forEach((d) => (d.open = true)));
    assert.deepEqual(await underscored(), []);
  });
}
