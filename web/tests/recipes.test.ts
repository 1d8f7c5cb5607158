// Recipes as a tree that is edited: every change is a copy, what is typed becomes the value that it reads as, every step kind has its form.
import { speak } from '../src/language';
import { readFileSync } from 'node:fs';
import { describe, expect, it } from 'vitest';
import { fieldsOfStep, unitOfField, withCommand, added, changed, defaultOf, documentOf, editable, freshStep, kindOf, moved, parameterFault, pointerOf, removed, renamedParameter, runWord, stepKinds, takesTolerance, titleOf, typedOf, valueOf, withoutParameter, withParameter, type RecipeDocument } from '../src/text/recipe';

const recipe = (): RecipeDocument => ({
  steps: [{ enable: { axis: 'a' } }, { if: { condition: { axis: 'a', point: 'fault', is: true }, then: [{ wait_s: 1 }, { wait_s: 2 }], else: [] } }, { message: 'x' }],
});

describe('editing', () => {
  it('moves a step within its list, never out of it', () => {
    const d = recipe();
    expect(moved(d, ['steps'], 0, 1).steps.map((s) => Object.keys(s)[0])).toEqual(['if', 'enable', 'message']);
    expect(moved(d, ['steps'], 0, -1)).toEqual(d);
    expect(moved(d, ['steps', 1, 'if', 'then'], 1, -1).steps[1]).toEqual({ if: { condition: { axis: 'a', point: 'fault', is: true }, then: [{ wait_s: 2 }, { wait_s: 1 }], else: [] } });
    expect(d).toEqual(recipe());
  });
  it('adds and removes, also where there is no list yet', () => {
    expect(removed(recipe(), ['steps'], 1).steps).toHaveLength(2);
    expect(added({ steps: [{ if: { condition: {}, then: [] } }] }, ['steps', 0, 'if', 'else'], { wait_s: 3 }).steps[0]).toEqual({ if: { condition: {}, then: [], else: [{ wait_s: 3 }] } });
  });
  it('changes one value, and takes a member away that became nothing', () => {
    expect(changed(recipe(), ['steps', 0, 'enable', 'wait_s'], () => 5).steps[0]).toEqual({ enable: { axis: 'a', wait_s: 5 } });
    expect(changed({ steps: [{ enable: { axis: 'a', wait_s: 5 } }] }, ['steps', 0, 'enable', 'wait_s'], () => undefined).steps[0]).toEqual({ enable: { axis: 'a' } });
  });
  it('names places as the gateway does', () => expect(pointerOf(['steps', 1, 'if', 'then', 0])).toBe('/steps/1/if/then/0'));
  it.each([
    [['steps', 1], 'Step 2'],
    [['steps', 1, 'repeat', 'steps', 0], 'Step 2.1'],
    [['steps', 1, 'if', 'then', 0], 'Step 2 then 1'],
    [['steps', 1, 'if', 'else', 0], 'Step 2 else 1'],
    [['steps', 1, 'if', 'else', 0, 'repeat', 'steps', 2], 'Step 2 else 1.3'],
  ])('calls each step by a name of its own: %j', (path, name) => expect(titleOf(path)).toBe(name));
});

it.each([['5', 5], ['-1.5e3', -1500], ['true', true], ['false', false], ['${distance}', '${distance}'], ['0x10', '0x10'], ['', undefined], ['operation_enabled', 'operation_enabled']])('reads %s', (typed, value) => {
  expect(valueOf(typed)).toEqual(value);
  expect(typedOf(value)).toBe(typed === '-1.5e3' ? '-1500' : typed);
});

it('has a form for every step of the schema, and no other', () => {
  const schema = readFileSync(new URL('../../schema/openapi.yaml', import.meta.url), 'utf8').split('    RecipeStep:\n')[1]?.split('    RecipeDocument:')[0] ?? '';
  const reported = [...schema.matchAll(/^ {8}([a-z_]+):/gm)].map((m) => m[1]).filter((w) => w !== 'comment').sort();
  expect(stepKinds.map((k) => k.word).sort()).toEqual(reported);
  for (const k of stepKinds) expect(kindOf(freshStep(k.word, 'feeder'))).toBe(k);
});
it('begins a step with the axis that there is', () => expect(freshStep('if', 'feeder')).toEqual({ if: { condition: { axis: 'feeder', point: 'referenced', is: false }, then: [], else: [] } }));

it('reads text, or says what is wrong with it', () => {
  expect(documentOf('{"steps":[{"wait_s":1}]}')).toEqual({ document: { steps: [{ wait_s: 1 }] } });
  for (const bad of ['{', '[]', 'null', '{}', '{"steps":[1]}', '{"steps":{}}']) expect(documentOf(bad)).toHaveProperty('fault');
});
it('leaves out what the gateway adds', () => expect(editable({ name: 'x', changed_at: 'y', changed_by: null, steps: [] })).toEqual({ steps: [] }));
it('has a word for every state', () => {
  const all = ['running', 'stopping', 'done', 'failed', 'cancelled', 'interrupted', 'not_run'].map((s) => runWord(s).text);
  expect(new Set(all).size).toBe(all.length);
});

describe('parameters', () => {
  const d = (): RecipeDocument => ({ description: 'x', steps: [{ wait_s: '${t}' }, { repeat: { times: 2, steps: [{ message: 'for ${t} of ${total}' }] } }], parameters: { t: { type: 'number', default: 1, min: 0 }, total: { type: 'number' } } });
  it('change member by member; what became nothing is taken away', () => {
    expect(withParameter(d(), 't', { max: 9, min: undefined }).parameters?.t).toEqual({ type: 'number', default: 1, max: 9 });
    expect(withParameter({ steps: [] }, 'new', { type: 'axis' })).toEqual({ parameters: { new: { type: 'axis' } }, steps: [] });
    expect(Object.keys(withParameter({ steps: [] }, 'new', { type: 'axis' }))).toEqual(['parameters', 'steps']);
  });
  it('are renamed in their place, in every step, and no other with them', () => {
    const r = renamedParameter(d(), 't', 'rest');
    expect(Object.keys(r.parameters ?? {})).toEqual(['rest', 'total']);
    expect(r.steps).toEqual([{ wait_s: '${rest}' }, { repeat: { times: 2, steps: [{ message: 'for ${rest} of ${total}' }] } }]);
    expect(d().parameters?.t).toBeDefined();
  });
  it('leave no empty list behind', () => {
    expect(withoutParameter(withoutParameter(d(), 't'), 'total').parameters).toBeUndefined();
    expect(Object.keys(withoutParameter(d(), 't').parameters ?? {})).toEqual(['total']);
  });
  it.each([['', /1 to 64/], ['two words', /1 to 64/], ['t', /already/], ['speed.x', /^$/]])('may be called %j or not', (name, why) => expect(parameterFault(d(), name)).toMatch(why));
  it('are at most 64', () => expect(parameterFault({ steps: [], parameters: Object.fromEntries(Array.from({ length: 64 }, (_, i) => [`p${i}`, { type: 'number' }])) }, 'one')).toMatch(/at most 64/));
  it.each([['number', '2.5', 2.5], ['boolean', 'true', true], ['text', '12', '12'], ['axis', 'feeder', 'feeder'], ['number', ' ', undefined], ['text', '', undefined]])('of type %s have the default %j', (type, typed, value) => expect(defaultOf(type, typed)).toEqual(value));
  it.each([['is', 6, true], ['is_not', 6, true], ['is', '${distance}', true], ['is', 'operation_enabled', false], ['is', true, false], ['at_least', 6, false]])('a comparison %s %j takes a tolerance: %j', (op, value, takes) => expect(takesTolerance(op, value)).toBe(takes));
});

describe('a command step', () => {
  const kind = stepKinds.find((k) => k.word === 'command')!;
  const keys = (body: object) => fieldsOfStep(kind, body).map((f) => f.key);
  it('has motion fields only where the command takes them', () => {
    expect(keys({ command: 'move_absolute' })).toEqual(['axis', 'command', 'position', 'velocity', 'acceleration', 'deceleration', 'wait_s']);
    for (const command of ['reset_fault', 'enable', 'disable', 'halt', 'quick_stop']) expect(keys({ command })).toEqual(['axis', 'command', 'wait_s']);
    expect(keys({ command: 'halt', velocity: 3 })).toContain('velocity'); // what stands in the document is seen
  });
  it('loses what another command does not take', () => expect(withCommand({ axis: 'a', command: 'move_absolute', position: 1, velocity: 2, wait_s: 3 }, 'reset_fault')).toEqual({ axis: 'a', command: 'reset_fault', wait_s: 3 }));
  it('tells what its fields are counted in', () => {
    expect(['position', 'velocity', 'acceleration', 'wait_s'].map((k) => unitOfField(k, 'mm'))).toEqual(['mm', 'mm/s', 'mm/s²', '']);
    expect(['position', 'velocity', 'acceleration'].map((k) => unitOfField(k, null))).toEqual(['', '', '']);
  });
});

it('values are read and written in the reader’s figures, and what may be two numbers is none', () => {
  speak('de');
  try {
    expect([valueOf('1,5'), valueOf('1.234,5'), valueOf('1.234'), valueOf('MT[1]'), valueOf('7')]).toEqual([1.5, 1234.5, '1.234', 'MT[1]', 7]);
    expect(typedOf(1.5)).toBe('1,5');
    expect(valueOf(typedOf(-0.125))).toBe(-0.125);
  } finally {
    speak('en');
  }
});
