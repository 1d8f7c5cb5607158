// Nothing moves: an alarm, its acknowledgement, the answer to a command, an event, a drive that is silent and a lost connection leave every button
// of the overview (as tiles and as a list) and of an axis' page where it was, at three widths; what is pressed is what was aimed at.
// In: the program. Out: the places of all buttons before and after, by their names. A button that comes or goes must not push another one.
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { launch, open, quiet, shot, until } from './lib/browser.mjs';
import { Program } from './lib/program.mjs';

const document = {
  lines: [{ name: 'can0', uri: 'twin', family: 'uim342', bitrate: 1000000 }],
  drives: [5, 6, 7, 8].map((address) => ({ name: `d${address}`, line: 'can0', address, presence: 'twin' })),
  axes: ['feeder', 'lift', 'clamp', 'press'].map((name, i) => ({ name, drive: `d${5 + i}`, channel: 1, number: 1 + i, unit: 'mm', increments_per_unit: 3200 })),
  mappings: [],
};
let browser;
before(async () => void (browser = await launch()));
after(() => browser?.close());

/** Everything has been in sight once: what was not may have another height than was reckoned. */
const walked = (page) =>
  page.evaluate(async () => {
    for (let y = 0; y < globalThis.document.body.scrollHeight; y += 400) {
      globalThis.scrollTo(0, y);
      await new Promise((r) => requestAnimationFrame(() => setTimeout(r)));
    }
  });
/** Where each button is on the page, from its top, by its name; of several of one name each by its turn. Those of the alarms' own place are told to read, not to aim at. */
const places = (page) =>
  page.evaluate(() => {
    globalThis.scrollTo(0, 0);
    const turn = new Map();
    const found = {};
    for (const e of globalThis.document.querySelectorAll('button, .button, .stop, select, input')) {
      if (!e.checkVisibility({ visibilityProperty: true }) || e.closest('.wrong, .strip')) continue;
      const name = `${e.localName} ${e.getAttribute('aria-label') ?? e.labels?.[0]?.textContent ?? e.textContent}`.trim().replace(/\s+/g, ' ');
      const n = (turn.get(name) ?? 0) + 1;
      turn.set(name, n);
      const r = e.getBoundingClientRect();
      found[`${name} #${n}`] = [Math.round(r.x), Math.round(r.y), Math.round(r.width), Math.round(r.height)];
    }
    return found;
  });
const moved = (was, is) => Object.keys(was).filter((k) => is[k] && was[k].some((v, i) => Math.abs(v - is[k][i]) > 1)).map((k) => `${k}: ${was[k]} -> ${is[k]}`);

const views = [
  { name: 'tiles', path: '/' },
  { name: 'list', path: '/', list: true },
  { name: 'axis', path: '/axes/feeder' },
];

for (const [width, device] of [[1440, {}], [1024, {}], [390, { hasTouch: true, isMobile: true }]]) {
  test(`no button moves, ${width} px`, async () => {
    const program = await Program.start({ site: document });
    const pages = [];
    try {
      for (const view of views) {
        const page = await open(browser, program.url + view.path, { viewport: { width, height: 900 }, ...device });
        page.expectLoss(true);
        await page.locator('[data-axis="feeder"] [data-live=true]').first().waitFor();
        if (view.list) await page.getByRole('button', { name: 'List', exact: true }).click();
        await walked(page);
        await quiet(page);
        const was = await places(page);
        assert.ok(Object.keys(was).length > 10, JSON.stringify(was));
        pages.push({ ...view, page, was, of: page.locator('[data-axis="feeder"]').first() });
      }
      const wrong = [];
      /** On each page, when it shows what has happened. */
      const stays = async (what, shown) => {
        for (const p of pages) {
          await shown?.(p);
          await quiet(p.page);
          wrong.push(...moved(p.was, await places(p.page)).map((m) => `${what}, ${p.name}: ${m}`));
        }
      };
      const says = (field, words) => ({ page, of }) => until(`${field} says ${words}`, async () => words.test((await of.locator(`[data-field="${field}"]`).first().innerText()).trim()) || of.locator(`[data-field="${field}"]`).first().innerText());
      const hand = (state) => program.call('PATCH', '/drives/d5/hand', state);

      await program.command('feeder', { command: 'enable' });
      await stays('enabled', says('state', /Enabled/));
      await program.command('feeder', { command: 'move_velocity', velocity: 1, acceleration: 20 });
      await stays('moving', says('motion', /Moving/));
      await hand({ stall: true });
      await stays('alarm', async (p) => {
        await says('state', /Fault/)(p);
        await says('notice', /^Fault/)(p);
        await p.page.locator('[data-field=alarm-badge]').waitFor({ state: 'attached' });
        await p.page.locator(p.path === '/' ? '[data-wrong=alarms]' : '[data-field=error-help]').first().waitFor({ state: 'attached' });
      });
      for (const p of pages) await shot(p.page, `still-alarm-${p.name}-${width}`);
      // What is pressed is answered with a reason; the list has no button for it.
      for (const p of pages.filter((x) => !x.list)) await p.of.getByRole('button', { name: /^Enable/ }).first().click();
      await stays('refused', async (p) => p.list || (await p.of.locator('.result-refused').first().waitFor({ state: 'attached' })));
      for (const p of pages) await shot(p.page, `still-refused-${p.name}-${width}`);
      for (const p of pages) await p.of.getByRole('button', { name: /^Stop feeder/ }).first().click();
      await stays('stopped', (p) => p.of.locator('.result:not(.result-none)').first().waitFor({ state: 'attached' }));
      for (const a of (await program.call('GET', '/alarms')).body.alarms) await program.call('POST', `/alarms/${a.id}/acknowledge`, {});
      await stays('acknowledged', (p) => p.page.locator('[data-field=alarm-badge]').waitFor({ state: 'detached' }));
      await program.command('lift', { command: 'enable' }); // an event of another axis
      await stays('an event', (p) => p.path !== '/' || until('it is told', async () => /lift/.test(await p.page.locator('.overview-side').innerText())));
      await hand({ stall: false, power: false });
      await stays('silent drive', says('state', /Offline/));
      for (const p of pages) await shot(p.page, `still-offline-${p.name}-${width}`);
      await hand({ power: true });
      await stays('drive again', says('state', /^(?!.*Offline)/));
      await program.stop();
      await stays('connection lost', (p) => p.page.locator('.strip.is-lost').waitFor());
      for (const p of pages) await shot(p.page, `still-lost-${p.name}-${width}`);
      await program.run();
      await stays('connected again', (p) => p.of.locator('[data-live=true]').first().waitFor({ timeout: 20_000 }));
      assert.equal(wrong.length, 0, `${wrong.length} places:\n${wrong.slice(0, 40).join('\n')}`);
      for (const p of pages) assert.deepEqual(p.page.faults(), []);
    } finally {
      for (const p of pages) await p.page.context().close();
      await program.end();
    }
  });
}
