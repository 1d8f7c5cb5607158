// Gallery: every part at three widths in one colour scheme: pictures for people, axe-core's verdict, and whether anything is cut off or lies upon
// another. In: the colour scheme. Out: tests; pictures under build/browser, part-NAME-WIDTH-SCHEME.png.
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { examine, launch, open, shot } from './browser.mjs';
import { arrive, furnish, parts } from './parts.mjs';
import { Program } from './program.mjs';

export function gallery(colorScheme) {
  let program, browser;
  before(async () => {
    program = await Program.start();
    await furnish(program);
    browser = await launch();
  });
  after(async () => {
    await browser?.close();
    await program?.end();
  });
  for (const width of [1440, 1024, 390]) {
    test(`every part at ${width} px, ${colorScheme}: axe-core finds nothing serious, nothing is cut off; pictures`, async () => {
      const phone = width < 500;
      const page = await open(browser, program.url, { colorScheme, viewport: { width, height: phone ? 844 : 900 }, bypassCSP: true, hasTouch: phone, isMobile: phone });
      const wrong = [];
      for (const part of parts) {
        await arrive(page, program, part);
        await shot(page, `part-${part.name}-${width}-${colorScheme}`, { fullPage: true });
        const wide = await page.evaluate(() => document.documentElement.scrollWidth - document.documentElement.clientWidth);
        if (wide > 0) wrong.push(`${part.path} is ${wide} px too wide`);
        wrong.push(...(await cutOff(page)).map((w) => `${part.path}: ${w}`));
        for (const f of await examine(page)) wrong.push(`${part.path}: ${f.id} ${f.where} ${f.why}`);
      }
      wrong.push(...page.faults());
      assert.deepEqual(wrong, []);
      await page.context().close();
    });
  }
}

/** Words of buttons and links that do not fit into them, and controls that lie upon each other. */
const cutOff = (page) =>
  page.evaluate(() => {
    const found = [];
    const controls = [...document.querySelectorAll('button, a.button, label.button, select, input:not(.visually-hidden)')].filter((e) => e.checkVisibility() && !e.closest('.visually-hidden'));
    const name = (e) => (e.getAttribute('aria-label') ?? e.textContent).trim().slice(0, 40);
    for (const e of controls) {
      if (e.matches('button, a.button, label.button') && e.scrollWidth > e.clientWidth + 1 && getComputedStyle(e).overflowX !== 'visible') found.push(`the words of "${name(e)}" do not fit`);
    }
    const boxes = controls.filter((e) => !e.closest('.top, .nav, .scroll, .table-scroll, .console-log')).map((e) => [e, e.getBoundingClientRect()]);
    for (let i = 0; i < boxes.length; i += 1) {
      for (let k = i + 1; k < boxes.length; k += 1) {
        const [a, p] = boxes[i];
        const [b, q] = boxes[k];
        if (a.contains(b) || b.contains(a)) continue;
        const x = Math.min(p.right, q.right) - Math.max(p.left, q.left);
        const y = Math.min(p.bottom, q.bottom) - Math.max(p.top, q.top);
        if (x > 2 && y > 2) found.push(`"${name(a)}" and "${name(b)}" lie upon each other`);
      }
    }
    return found.slice(0, 10);
  });
