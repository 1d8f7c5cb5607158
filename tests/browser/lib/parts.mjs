// Parts: every part of the page, once, for the tests that walk through all of them; and a gateway in which none of them is empty.
// In: a program. Out: addresses, and what tells that a part is drawn.
import { readFileSync } from 'node:fs';
import { quiet } from './browser.mjs';

/** `ready`: a selector that is there when the part has got its documents. */
export const parts = [
  { name: 'overview', path: '/', title: 'Overview', ready: '[data-axis=feeder] [data-live=true]' },
  { name: 'axis', path: '/axes/feeder', title: 'feeder', ready: '.machine' },
  { name: 'axis-scope', path: '/axes/feeder/scope', title: 'Scope of feeder', ready: '.scope canvas' },
  { name: 'axis-drive', path: '/axes/feeder/drive', title: 'Drive of feeder', ready: '[data-part=actions]' },
  { name: 'axis-simulation', path: '/axes/feeder/simulation', title: 'Simulation of feeder', ready: '[data-hand]' },
  { name: 'axis-events', path: '/axes/feeder/events', title: 'Events of feeder', ready: '.event' },
  { name: 'parameters', path: '/axes/feeder/parameters', title: 'Parameters of feeder', ready: '[data-snapshot]' },
  { name: 'lines', path: '/lines', title: 'Lines and drives', ready: '[data-drive=feeder]' },
  { name: 'line', path: '/lines/can0', title: 'can0', ready: '.frame-list li' },
  { name: 'mappings', path: '/mappings', title: 'Mappings', ready: '[data-mapping]' },
  { name: 'site', path: '/site', title: 'Site', ready: '.site-history .fold, [data-revision]' },
  { name: 'descriptions', path: '/descriptions', title: 'Descriptions of drives', ready: '[data-description="example.dcf"]' },
  { name: 'description', path: '/descriptions/example.dcf/', title: 'example.dcf', ready: 'tr[data-object]' },
  { name: 'recipes', path: '/recipes', title: 'Recipes', ready: '[data-recipe]' },
  { name: 'recipe', path: '/recipes/there-and-back', title: 'there-and-back', ready: '[data-report]' },
  { name: 'events', path: '/events', title: 'Events and alarms', ready: '[data-alarm]' },
  { name: 'gateway', path: '/gateway', title: 'Gateway', ready: '.facts dd' },
  { name: 'users', path: '/users', title: 'Users', ready: '[data-field=account]' },
];

const recipe = {
  description: 'There and back, three times',
  parameters: { distance: { type: 'number', default: 2, min: 0, max: 10, unit: 'mm', description: 'one way' }, which: { type: 'axis', default: 'slide.x' } },
  steps: [
    { enable: { axis: '${which}' } },
    { if: { condition: { axis: '${which}', point: 'fault', is: true }, then: [{ command: { axis: '${which}', command: 'reset_fault' } }], else: [{ message: 'ready' }] } },
    { repeat: { times: 3, steps: [{ command: { axis: '${which}', command: 'move_relative', position: '${distance}', velocity: 90, wait_s: 20 } }, { wait_s: 0.1 }] } },
    { check: { axis: '${which}', point: 'position', is: 6, tolerance: 0.1, text: 'three times the distance' }, comment: 'the end' },
    { disable: { axis: '${which}' } },
  ],
};

/** What `furnish` types as a person does, in a language of her own. */
export const typed = ['shown on the panel', recipe.description, 'one way', 'the end', 'which', 'three times the distance', 'as delivered'];

/** On the page of the part, with all of its documents. */
export async function arrive(page, program, part) {
  await page.goto(program.url + part.path);
  await arrived(page, part);
}

/** The page that was opened at the part has all of its documents. */
export async function arrived(page, part) {
  await page.locator('main h1', { hasText: part.title }).first().waitFor();
  await page.locator(part.ready).first().waitFor();
  await quiet(page);
}

/** A description, mappings, a recipe with a run, a snapshot, an earlier site, a written parameter, a standing alarm. */
export async function furnish(program) {
  const must = async (method, path, body, good = [200, 201, 202, 204]) => {
    const r = await program.call(method, path, body);
    if (!good.includes(r.status)) throw new Error(`${method} ${path}: ${r.status} ${JSON.stringify(r.body)}`);
    return r.body;
  };
  const mapping = { unit: 2, table: 'holding_registers', axis: 'feeder', access: 'R' };
  await must('POST', '/descriptions', { name: 'example.dcf', text: readFileSync(new URL('../../../adapters/cia402/tests/eds/by_tool.dcf', import.meta.url), 'latin1') });
  await must('POST', '/mappings', { ...mapping, id: 'm1', address: 0, point: 'position_units', type: 'f32', comment: 'shown on the panel' });
  await must('POST', '/mappings', { ...mapping, id: 'm2', address: 4, point: 'velocity', type: 'i32', axis: 'slide.x' });
  await must('PATCH', '/axes/slide.x', { velocity_max: 360 });
  const writable = (await must('GET', '/axes/feeder/parameters')).find((p) => p.access === 'RW' && p.type !== 'text' && typeof p.default === 'number' && p.min !== null && p.min <= p.default);
  await must('PUT', `/axes/feeder/parameters/${encodeURIComponent(writable.id)}`, { value: writable.default });
  await must('POST', '/axes/feeder/snapshots', { name: 'first', comment: 'as delivered', from: 'stored' });
  await must('PUT', '/recipes/there-and-back', recipe);
  await must('POST', '/recipes/there-and-back/run', {});
  const over = () => program.call('GET', '/recipes/there-and-back/runs/1').then((r) => r.body.state !== 'running' && r.body.state !== 'stopping');
  for (let i = 0; i < 100 && !(await over()); i += 1) await new Promise((r) => setTimeout(r, 100));
  await must('PATCH', '/drives/feeder/hand', { stall: true });
  await program.command('feeder', { command: 'enable' });
  await program.command('feeder', { command: 'move_relative', position: 50, velocity: 20 });
  const alarmed = () => program.call('GET', '/alarms').then((r) => r.body.alarms.length > 0);
  for (let i = 0; i < 100 && !(await alarmed()); i += 1) await new Promise((r) => setTimeout(r, 100));
  if (!(await alarmed())) throw new Error('no alarm came of a stalled motor');
  await must('PATCH', '/drives/feeder/hand', { stall: false });
}
