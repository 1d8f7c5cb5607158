// Recipes on the page: made by forms, mended after the gateway's own words, run with live progress, cancelled, reported; a line is scanned.
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { becomes, launch, look, open, shot, until, visits } from './lib/browser.mjs';
import { Program } from './lib/program.mjs';

const long = {
  description: 'There and back, three times',
  parameters: { distance: { type: 'number', default: 2, unit: 'mm' } },
  steps: [
    { enable: { axis: 'feeder' } },
    { if: { condition: { axis: 'feeder', point: 'fault', is: true }, then: [{ command: { axis: 'feeder', command: 'reset_fault' } }], else: [{ message: 'ready' }] } },
    { repeat: { times: 3, steps: [{ command: { axis: 'feeder', command: 'move_relative', position: '${distance}', velocity: 50, wait_s: 20 } }, { wait_s: 0.1 }] } },
    { check: { axis: 'feeder', point: 'position', is: 6, tolerance: 0.1, text: 'three times the distance' }, comment: 'the end' },
    { disable: { axis: 'feeder' } },
  ],
};
let program, browser;
before(async () => {
  program = await Program.start();
  browser = await launch();
});
after(async () => {
  await browser?.close();
  await program?.end();
});

test('a recipe is made by forms alone, saved, run, and its report tells each step', async () => {
  const page = await open(browser, `${program.url}/recipes`);
  await page.getByLabel('Name of the new recipe').fill('first');
  await page.getByRole('button', { name: 'New recipe' }).click();
  await page.getByRole('heading', { level: 1, name: 'first' }).waitFor();
  const add = page.getByLabel('Add a step to steps');
  await add.selectOption('enable');
  await add.selectOption('wait_s');
  await add.selectOption('disable');
  await page.getByLabel('Step 2: Seconds').fill('0.2');
  await page.getByLabel('Step 2: Seconds').press('Tab');
  const json = page.getByLabel('The recipe as JSON');
  const steps = async () => JSON.parse(await json.inputValue()).steps;
  await becomes('the text has the steps', steps, [{ enable: { axis: 'feeder' } }, { wait_s: 0.2 }, { disable: { axis: 'feeder' } }]);
  await page.getByRole('button', { name: 'Move Step 2 up' }).click();
  await becomes('it is moved', async () => (await steps())[0], { wait_s: 0.2 });
  await page.getByRole('button', { name: 'Move Step 1 down' }).click();
  await becomes('what is not saved is not run', () => page.getByRole('button', { name: 'Run', exact: true }).isDisabled(), true);
  await page.getByRole('button', { name: 'Save' }).click();
  await page.getByRole('button', { name: 'Run', exact: true }).click();
  await page.locator('[data-report="/steps/2"][data-state=done]').waitFor();
  const state = page.locator('[data-field=run-state]');
  await until('the page says that it is done', async () => /Done/.test(await state.innerText()) || (await state.innerText()));
  await becomes('so does the gateway', async () => (await program.call('GET', '/recipes/first/runs/1')).body.state, 'done');
  await page.goto(`${program.url}/recipes`);
  await page.locator('[data-recipe=first]').waitFor();
  assert.deepEqual(page.faults(), []);
  await page.context().close();
});

test('what is wrong is said at its step, and the text is read only when it is JSON', async () => {
  const page = await open(browser, `${program.url}/recipes/wrong`);
  const json = page.getByLabel('The recipe as JSON');
  await json.fill('{"steps":[{"wait_s":1},{"check":{"axis":"feeder","point":"colour","is":1}}]}');
  await page.locator('[data-step="/steps/1"].is-wrong').waitFor();
  assert.match(await page.locator('[data-step="/steps/1"]').innerText(), /an axis has no point colour/);
  assert.equal(await page.locator('[data-step="/steps/0"].is-wrong').count(), 0);
  await page.getByLabel('Step 2: What').selectOption('moving');
  await page.getByLabel('Step 2: Value').fill('false');
  await page.getByLabel('Step 2: Value').press('Tab');
  await page.locator('.is-wrong').waitFor({ state: 'detached' });
  await becomes('the text follows', async () => JSON.parse(await json.inputValue()).steps[1], { check: { axis: 'feeder', point: 'moving', is: false } });
  await json.fill('{"steps":[');
  await becomes('it cannot be saved', () => page.getByRole('button', { name: 'Save' }).isDisabled(), true);
  assert.equal(await page.locator('[data-step]').count(), 2, 'the forms keep the last good text');
  await page.getByRole('button', { name: 'Delete wrong' }).click();
  await page.locator('[data-field=delete]').getByRole('button', { name: 'Delete', exact: true }).click();
  await page.getByRole('heading', { level: 1, name: 'Recipes' }).waitFor();
  assert.deepEqual(page.faults(), []);
  await page.context().close();
});

test('parameters, tolerance, comment and the longest time are edited by form', async () => {
  const page = await open(browser, `${program.url}/recipes/formed`);
  const document = async () => JSON.parse(await page.getByLabel('The recipe as JSON').inputValue());
  const set = async (label, value) => {
    await page.getByLabel(label, { exact: true }).fill(value);
    await page.getByLabel(label, { exact: true }).press('Tab');
  };
  await set('Name of the new parameter', 'two words');
  await page.getByRole('button', { name: 'Add a parameter' }).click();
  await page.getByText('A name has 1 to 64 letters').waitFor();
  await page.getByLabel('Name of the new parameter').fill('far');
  await page.getByLabel('Name of the new parameter').press('Enter');
  for (const [what, value] of [['Default', '2'], ['Least', '0'], ['Most', '10'], ['Unit', 'mm'], ['What it is for', 'one way']]) await set(`Parameter far: ${what}`, value);
  await page.getByLabel('Name of the new parameter').fill('who');
  await page.getByRole('button', { name: 'Add a parameter' }).click();
  await page.getByLabel('Parameter who: Type').selectOption('axis');
  await set('Parameter who: Default', 'feeder');
  await becomes('the text has both parameters', async () => (await document()).parameters, { far: { type: 'number', default: 2, min: 0, max: 10, unit: 'mm', description: 'one way' }, who: { type: 'axis', default: 'feeder' } });
  const add = page.getByLabel('Add a step to steps');
  await add.selectOption('enable');
  await add.selectOption('command');
  await add.selectOption('check');
  await page.getByLabel('Step 2: Command', { exact: true }).selectOption('move_relative');
  await set('Step 2: Position', '${far}');
  await set('Step 2: Velocity', '50');
  await set('Step 2: Comment', 'the way');
  await becomes('what is true or false has no tolerance', () => page.getByLabel('Step 3: Tolerance').count(), 0);
  await page.getByLabel('Step 3: What').selectOption('position');
  await set('Step 3: Value', '${far}');
  await set('Step 3: Tolerance', '0.5');
  await set('Longest time of a run, s', '90');
  // A new name goes into the steps, too.
  await set('Parameter far: Name', 'distance');
  await becomes('the steps follow', async () => (await document()).steps[1], { command: { axis: 'feeder', command: 'move_relative', position: '${distance}', wait_s: 30, velocity: 50 }, comment: 'the way' });
  const d = await document();
  assert.deepEqual(d.steps[2].check, { axis: 'feeder', point: 'position', is: '${distance}', tolerance: 0.5 });
  assert.equal(d.timeout_s, 90);
  // What the gateway does not like stands at the parameter.
  await set('Parameter distance: Default', '99');
  await page.locator('[data-recipe-parameter=distance].is-wrong').waitFor();
  await set('Parameter distance: Default', '2');
  await until('nothing is wrong', async () => (await page.locator('.is-wrong').count()) === 0);
  await page.getByRole('button', { name: 'Save' }).click();
  await page.getByText('Saved.').waitFor();
  await page.getByLabel('Argument distance').fill('1.5');
  await page.getByRole('button', { name: 'Run', exact: true }).click();
  const run = async () => (await program.call('GET', '/recipes/formed/runs/1')).body;
  await until('it has run', async () => { const r = await run(); return r.state === 'done' || [r.state, r.text, r.steps]; }, 30_000);
  await page.getByLabel('Step 3: Comparison').selectOption('at_least');
  await becomes('a bound has no tolerance', async () => 'tolerance' in (await document()).steps[2].check, false);
  await page.getByRole('button', { name: 'Remove parameter who' }).click();
  await becomes('it is removed', async () => Object.keys((await document()).parameters), ['distance']);
  await program.command('feeder', { command: 'disable' });
  await program.command('feeder', { command: 'set_position', position: 0 });
  assert.deepEqual(page.faults(), []);
  await page.context().close();
});

test('progress is live, and cancel stops the axis', async () => {
  const recipe = { steps: [{ enable: { axis: 'feeder' } }, { command: { axis: 'feeder', command: 'move_velocity', velocity: 3, acceleration: 100 } }, { wait_s: 600 }] };
  assert.equal((await program.call('PUT', '/recipes/endless', recipe)).status, 201);
  const page = await open(browser, `${program.url}/recipes/endless`);
  await page.getByRole('button', { name: 'Check only' }).click();
  await page.getByText('Can run: 3 steps, commands feeder (simulated).').waitFor();
  await page.getByRole('button', { name: 'Run', exact: true }).click();
  await page.locator('[data-report="/steps/2"][data-state=running]').waitFor();
  await until('motion', async () => (await program.axis('feeder')).moving);
  await page.getByRole('button', { name: 'Cancel run 1' }).click();
  await page.locator('[data-report="/steps/2"][data-state=cancelled]').waitFor();
  await page.getByText('feeder SIM: stopped').waitFor();
  await until('rest', async () => !(await program.axis('feeder')).moving);
  await program.command('feeder', { command: 'set_position', position: 0 });
  assert.deepEqual(page.faults(), []);
  await page.context().close();
});

test('a line is searched for drives', async () => {
  const page = await open(browser, `${program.url}/lines/can0`);
  await page.getByLabel('First address').fill('5');
  await page.getByLabel('Last address').fill('8');
  await page.getByRole('button', { name: 'Look for drives' }).click();
  await page.getByText('2 of 2 addresses asked, done').waitFor();
  assert.match(await page.locator('[data-found="5"]').innerText(), /is the drive feeder/);
  await page.getByLabel('First address').fill('4');
  await page.getByRole('button', { name: 'Look for drives' }).click();
  await page.getByText('4 is not an address').waitFor();
  assert.deepEqual(page.faults(), []);
  await page.context().close();
});

test('light and dark, two widths: pictures for people, nothing serious for axe-core, nothing wider than the screen', async () => {
  await program.call('PUT', '/recipes/there-and-back', long);
  await program.call('POST', '/recipes/there-and-back/run', {});
  await until('the end of the run', async () => (await program.call('GET', '/recipes/there-and-back/runs/1')).body.state === 'done' || (await program.call('GET', '/recipes/there-and-back/runs/1')).body.text);
  for (const { device } of visits) {
    const page = await open(browser, `${program.url}/recipes/there-and-back`, { ...device, bypassCSP: true });
    await page.locator('[data-report="/steps/4"]').waitFor();
    assert.deepEqual(await look(page, 'recipe'), []);
    await page.goto(`${program.url}/recipes`);
    await page.locator('[data-recipe]').first().waitFor();
    assert.deepEqual(await look(page, 'recipes'), []);
    await page.goto(`${program.url}/lines/can0`);
    await page.locator('[data-field=scan]').waitFor();
    for (const colorScheme of ['dark', 'light']) {
      await page.emulateMedia({ colorScheme });
      await shot(page, `line-${page.viewportSize().width}-${colorScheme}`);
    }
    assert.deepEqual(page.faults(), []);
    await page.context().close();
  }
});

test('a recipe that somebody else has changed meanwhile is shown first; what was typed stays', async () => {
  const steps = (n) => ({ description: 'two people', steps: [{ wait_s: n }] });
  await program.call('PUT', '/recipes/shared', steps(1));
  const head = await fetch(`${program.url}/api/v1/recipes/shared`);
  assert.ok(head.headers.get('etag'), 'a state of a recipe has a name');
  const page = await open(browser, `${program.url}/recipes/shared`);
  const field = page.getByRole('textbox', { name: 'Step 1: Seconds' });
  await field.fill('5');
  await field.press('Enter');
  await program.call('PUT', '/recipes/shared', steps(9));
  await page.getByRole('button', { name: 'Save', exact: true }).click();
  const clash = page.locator('[data-field=recipe-clash]');
  await clash.waitFor();
  assert.match(await clash.innerText(), /\/steps\/0\/wait_s: 9 → 5/);
  assert.equal(await field.inputValue(), '5');
  assert.equal((await program.call('GET', '/recipes/shared')).body.steps[0].wait_s, 9);
  await shot(page, 'recipe-clash');
  await clash.getByRole('button', { name: 'Save mine all the same' }).click();
  await until('mine is saved', async () => (await program.call('GET', '/recipes/shared')).body.steps[0].wait_s === 5);
  assert.deepEqual(page.faults(), []);
  await page.context().close();
});

test('run stands in the head; steps fold to one line and open where something is wrong; the report has values and times', async () => {
  await program.call('PUT', '/recipes/folded', { steps: [{ set_parameter: { axis: 'feeder', parameter: 'AC', value: 20000 } }, { read_parameter: { axis: 'feeder', parameter: 'AC' } }, { wait_s: 0.3 }] });
  const page = await open(browser, `${program.url}/recipes/folded`);
  const run = page.getByRole('button', { name: 'Run', exact: true });
  await run.waitFor();
  assert.ok((await run.boundingBox()).y < (await page.locator('[data-step="/steps/0"]').boundingBox()).y, 'the button stands above the steps');
  await page.getByRole('button', { name: 'Fold all', exact: true }).click();
  await becomes('no form is shown', () => page.getByLabel('Step 1: Value').count(), 0);
  assert.match(await page.locator('[data-step="/steps/0"] [data-field=summary]').innerText(), /feeder, AC, 20000/);
  await page.getByRole('button', { name: 'Unfold Step 1' }).click();
  await page.getByLabel('Step 1: Parameter').fill('');
  await page.getByLabel('Step 1: Parameter').press('Tab');
  await page.getByRole('button', { name: 'Fold all', exact: true }).click();
  await page.locator('[data-step="/steps/0"].is-wrong').waitFor();
  assert.equal(await page.getByLabel('Step 1: Value').count(), 1, 'what is wrong is not folded away');
  await page.reload();
  await run.click();
  await page.locator('[data-report="/steps/2"][data-state=done]').waitFor();
  const row = (n) => page.locator(`[data-report="/steps/${n}"]`).innerText();
  assert.match(await row(0), /AC of feeder = 20000[\s\S]*taken as 20000/);
  assert.match(await row(1), /= 20000/);
  assert.match(await page.locator('[data-report="/steps/2"] [data-field=step-took]').innerText(), /0\.[34]\d s/);
  await page.locator('[data-field=run-now]').getByText('Done').waitFor();
  assert.deepEqual(page.faults(), []);
  await page.context().close();
});

test('what is done by hand is recorded over two pages and a door, becomes steps, and does the same when it is run', async () => {
  const page = await open(browser, `${program.url}/recipes/by-hand`);
  await page.getByText('Record what is done by hand').click();
  await page.getByRole('button', { name: 'Record', exact: true }).click();
  await page.getByRole('group', { name: 'Recording' }).waitFor();
  await page.goto(`${program.url}/axes/feeder`); // the recording outlives the page
  await program.command('feeder', { command: 'enable' });
  await program.command('feeder', { command: 'set_position', position: 0 });
  const at = (await program.axis('feeder')).position;
  await program.call('POST', '/axes/feeder/commands?wait=10', { command: 'move_relative', position: 3, velocity: 30 });
  await until('it stands', async () => !(await program.axis('feeder')).moving && Math.abs((await program.axis('feeder')).position - at - 3) < 0.1);
  await program.call('PATCH', '/drives/feeder/hand', { temperature: 55 });
  await page.goto(`${program.url}/recipes/by-hand`);
  await until('the steps are shown as they come', async () => (await page.getByRole('list', { name: 'Steps so far' }).innerText().catch(() => '')).includes('Simulate'));
  await page.getByRole('button', { name: 'End and add the steps' }).click();
  const json = page.getByLabel('The recipe as JSON');
  const words = async () => JSON.parse(await json.inputValue()).steps.map((s) => Object.keys(s)[0] + (s.command ? ` ${s.command.command}` : ''));
  await until('they are in the recipe', async () => JSON.stringify(await words()) === JSON.stringify(['enable', 'command set_position', 'command move_relative', 'simulate']) || (await words()));
  const move = JSON.parse(await json.inputValue()).steps[2].command;
  assert.equal(move.position, 3);
  assert.ok(move.wait_s >= 10, 'the move was waited for');
  await page.getByRole('button', { name: 'Save' }).click();
  await page.getByRole('button', { name: 'Run', exact: true }).click();
  await page.locator('[data-report="/steps/3"][data-state=done]').waitFor();
  assert.equal((await program.call('GET', '/drives/feeder/hand')).body.temperature, 55);
  assert.deepEqual(page.faults(), []);
  await page.context().close();
});

test('a rehearsal is a step: what the model of the drive offers is offered, and the run sets it', async () => {
  const page = await open(browser, `${program.url}/recipes/rehearsal`);
  await page.getByRole('heading', { level: 1, name: 'rehearsal' }).waitFor();
  await page.getByLabel('Add a step to steps').selectOption('simulate');
  await becomes('the conditions of its drive are offered', () => page.locator('datalist[id^="offers-"] option[value="stall"]').count(), 1);
  await page.getByLabel('Step 1: Condition').fill('temperature');
  await page.getByLabel('Step 1: Value').fill('60');
  await page.getByLabel('Step 1: Value').press('Tab');
  await page.getByRole('button', { name: 'Save' }).click();
  await page.getByRole('button', { name: 'Run', exact: true }).click();
  await page.locator('[data-report="/steps/0"][data-state=done]').waitFor();
  assert.equal((await program.call('GET', '/drives/feeder/hand')).body.temperature, 60);
  assert.deepEqual(page.faults(), []);
  await page.context().close();
});

test('a recipe is rehearsed against specimens: a row for each, the reason of a failure, a specimen in words; the machine stays where it is', async () => {
  const document = {
    steps: [
      { enable: { axis: 'feeder' } },
      { wait_for: { axis: 'feeder', point: 'state', is: 'operation_enabled', timeout_s: 20 } },
      { command: { axis: 'feeder', command: 'move_relative', position: 1, velocity: 20, wait_s: 30 } },
      { check: { axis: 'feeder', point: 'moving', is: true, text: 'it must not have stopped' } },
    ],
  };
  assert.equal((await program.call('PUT', '/recipes/hundred', document)).status, 201);
  const before = (await program.call('GET', '/axes/feeder')).body.position;
  const page = await open(browser, `${program.url}/recipes/hundred`);
  await page.getByLabel('Specimens to rehearse').fill('0..3,slow');
  await page.getByRole('button', { name: 'Rehearse', exact: true }).click();
  await page.locator('[data-field=rehearsal-sum][data-state=done]').waitFor({ timeout: 60_000 });
  const rows = page.getByRole('region', { name: 'Rehearsed specimens' }).locator('tr[data-specimen]');
  await becomes('there is a row for each', () => rows.count(), 5);
  const first = page.locator('tr[data-specimen="0"]');
  assert.equal(await first.getAttribute('data-passed'), 'false', 'the check of the last step does not hold for the drive of the manual');
  assert.match(await first.innerText(), /Step 4: .*it must not have stopped/s);
  await page.locator('tr[data-specimen=slow] button').click();
  await until('its words are shown', async () => /reply_ms/.test(await page.locator('[data-field=specimen-words]').innerText().catch(() => '')));
  assert.equal((await program.call('GET', '/axes/feeder')).body.position, before);
  await page.getByLabel('Specimens to rehearse').fill('fast');
  await page.getByRole('button', { name: 'Rehearse', exact: true }).click();
  await until('the refusal is told', async () => /write a seed/.test(await page.locator('[data-field=rehearsal-told]').innerText()));
  assert.deepEqual(page.faults(), []);
  await page.context().close();
});
