// Overview benchmark: what the overview of 64 axes, all of which move, costs the browser and the gateway.
// In: AXISGATE_BIN, CHROMIUM, seconds (default 10). Out: shares of a core, each with its limit; exit 1 if one is not kept. The browser is all of its processes
// less what they need for an empty page; the gateway is its process less what it needs while nobody looks. Both by the processor's time, so that a
// busy machine changes little.
import { readFileSync } from 'node:fs';
import { launch } from '../browser/lib/browser.mjs';
import { manyMappings } from '../browser/lib/many.mjs';
import { Program } from '../browser/lib/program.mjs';
import { say } from './page_report.mjs';

const seconds = Number(process.argv[2] ?? 10);
const axes = 64;
const mostBrowser = 25;
const mostGateway = 4;
const tick_s = 0.01; // USER_HZ

const view = { viewport: { width: 1440, height: 900 } };
const gateway_s = (pid) => {
  const fields = readFileSync(`/proc/${pid}/stat`, 'utf8').split(') ')[1].split(' ');
  return (Number(fields[11]) + Number(fields[12])) * tick_s; // utime, stime
};
async function browser_s(cdp) {
  const { processInfo } = await cdp.send('SystemInfo.getProcessInfo');
  return processInfo.reduce((sum, p) => sum + p.cpuTime, 0);
}

const program = await Program.start({ site: manyMappings() });
const browser = await launch();
let kept = true;
try {
  const cdp = await browser.newBrowserCDPSession();
  /** Percent of a core that both use while `page` is open. */
  const shares = async (page) => {
    await page.waitForTimeout(2000); // what is loaded is drawn
    const begun = performance.now();
    const [b, g] = [await browser_s(cdp), gateway_s(program.process.child.pid)];
    await page.waitForTimeout(seconds * 1000);
    const took_s = (performance.now() - begun) / 1000;
    return { browser: ((await browser_s(cdp)) - b) * (100 / took_s), gateway: (gateway_s(program.process.child.pid) - g) * (100 / took_s) };
  };
  for (let i = 1; i <= axes; i += 1) {
    await program.command(`axis${i}`, { command: 'enable' });
    await program.command(`axis${i}`, { command: 'move_velocity', velocity: 5 });
  }
  const page = await (await browser.newContext(view)).newPage();
  const alone = await shares(page);
  await page.goto(program.url);
  await page.locator('[data-axis] [data-field=position][data-live=true]').first().waitFor();
  const positions = () => page.locator('[data-axis] [data-field=position]').evaluateAll((all) => all.map((f) => f.getAttribute('data-value')));
  const before = await positions();
  const looked = await shares(page);
  const after = await positions();
  const moved = after.filter((v, i) => v !== before[i]).length;
  console.log(`the overview, ${seconds} s: ${moved} of ${after.length} positions shown have changed`);
  kept = say('axes that are not shown moving', axes - moved, 0, `of ${axes}`) && kept;
  kept = say('browser, of a core', Math.max(0, looked.browser - alone.browser), mostBrowser, '%') && kept;
  console.log(`    ${looked.browser.toFixed(1)} %, with an empty page ${alone.browser.toFixed(1)} %`);
  kept = say('gateway, of a core', Math.max(0, looked.gateway - alone.gateway), mostGateway, '%') && kept;
  console.log(`    ${looked.gateway.toFixed(1)} %, with nobody who looks ${alone.gateway.toFixed(1)} %`);
} finally {
  await browser.close();
  await program.end();
}
console.log(kept ? 'all limits kept' : 'NOT all limits kept');
process.exitCode = kept ? 0 : 1;
