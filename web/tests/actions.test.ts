// Actions as forms: every command of every family's catalogue has fields that take a right value, and only right ones; what is sent; the text for recipes.
import { readdirSync, readFileSync } from 'node:fs';
import { describe, expect, it } from 'vitest';
import { argumentFault, bodyOf, faultsOf, found, hintOf, isFlag, isText, labelOf, questionOf, rangeOf, recipeText, type CatalogueCommand, type CommandArgument } from '../src/text/action';

const folder = new URL('../../schema/families/', import.meta.url);
/** As GET /families/{family}/commands gives them. */
const served = (family: string): CatalogueCommand[] =>
  JSON.parse(readFileSync(new URL(family, folder), 'utf8')).commands.map((c: Partial<CatalogueCommand>) => ({ description: null, completes: 'acknowledged', confirm: null, ...c, arguments: (c.arguments ?? []).map((a: Partial<CommandArgument>) => ({ unit: null, scale: 1, min: null, max: null, default: null, description: null, ...a })) }));
const families = readdirSync(folder).filter((f) => f.endsWith('.json'));
const argument = (change: Partial<CommandArgument>): CommandArgument => ({ name: 'position', type: 'i32', unit: 'mm', scale: 0.0001, min: null, max: null, default: null, description: null, ...change });

describe('every command of every catalogue', () => {
  it.each(families)('%s: its fields take what is in their range, and nothing else', (family) => {
    for (const c of served(family)) {
      const good: Record<string, string> = {};
      for (const a of c.arguments) {
        const r = rangeOf(a);
        good[a.name] = isText(a) ? 'x' : isFlag(a) ? 'true' : String(r && Number.isFinite(r[0]) ? Math.max(r[0], Math.min(r[1], 1)) : 1);
        expect(labelOf(a), `${c.id} ${a.name}`).toMatch(/^[A-Z0-9]/);
        if (a.default === null) expect(argumentFault(a, ''), `${c.id} ${a.name}`).not.toBe('');
        if (r && Number.isFinite(r[1])) expect(argumentFault(a, String(r[1] + a.scale)), `${c.id} ${a.name}`).not.toBe('');
        if (!isText(a)) expect(argumentFault(a, 'x'), `${c.id} ${a.name}`).not.toBe('');
      }
      expect(faultsOf(c, good), c.id).toEqual({});
      expect(Object.keys(bodyOf(c, good).arguments ?? {}), c.id).toEqual(c.arguments.map((a) => a.name));
    }
  });
  it('LinMot: all 216 motion commands are found by name', () => {
    const all = served('linmot.json').filter((c) => /^[0-9A-F]{3}xh$/.test(c.id));
    expect(all).toHaveLength(216);
    for (const c of all) expect(found(all, c.name), c.name).toContain(c);
    expect(found(all, 'encoder CAM curve from act pos').map((c) => c.id)).toEqual(['111xh', '121xh']);
  });
});

/** Sets settings or programs back, replaces what is saved, restarts, changes how the drive is reached, gives the position another name, takes the power. */
const harmful = /state from the factory|factory (values|settings)|restarts the drive|reboots|delet|clears? (the )?program|program memory is cleared|\bsaves?\b|flash|EEPROM|node address|puts it into party mode|sets? (the )?(position|actual position)|no current|loses its power/i;
/** Whose description has such a word and that do no harm, each for a reason. */
const harmless: Record<string, string> = {
  'pacontrol delete_g29': 'the port has no command for it: it is always refused',
};

describe('what a person is asked before it is sent', () => {
  it.each(families)('%s: every command that loses something says what', (family) => {
    const own = family.replace('.json', '');
    const silent = served(family).filter((c) => !c.confirm && harmful.test(c.description ?? '') && !harmless[`${own} ${c.id}`]);
    expect(silent.map((c) => `${c.id}: ${c.description}`)).toEqual([]);
    for (const c of served(family).filter((x) => x.confirm)) {
      expect(c.confirm, c.id).toMatch(/^[A-Z].*\.$/);
      expect(questionOf(c, 'feeder'), c.id).toMatch(/ on feeder: [A-Z].*\. Run it\?$/);
    }
  });
  it('nothing is asked where nothing is lost', () => {
    expect(questionOf(served('example.json')[0] as CatalogueCommand, 'feeder')).toBe('');
    expect(served('linmot.json').filter((c) => c.confirm && /Go To Pos/.test(c.name))).toEqual([]);
  });
});

describe('one argument', () => {
  it.each([
    ['12.5', ''], ['12,5', 'Write the decimal sign as a point: 1.5'], ['-214748.3648', ''], ['214748.3648', '-214748.3648 to 214748.3647.'], ['', 'A value is needed.'], ['x', '“x” is not a number.'],
  ])('a position of %j: %j', (text, why) => expect(argumentFault(argument({}), text)).toBe(why));
  it.each([['1', ''], ['1.5', 'A whole number.'], ['0', '1 to 100.'], ['101', '1 to 100.']])('a curve of %j: %j', (text, why) =>
    expect(argumentFault(argument({ name: 'curve', type: 'u16', unit: null, scale: 1, min: 1, max: 100 }), text)).toBe(why));
  it('says its range with its unit', () => expect(hintOf(argument({ description: 'Where to.' }))).toBe('Where to. -214748.3648 to 214748.3647 mm.'));
});

it('what is sent has numbers as numbers; what stayed empty has its default; a recipe has the same as one text', () => {
  const c: CatalogueCommand = { id: 'go', name: 'go', description: null, completes: 'acknowledged', confirm: null, arguments: [argument({}), argument({ name: 'times', type: 'u16', unit: null, scale: 1, default: 1 }), argument({ name: 'note', type: 'text', unit: null, default: '' })] };
  expect(bodyOf(c, { position: '12.5', times: '', note: '' })).toEqual({ name: 'go', arguments: { position: 12.5 } });
  expect(recipeText(c, { position: '12.5', times: '3', note: 'a' })).toBe('position=12.5 times=3 note=a');
  expect(recipeText(c, { position: '1', note: 'two words' }), 'that form carries no blanks').toBe('');
  expect(bodyOf({ ...c, arguments: [] }, {}, ' 5')).toEqual({ name: 'go', argument: ' 5' });
});
