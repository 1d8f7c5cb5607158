// A machine of four axes in two machine parts, for the tests of the page's shape: its program, a browser, and a page with its overview.
// In: nothing. Out: what the tests of a file share.
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

/** Before the first test of a file. */
export async function start() {
  const program = await Program.start({ site: document });
  const browser = await launch();
  const page = await open(browser, program.url, { permissions: ['clipboard-read', 'clipboard-write'] });
  await page.locator('[data-axis=lift] [data-live=true]').waitFor();
  return { program, browser, page };
}
