// Gallery: every part of the page as one kind of device shows it, in light and dark: pictures for people, axe-core's verdict, and whether anything
// is cut off or lies upon another. In: the device and its widths, and which half of the parts: a file of tests for each half, so that none is long on a
// slow machine. Out: tests; pictures under build/browser, part-NAME-WIDTH-SCHEME.png.
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { launch, look, open } from './browser.mjs';
import { arrive, furnish, parts } from './parts.mjs';
import { Program } from './program.mjs';

const half = Math.ceil(parts.length / 2);
export const halves = { first: parts.slice(0, half), second: parts.slice(half) };

export function gallery({ widths, device }, some) {
  let program, browser, page; // one page for all parts: to open a new one costs a good part of a test
  before(async () => {
    program = await Program.start();
    await furnish(program);
    browser = await launch();
    page = await open(browser, program.url, { ...device, bypassCSP: true });
  });
  after(async () => {
    await browser?.close();
    await program?.end();
  });
  for (const part of some) {
    test(`${part.name} at ${widths.join(', ')} px, in light and dark: axe-core finds nothing serious, nothing is cut off; pictures`, async () => {
      await page.setViewportSize(device.viewport);
      await arrive(page, program, part);
      const wrong = await apiWords(page);
      for (const width of widths) {
        await page.setViewportSize({ ...device.viewport, width });
        wrong.push(...(await look(page, `part-${part.name}`)), ...(await cutOff(page)).map((w) => `${width} px: ${w}`));
      }
      assert.deepEqual([...wrong, ...page.faults().splice(0)], []);
    });
  }
}

/** What the API calls states, commands and steps is nothing that people read; names of parameters and points, which they type, are. */
const apiWords = (page) =>
  page.evaluate(() => {
    const said = document.body.innerText.match(/\b(?:not_ready_to_switch_on|switch_on_disabled|ready_to_switch_on|switched_on|operation_enabled|quick_stop(?:_active)?|fault_reaction_active|move_(?:absolute|relative|velocity)|reset_fault|wait_(?:for|s|register)|(?:set|read)_parameter|(?:read|write)_register|confirm_within_s)\b/g);
    return said ? [...new Set(said)].map((w) => `${w} is said`) : [];
  });

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
