// @vitest-environment happy-dom
// The site's page over the mock door: a restore that waits, older states page by page, options as fields. Nobody else's page asks what only
// administrators are told.
import { afterEach, beforeEach, describe, expect, it } from 'vitest';
import { MockDoor } from '../dev/mock/door.mjs';
import { openPage, soon, type MockPage } from './mock-page';

let p: MockPage;
let door: MockDoor;
beforeEach(() => void (door = new MockDoor()));
afterEach(() => p.close());
const asAnna = async (path: string) => {
  const a = door.answer({ method: 'POST', target: '/api/v1/session/first', head: {}, text: JSON.stringify({ code: door.access.code, user: 'anna', password: 'a long enough phrase' }), peer: '127.0.0.1:1' });
  p = await openPage(path, { door, cookie: String(a.head['set-cookie']).split(';')[0] ?? '' });
};
const asked = (what: string) => p.wire.asked.filter((a) => a === what).length;
const laid = { waiting: true, at: '2026-03-01T10:11:12Z', who: 'bert 10.0.0.9', bytes: 319_488, version: 5, site_revision: 7 };

describe('a restore that waits', () => {
  it('is shown to an administrator with what it is, and dropped after a second question', async () => {
    door.configuration.pending = laid;
    await asAnna('/site');
    await p.see('[data-field=pending]', 'A restore waits: it takes effect with the next start.');
    expect(p.text('[data-field=pending-what]')).toMatch(/by bert 10\.0\.0\.9, 312 KiB\. It brings site revision 7 with it/);
    await p.press('Drop the restore …');
    await p.press('Leave it');
    expect(door.configuration.pending).toEqual(laid);
    await p.press('Drop the restore …');
    await p.press('Drop it');
    await p.see('[data-field=pending-told]', 'Dropped: the next start goes on with the database as it is.');
    expect(door.configuration.pending).toBeNull();
    expect(p.text('[data-field=pending]')).not.toContain('A restore waits');
  });
  it('is shown right after one was laid down; that it was dropped by somebody else is told', async () => {
    await asAnna('/site');
    await p.see('.files', 'Restore a backup');
    await soon(() => expect(asked('GET /backup/pending')).toBe(1));
    expect(p.root.querySelector('[data-field=pending]')).toBeNull();
    const input = p.field('Restore a backup');
    Object.defineProperty(input, 'files', { value: [new File(['SQLite format 3'], 'copy.db')], configurable: true });
    input.dispatchEvent(new Event('change', { bubbles: true }));
    await p.press('Replace everything');
    await p.see('[data-field=pending]', 'A restore waits');
    door.configuration.pending = null;
    await p.press('Drop the restore …');
    await p.press('Drop it');
    await p.see('[data-field=pending-told]', 'No backup waits for the next start');
    await soon(() => expect(p.text('[data-field=pending]')).not.toContain('A restore waits'));
  });
  it('is asked for by nobody who is not told; that is said', async () => {
    door.configuration.pending = laid;
    p = await openPage('/site', { door });
    await p.see('.files', 'A backup of everything, its restore, and whether one waits for the next start needs the role administrator. Yours is engineer.');
    await p.drawn();
    expect(asked('GET /backup/pending')).toBe(0);
    expect(p.root.querySelector('[data-field=pending]')).toBeNull();
  });
});

describe('the applied states', () => {
  const fill = (n: number) => {
    const entry = (revision: number) => ({ revision, at: '2026-03-01T10:11:12Z', who: 'bert', bytes: 100, document: door.world.site });
    door.configuration.site.history = Array.from({ length: n }, (_, i) => entry(n - i));
  };
  const revisions = () => [...p.root.querySelectorAll<HTMLElement>('[data-revision]')].map((e) => Number(e.dataset.revision));
  it('come fifty at a time, to the oldest, each once', async () => {
    fill(120);
    p = await openPage('/site', { door });
    await p.see('[data-field=history-count]', '50 states shown; there may be older ones.');
    await p.press('Older');
    await p.see('[data-field=history-count]', '100 states shown; there may be older ones.');
    await p.press('Older');
    await p.see('[data-field=history-count]', '120 states, the oldest that is kept included.');
    expect(revisions()).toEqual(Array.from({ length: 120 }, (_, i) => 120 - i));
    expect(() => p.button('Older')).toThrow();
    expect(p.wire.asked.filter((a) => a.startsWith('GET /site/history'))).toEqual(['GET /site/history?limit=50', 'GET /site/history?limit=50&before=71', 'GET /site/history?limit=50&before=21']);
  });
  it('that were fetched stay below a new one', async () => {
    fill(60);
    door.world.revision = 61;
    p = await openPage('/site', { door });
    await p.press('Older').catch(() => undefined);
    await p.see('[data-field=history-count]', '60 states, the oldest');
    const site = structuredClone(door.world.site);
    (site.axes[0] as { unit: string }).unit = 'cm';
    expect(p.other('PUT', '/site', site).status).toBe(200);
    p.wire.turn();
    await p.see('[data-field=history-count]', '61 states, the oldest');
    expect(revisions().slice(0, 2)).toEqual([61, 60]);
  });
});

describe('options', () => {
  it('are fields of their family; one that it does not know stays in sight until it is removed', async () => {
    (door.world.site.drives[0] as { options?: unknown }).options = { old_one: 'a,b' };
    p = await openPage('/site', { door });
    await p.see('main', 'Add an axis');
    await p.press('Change drive feeder');
    await p.see('[data-field=options] summary', 'Options of uim342: 7; set: old_one');
    await p.see('[data-option=old_one]', 'uim342 has no such option here: it counts as not given.');
    expect(p.field('Home input').placeholder).toBe('');
    await p.see('[data-field=options]', 'the search is given up and stopped after that. 1 to 3600 s. default 60 s.');
    p.type(p.field('Home timeout, s'), '9999');
    await p.press('Save to draft');
    await p.see('[data-field=options]', '1 to 3600 s.');
    expect(p.field('Home timeout, s').getAttribute('aria-invalid')).toBe('true');
    p.type(p.field('Home timeout, s'), '30');
    p.type(p.field('Notify'), 'on');
    await p.press('Remove option old_one');
    await p.press('Save to draft');
    await p.see('[data-diff="drives/feeder"]', 'options {"old_one":"a,b"} → {"home_timeout_s":"30","notify":"on"}');
  });
  it('of a line stand at the line, and an axis says what an increment is', async () => {
    p = await openPage('/site', { door });
    await p.see('main', 'Add an axis');
    await p.press('Change line can0');
    await p.see('[data-field=options] summary', 'Options of uim342: 4, none set');
    p.type(p.field('Crc'), '13');
    await p.press('Save to draft');
    await p.see('[data-diff="lines/can0"]', 'options nothing → {"crc":"13"}');
    await p.press('Change axis gantry-x');
    await p.see('form[aria-label="Change axis gantry-x"]', 'make one mm; one increment of pacontrol is 0.001 AE');
  });
});

describe('trends of an axis', () => {
  it('are kept on the disk by a box, which says what for', async () => {
    p = await openPage('/site', { door });
    await p.see('main', 'Add an axis');
    await p.press('Change axis gantry-x');
    const box = p.field('Trends on the disk');
    expect(box.checked).toBe(false);
    expect(document.getElementById(box.getAttribute('aria-describedby') ?? '')?.textContent).toBe('they outlive a restart of the gateway');
    box.click();
    await p.press('Save to draft');
    await p.see('[data-diff="axes/gantry-x"]', 'trend on disk nothing → true');
    await p.press('Change axis gantry-x');
    expect(p.field('Trends on the disk').checked).toBe(true);
    p.field('Trends on the disk').click();
    await p.press('Save to draft');
    await soon(() => expect(p.root.querySelector('[data-diff="axes/gantry-x"]')).toBeNull());
  });
});
