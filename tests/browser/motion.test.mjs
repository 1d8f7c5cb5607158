// Motion through the page and beside it: the tile follows; the stop key stops; a refusal tells its reason; the jog ends when let go.
import assert from 'node:assert/strict';
import { after, before, beforeEach, test } from 'node:test';
import { launch, open, shot, tileOf, until } from './lib/browser.mjs';
import { Program } from './lib/program.mjs';

let program, browser, page, feeder;
before(async () => {
  program = await Program.start();
  browser = await launch();
  page = await open(browser, program.url);
  feeder = tileOf(page, 'feeder');
  await feeder.tile.locator('[data-live=true]').waitFor();
});
after(async () => {
  await browser?.close();
  await program?.end();
});
beforeEach(async () => {
  await program.command('feeder', { command: 'disable' });
  await until('the axis is disabled and at rest', async () => {
    const a = await program.axis('feeder');
    return (a.state === 'switch_on_disabled' && !a.moving) || a.state;
  });
});

const say = (name) => page.getByRole('button', { name, exact: true }).click();
const type = (name, text) => page.getByRole('textbox', { name, exact: true }).fill(text);
const motion = () => feeder.text('motion');

test('a refused command tells its reason, and what was typed stays', async () => {
  await type('Target of feeder', '12.5');
  await say('Move to target of feeder');
  await until('the refusal is told', async () => /refused\. .*enable it first/i.test(await feeder.result()) || (await feeder.result()));
  assert.equal(await page.getByRole('textbox', { name: 'Target of feeder' }).inputValue(), '12.5');
  await shot(page, 'refused');
});

test('enable, move to a target: the position runs, the target is reached', async () => {
  await say('Enable feeder');
  await until('it is enabled', async () => /Enabled/.test(await feeder.text('state')));
  const begin = await feeder.position();
  const target = begin + 20;
  await type('Target of feeder', String(target));
  await type('Speed of feeder', '10');
  await say('Move to target of feeder');
  const seen = new Set();
  let said = false; // while it is between, the page says that it moves
  await until('positions between are shown', async () => {
    const p = await feeder.position();
    if (p > begin + 0.5 && p < target - 0.5) seen.add(p);
    said ||= /Moving/.test(await motion());
    return (seen.size >= 4 && said) || [seen.size, said];
  });
  await shot(page, 'moving');
  await until('the target is reached', async () => /In position/.test(await motion()) || (await motion()));
  await until('it is there', async () => Math.abs((await feeder.position()) - target) < 0.01 || `at ${await feeder.position()} instead of ${target}`);
  await until('it is told where it was given that it is done', async () => /^Move to .*: done$/.test(await feeder.result()) || (await feeder.result()));
});

test('a move that somebody else ends is told as ended where it was given; a refusal goes when its cause does', async () => {
  await until('it is seen to be disabled', async () => /Disabled/.test(await feeder.text('state')) || (await feeder.text('state')));
  await say('Move to target of feeder');
  await until('it is refused', async () => /enable it first/.test(await feeder.result()) || (await feeder.result()));
  await program.command('feeder', { command: 'enable' });
  await until('the refusal has gone', async () => (await feeder.result()) === '' || (await feeder.result()));
  await type('Target of feeder', String((await feeder.position()) + 100));
  await type('Speed of feeder', '10');
  await say('Move to target of feeder');
  await until('it moves', async () => /Moving/.test(await motion()) && /accepted/.test(await feeder.result()) || (await feeder.result()));
  await program.command('feeder', { command: 'disable' });
  await until('it is told', async () => /^Move to .*: interrupted: the axis is disabled now, at /.test(await feeder.result()) || (await feeder.result()));
  assert.equal(await feeder.tile.locator('.result-good').count(), 0);
});

test('a move that REST commanded is seen', async () => {
  await program.command('feeder', { command: 'enable' });
  const begin = await feeder.position();
  await program.command('feeder', { command: 'move_relative', position: -15, velocity: 20 });
  await until('it is seen to move back', async () => (await feeder.position()) < begin - 2);
  await until('it arrives', async () => Math.abs((await feeder.position()) - (begin - 15)) < 0.01 || (await feeder.position()));
});

test('the Escape key stops all axes, with the keyboard in a field', async () => {
  await program.command('feeder', { command: 'enable' });
  await program.command('feeder', { command: 'move_velocity', velocity: 15 });
  await until('it moves', async () => /Moving/.test(await motion()));
  await page.getByRole('textbox', { name: 'Target of feeder' }).focus();
  await page.keyboard.press('Escape');
  await until('it stands, by what the gateway says', async () => {
    const a = await program.axis('feeder');
    return (!a.moving && a.velocity === 0) || a.velocity;
  }, 3_000);
  await until('the page says so', async () => /Quick stop|At rest/.test(`${await feeder.text('state')} ${await motion()}`));
  const strip = page.locator('.strip-stop');
  await until('the stop is confirmed', async () => /Stop accepted/.test(await strip.innerText()) || (await strip.innerText()));
});

test('the stop of one axis leaves the other one alone', async () => {
  for (const a of ['feeder', 'slide.x']) {
    await program.command(a, { command: 'enable' });
    await program.command(a, { command: 'move_velocity', velocity: 10 });
  }
  await until('both move', async () => /Moving/.test(await motion()) && /Moving/.test(await tileOf(page, 'slide.x').text('motion')));
  await say('Stop feeder');
  await until('one stands', async () => (await program.axis('feeder')).moving === false, 3_000);
  assert.equal((await program.axis('slide.x')).moving, true);
  await program.command('slide.x', { command: 'disable' });
});

test('a jog moves while the button is held and ends when it is let go', async () => {
  await program.command('feeder', { command: 'enable' });
  await type('Speed of feeder', '8');
  const button = page.getByRole('button', { name: 'Jog feeder backward while held' });
  await button.scrollIntoViewIfNeeded();
  const box = await button.boundingBox();
  const begin = await feeder.position();
  await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
  await page.mouse.down();
  await until('it moves back', async () => (await feeder.position()) < begin - 1);
  await page.mouse.up();
  await until('it stands', async () => (await program.axis('feeder')).moving === false, 3_000);
  assert.equal((await program.axis('feeder')).state, 'operation_enabled');
});

test('a jog by a held key ends when the window loses the keyboard', async () => {
  await program.command('feeder', { command: 'enable' });
  await type('Speed of feeder', '8');
  await page.getByRole('button', { name: 'Jog feeder forward while held' }).focus();
  const begin = await feeder.position();
  await page.keyboard.down('Space');
  await until('it moves', async () => (await feeder.position()) > begin + 1);
  await page.evaluate(() => globalThis.dispatchEvent(new Event('blur')));
  await until('it stands', async () => (await program.axis('feeder')).moving === false, 3_000);
  await page.keyboard.up('Space');
});

test('a fault of the drive is shown with code and text, spoken, and reset', async () => {
  await program.command('slide.x', { command: 'enable' });
  const hand = await program.call('PATCH', '/drives/slide/hand', { inject_error: 29 });
  assert.equal(hand.status, 200, JSON.stringify(hand.body));
  const slide = tileOf(page, 'slide.x');
  await until('the fault is shown', async () => /29/.test(await slide.text('notice')) || (await slide.text('notice')));
  await until('the alarm is spoken', async () => /Alarm/.test(await page.locator('[data-field=spoken]').textContent()) || 'silent');
  await until('the event list has it', async () => (await page.locator('[data-severity=alarm]').count()) > 0);
  await shot(page, 'fault');
  await program.call('PATCH', '/drives/slide/hand', { inject_error: 0 });
  await page.getByRole('button', { name: 'Reset fault of slide.x' }).click();
  await until('the fault is gone', async () => !/^Fault/.test(await slide.text('notice')) || (await slide.text('notice')));
});

test('nothing on the way was a fault of the page', () => assert.deepEqual(page.faults(), []));
