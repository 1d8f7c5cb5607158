// @vitest-environment happy-dom
// Words of the API never reach people: every part of the page over the mock door, searched for words with an underscore. What stands in a fixed-width
// face is a name that one types, and no text.
import { afterEach, expect, it } from 'vitest';
import { plain, plainWord } from '../src/text/plain';
import { openPage, type MockPage } from './mock-page';

let p: MockPage;
afterEach(() => p?.close());

const underscored = (root: HTMLElement): string[] => {
  const found: string[] = [];
  const look = (text: string | null, where: string) => {
    for (const m of text?.match(/\b[a-z0-9]+(?:_[a-z0-9]+)+\b/g) ?? []) found.push(`${m} in ${where}`);
  };
  for (const e of root.querySelectorAll('*')) {
    if (e.closest('code, pre, kbd, textarea, .mono')) continue;
    for (const n of e.childNodes) if (n.nodeType === 3) look(n.textContent, `<${e.localName}> ${n.textContent}`);
    for (const a of ['aria-label', 'title', 'placeholder', 'aria-description']) look(e.getAttribute(a), `${a} of <${e.localName}>`);
  }
  return [...new Set(found)];
};

const ready: [string, string, RegExp][] = [
  ['/', '[data-axis=feeder]', /feeder/], ['/axes/feeder', '.machine', /Control word/], ['/axes/feeder/drive', '[data-part=actions]', /Find/], ['/axes/feeder/simulation', '.hand', /Stall/], ['/axes/feeder/events', 'main', /Events of this axis/], ['/axes/feeder/parameters', '[data-part=snapshots], main', /No snapshot is kept/],
  ['/lines', 'main', /feeder/], ['/lines/can0', 'main', /can0/], ['/mappings', '#mapping-form', /gantry-x/], ['/site', 'main', /feeder/], ['/recipes', 'main', /Recipes/],
  ['/events', 'main', /Events/], ['/gateway', 'main', /Modbus/], ['/fleet', 'main', /in no domain/], ['/users', 'main', /Users/],
];
for (const [path, where, shown] of ready) {
  it(`${path}: no word of the API`, async () => {
    p = await openPage(path);
    p.other('PATCH', '/axes/feeder', { velocity_max: 90 });
    await p.see(where, shown);
    await p.drawn();
    expect(underscored(p.root)).toEqual([]);
  });
}

it('states, reasons, points and settings have plain words, behind an axis and a dot too; a unit at the end is told as one', () => {
  expect(plain('axis x: velocity_max not set -> 360')).toBe('axis x: velocity max not set -> 360');
  expect(plain('mapping m1 (unit 2 holding_registers 0, feeder.position_units): added')).toBe('mapping m1 (unit 2 holding registers 0, feeder.position in units): added');
  expect([plainWord('retry_pause_min_ms'), plainWord('timeout_s'), plainWord('target_reached'), plainWord('wrong_state')]).toEqual(['retry pause min in ms', 'timeout in s', 'target reached', 'not possible in this state']);
  expect(plain('line slide.move_absolute is up')).toBe('line slide.move_absolute is up');
});

it('what had words of its maker has plain ones: confirm within, save to draft, fault simulation, unit ID', async () => {
  const shows = async (path: string, where: string, text: RegExp) => {
    p = await openPage(path);
    await p.see(where, text);
    p.close();
  };
  await shows('/axes/feeder/simulation', 'main h2', /^Fault simulation/);
  await shows('/mappings', 'main', /Unit ID/);
  p = await openPage('/site');
  await p.see('[data-entry="axes/feeder"]', 'feeder');
  await p.press('Change axis feeder');
  await p.see('form[aria-label="Change axis feeder"]', 'Unit');
  p.type(p.field('Unit'), 'cm');
  await p.press('Save to draft');
  await p.see('main', /Confirm within, s/);
  expect(p.root.textContent).not.toMatch(/Take into the draft|\bSlave\b|Rehearse faults/);
});

it('the four ways to stop are told apart where they are: by title each, and in one sentence on the page of the axis; a tile has its stop and halt alone', async () => {
  p = await openPage('/axes/feeder');
  await p.see('.stops-told', /Halt slows down on the profile ramp.*Quick stop, STOP and Esc slow down on the quick-stop ramp.*Disable takes the power off at once/);
  const title = (name: RegExp) => [...p.root.querySelectorAll('main button')].find((b) => name.test(b.textContent ?? ''))?.getAttribute('title') ?? '';
  expect([title(/^Halt$/), title(/^Quick stop$/), title(/^STOP$/)]).toEqual(['Stop on the profile ramp, stay enabled', 'Stop on the quick-stop ramp; enable to go on', expect.stringContaining('Quick stop of feeder. Not a safety function')]);
  expect(title(/^Disable$/)).toMatch(/power off at once/);
  p.close();
  p = await openPage('/');
  await p.see('[data-axis=feeder]', /STOP/);
  const tile = p.root.querySelector('[data-axis=feeder]') as Element;
  expect([...tile.querySelectorAll('button')].map((b) => b.textContent?.trim()).filter((w) => /stop|halt/i.test(w ?? ''))).toEqual(['STOP', 'Halt']);
});
