// What may be done with what waits to be applied; and the wizard's memory: which step is shown, what its fields begin with, what is forgotten at the end.
import { signal } from '@preact/signals';
import { beforeEach, describe, expect, it } from 'vitest';
import type { SiteDraft } from '../src/state/site-draft';
import { choose, forget, goTo, keepTyped, placeOf, textsOf } from '../src/state/site-wizard';
import { readWithin, stageView } from '../src/state/stage-view';
import type { Site } from '../src/text/site';

const site: Site = { lines: [{ name: 'can0' }], drives: [], axes: [], mappings: [] } as never;
const change = { kind: 'added', what: 'lines/can0', before: null, after: site.lines![0]! };
const fault = { pointer: '/lines/0', text: 'wrong', remedy: 'mend it' };
const draft = (of: Record<string, unknown> = {}) => {
  const all = { stage: { state: 'none' }, changes: [change], checked: null, draft: site, faults: [], theirs: null, rival: null, reported: { tone: 'none', text: '' }, rolledBack: null, ...of };
  return Object.fromEntries(Object.entries(all).map(([k, v]) => [k, signal(v)])) as unknown as SiteDraft;
};

describe('a stage', () => {
  it.each([
    ['nothing is checked', {}, { ready: false, checked: false, foreign: false }],
    ['what is checked is what stands there', { checked: site, stage: { state: 'staged' } }, { ready: true, checked: true, foreign: false }],
    ['something was typed since', { checked: { ...site, drives: [{ name: 'd' }] }, stage: { state: 'staged' } }, { ready: false, checked: false, foreign: true }],
    ['it has faults', { checked: site, faults: [fault] }, { ready: false, faults: [fault] }],
    ['somebody else has changed the site', { checked: site, theirs: {} }, { ready: false }],
    ['nothing is changed', { checked: site, changes: [] }, { ready: false }],
    ['somebody else’s is in view', { rival: { inView: true }, stage: { state: 'staged' } }, { ready: true, inView: true, foreign: true }],
    ['somebody else’s is in view, and wrong', { rival: { inView: true }, stage: { state: 'staged', faults: [fault] } }, { ready: false, inView: true, faults: [fault] }],
    ['what was in view is gone', { rival: { inView: true } }, { ready: false, inView: false }],
  ])('%s', (_, of, view) => expect(stageView(draft(of), '60')).toMatchObject(view));
  it.each([['60', 60], ['0', 0], ['5', 5], ['600', 600], ['4', null], ['601', null], ['1.5', null], ['x', null]])('is kept within %j', (text, s) => expect(readWithin(text)).toBe(s));
});

describe('the wizard', () => {
  beforeEach(forget);
  const of = (change: Partial<Site> = {}) => draft({ draft: { ...site, ...change } });
  it('is at its first step until a line is chosen, and goes back to it when the line is not there any more', () => {
    expect(placeOf(of())).toEqual({ at: 0, gone: null });
    choose('lines', 'can0');
    goTo(1);
    expect(placeOf(of())).toEqual({ at: 1, gone: null });
    goTo(3);
    expect(placeOf(of())).toEqual({ at: 1, gone: 'drives' });
    expect(placeOf(of({ lines: [] }))).toEqual({ at: 0, gone: 'lines' });
  });
  it('stays where it can be applied again after a roll back', () => {
    choose('lines', 'gone');
    goTo(4);
    expect(placeOf(draft({ rolledBack: site }))).toEqual({ at: 4, gone: null });
    goTo(2);
    expect(placeOf(draft({ rolledBack: site }))).toEqual({ at: 0, gone: 'lines' });
  });
  it('begins with a proposal, and with what was typed for the same line; for another line it begins anew', () => {
    choose('lines', 'can0');
    expect(textsOf('drives', of())).toMatchObject({ line: 'can0', presence: 'auto' });
    keepTyped('drives', { name: 'lifter', address: '7', line: 'can0', more: 'x' });
    expect(textsOf('drives', of())).toMatchObject({ name: 'lifter', address: '7', line: 'can0' });
    expect(textsOf('drives', of())).not.toHaveProperty('more');
    choose('lines', 'other');
    expect(textsOf('drives', of()).name).not.toBe('lifter');
    choose('lines', 'can0');
    choose('drives', 'lifter');
    expect(textsOf('drives', of()).name).not.toBe('lifter'); // the step is done
  });
});
