// One user of each role, signed in, on a gateway in which no part of the page is empty; what the gateway refuses a page; everything on all parts pressed.
// In: nothing. Out: pages of somebody with a role; tests that press. A file of tests for each role that presses: each goes through the whole page.
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { launch, open } from './browser.mjs';
import { arrive, furnish, parts } from './parts.mjs';
import { Program } from './program.mjs';

export const password = 'a long enough phrase';
const all = { program: null, browser: null };
/** A page of somebody with this role. */
export const pageOf = async (role) => {
  const page = await open(all.browser, all.program.url);
  const r = await page.context().request.post(`${all.program.url}/api/v1/session`, { data: { user: role, password } });
  assert.equal(r.status(), 200, await r.text());
  return page;
};
/** Before the first test of a file. */
export async function start() {
  const program = (all.program = await Program.start());
  await furnish(program);
  const browser = (all.browser = await launch());
  const page = await open(browser, program.url);
  const door = page.context().request;
  const first = await door.post(`${program.url}/api/v1/session/first`, { data: { code: program.firstCode, user: 'administrator', password } });
  assert.equal(first.status(), 200, await first.text());
  const { csrf } = await first.json();
  for (const role of ['viewer', 'operator', 'engineer']) {
    const r = await door.post(`${program.url}/api/v1/users`, { data: { name: role, role, password }, headers: { 'x-csrf-token': csrf } });
    assert.equal(r.status(), 201, await r.text());
  }
  await page.context().close();
  return all;
}
export async function end() {
  await all.browser?.close();
  await all.program?.end();
}

/** What the gateway refuses a page for its role, until `end`. */
export function refusals(page) {
  const seen = [];
  const listen = (r) => {
    if (r.status() === 403) seen.push(`${r.request().method()} ${new URL(r.url()).pathname}`);
  };
  page.on('response', listen);
  return { seen, end: () => page.off('response', listen) };
}

/** Presses everything on a part that can be pressed and is no stop, and Enter in every field. What the gateway refused for the role. */
async function pressAll(page, part) {
  const refused = refusals(page);
  await arrive(page, all.program, part);
  const done = new Set();
  for (let turn = 0; turn < 80; turn += 1) {
    const pressed = await page.evaluate((known) => {
      const buttons = [...document.querySelectorAll('main button:enabled:not(.stop)')].filter((b) => b.offsetParent !== null);
      for (const b of buttons) {
        const name = (b.getAttribute('aria-label') ?? b.textContent).trim().replace(/\d+/g, '#');
        if (known.includes(name)) continue;
        b.click();
        return name;
      }
      return null;
    }, [...done]);
    if (pressed === null) break;
    done.add(pressed);
  }
  const fields = page.locator('main input[type=text]:enabled, main input[type=search]:enabled');
  let entered = 0;
  for (let i = 0; i < 60; i += 1) {
    // Held on to: an Enter may take the field away, and then the next of this number is another one, or none.
    const field = (await fields.elementHandles())[i];
    if (!field) break;
    if (!(await field.isVisible()) || !(await field.isEditable())) continue;
    await field.fill('1');
    await field.press('Enter');
    entered += 1;
  }
  await page.waitForTimeout(200);
  refused.end();
  return { refused: refused.seen, pressed: done.size, entered };
}

/** The presses of a role change what there is to see: it is the only test of its file. */
export function presses(role) {
  before(start);
  after(end);
  test(`as ${role}, no button and no Enter on any part sends what the gateway refuses`, async () => {
    const page = await pageOf(role);
    let pressed = 0;
    let entered = 0;
    for (const part of parts) {
      const r = await pressAll(page, part);
      assert.deepEqual(r.refused, [], part.path);
      pressed += r.pressed;
      entered += r.entered;
    }
    assert.ok(pressed > 20, `${pressed} buttons could be pressed`);
    assert.ok(entered > 5, `Enter was pressed in ${entered} fields`);
    await page.context().close();
  });
}
