// A machine of four axes in two machine parts, for the tests of the page's shape: its program, a browser, and a page with its overview.
// In: nothing. Out: what the tests of a file share, from before the first of them to after the last.
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { launch, open } from './browser.mjs';
import { Program } from './program.mjs';

export const document = {
  lines: [{ name: 'can0', uri: 'twin', family: 'uim342', bitrate: 1000000 }],
  drives: [5, 6, 7, 8].map((address) => ({ name: `d${address}`, line: 'can0', address, presence: 'twin' })),
  axes: [
    { name: 'lift', drive: 'd5', channel: 1, number: 1, unit: 'mm', increments_per_unit: 3200, group: 'Outfeed' },
    { name: 'feeder', drive: 'd6', channel: 1, number: 2, unit: 'mm', increments_per_unit: 3200, group: 'Infeed' },
    { name: 'slide.x', drive: 'd7', channel: 1, number: 3, unit: 'mm', increments_per_unit: 3200, group: 'Infeed' },
    { name: 'axis10', drive: 'd8', channel: 1, number: 4, unit: 'mm', increments_per_unit: 3200 },
  ],
  mappings: [],
};

/** Filled before the first test of the file that asks for it. */
export function machine() {
  const all = { program: null, browser: null, page: null };
  before(async () => {
    all.program = await Program.start({ site: document });
    all.browser = await launch();
    all.page = await open(all.browser, all.program.url, { permissions: ['clipboard-read', 'clipboard-write'] });
    await all.page.locator('[data-axis=lift] [data-live=true]').waitFor();
  });
  after(async () => {
    await all.browser?.close();
    await all.program?.end();
  });
  return all;
}

/** The last test of a file. */
export const noFaults = (all) => test('nothing on the way was a fault of the page', () => assert.deepEqual(all.page.faults(), []));
