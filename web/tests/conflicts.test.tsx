// @vitest-environment happy-dom
// What the page shows when somebody else was quicker, and when a session has ended: the whole page over the mock door, which refuses as the program does.
// What was typed must always be there afterwards; nothing that was not shown may be applied.
import { afterEach, describe, expect, it } from 'vitest';
import { MockDoor } from '../dev/mock/door.mjs';
import { openPage, soon, type MockPage } from './mock-page';

let p: MockPage;
afterEach(() => p.close());

const siteOf = () => p.other('GET', '/site').body;
const axisOf = (name: string) => siteOf().axes.find((a: any) => a.name === name);
/** Another client stages a site in which only the top speed of the lift is different. */
const bertStages = (velocity_max: number, replace = false) => {
  const site = structuredClone(siteOf());
  site.axes.find((a: any) => a.name === 'lift').velocity_max = velocity_max;
  const r = p.other('POST', `/site/stage${replace ? '?replace=true' : ''}`, site);
  expect(r.status).toBe(200);
  return r.body.id as string;
};
const typeUnit = async (unit: string) => {
  await p.see('[data-entry="axes/feeder"]', 'feeder');
  await p.press('Change axis feeder');
  await p.see('form[aria-label="Change axis feeder"]', 'Unit');
  p.type(p.field('Unit'), unit);
  await p.press('Save to draft');
  await p.see('[data-diff="axes/feeder"]', `→ ${unit}`);
};
const reported = '[data-field=stage-told]';
const mine = '.site-diff[aria-label="What would change"]';

describe('a site that two people change', () => {
  it('is not staged over what another client has staged: it is shown, and mine can be checked in its place', async () => {
    p = await openPage('/site');
    await typeUnit('cm');
    bertStages(91);
    await p.press('Check');
    await p.see(reported, 'Somebody at 10.0.0.9 has staged another change. What you typed is kept.');
    expect(p.text('[data-field=rival]')).toContain('Somebody at 10.0.0.9 has staged this; nothing of it is in force yet. What you typed is kept.');
    expect(p.text('[data-field=rival]')).toContain('lift: velocity max nothing → 91');
    expect(p.button('Apply').disabled).toBe(true);
    await p.press('Check mine instead');
    await p.see(reported, 'Checked: it can be applied.');
    await p.press('Apply');
    await p.see('[data-field=countdown]', 'It is rolled back by itself in');
    expect([axisOf('feeder').unit, axisOf('lift').velocity_max]).toEqual(['cm', undefined]);
  });
  it('takes theirs into view and back; applies theirs only then, and has mine still typed on top of it', async () => {
    p = await openPage('/site');
    await typeUnit('cm');
    bertStages(91);
    await p.press('Check');
    await p.see('[data-field=rival]', '→ 91');
    await p.press('Take theirs into view');
    await p.press('Back to mine');
    await soon(() => expect(p.button('Apply').disabled).toBe(true));
    await p.press('Take theirs into view');
    bertStages(92); // not what is in view
    await p.press('Apply theirs');
    await p.see(reported, 'Nothing was applied: somebody at 10.0.0.9 has staged another change.');
    await p.press('Take theirs into view');
    await p.press('Apply theirs');
    await p.see('[data-field=countdown]', 'It is rolled back by itself in');
    expect([axisOf('feeder').unit, axisOf('lift').velocity_max]).toEqual(['mm', 92]);
    await p.press('Keep');
    await p.see(mine, 'unit mm → cm');
  });
  it('applies nothing when another stage stands in the place of the one that was shown', async () => {
    p = await openPage('/site');
    await typeUnit('cm');
    await p.press('Check');
    await p.see(reported, 'Checked: it can be applied.');
    bertStages(92, true);
    await p.press('Apply');
    await p.see(reported, 'Nothing was applied: somebody at 10.0.0.9 has staged another change. What you typed is kept.');
    expect(p.text('[data-field=rival]')).toContain('→ 92');
    expect([axisOf('feeder').unit, axisOf('lift').velocity_max]).toEqual(['mm', undefined]);
    expect(p.text(mine)).toContain('unit mm → cm');
  });
  it('applies nothing when what was checked is not staged any more, and says to check it again', async () => {
    p = await openPage('/site');
    await typeUnit('cm');
    await p.press('Check');
    await p.see(reported, 'Checked: it can be applied.');
    expect(p.other('DELETE', '/site/stage').status).toBe(204);
    await p.press('Apply');
    await p.see(reported, 'Nothing was applied: what you checked is not staged any more. Check it again.');
    expect(p.button('Apply').disabled).toBe(true);
    await p.press('Check');
    await p.see(reported, 'Checked: it can be applied.');
  });
  it('shows what somebody else has applied meanwhile; mine goes on top of it, or is dropped', async () => {
    p = await openPage('/site');
    await typeUnit('cm');
    const applied = (velocity_max: number) => {
      const site = structuredClone(siteOf());
      site.axes.find((a: any) => a.name === 'lift').velocity_max = velocity_max;
      expect(p.other('PUT', '/site', site).status).toBe(200);
    };
    applied(77);
    await p.see('[data-field=theirs]', 'Somebody else has changed the site meanwhile. What you typed is kept.');
    expect(p.text('[data-field=theirs]')).toContain('lift: velocity max nothing → 77');
    expect(p.button('Check').disabled).toBe(true);
    await p.press('Put mine on top');
    await p.see(reported, 'Your changes stand on the newer site now.');
    expect(p.text(mine)).toContain('unit mm → cm');
    applied(78);
    await p.see('[data-field=theirs]', '77 → 78');
    await p.press('Drop mine');
    await p.see(reported, 'Your changes are dropped.');
    expect([p.text(mine), axisOf('lift').velocity_max]).toEqual(['', 78]);
  });
  it('shows what another client has staged also to who has typed nothing, and leaves it alone', async () => {
    p = await openPage('/site', { door: staged() });
    await p.see('[data-field=rival]', /^ ?Somebody at 10\.0\.0\.9 has staged this; nothing of it is in force yet\.changed axis lift/);
    await p.press('Take theirs into view');
    await p.see('[data-field=stage]', 'Apply theirs');
    await p.press('Leave it');
    await p.see('[data-field=rival]', 'Take theirs into view');
    expect(axisOf('lift').velocity_max).toBeUndefined();
  });
  it('is kept by who applied it alone, and the reason stands at the button', async () => {
    p = await openPage('/site');
    await p.see('[data-entry="axes/feeder"]', 'feeder');
    const id = bertStages(91);
    expect(p.other('POST', '/site/stage/apply', { confirm_within_s: 60, stage: id }).status).toBe(200);
    await p.see('[data-field=countdown]', 'It is rolled back by itself in');
    expect([p.button('Keep').disabled, p.button('Keep').title]).toEqual([true, 'Only the page of somebody at 10.0.0.9 that applied it can keep it; take it back and apply it from here if need be.']);
    // The door itself keeps to it, too.
    expect(p.door.answer({ method: 'POST', target: '/api/v1/site/stage/confirm', head: {}, text: '{}', peer: '127.0.0.1:1' }).status).toBe(409);
    await p.press('Roll back now');
    await p.see('[data-entry="axes/feeder"]', 'feeder');
    expect(axisOf('lift').velocity_max).toBeUndefined();
  });
  it('that nobody kept in time says so, and can be put into the draft again', async () => {
    p = await openPage('/site');
    await typeUnit('cm');
    await p.press('Check');
    await p.press('Apply');
    await p.see('[data-field=countdown]', 'It is rolled back by itself in');
    p.door.configuration.site.stage!.confirm_by = 1;
    p.door.step(0.01, 1);
    await p.see(reported, 'Rolled back by itself: nobody pressed Keep in time.');
    expect([axisOf('feeder').unit, p.text(mine)]).toEqual(['mm', '']);
    await p.press('Put it into the draft again');
    await p.see(mine, 'unit mm → cm');
  });
  it('an older state is not put over what is typed before it is asked for', async () => {
    p = await openPage('/site');
    await p.see('[data-entry="axes/feeder"]', 'feeder');
    const site = structuredClone(siteOf());
    site.axes.pop();
    expect(p.other('PUT', '/site', site).status).toBe(200);
    await p.see('[data-field=history]', 'Revision 1');
    await soon(() => expect(p.text('[data-entry="axes/gantry-y"]')).toBe(''));
    await typeUnit('cm');
    await p.press('Restore revision 1');
    const ask = '[role=group][aria-label="Restore revision 1"]';
    await p.see(ask, 'One change of yours is not applied; restoring puts revision 1 in their place.');
    await p.press('Keep mine');
    await soon(() => expect(p.text(ask)).toBe(''));
    expect(p.text(mine)).toContain('unit mm → cm');
    await p.press('Restore revision 1');
    await p.press('Drop mine and restore');
    await p.see(reported, 'Revision 1 is staged; nothing has been applied yet.');
    expect(p.text(mine)).toMatch(/^added axis gantry-y/);
    expect(siteOf().axes).toHaveLength(5);
  });
  it('on trial is not changed otherwise, and the refusal is shown where it was tried', async () => {
    p = await openPage('/mappings');
    await p.see('.register-grid', 'Nothing is mapped yet.');
    expect(p.other('POST', '/mappings', { unit: 2, address: 0, axis: 'feeder', point: 'position', type: 'i32' }).status).toBe(201);
    await p.see('[data-mapping=m1]', 'feeder');
    p.other('POST', '/site/stage/apply', { confirm_within_s: 60, stage: bertStages(91) });
    p.root.querySelector<HTMLElement>('[data-mapping=m1]')!.click();
    await soon(() => p.button('Remove m1'));
    await p.press('Remove m1');
    await p.see('[data-field=grid-told]', 'A staged site is on trial: confirm it or roll it back before the site is changed otherwise');
    expect(siteOf().mappings).toHaveLength(1);
  });
});

/** A door at which bert was first. */
function staged(): MockDoor {
  const door = new MockDoor();
  const say = (method: string, target: string, text = '') => door.answer({ method, target: `/api/v1${target}`, head: { 'x-client': 'bert' }, text, peer: '10.0.0.9:1' });
  const site = JSON.parse(say('GET', '/site').text);
  site.axes[2].velocity_max = 91;
  expect(say('POST', '/site/stage', JSON.stringify(site)).status).toBe(200);
  return door;
}

describe('a recipe that two people change', () => {
  const steps = (seconds: number) => ({ steps: [{ wait_s: seconds }] });
  const saved = (document: object, head: Record<string, string> = {}) => p.other('PUT', '/recipes/r', document, head);
  const there = () => p.other('GET', '/recipes/r').body?.steps;
  const clash = '[data-field=recipe-clash]';
  const open = async (begin: object | null) => {
    const door = new MockDoor();
    if (begin) door.answer({ method: 'PUT', target: '/api/v1/recipes/r', head: {}, text: JSON.stringify(begin), peer: '10.0.0.9:1' });
    p = await openPage('/recipes/r', { door });
    const json = await soon(() => p.field('The recipe as JSON'));
    const type = (document: object) => p.type(json, JSON.stringify(document));
    return { json, type };
  };
  it('is saved against what was read; the difference is shown, and mine is saved all the same', async () => {
    const { json, type } = await open(steps(1));
    type(steps(2));
    expect(saved(steps(9)).status).toBe(200);
    await p.press('Save');
    await p.see('.result', 'Somebody else has changed r meanwhile. What you typed is kept.');
    expect(p.text(clash)).toContain('/steps/0/wait_s: 9 → 2');
    expect([p.button('Save').disabled, there(), JSON.parse(json.value)]).toEqual([true, steps(9).steps, steps(2)]);
    await p.press('Save mine all the same');
    await p.see('.result', 'Saved.');
    expect([there(), p.text(clash)]).toEqual([steps(2).steps, '']);
  });
  it('is taken as the other has made it, and goes on from there', async () => {
    const { json, type } = await open(steps(1));
    type(steps(2));
    saved(steps(9));
    await p.press('Save');
    await p.see(clash, 'Take theirs');
    await p.press('Take theirs');
    await p.see('.result', 'In view is what the gateway has now.');
    expect(JSON.parse(json.value)).toEqual(steps(9));
    type(steps(3));
    await p.press('Save');
    await p.see('.result', 'Saved.');
    expect(there()).toEqual(steps(3).steps);
  });
  it('that is new takes the place of none that was made meanwhile', async () => {
    const { type } = await open(null);
    type(steps(2));
    saved(steps(9));
    await p.press('Save');
    await p.see('.result', 'Somebody else has made a recipe r meanwhile.');
    expect(there()).toEqual(steps(9).steps);
  });
  it('that was deleted meanwhile can be made anew', async () => {
    const { type } = await open(steps(1));
    type(steps(2));
    expect(p.other('DELETE', '/recipes/r').status).toBe(204);
    await p.press('Save');
    await p.see('.result', 'Somebody else has deleted r meanwhile. What you typed is kept.');
    await p.press('Save mine all the same');
    await p.see('.result', 'Saved.');
    expect(there()).toEqual(steps(2).steps);
  });
  it('is not deleted unseen after somebody else has changed it', async () => {
    await open(steps(1));
    await p.see('[data-step="/steps/0"]', 'Step 1');
    saved(steps(9));
    await p.press('Delete r');
    await p.press('Delete');
    await p.see(clash, 'Delete it all the same');
    expect([p.text('.result'), there()]).toEqual(['Somebody else has changed r meanwhile. What you typed is kept.', steps(9).steps]);
    await p.press('Delete it all the same');
    await p.see('h1', 'Recipes');
    expect(p.other('GET', '/recipes/r').status).toBe(404);
  });
  it('that runs is not deleted, and the reason is said', async () => {
    await open({ steps: [{ wait_s: 600 }] });
    await p.see('[data-step="/steps/0"]', 'Step 1');
    expect(p.other('POST', '/recipes/r/run', {}).status).toBe(202);
    await p.press('Delete r');
    await p.press('Delete');
    await p.see('.result', 'Recipe r is running (run 1): cancel it first');
  });
});

describe('a session that has ended', () => {
  const password = 'a long enough phrase';
  const begin = async (localRole: 'engineer' | null) => {
    const door = new MockDoor({ localRole });
    const answer = door.answer({ method: 'POST', target: '/api/v1/session/first', head: {}, text: JSON.stringify({ code: door.access.code, user: 'anna', password }), peer: '127.0.0.1:1' });
    p = await openPage('/recipes', { door, cookie: String(answer.head['set-cookie']).split(';')[0]! });
    await p.see('h1', 'Recipes');
    p.type(p.field('Name of the new recipe'), 'half-typ');
    door.access.sessions.clear();
  };
  const text = 'Your session has ended: it was ended elsewhere, it expired, or the gateway was restarted. Sign in again; what you typed is kept.';

  it('is told by the first request that is refused: the page waits behind the sign-in with what was typed', async () => {
    await begin(null);
    p.go('/recipes/half');
    await p.see('[data-field=session-ended]', text);
    expect(p.text('[data-field=strip]')).toContain('Your session has ended: no values are shown until you sign in again.');
    expect(p.text('[data-field=connection]')).toBe('Not signed in');
    expect([...p.root.querySelectorAll('button')].map((b) => b.textContent)).not.toContain('Go on without signing in');
    p.type(p.field('Name'), 'anna');
    p.type(p.field('Password'), 'wrong');
    await p.press('Sign in');
    await p.see('[data-field=sign-in-told]', 'the user or the password is wrong');
    p.type(p.field('Password'), password);
    await p.press('Sign in');
    await p.see('h1', 'half');
    await p.see('[data-field=connection]', 'Live');
    expect(p.text('[data-field=session-ended]')).toBe('');
  });
  it('keeps the page as it is behind the sign-in', async () => {
    await begin(null);
    const typed = p.field('Name of the new recipe');
    await p.gateway.client.axes().catch(() => undefined);
    await p.see('[data-field=session-ended]', text);
    expect(typed.closest('[hidden]')).not.toBeNull();
    p.type(p.field('Name'), 'anna');
    p.type(p.field('Password'), password);
    await p.press('Sign in');
    await p.see('h1', 'Recipes');
    expect([p.field('Name of the new recipe') === typed, typed.value]).toEqual([true, 'half-typ']);
  });
  it('is no local access by itself, but offers it where this machine has one', async () => {
    await begin('engineer');
    await p.gateway.client.axes().catch(() => undefined);
    await p.see('[data-field=session-ended]', text);
    await p.see('.sign-in .form-foot', 'Go on without signing in');
    expect(p.text('[data-field=connection]')).toBe('Not signed in');
  });
  it('was none for who signs out: nothing is said to have ended', async () => {
    await begin(null);
    p.door.access.sessions.set(p.wire.cookie.split('=')[1]!, { user: 'anna', csrf: p.gateway.client.csrf! });
    expect(await p.gateway.session.signOut()).toBeNull();
    await p.see('h1', 'Sign in');
    expect([p.text('[data-field=session-ended]'), p.text('[data-field=strip]')]).toEqual(['', expect.stringContaining('Not signed in: no values are shown. This gateway serves nobody without a sign-in.')]);
  });
});
