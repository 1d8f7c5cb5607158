// @vitest-environment happy-dom
// The wizard of the site over the mock door: from a line that is typed to its scan with one click, on after a reload, back where something is gone.
import { afterEach, beforeEach, describe, expect, it, vi } from 'vitest';
import { MockDoor } from '../dev/mock/door.mjs';
import { openPage, soon, type MockPage } from './mock-page';

let p: MockPage;
let door: MockDoor;
const head = '#wizard-head';
const later = '[data-field=scan-later]';
const siteOf = () => p.other('GET', '/site').body;
beforeEach(() => void (door = new MockDoor({ site: { lines: [], drives: [], axes: [], mappings: [] } })));
afterEach(() => p.close());
/** As a reload of the page: what was typed in this tab is kept. */
const reload = async () => {
  p.close();
  p = await openPage('/site', { door, again: true });
};
const typeLine = async () => {
  p = await openPage('/site', { door });
  await p.see(head, 'Step 1 of 5: Where is the line?');
  p.type(p.field('Name'), 'bus');
  p.type(p.field('Family'), 'mcode');
  p.type(p.field('URI'), 'serial:/dev/ttyUSB0?baud=9600&rs485=1');
  await p.press('Next');
  await p.see(head, 'Step 2 of 5: Which drive is on it?');
};

describe('a line that is typed', () => {
  it('says that it must be in force before it can be scanned; one click checks, applies, keeps and scans it', async () => {
    await typeLine();
    expect(p.text(later)).toMatch(/^Scanning asks the line itself, so bus must be in force first\. One click checks it, applies it, keeps it and begins to scan; nothing else is changed\./);
    expect(siteOf().lines).toEqual([]);
    await p.press('Apply bus and scan it');
    await p.see('form[aria-label="Scan line bus"]', /2 found/);
    expect(siteOf().lines.map((l: any) => l.name)).toEqual(['bus']);
    expect(door.configuration.site.stage).toBeNull();
    expect(p.wire.asked.filter((a) => /stage/.test(a) && !a.startsWith('GET')).map((a) => a.replace(/.*stage/, ''))).toEqual(['', '/apply', '/confirm']);
    await p.press('Add 9 as a drive');
    await p.press('Next');
    await p.see(head, 'Step 3 of 5');
    await p.press('Back');
    await p.see('form[aria-label="Scan line bus"]', 'Scan');
    await p.drawn();
    expect(p.wire.asked.filter((a) => a === 'POST /lines/bus/scan')).toHaveLength(1);
  });
  it('is where it was after a reload: before it is applied, and after', async () => {
    await typeLine();
    p.type(p.field('Name'), 'lifter');
    await reload();
    await p.see(head, 'Step 2 of 5');
    await p.see(later, 'bus must be in force first');
    expect(p.field('Name').value).toBe('lifter');
    await p.press('Apply bus and scan it');
    await p.see('form[aria-label="Scan line bus"]', /2 found/);
    await reload();
    await p.see('form[aria-label="Scan line bus"]', 'Scan');
    await p.see('[data-field=scan-told]', 'The last scan: 2 found, 10 asked.');
    expect(p.text('[data-found="9"]')).toContain('Add 9 as a drive');
    expect(p.wire.asked.filter((a) => a === 'POST /lines/bus/scan')).toEqual([]); // a reload scans nothing by itself
    expect([p.text(later), p.text(head)]).toEqual(['', 'Step 2 of 5: Which drive is on it?']);
  });
  it('is followed to the end of its scan after a reload in the middle of it, and can be ended there', async () => {
    await typeLine();
    await p.press('Apply bus and scan it');
    await p.see('[data-field=scan-told]', /^Scanning/);
    const scan = door.configuration.scans.get('bus');
    scan.begun = Date.now() + 60_000; // it takes as long as the test wants
    await reload();
    await p.see('[data-field=scan-told]', /^Scanning/);
    expect(p.other('POST', '/lines/bus/scan', {}).status).toBe(409);
    scan.begun = Date.now() - 400;
    await p.press('End');
    await p.see('[data-field=scan-told]', 'The scan is cancelled. ended by hand');
  });
  it('that was applied and not kept when the page was reloaded can be kept or scanned there', async () => {
    await typeLine();
    const stage = p.other('POST', '/site/stage', { ...siteOf(), lines: [{ name: 'bus', uri: 'serial:/dev/ttyUSB0?baud=9600&rs485=1', family: 'mcode' }] }).body;
    expect(p.other('POST', '/site/stage/apply', { stage: stage.id }).status).toBe(200);
    await reload();
    await p.see('[data-field=countdown]', 'It is rolled back by itself in');
    await p.see('form[aria-label="Scan line bus"]', 'Scan');
    await p.press('Roll back now');
    await p.see(head, 'Step 1 of 5');
    expect(p.text('[data-field=wizard-back]')).toBe('bus is not there any more: it was rolled back, dropped, or removed by somebody else. So it goes on from here.');
  });
  it('is not applied by one click together with more than was shown: all of it is shown first', async () => {
    await typeLine();
    p.type(p.field('Name'), 'lifter');
    p.type(p.field('Address'), 'A');
    await p.press('Next');
    await p.see(head, 'Step 3 of 5');
    await p.press('Back');
    await p.see(later, 'More than this line is changed: look at all of it, apply it, then scan here.');
    expect([...p.root.querySelectorAll('button')].map((b) => b.textContent)).not.toContain('Apply bus and scan it');
    await p.drawn();
    p.choose('a new drive');
    await soon(() => expect(p.field('Name').value).toBe('feeder1')); // what was typed for the first one is no proposal for the next
    await p.press('Look at all changes');
    await p.see('.site-diff[aria-label="What would change"]', 'added drive lifter');
    await p.press('Check');
    await p.press('Apply');
    await p.press('Keep');
    await p.see('form[aria-label="Scan line bus"]', 'Scan');
  });
  it('that the gateway refuses is not applied, and why stands there', async () => {
    await typeLine();
    expect(p.other('POST', '/site/stage', siteOf()).status).toBe(200);
    await p.press('Apply bus and scan it');
    await p.see('[data-field=stage-told]', 'Somebody at 10.0.0.9 has staged another change. What you typed is kept.');
    expect(siteOf().lines).toEqual([]);
    await p.press('Check mine instead');
    await p.see('[data-field=stage-told]', 'Checked: it can be applied.');
  });
  it('whose change disturbs axes that run is not applied by one click: they are named first', async () => {
    door = new MockDoor();
    const faults = vi.spyOn(door.configuration.site, 'told');
    p = await openPage('/site', { door });
    await p.see('[data-entry="lines/can0"]', 'can0');
    await p.press('Wizard: to a moving axis');
    await p.see(head, 'Step 1 of 5');
    p.choose('a new line');
    await soon(() => p.field('Family'));
    p.type(p.field('Name'), 'bus');
    p.type(p.field('Family'), 'mcode');
    p.type(p.field('URI'), 'serial:/dev/ttyUSB1');
    await p.press('Next');
    await p.see(later, 'bus must be in force first');
    faults.mockImplementationOnce(() => ({ body: { state: 'staged', id: 'x', faults: [], diff: [], disturbs: ['lift'] } }));
    await p.press('Apply bus and scan it');
    await p.see('[data-field=stage]', 'Applying disturbs for a moment: lift.');
    expect(siteOf().lines).toHaveLength(3);
  });
  it('whose change closes connections is not applied by one click: they are named first', async () => {
    door = new MockDoor();
    const faults = vi.spyOn(door.configuration.site, 'told');
    p = await openPage('/site', { door });
    await p.see('[data-entry="lines/can0"]', 'can0');
    await p.press('Wizard: to a moving axis');
    await p.see(head, 'Step 1 of 5');
    p.choose('a new line');
    await soon(() => p.field('Family'));
    p.type(p.field('Name'), 'bus');
    p.type(p.field('Family'), 'mcode');
    p.type(p.field('URI'), 'serial:/dev/ttyUSB1');
    await p.press('Next');
    await p.see(later, 'bus must be in force first');
    faults.mockImplementationOnce(() => ({ body: { state: 'staged', id: 'x', faults: [], diff: [], disturbs: [], closes: [{ id: 'enip-9', kind: 'exclusive_owner', peer: '192.0.2.7:50000', axes: ['lift'] }] } }));
    await p.press('Apply bus and scan it');
    await p.see('[data-field=stage]', 'Applying closes EtherNet/IP connections, because their bytes change: 192.0.2.7:50000 (commands lift).');
    expect(siteOf().lines).toHaveLength(3);
  });
});

it('the part of the site says at a line that is only typed why it has no scan yet', async () => {
  p = await openPage('/site');
  await p.see('[data-entry="lines/can0"]', 'Scan');
  await p.press('Add a line');
  await soon(() => p.field('Family'));
  p.type(p.field('Name'), 'bus');
  p.type(p.field('Family'), 'mcode');
  p.type(p.field('URI'), 'serial:/dev/ttyUSB1');
  await p.press('Save to draft');
  await p.see('[data-entry="lines/bus"]', 'Scan: once it is applied');
  expect(p.root.querySelectorAll('[data-entry="lines/can0"] [data-field=scan-later]')).toHaveLength(0);
});
