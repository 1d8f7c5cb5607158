// The overview of many axes: as tiles and as a list with headings, orders and groups, one command for several axes; what is out of sight is written less
// often. In: the program. Out: counts; pictures under build/browser.
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { becomes, look, open, shot, until } from './lib/browser.mjs';
import { document, start } from './lib/machine.mjs';
import { manyMappings } from './lib/many.mjs';
import { Program } from './lib/program.mjs';

let program, browser, page;
before(async () => void ({ program, browser, page } = await start()));
after(async () => {
  await browser?.close();
  await program?.end();
});
const names = () => page.locator('.axis-row').evaluateAll((l) => l.map((e) => e.dataset.axis));
const heading = (name) => page.getByRole('columnheader', { name });

test('axes stand under their machine parts, as tiles and as a list with headings and velocity', async () => {
  const groups = () => page.locator('[data-group]').evaluateAll((l) => l.map((e) => [e.dataset.group, [...e.querySelectorAll('[data-axis]')].map((a) => a.dataset.axis).filter((n, i, all) => all.indexOf(n) === i)]));
  const wanted = [['Outfeed', ['lift']], ['Infeed', ['feeder', 'slide.x']], ['', ['axis10']]];
  assert.deepEqual(await groups(), wanted);
  await shot(page, 'shape-tiles', { fullPage: true });
  await page.getByRole('button', { name: 'List', exact: true }).click();
  await page.locator('.axis-row').first().waitFor();
  assert.deepEqual(await groups(), wanted);
  for (const name of ['Axis', 'Position', 'Velocity', 'State', 'Message']) await heading(name).waitFor();
  await page.getByRole('rowheader', { name: /Infeed\s+2 axes/ }).waitFor();
  await program.command('slide.x', { command: 'enable' });
  await program.command('slide.x', { command: 'move_velocity', velocity: 5, acceleration: 50 });
  const velocity = page.locator('[data-axis="slide.x"] [data-field=velocity]');
  await until('the velocity is told', async () => /^5\.0\d* mm\/s$/.test((await velocity.innerText()).trim()) || (await velocity.innerText()));
  await page.getByRole('button', { name: 'By machine part' }).click();
  await becomes('one list', names, ['lift', 'feeder', 'slide.x', 'axis10']);
});

test('a heading sorts, the other way round, and as in the site again; a live value moves no row', async () => {
  await heading('Axis').getByRole('button').click();
  await becomes('by name', names, ['axis10', 'feeder', 'lift', 'slide.x']);
  assert.equal(await heading('Axis').getAttribute('aria-sort'), 'ascending');
  await heading('Axis').getByRole('button').click();
  await becomes('backward', names, ['slide.x', 'lift', 'feeder', 'axis10']);
  await heading('Axis').getByRole('button').click();
  await becomes('as in the site', names, ['lift', 'feeder', 'slide.x', 'axis10']);
  await heading('Velocity').getByRole('button').click();
  await becomes('the fastest first', async () => (await names())[0], 'slide.x');
  await program.command('slide.x', { command: 'halt' });
  await until('it stands', async () => (await program.axis('slide.x')).moving === false);
  await until('the page knows', async () => /^[−-]?0\.0/.test((await page.locator('[data-axis="slide.x"] [data-field=velocity]').innerText()).trim()));
  assert.equal((await names())[0], 'slide.x', 'it stays where it is');
  await page.getByLabel('Order').selectOption('number');
  await becomes('as in the site', names, ['lift', 'feeder', 'slide.x', 'axis10']);
});

test('one command goes to the axes that are selected, and each one answers', async () => {
  const bar = page.locator('[data-field=selection]');
  assert.equal(await bar.getByRole('button', { name: 'Enable the selected axes' }).isDisabled(), true);
  const places = () => page.locator('.axis-row').evaluateAll((l) => l.map((e) => Math.round(e.getBoundingClientRect().y)));
  const before = await places();
  for (const n of ['lift', 'feeder']) await page.getByRole('checkbox', { name: `Select ${n}`, exact: true }).check();
  await bar.getByText('2 axes selected').waitFor();
  assert.deepEqual(await places(), before, 'a selection moves nothing');
  await bar.getByRole('button', { name: 'Enable the selected axes' }).click();
  const enabled = async () => (await Promise.all(document.axes.map((a) => program.axis(a.name)))).filter((a) => a.state === 'operation_enabled').map((a) => a.name);
  await becomes('they are enabled, and no other', async () => (await enabled()).filter((n) => n !== 'slide.x').sort(), ['feeder', 'lift']);
  await bar.getByText('Enable: 2 good').waitFor();
  // Two of three can home; the third says why not.
  await page.getByRole('checkbox', { name: 'Select axis10', exact: true }).check();
  await bar.getByRole('button', { name: 'Home the selected axes' }).click();
  const question = page.locator('[data-field=selection-home]');
  assert.match(await question.innerText(), /Home lift, feeder, axis10\? Each of them moves/);
  await becomes('the keyboard is at the answer that changes nothing', () => page.evaluate(() => globalThis.document.activeElement.textContent), 'Leave it');
  await page.keyboard.press('Enter');
  await question.waitFor({ state: 'detached' });
  await bar.getByRole('button', { name: 'Home the selected axes' }).click();
  await question.getByRole('button', { name: 'Home them' }).click();
  const answer = (n) => bar.locator(`[data-answer="${n}"]`);
  await until('the one that has no power says so', async () => /enable it first|the axis is disabled now/i.test(await answer('axis10').innerText()) || (await bar.innerText()));
  await until('the others are told apart', async () => !/refused/.test(await answer('lift').innerText()) || (await bar.innerText()));
  await shot(page, 'shape-selection', { fullPage: true });
  await bar.getByRole('button', { name: 'Stop the selected axes' }).click();
  await until('all have answered', async () => /Stop: 3 good/.test(await bar.innerText()) || (await bar.innerText()));
  await bar.getByRole('button', { name: 'Select nothing' }).click();
  assert.equal(await page.locator('.axis-row input:checked').count(), 0);
});

test('tiles have no empty footer, and what is said in them is whole', async () => {
  await page.getByRole('button', { name: 'List', exact: true }).click();
  await page.locator('.tile').first().waitFor();
  const feet = await page.locator('.tile-foot').evaluateAll((l) => l.map((e) => ({ said: [...e.children].filter((c) => c.checkVisibility()).map((c) => c.textContent.trim()), high: e.getBoundingClientRect().height })));
  for (const { said, high } of feet) {
    assert.ok(said.length >= 1 && said.every((t) => t !== ''), JSON.stringify(said));
    assert.ok(high <= 20 * said.length + 14, `${said.length} lines in ${high} px`);
  }
});

test('the list at four widths: nothing is cut, nothing scrolls sideways, nothing serious for axe-core', async () => {
  const wrong = [];
  for (const [width, device] of [[1440, {}], [1024, {}], [768, {}], [390, { hasTouch: true, isMobile: true }], [320, { hasTouch: true, isMobile: true }]]) {
    const p = await open(browser, program.url, { viewport: { width, height: 900 }, bypassCSP: true, ...device });
    await p.locator('[data-axis=lift] [data-live=true]').waitFor();
    await p.getByRole('button', { name: 'List', exact: true }).click();
    await p.locator('.axis-row').first().waitFor();
    assert.equal(await p.locator('.axis-row [data-field=mark]:visible').count(), 4, `${width} px: each row says whether it is simulated`);
    wrong.push(...(await look(p, 'shape-list')));
    await p.context().close();
  }
  assert.deepEqual(wrong, []);
});

test('of many axes those in sight are written with every reading, the others once a second, until they come into sight', async () => {
  const many = await Program.start({ site: { ...manyMappings(), mappings: [] } });
  try {
    for (const axis of ['axis1', 'axis64']) {
      await until(`${axis} is heard`, async () => (await many.axis(axis)).online === true);
      await many.command(axis, { command: 'enable' });
      await until(`${axis} is enabled`, async () => (await many.axis(axis)).state === 'operation_enabled');
      await many.command(axis, { command: 'move_velocity', velocity: 5, acceleration: 50 });
      await until(`${axis} moves`, async () => (await many.axis(axis)).moving === true);
    }
    const p = await open(browser, many.url);
    await p.locator('[data-axis=axis64] [data-live=true]').waitFor();
    /** How often its position is written within 3 s. */
    const written = (axis) =>
      p.locator(`[data-axis=${axis}] [data-field=position]`).evaluate(
        (cell) =>
          new Promise((resolve) => {
            let n = 0;
            const eye = new MutationObserver((all) => (n += all.length));
            eye.observe(cell, { attributeFilter: ['data-value'] });
            setTimeout(() => resolve((eye.disconnect(), n)), 3000); // a rate is measured
          }),
      );
    const seen = async () => Promise.all(['axis1', 'axis64'].map(written));
    const near = (n) => n > 6 && n <= 17; // five times a second
    const far = (n) => n >= 1 && n <= 4;
    const [first, last] = await seen();
    assert.ok(near(first) && far(last), `above ${first}, below ${last}`);
    await p.locator('[data-axis=axis64]').scrollIntoViewIfNeeded();
    const [above, here] = await seen();
    assert.ok(far(above) && near(here), `above ${above}, here ${here}`);
    // Its state is that of now when it is come back to.
    await many.command('axis1', { command: 'halt' });
    await p.locator('[data-axis=axis1]').scrollIntoViewIfNeeded();
    await until('it stands', async () => /At rest|In position/.test(await p.locator('[data-axis=axis1] [data-field=motion]').innerText()));
    assert.deepEqual(p.faults(), []);
    await p.context().close();
  } finally {
    await many.end();
  }
});

test('nothing on the way was a fault of the page', () => assert.deepEqual(page.faults(), []));
