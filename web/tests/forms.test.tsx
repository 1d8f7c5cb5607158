// @vitest-environment happy-dom
// What forms say of what was typed, and what became of it: the whole page over the mock door. Nothing wrong may be sent; nothing typed may be lost.
import { afterEach, beforeEach, describe, expect, it, vi } from 'vitest';
import { MockDoor } from '../dev/mock/door.mjs';
import { persisted } from '../src/state/persisted';
import { openPage, soon, type MockPage } from './mock-page';

let p: MockPage;
let door: MockDoor;
const password = 'a long enough phrase';
beforeEach(() => void (door = new MockDoor()));
afterEach(() => {
  p.close();
  vi.restoreAllMocks();
});
const open = async (path: string, cookie = '') => (p = await openPage(path, { door, cookie }));
const asked = (what: string) => p.wire.asked.filter((a) => a === what).length;
/** Signed in as the first administrator. */
const asAnna = async (path: string) => {
  const a = door.answer({ method: 'POST', target: '/api/v1/session/first', head: {}, text: JSON.stringify({ code: door.access.code, user: 'anna', password }), peer: '127.0.0.1:1' });
  await open(path, String(a.head['set-cookie']).split(';')[0]);
};
const give = (label: string, name: string, text: string) => {
  const input = p.field(label);
  Object.defineProperty(input, 'files', { value: [new File([text], name)], configurable: true });
  input.dispatchEvent(new Event('change', { bubbles: true }));
};

describe('users', () => {
  it('a first sign-in needs the code, a name, and one password twice; nothing else is sent', async () => {
    door = new MockDoor({ localRole: null });
    persisted('typed.user').value = '';
    await open('/');
    await p.see('h1', 'First sign-in');
    const reported = '[data-field=sign-in-told]';
    await p.press('Make the first administrator');
    await p.see(reported, 'The code is missing.');
    p.type(p.field('Code'), door.access.code);
    p.type(p.field('Name'), 'Anna');
    await p.press('Make the first administrator');
    await p.see(reported, 'A name has 1 to 64 of');
    p.type(p.field('Name'), 'anna');
    p.type(p.field('Password'), 'short');
    await p.press('Make the first administrator');
    await p.see(reported, 'at least 12 characters; this one has 5.');
    p.type(p.field('Password'), password);
    p.type(p.field('Password again'), `${password}!`);
    await p.press('Make the first administrator');
    await p.see(reported, 'The two passwords are not the same.');
    expect(asked('POST /session/first')).toBe(0);
    p.type(p.field('Password again'), password);
    await p.press('Make the first administrator');
    await p.see('[data-field=connection]', 'Live');
  });
  it('a sign-in needs a name', async () => {
    door = new MockDoor({ localRole: null });
    door.access.add({ name: 'anna', role: 'viewer', password });
    persisted('typed.user').value = '';
    await open('/');
    await p.see('h1', 'Sign in');
    await p.press('Sign in');
    await p.see('[data-field=sign-in-told]', 'The name is missing.');
    expect(asked('POST /session')).toBe(0);
  });
  it('a new password for oneself needs the old one, and ends the session', async () => {
    await asAnna('/users');
    await p.see('[data-field=account]', 'You are anna, administrator.');
    const reported = '[data-field=password-told]';
    await p.press('Change the password');
    await p.see(reported, 'The old password is missing.');
    p.type(p.field('Old password'), 'not this one');
    p.type(p.field('New password'), 'x'.repeat(257));
    p.type(p.field('New password again'), 'x'.repeat(257));
    await p.press('Change the password');
    await p.see(reported, 'A password has at most 256 characters.');
    for (const f of ['New password', 'New password again']) p.type(p.field(f), 'another long phrase');
    await p.press('Change the password');
    await p.see(reported, 'the old password is wrong');
    p.type(p.field('Old password'), password);
    await p.press('Change the password');
    await p.see('[data-field=session-ended]', 'Your session has ended');
    expect(door.access.users.get('anna')?.password).toBe('another long phrase');
  });
  it('a token is made for a user alone, is shown once, and says when it ends', async () => {
    await open('/users');
    await p.see('form[aria-label="Add a token"]', 'A token belongs to a user: sign in with a password to make one.');
    expect([p.button('Add token').disabled, p.field('Name of the token').disabled]).toEqual([true, true]);
    p.close();
    await asAnna('/users');
    await p.see('.access-list', 'anna');
    await p.press('Add token');
    await p.see('[data-field=tokens-told]', 'The name is missing.');
    p.type(p.field('Name of the token'), 'line');
    p.type(p.field('It ends'), '');
    await p.press('Add token');
    await p.see('[data-field=tokens-told]', 'Made. It is shown this once: copy it now.');
    await p.see('[data-token=line]', 'viewer · anna · does not end · never used');
    expect(p.text('[data-field=secret]')).toBe(door.access.tokens[0].token);
    await p.press('Hide');
    await soon(() => expect(p.text('[data-field=secret]')).toBe(''));
    door.access.tokens[0].expires_at = new Date(Date.now() - 1000).toISOString();
    p.go('/');
    await p.see('.tiles', 'feeder');
    p.go('/users');
    await p.see('[data-token=line]', '· expired ');
  });
});

describe('the site', () => {
  it('counts what waits, takes a time to keep it within bounds only, and says of a file what it is', async () => {
    await open('/site');
    await p.see('[data-field=stage]', 'Nothing is changed.');
    const site = JSON.parse(JSON.stringify(door.world.site));
    give('Import a site', 'same.json', JSON.stringify(site));
    await p.see('[data-field=files-told]', 'same.json is the site that is in force.');
    give('Import a site', 'huge.json', 'x'.repeat(8_000_001));
    await p.see('[data-field=files-told]', 'huge.json is larger than a site can be.');
    site.axes[0].unit = 'cm';
    give('Import a site', 'one.json', JSON.stringify(site));
    await p.see('[data-field=stage]', '1 change is waiting; nothing has been sent to the drives.');
    site.axes[1].unit = 'rad';
    give('Import a site', 'two.json', JSON.stringify(site));
    await p.see('[data-field=files-told]', 'two.json is in the draft: 2 differences. Nothing has been sent; check and apply above.');
    expect(p.text('[data-field=stage]')).toContain('2 changes are waiting');
    await p.press('Check');
    await p.see('[data-field=stage-told]', 'Checked: it can be applied.');
    for (const [within, good] of [['4', false], ['0', true], ['601', false], ['600', true], ['x', false], ['5', true]] as const) {
      p.type(p.field('Confirm within, s'), within);
      await soon(() => expect([within, p.button('Apply').disabled, /5 to 600; 0: no roll back\./.test(p.text('[data-field=stage]'))]).toEqual([within, !good, !good]));
    }
    p.type(p.field('Confirm within, s'), '60');
    await p.press('Discard what is staged');
    await p.see('[data-field=stage-told]', 'Nothing is staged now. What you typed is still there.');
    expect(door.configuration.site.stage).toBeNull();
    await p.press('Drop …');
    await p.press('Keep typing');
    expect(p.text('[data-field=stage]')).toContain('2 changes are waiting');
    await p.press('Drop …');
    await p.press('Drop all changes');
    await p.see('[data-field=stage]', 'Nothing is changed.');
  });
  it('has no earlier state in a new gateway; two changes of mine are counted before one is restored over them', async () => {
    await open('/site');
    await p.see('[data-field=history]', 'No earlier state is kept.');
    const site = JSON.parse(JSON.stringify(door.world.site));
    site.axes.pop();
    expect(p.other('PUT', '/site', site).status).toBe(200);
    await p.see('[data-field=history]', 'Revision 1');
    site.axes[0].unit = 'cm';
    site.axes[1].unit = 'rad';
    give('Import a site', 'two.json', JSON.stringify(site));
    await p.see('[data-field=stage]', '2 changes are waiting');
    await p.press('Restore revision 1');
    await p.see('[role=group][aria-label="Restore revision 1"]', '2 changes of yours are not applied; restoring puts revision 1 in their place.');
    await p.press('Keep mine');
  });
  it('a backup that is too large is not sent', async () => {
    await asAnna('/site');
    await p.see('[data-entry="axes/feeder"]', 'feeder');
    const input = p.field('Restore a backup');
    Object.defineProperty(input, 'files', { value: [{ name: 'copy.db', size: 65 * 1024 * 1024 }], configurable: true });
    input.dispatchEvent(new Event('change', { bubbles: true }));
    await p.see('[data-field=files-told]', 'copy.db has 65.0 MiB; at most 64 MiB are taken.');
    expect(asked('PUT /backup')).toBe(0);
  });
});

describe('parameters', () => {
  it('no snapshot is kept at first; a comparison reads what is not known, says how much could be compared, and what differs', async () => {
    await open('/axes/feeder/parameters');
    await p.see('main', 'No snapshot is kept.');
    await p.press('Compare');
    await p.see('[data-field=compare-told]', '0 of 11 values differ; 3 of 14 cannot be compared, because one side does not know them.');
    await p.see('.compare', 'Nothing differs.');
    const feeder = door.world.axisOf('feeder');
    feeder.write('AC', 5000, 'x');
    feeder.read('SP');
    feeder.read('TE');
    door.world.axisOf('turntable').values.set('TE', 50);
    await p.press('Compare');
    await p.see('[data-compared=AC]', /differs$/);
    await p.see('[data-field=compare-told]', '1 of 11 values differ; 3 of 14 cannot be compared');
    expect(p.text('[data-compared=SP]')).toBe('');
    p.field('equal ones too').click();
    p.field('equal ones too').dispatchEvent(new Event('change', { bubbles: true }));
    await p.see('[data-compared=SP]', 'equal');
    p.type(p.field('with'), 'axis:turntable');
    await p.press('Compare');
    await p.see('[data-compared=TE]', 'differs, read only');
    p.type(p.field('with'), 'axis:lift');
    await p.press('Compare');
    await p.see('[data-field=compare-told]', 'The families differ: lift is Schneider Electric Lexium MCode (mcode), feeder is UIROBOT UIM342 (uim342). Their parameters are not the same ones, so they cannot be compared.');
    expect(p.text('.compare')).not.toContain('Nothing differs.');
  });
  it('a file to be written says what is wrong with it; what is exported, what is missing in it', async () => {
    persisted('transfer.feeder').value = '';
    await open('/axes/feeder/parameters');
    await p.see('main', 'No snapshot is kept.');
    const area = p.root.querySelector<HTMLTextAreaElement>('#transfer-text')!;
    for (const [text, shown] of [['a,b\nAC,1', 'The first line must name the columns: parameter, value.'], ['{"AC":', 'This is not JSON:'], ['parameter,value\nAC,1\nTE,3', '1 of 2 rows must be mended before anything is sent.'], ['parameter,value\nAC,1\nSP,2', '2 will be written; 0 are so already.'], [`parameter,value\n${'AC,1\n'.repeat(5001)}`, 'There are more than 5000 rows.']] as const) {
      p.type(area, text);
      await p.see('[data-field=transfer-count]', shown);
    }
    p.type(area, '');
    vi.spyOn(URL, 'createObjectURL').mockImplementation(() => 'blob:x');
    await p.press('Export CSV');
    await p.see('[data-field=transfer-told]', /^0 of 15 values are known and in the file\. “Read all” above asks the drive for the others\.$/);
  });
});

describe('the gateway', () => {
  it('says what becomes of its Modbus door', async () => {
    await open('/gateway');
    await p.see('[data-field=modbus-writing]', 'allowed');
    await p.press('Make it read-only');
    await p.see('[data-field=modbus-told]', 'Read-only now: writes are refused, a quick stop and switching off are not.');
    expect(p.text('[data-field=modbus-writing]')).toBe('read-only: no write is taken but a quick stop or switching off by the control word alone');
    await p.press('Allow writing');
    await p.see('[data-field=modbus-told]', 'Writing is allowed now.');
    expect(door.configuration.modbus.read_only).toBe(false);
  });
  it('shows an exception with the places that nothing answers for, and follows when it is asked to', async () => {
    for (const [name, value] of [['unit', '2'], ['table', 'holding_registers'], ['address', '0'], ['count', '4']] as const) persisted(`hmi.${name}`).value = value;
    await open('/mappings');
    await p.see('.register-grid', 'Nothing is mapped yet.');
    await p.press('What the HMI sees');
    await p.press('Look');
    await p.see('[data-field=hmi-told]', 'The Modbus door answers exception 2: illegal data address. Not mapped: 0–3.');
    p.type(p.field('Count'), '126');
    await p.see('.hmi', 'A whole number from 1 to 125.');
    p.type(p.field('Count'), '4');
    await p.press('Follow');
    await p.see('.hmi', 'Following each second');
    await p.press('Following each second');
    await p.see('.hmi', 'Follow');
    await p.press('Map');
  });
});

describe('a recipe', () => {
  it('that is not saved is not run, and says so; an axis that did not stop is told loudly', async () => {
    await open('/recipes/r');
    const json = await soon(() => p.field('The recipe as JSON'));
    p.type(json, '{"steps":[{"enable":{"axis":"lift"}},{"wait_s":600}]}');
    await p.see('.result', 'Not saved yet.');
    await p.see('.recipe-run .result', 'Save the recipe to run it.');
    expect([p.button('Run').disabled, p.button('Check only').disabled]).toEqual([true, true]);
    await p.press('Save');
    await p.press('Check only');
    await p.see('.recipe-run .result', 'Can run: 2 steps, commands lift.');
    await p.press('Run');
    await p.see('[data-field=run-state]', 'Running');
    door.world.driveOf('lift').presence = 'offline'; // so that it cannot be halted
    await p.press('Cancel run 1');
    await p.see('.recipe-report', 'lift: NOT stopped');
  });
});
