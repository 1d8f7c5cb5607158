// The register map by mouse, by keys and by a finger: drag in, resize, move, copy to another axis, a conflict shown, undo; unit 1; a walk by keys alone;
// a site of 64 axes and 4096 entries, of which only what is in sight is drawn (how quick: tests/bench/bench_page.mjs). In: the program. Out: counts; pictures under build/browser.
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { becomes, examine, launch, open, quiet, shot, tooWide, until } from './lib/browser.mjs';
import { manyMappings } from './lib/many.mjs';
import { Program } from './lib/program.mjs';

/** Of the whole page with 4096 entries: the grid in sight, the palette, the head. */
const mostNodes = 4000;
let program, browser, page;
before(async () => {
  program = await Program.start();
  browser = await launch();
  page = await open(browser, `${program.url}/mappings`, { bypassCSP: true });
  await page.locator('[data-point=position]').waitFor();
});
after(async () => {
  await browser?.close();
  await program?.end();
});
const all = async () => (await program.call('GET', '/mappings')).body;
const places = async () => (await all()).map((m) => `${m.address} ${m.axis} ${m.point} ${m.type}`).sort((a, b) => parseInt(a) - parseInt(b));
const told = () => page.locator('[data-field=grid-told]').innerText();
const middle = async (selector, dx = 0.5) => {
  const b = await page.locator(selector).first().boundingBox();
  return [b.x + b.width * dx, b.y + b.height / 2];
};
const entry = (point) => `[data-mapping]:has(.map-name:text-is("${point}"))`;
/** Presses, goes in steps as a hand does, looks, and lets go. */
async function drag(from, to, { meanwhile, held } = {}) {
  if (held) await page.keyboard.down(held);
  await page.mouse.move(...from);
  await page.mouse.down();
  await page.mouse.move((from[0] + to[0]) / 2, (from[1] + to[1]) / 2, { steps: 4 });
  await page.mouse.move(...to, { steps: 4 });
  await meanwhile?.();
  await page.mouse.up();
  if (held) await page.keyboard.up(held);
}

test('a point is dragged from the palette into a free place, and is live there', async () => {
  await drag(await middle('[data-point=position]'), await middle('[data-place="2"]'), {
    meanwhile: async () => {
      await page.locator('.map-ghost').first().waitFor();
      assert.match(await told(), /^position of feeder at 2–3: free$/);
      assert.deepEqual(await all(), [], 'nothing is sent before it is let go');
    },
  });
  await becomes('it is there', places, ['2 feeder position i32']);
  await until('it is told', async () => /^Added position of feeder/.test(await told()) || (await told()));
  await becomes('it is live', () => page.locator(`${entry('position')} [data-field=value]`).getAttribute('data-live'), 'true');
  await until('its words are shown', async () => /^[0-9A-F]{4} [0-9A-F]{4}$/.test(await page.locator(`${entry('position')} [data-field=in-register]`).innerText()));
});

test('a place that is taken says by whom, and nothing is changed', async () => {
  await drag(await middle('[data-point=velocity]'), await middle(entry('position'), 0.25), {
    meanwhile: async () => {
      await page.locator('.map-ghost.is-taken').first().waitFor();
      assert.match(await told(), /^velocity of feeder at 2–3: taken by \S+ \(position of feeder, 2–3\)\. Next free place: 4$/);
      await shot(page, 'register-map-conflict');
    },
  });
  await until('it is said', async () => /taken by/.test(await told()) || (await told()));
  assert.deepEqual(await places(), ['2 feeder position i32']);
});

test('an entry is moved, and undo brings it back', async () => {
  await drag(await middle(entry('position'), 0.2), await middle('[data-place="10"]'));
  await becomes('it is there', places, ['10 feeder position i32']);
  await page.getByRole('button', { name: /^Undo: moved / }).click();
  await becomes('it is back', places, ['2 feeder position i32']);
});

test('an entry is made wider and narrower at its end', async () => {
  await page.locator('[data-place="2"][data-mapping]').waitFor();
  await drag(await middle(`${entry('position')} .map-handle`), await middle('[data-place="5"]'));
  await becomes('it is wider', places, ['2 feeder position i64']);
  await becomes('on the map, too', () => page.locator(entry('position')).getAttribute('aria-colspan'), '4');
  await drag(await middle(`${entry('position')} .map-handle`), await middle(entry('position'), 0.3));
  await becomes('it is narrower', places, ['2 feeder position i32']);
});

test('a block is copied to another axis by a drag with Ctrl, and undone as one', async () => {
  await drag(await middle('[data-point=statusword]'), await middle('[data-place="4"]'));
  await becomes('a second one', places, ['2 feeder position i32', '4 feeder statusword u16']);
  await page.locator(entry('position')).click();
  await page.locator(entry('statusword')).click({ modifiers: ['Shift'] });
  await page.getByText('2 entries are chosen.').waitFor();
  await page.getByLabel('Points of').selectOption('slide.x');
  await drag(await middle(entry('position'), 0.25), await middle('[data-place="8"]'), { held: 'Control' });
  await becomes('both are there', places, ['2 feeder position i32', '4 feeder statusword u16', '8 slide.x position i32', '10 slide.x statusword u16']);
  await page.getByRole('button', { name: /^Undo: copied 2 mappings to slide\.x/ }).click();
  await becomes('both are gone', places, ['2 feeder position i32', '4 feeder statusword u16']);
});

test('by keys alone: pick a point, carry, put down, resize, move, copy, open the form, delete', async () => {
  await page.locator('[data-point=position]').focus();
  await page.keyboard.press('ArrowDown');
  await becomes('the arrows go from point to point', () => page.evaluate(() => document.activeElement.dataset.point), 'velocity');
  await page.keyboard.press('Enter');
  await until('it is in the hand, where it fits', async () => /velocity of slide\.x at \S+: free/.test(await told()) || (await told()));
  await becomes('Escape puts back first, and says so', () => page.locator('.stop-all kbd').innerText(), 'Esc Esc');
  const stops = [];
  page.on('request', (r) => /commands$/.test(r.url()) && stops.push(r.postData()));
  await page.keyboard.press('Escape');
  await becomes('nothing is carried', () => page.locator('.map-ghost').count(), 0);
  assert.deepEqual(stops, []);
  await page.locator('[data-point=velocity]').focus();
  await page.keyboard.press(' ');
  await until('it is in the hand', async () => (await page.locator('.map-ghost').count()) > 0);
  await page.keyboard.press('Home');
  await until('it is carried', async () => /velocity of slide\.x at 0–1: free/.test(await told()) || (await told()));
  await page.keyboard.press('ArrowRight');
  await until('a conflict is told', async () => /at 1–2: taken by/.test(await told()) || (await told()));
  await page.keyboard.press('ArrowLeft');
  await page.keyboard.press('Enter');
  await until('it is put down', async () => (await places())[0] === '0 slide.x velocity i32' || (await places()));
  await page.locator(entry('velocity')).waitFor();
  await page.locator('.register-map').focus();
  await page.keyboard.press('Control+Home');
  await page.locator(entry('velocity')).waitFor();
  await page.keyboard.press('-');
  await until('it is narrower', async () => (await places())[0] === '0 slide.x velocity i16' || (await places()));
  await becomes('on the map, too', () => page.locator(entry('velocity')).getAttribute('aria-colspan'), '1');
  await page.keyboard.press('c');
  await until('a copy is in the hand', async () => /Copy of \S+ for slide\.x at 1: free/.test(await told()) || (await told()));
  await page.keyboard.press(' ');
  await until('the copy is there', async () => (await places())[1] === '1 slide.x velocity i16' || (await places()));
  await becomes('on the map, too', () => page.locator(entry('velocity')).count(), 2);
  await page.keyboard.press('Delete');
  await until('the copy is gone', async () => (await places())[1] === '2 feeder position i32' || (await places()));
  await becomes('and from the map', () => page.locator(entry('velocity')).count(), 1);
  await page.keyboard.press('Control+Home');
  await page.keyboard.press('Enter');
  await until('the form has the keyboard', () => page.evaluate(() => document.activeElement?.closest('#mapping-form') !== null));
  await page.getByRole('form', { name: /^Change mapping / }).waitFor();
  const id = await page.locator('.register-map').getAttribute('aria-activedescendant');
  assert.equal(await page.evaluate((x) => document.getElementById(x)?.getAttribute('role'), id), 'gridcell');
});

test('unit 1 is a map too: fixed, live, with the names of its bits', async () => {
  await page.getByLabel('Unit ID').first().selectOption('1');
  const status = page.locator('[data-block="1/holding_registers/0"]');
  await status.waitFor();
  await becomes('it is live', () => status.locator('[data-field=value]').getAttribute('data-live'), 'true');
  await status.click();
  await until('its bits have names', async () => /Operation enabled/.test(await page.locator('.map-bits').innerText()));
  await page.locator('.map-panel').getByText('This register is fixed').waitFor();
  const before = await places();
  await drag(await middle('[data-point=velocity]'), await middle('[data-place="24"]'));
  await until('it is refused', async () => /standard map: it is not changed/.test(await told()) || (await told()));
  assert.deepEqual(await places(), before);
  assert.deepEqual(await examine(page), []);
  await page.getByRole('button', { name: /^Coils/ }).click();
  await page.locator('[data-block="1/coils/6"]').getByText('fault').first().waitFor();
  await page.getByRole('button', { name: /^Holding/ }).click();
  await page.getByLabel('Unit ID').first().selectOption('2');
});

test('a place far away is shown when it is asked for, and takes an entry', async () => {
  await page.getByLabel('Go to').fill('4000');
  await page.getByLabel('Go to').press('Enter');
  const far = page.locator('[data-place="4002"]');
  await far.waitFor();
  await page.getByLabel('Points of').selectOption('feeder');
  await drag(await middle('[data-point=flags]'), await middle('[data-place="4002"]'));
  await until('it is there', async () => (await places()).includes('4002 feeder flags u16') || (await places()));
});

test('a finger picks up by one press and puts down by the next; nothing is wider than 360 px', async () => {
  const phone = await open(browser, `${program.url}/mappings`, { viewport: { width: 360, height: 740 }, hasTouch: true, isMobile: true, bypassCSP: true });
  await phone.locator('[data-mapping]').first().waitFor();
  await becomes('four in a row', () => phone.locator('.register-map').getAttribute('data-per-row'), '4');
  await phone.locator('[data-point=mode_display]').tap();
  await phone.locator('.map-ghost').waitFor();
  await phone.locator('[data-place="9"]').tap();
  await until('it is there', async () => (await places()).includes('9 feeder mode_display i16') || (await places()));
  assert.equal(await tooWide(phone), 0);
  await phone.evaluate(() => scrollTo(0, 0)); // nothing behind the head that stays
  assert.deepEqual(await examine(phone), []);
  assert.deepEqual(phone.faults(), []);
  await phone.context().close();
  assert.deepEqual(page.faults(), []);
});

test('64 axes and 4096 entries: only what is in sight is in the document, however far one scrolls and whatever values change', async () => {
  const big = await Program.start({ site: manyMappings() });
  const p = await open(browser, `${big.url}/mappings`);
  try {
    await p.locator('[data-mapping=m0] [data-field=value]').waitFor();
    const nodes = () => p.evaluate(() => document.querySelectorAll('*').length);
    const cells = () => p.locator('[data-mapping]').count();
    assert.ok((await cells()) > 0 && (await cells()) < 200, `${await cells()} entries are drawn`);
    assert.ok((await nodes()) < mostNodes, `${await nodes()} elements`);
    const asked = [];
    p.on('request', (r) => /\/registers\?/.test(r.url()) && asked.push(r.url()));
    await big.command('axis1', { command: 'enable' });
    await big.command('axis1', { command: 'move_velocity', velocity: 5 });
    const value = p.locator('[data-mapping=m1] [data-field=value]');
    const first = await value.innerText();
    // What changes in the page while one axis moves: the texts of its own cells, and no element comes or goes.
    await p.evaluate(() => {
      globalThis.come = 0;
      new MutationObserver((all) => {
        for (const m of all) for (const n of [...m.addedNodes, ...m.removedNodes]) if (n.nodeType === Node.ELEMENT_NODE && n.matches?.('[data-mapping], [data-mapping] *')) globalThis.come += 1;
      }).observe(document.querySelector('.register-map'), { childList: true, subtree: true });
    });
    await until('its position changes', async () => (await value.innerText()) !== first);
    const second = await value.innerText();
    await until('and goes on', async () => (await value.innerText()) !== second);
    assert.equal(await p.evaluate(() => globalThis.come), 0, 'no cell is drawn anew by a value');
    for (const part of [0.25, 0.5, 0.75, 1]) {
      await p.locator('.register-map').evaluate((m, x) => (m.scrollTop = x * (m.scrollHeight - m.clientHeight)), part);
      const last = part === 1 ? '[data-mapping=m4095]' : '[data-mapping] [data-field=value]';
      await p.locator(last).first().waitFor();
      await quiet(p);
      assert.ok((await cells()) < 200, `${await cells()} entries are drawn`);
      assert.ok((await nodes()) < mostNodes, `${await nodes()} elements`);
    }
    // A look asks for what is in sight: a bounded run of registers, never for all 4096.
    for (const u of asked) assert.ok(Number(new URL(u).searchParams.get('count')) <= 500, u);
    assert.deepEqual(p.faults(), []);
  } finally {
    await p.context().close();
    await big.end();
  }
});
