// The draft of the site against a gateway in memory: check, apply, keep, roll back, another writer, a gateway without staging.
import { beforeEach, describe, expect, it } from 'vitest';
import { Problem } from '../src/api/problem';
import type { SiteDoor, Stage } from '../src/api/site';
import { SiteDraft } from '../src/state/site-draft';
import type { Site } from '../src/text/site';

const first: Site = { lines: [{ name: 'can0', uri: 'twin', family: 'uim342' }], drives: [], axes: [], mappings: [] };
let inForce: Site;
let before: Site;
let tag: number;
let stage: Stage & { site?: Site };
let stages: number;
/** Whether this gateway tells one stage from another. */
let named: boolean;
let takers: string[];
const problem = (reason: string) => Promise.reject(new Problem('answered', `${reason} by bert`, 409, { type: `urn:axisgate:problem:${reason}`, reason }));
const bert = (s: Site) => {
  stages += 1;
  stage = { state: 'staged', id: `s${stages}`, by: 'bert 10.0.0.9', site: s, faults: [], diff: [{ kind: 'added', what: 'lines/rs', before: null, after: { name: 'rs' } }] };
};
let staging: boolean;
let faults: { pointer: string; text: string; remedy: string; document: 'body' }[];
let draft: SiteDraft;
const no = () => Promise.reject(new Problem('answered', 'there is nothing', 404));
const stale = (t: string) => t !== '' && t !== `"${tag}"`;
const late = () => Promise.reject(new Problem('answered', 'the site has another revision', 412));

const door = {
  read: async () => ({ site: inForce, tag: `"${tag}"` }),
  stage: () => (staging ? Promise.resolve({ ...stage }) : no()),
  putStage: (s: Site, t: string, replace = false) => {
    if (!staging) return no();
    if (stale(t)) return late();
    if (stage.by === 'bert 10.0.0.9' && !replace) return problem('stage_taken');
    stages += 1;
    stage = { state: 'staged', site: s, faults, diff: [], disturbs: ['feeder'], ...(named ? { id: `s${stages}` } : {}) };
    return Promise.resolve({ ...stage });
  },
  replace: (s: Site, how: { dryRun: boolean; tag: string }) => {
    if (stale(how.tag)) return late();
    if (!how.dryRun) [inForce, tag] = [s, tag + 1];
    return Promise.resolve({ dry_run: how.dryRun, valid: faults.length === 0, revision: tag, differences: [], faults });
  },
  apply: async (s: number, id = '') => {
    takers.push(id);
    if (id !== '' && id !== stage.id) return problem('stage_replaced');
    await typing();
    before = inForce;
    [inForce, tag] = [stage.site!, tag + 1];
    stage = s > 0 ? { ...stage, state: 'applied', confirm_by: '2027-01-02T03:04:05.678901Z' } : { state: 'none' };
    return stage;
  },
  confirm: async () => (stage = { state: 'none' }),
  rollBack: async () => {
    [inForce, tag, stage] = [before, tag + 1, { state: 'none' }];
  },
  discard: async () => (stage = { state: 'none' }),
  old: async () => first,
  restore: async () => (stage = { state: 'staged', site: first, faults: [], diff: [] }),
};
/** What a person does while the gateway applies. */
let typing: () => Promise<unknown> | void;
const rs = { ...first, lines: [...first.lines!, { name: 'rs', uri: 'twin', family: 'mcode' }] };
const add = () => draft.put('drives', { name: 'feeder', line: 'can0', address: 5 }, null);

beforeEach(async () => {
  [inForce, tag, stage, staging, faults] = [first, 1, { state: 'none' }, true, []];
  [stages, named, takers, typing] = [0, true, [], () => undefined];
  draft = new SiteDraft(door as unknown as SiteDoor);
  await draft.load();
});

describe('a draft', () => {
  it('is checked, applied and kept', async () => {
    add();
    expect(draft.changes.value.map((c) => c.what)).toEqual(['drives/feeder']);
    expect(inForce).toBe(first);
    expect(await draft.check()).toBe(true);
    expect(draft.disturbs.value).toEqual(['feeder']);
    expect(inForce).toBe(first);
    await draft.apply(60);
    expect(draft.stage.value.state).toBe('applied');
    expect(draft.changes.value).toEqual([]);
    await draft.confirm();
    expect(draft.stage.value.state).toBe('none');
    expect(inForce.drives).toHaveLength(1);
  });
  it('is rolled back', async () => {
    add();
    await draft.check();
    await draft.apply(60);
    await draft.rollBack();
    expect(inForce).toEqual(first);
    expect(draft.draft.value.drives).toEqual([]);
  });
  it('sees that the gateway rolled back by itself', async () => {
    add();
    await draft.check();
    await draft.apply(5);
    await door.rollBack();
    await draft.look();
    expect(draft.stage.value.state).toBe('none');
    expect(draft.draft.value.drives).toEqual([]);
  });
  it('with faults is not applicable, and keeps what was typed', async () => {
    faults = [{ pointer: '/drives/0/address', text: 'is taken', remedy: 'choose another', document: 'body' }];
    add();
    expect(await draft.check()).toBe(false);
    expect(draft.reported.value.text).toBe('One fault must be mended.');
    expect(draft.faults.value).toHaveLength(1);
    expect(draft.changes.value).toHaveLength(1);
  });
  it('shows the difference when somebody else was quicker, keeps what was typed, and goes on from there', async () => {
    add();
    inForce = { ...first, lines: [...first.lines!, { name: 'rs', uri: 'twin', family: 'mcode' }] };
    tag += 1;
    expect(await draft.check()).toBe(false);
    expect(draft.theirs.value?.changes.map((c) => c.what)).toEqual(['lines/rs']);
    expect(draft.changes.value.map((c) => c.what)).toEqual(['drives/feeder']);
    await draft.adopt(true);
    expect(draft.changes.value.map((c) => c.what)).toEqual(['drives/feeder']);
    expect(draft.draft.value.lines).toHaveLength(2);
    expect(await draft.check()).toBe(true);
  });
  it('can be dropped for the other one', async () => {
    add();
    inForce = { ...first, lines: [] };
    tag += 1;
    await draft.load();
    await draft.adopt(false);
    expect(draft.changes.value).toEqual([]);
    expect(draft.draft.value.lines).toEqual([]);
  });
  it('without staging goes as a whole, and it is said that nothing rolls back', async () => {
    staging = false;
    add();
    expect(await draft.check()).toBe(true);
    expect(draft.offersStage.value).toBe(false);
    await draft.apply(60);
    expect(draft.reported.value.text).toContain('does not roll back');
    expect(inForce.drives).toHaveLength(1);
  });
  it('of an older state is staged, not applied', async () => {
    await draft.restore(1);
    expect(draft.stage.value.state).toBe('staged');
    expect(inForce).toBe(first);
  });
});

describe('two people', () => {
  it('apply only what this page has shown', async () => {
    add();
    await draft.check();
    bert(rs);
    expect(await draft.apply(60)).toBe(false);
    expect(inForce).toBe(first);
    expect(draft.reported.value.text).toBe('Nothing was applied: bert 10.0.0.9 has staged another change. What you typed is kept.');
    expect(draft.stage.value.diff?.[0]?.what).toBe('lines/rs');
    expect(draft.rival.value).toEqual({ inView: false });
    expect(draft.changes.value.map((c) => c.what)).toEqual(['drives/feeder']);
    expect(await draft.check(true)).toBe(true);
    expect(await draft.apply(60)).toBe(true);
    expect(inForce.drives).toHaveLength(1);
  });
  it('are told before Apply is pressed', async () => {
    add();
    await draft.check();
    bert(rs);
    await draft.look();
    expect(draft.checked.value).toBeNull();
    expect(draft.reported.value.text).toContain('has staged something else');
  });
  it('take theirs into view, apply it, and have their own on top of it', async () => {
    add();
    bert(rs);
    expect(await draft.check()).toBe(false);
    expect(draft.rival.value).toEqual({ inView: false });
    draft.view(true);
    expect(await draft.apply(60)).toBe(true);
    expect(takers).toEqual(['s1']);
    expect(inForce.lines).toHaveLength(2);
    expect(draft.base.value.lines).toHaveLength(2);
    expect(draft.changes.value.map((c) => c.what)).toEqual(['drives/feeder']);
  });
  it('an older gateway is not asked for what it does not know', async () => {
    named = false;
    add();
    await draft.check();
    bert(rs);
    stage.id = 7;
    expect(await draft.apply(60)).toBe(true);
    expect(takers).toEqual(['']);
  });
});

describe('what is typed', () => {
  it('while it is applied stands on the new site', async () => {
    add();
    await draft.check();
    typing = () => {
      draft.put('drives', { name: 'late', line: 'can0', address: 6 }, null);
      return draft.load(); // the stream tells the new revision before apply has answered
    };
    await draft.apply(60);
    expect(draft.theirs.value).toBeNull();
    expect(draft.base.value.drives?.map((d) => d.name)).toEqual(['feeder']);
    expect(draft.changes.value.map((c) => c.what)).toEqual(['drives/late']);
  });
  it('is not replaced by an older state before it is asked for', async () => {
    add();
    expect(await draft.restore(1)).toBe(false);
    expect(draft.askRestore.value).toBe(1);
    expect(draft.changes.value).toHaveLength(1);
    expect(stage.state).toBe('none');
    expect(await draft.restore(1, true)).toBe(true);
    expect(draft.askRestore.value).toBeNull();
    expect(draft.changes.value).toEqual([]);
  });
  it('and goes for an older state leaves a difference to the site in force, also where somebody else has just changed that', async () => {
    add();
    [inForce, tag] = [rs, tag + 1];
    await draft.load();
    expect(draft.theirs.value?.changes.map((c) => c.what)).toEqual(['lines/rs']);
    expect(await draft.restore(1, true)).toBe(true);
    expect(draft.theirs.value).toBeNull();
    expect(draft.changes.value.map((c) => `${c.kind} ${c.what}`)).toEqual(['removed lines/rs']);
  });
  it('and rolled back by itself can be applied again; kept by somebody else leaves no words behind', async () => {
    add();
    await draft.check();
    await draft.apply(5);
    await door.rollBack();
    await draft.look();
    expect(draft.reported.value.text).toContain('nobody pressed Keep');
    draft.again();
    expect(draft.changes.value.map((c) => c.what)).toEqual(['drives/feeder']);
    await draft.check();
    await draft.apply(5);
    await door.confirm();
    await draft.look();
    expect(draft.reported.value.text).toBe('');
    expect(draft.rolledBack.value).toBeNull();
  });
});
