// Draws: whether the page shows anything at all. In: AXISGATE_BIN, CHROMIUM. Out: exit status 0, or what the browser said.
import { launch, open } from './browser.mjs';
import { Program } from './program.mjs';

const program = await Program.start();
const browser = await launch();
const page = await open(browser, program.url);
const drawn = await page
  .locator('main h1')
  .first()
  .waitFor()
  .then(() => true, () => false);
await browser.close();
await program.end();
const faults = page.faults();
if (!drawn || faults.length > 0) console.error(`browser: the page ${drawn ? 'draws itself with faults' : 'draws nothing'}; the browser says: ${faults.join('; ') || 'nothing'}`);
process.exit(drawn && faults.length === 0 ? 0 : 1);
