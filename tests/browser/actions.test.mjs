// LinMot's motion commands on the page: each of the 216 has a form with its fields; one of each type of argument is filled in, run, and seen
// at the drive. What loses something is asked first.
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { becomes, launch, open, until } from './lib/browser.mjs';
import { isMock, Program } from './lib/program.mjs';

if (isMock) {
  console.log('the mock has no LinMot drive: the tests of its actions are left out');
} else {
  let program, browser, page, card, commands;
  before(async () => {
    program = await Program.start({
      site: {
        lines: [{ name: 'rs485', uri: 'twin', family: 'linmot', bitrate: 115200 }],
        drives: [{ name: 'shuttle', line: 'rs485', address: 17, presence: 'twin' }],
        axes: [{ name: 'shuttle', drive: 'shuttle', number: 1, unit: 'mm', increments_per_unit: 10000 }],
        mappings: [],
      },
    });
    await until('the drive is live', async () => (await program.axis('shuttle')).online);
    await until('it is enabled', async () => {
      const { body } = await program.call('POST', '/axes/shuttle/commands?wait=20', { command: 'enable' });
      return body.result === 'done' || JSON.stringify(body);
    });
    commands = (await program.call('GET', '/families/linmot/commands')).body;
    browser = await launch();
    page = await open(browser, `${program.url}/axes/shuttle/drive`);
    card = page.locator('[data-part=actions]');
    await card.waitFor();
  });
  after(async () => {
    await browser?.close();
    await program?.end();
  });
  /** Its form is there when this is over: a field of the one before may have the same name, and what is typed there is not for this one. */
  async function choose(id) {
    await card.getByLabel('Action', { exact: true }).selectOption(id);
    await card.locator(`form[data-action="${id}"]`).waitFor();
  }
  const answer = () => card.locator('[data-field=action-result]');
  /** Chosen, filled in, run, answered without a refusal. */
  async function run(id, values) {
    await choose(id);
    for (const [label, value] of Object.entries(values)) await card.getByLabel(label, { exact: true }).fill(value);
    await card.getByRole('button', { name: 'Run', exact: true }).click();
    await until(`${id} is answered`, async () => /result-good/.test(await answer().getAttribute('class')) || (await answer().innerText()), 20_000);
  }
  const parameter = async (name) => (await program.call('GET', `/axes/shuttle/parameters/${encodeURIComponent(name)}`)).body.value;
  const position = async () => (await program.axis('shuttle')).position;

  test('each of the 216 motion commands has a form with a field per argument', async () => {
    const motions = commands.filter((c) => /^[0-9A-F]{3}xh$/.test(c.id));
    assert.equal(motions.length, 216);
    for (const c of motions) {
      await choose(c.id);
      const wanted = c.arguments.length || 1;  // a command without any still takes a text
      await becomes(`${c.id} ${c.name}`, () => card.locator('form input').count(), wanted);
      assert.equal(await card.getByRole('button', { name: c.confirm ? 'Run …' : 'Run', exact: true }).count(), 1, c.id);
    }
  });

  test('positions, speeds and accelerations of 32 bits move the axis', async () => {
    await run('010xh', { 'Position, mm': '12.5', 'Velocity, m/s': '0.5', 'Acceleration, m/s^2': '10', 'Deceleration, m/s^2': '10' });
    await becomes('the place', position, 12.5);
  });

  test('so do those of 16 bits', async () => {
    await run('090xh', { Position: '-3000', Velocity: '50000', Acceleration: '60000', Deceleration: '60000' });
    await becomes('the place', position, -0.3);
  });

  test('a value of any 32 bits goes where it is meant to', async () => {
    await run('002xh', { Upid: '5310', Value: '4294967295' });
    await becomes('14BEh', () => parameter('14BEh'), 4294967295);
    await run('240xh', { Value: '-70000' });
    await becomes('variable 1', () => parameter('1E72h'), -70000);
  });

  test('a text becomes a row of the command table, after the question what is lost', async () => {
    await choose('table.write');
    for (const [label, value] of Object.entries({ Entry: '5', Command: 'VAI Go To Pos', Arguments: 'position=50 velocity=1 acceleration=10 deceleration=10', Next: '6' }))
      await card.getByLabel(label, { exact: true }).fill(value);
    await card.getByRole('button', { name: 'Run …', exact: true }).click();
    await card.locator('[data-field=action-question]').waitFor();
    assert.equal(await parameter('table[5]'), '', 'nothing is written yet');
    await card.getByRole('button', { name: 'Run table write', exact: true }).click();
    await becomes('the row', () => parameter('table[5]'), 'VAI Go To Pos: position=50 velocity=1 acceleration=10 deceleration=10; next=6', 20_000);
  });

  test('what is out of range is said at its field and not sent; no argument is needed where there is none', async () => {
    await choose('010xh');
    await card.getByLabel('Position, mm', { exact: true }).fill('214748.3648');
    await card.getByRole('button', { name: 'Run', exact: true }).click();
    await becomes('the answer', () => answer().innerText(), 'Not sent: see the fields.');
    await run('000xh', {});
    assert.deepEqual(page.faults(), []);
  });
}
