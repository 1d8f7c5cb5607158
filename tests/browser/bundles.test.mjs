// Bundles: the overview is there without the code of other pages, each page brings its own; what a person sees when the code does not come; a tab that is
// older than the gateway is loaded again, once. In: the program. Out: counts; pictures under build/browser.
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { becomes, examine, open, shot, until } from './lib/browser.mjs';
import { start } from './lib/machine.mjs';

let program, browser, page;
before(async () => void ({ program, browser, page } = await start()));
after(async () => {
  await browser?.close();
  await program?.end();
});

const ready = '[data-axis=lift] [data-live=true]';
const nav = (p, name) => p.locator('.nav').getByRole('link', { name, exact: true });
const missing = '[data-field=part-missing]';
/** A page whose scripts that are not yet there come as `answer` says. The browser complains of those that do not, so its console is not looked at. */
async function openWith(answer, scripts = /\/assets\/.*\.js$/) {
  const p = await open(browser, program.url, { bypassCSP: true });
  await p.locator(ready).first().waitFor();
  await p.route(scripts, answer);
  return p;
}

test('the overview asks for the scripts of the beginning alone; a page brings its own, once, and its heading gets the keyboard', async () => {
  const asked = [];
  const p = await open(browser, program.url);
  p.on('request', (r) => /\/assets\/.*\.js$/.test(r.url()) && asked.push(new URL(r.url()).pathname));
  await p.goto(program.url);
  await p.locator(ready).first().waitFor();
  assert.equal(asked.length, 2, `${asked}`);
  for (const times of [1, 2]) {
    await nav(p, 'Mappings').click();
    await p.getByRole('heading', { level: 1, name: 'Mappings' }).waitFor();
    await becomes('the heading has the keyboard', () => p.evaluate(() => document.activeElement?.textContent), 'Mappings');
    const more = asked.length;
    assert.ok(more > 2, `${asked}`);
    assert.equal(new Set(asked).size, more, `the ${times}. time: ${asked}`);
    await nav(p, 'Axes').click();
    await p.locator(ready).first().waitFor();
  }
  assert.deepEqual(p.faults(), []);
  await p.context().close();
});

test('scripts are kept for good by the browser, the page itself is asked for each time', async () => {
  const of = async (path) => (await fetch(program.url + path, { headers: { accept: 'text/html' } })).headers.get('cache-control');
  const html = await (await fetch(program.url)).text();
  const [first] = /\/assets\/[^"]+\.js/.exec(html);
  assert.deepEqual([await of('/'), await of('/mappings'), await of(first)], ['no-cache', 'no-cache', 'max-age=31536000, immutable']);
});

test('a script that the gateway does not have: it is said under the title, and comes when it is tried again', async () => {
  let gone = true;
  const p = await openWith((r) => (gone ? r.fulfill({ status: 404, body: '' }) : r.continue()));
  await nav(p, 'Mappings').click();
  await p.locator(missing).waitFor();
  assert.match(await p.locator(missing).innerText(), /The gateway has not sent this part of the page\./);
  assert.equal(await p.locator('main h1').innerText(), 'Mappings');
  assert.deepEqual(await examine(p), []);
  await shot(p, 'bundles-missing');
  gone = false;
  await p.getByRole('button', { name: 'Try again' }).press('Enter');
  await p.getByRole('heading', { name: 'Register map' }).waitFor();
  await p.context().close();
});

test('a gateway that is away: the axes stay as they are known, the page says that it cannot come, and comes with the gateway', async () => {
  const p = await openWith((r) => r.continue());
  await p.context().setOffline(true);
  await nav(p, 'Recipes').click();
  await p.locator(missing).waitFor();
  assert.match(await p.locator(missing).innerText(), /the gateway cannot be reached/);
  await p.context().setOffline(false);
  // By itself with a new connection; where the old one has lasted, by the button.
  await until('it comes', async () => {
    const again = p.getByRole('button', { name: 'Try again' });
    if ((await again.count()) > 0) await again.click({ timeout: 1_000 }).catch(() => undefined);
    return (await p.locator(missing).count()) === 0 && (await p.getByRole('heading', { name: 'All recipes' }).count()) === 1;
  });
  await p.context().close();
});

test('a tab that is older than the gateway is loaded again at the page that was wanted, once, and never in a loop', async () => {
  for (const upgraded of [true, false]) {
    let old = true;
    const p = await openWith((r) => (old ? r.fulfill({ status: 404, body: '' }) : r.continue()), /\/assets\/recorder-.*\.js$/);
    let loads = 0;
    p.on('request', (r) => {
      if (!r.isNavigationRequest()) return;
      loads += 1;
      if (upgraded) old = false; // the gateway's own page has the scripts that it names
    });
    // The index of the gateway as it is now names another first script.
    await p.route(program.url + '/', async (r) => {
      const html = await (await fetch(program.url)).text();
      await r.fulfill({ contentType: 'text/html', body: html.replace(/first-[\w-]{8}\.js/, 'first-UPGRADED.js') });
    });
    await nav(p, 'Recorder').click();
    if (upgraded) await p.getByRole('heading', { level: 1, name: /^Recorder/ }).waitFor();
    else await p.locator(missing).waitFor();
    await until('it was loaded again', () => loads === 1 || loads);
    assert.equal(new URL(p.url()).pathname, '/recorder');
    if (!upgraded) {
      for (let i = 0; i < 3; i += 1) {
        await p.getByRole('button', { name: 'Try again' }).click();
        await p.locator(missing).waitFor();
      }
    }
    assert.equal(loads, 1);
    await p.context().close();
  }
});

test('nothing on the way was a fault of the page', () => assert.deepEqual(page.faults(), []));
