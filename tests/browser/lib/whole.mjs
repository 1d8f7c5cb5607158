// Whole: every part of the page in one language at three widths, with its folds, forms, dialogs and modes: every text is seen whole.
// In: the language; lib/cut.mjs says what is not. Out: a test for each width; pictures under build/browser, whole-LANGUAGE-WIDTH-NAME.png.
// A file for each language, since each goes through the whole page three times.
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { drawn, launch, open, quiet, shot } from './browser.mjs';
import { cut, unfold } from './cut.mjs';
import { furnish, parts } from './parts.mjs';
import { Program } from './program.mjs';

/** By part: steps with a name and what is pressed, one after the other; each begins where the one before it ended. */
const steps = {
  overview: [['rows', 'main .button.quiet[aria-pressed] >> nth=-1 >> visible=true']],
  mappings: [['template', 'main button[aria-expanded=false]:not(.help-button) >> nth=0'], ['paste', '.map-dialog header button', 'main button[aria-expanded=false]:not(.help-button) >> nth=1'], ['form', '.map-dialog header button', '[data-mapping]'], ['hmi', 'main .group button[aria-pressed=false] >> nth=0']],
  site: [['line', '.site-tree .section-head .button >> nth=0'], ['drive', '.site-tree .section-head .button >> nth=1'], ['axis', '.site-tree .section-head .button >> nth=2'], ['wizard', 'main .page-head button, main .section-head button']],
};
const more = [
  { name: 'trends', path: '/recorder', ready: 'main canvas' },
  { name: 'captures', path: '/recorder/captures/feeder' },
  { name: 'recordings', path: '/recorder/recordings' },
  { name: 'report', path: '/report' },
  { name: 'fleet', path: '/fleet' },
];
const looks = [...parts, ...more].map((p) => ({ ...p, open: steps[p.name] ?? [] }));

export function whole(language) {
  let program, browser;
  before(async () => {
    program = await Program.start();
    browser = await launch();
    await furnish(program);
  });
  after(async () => {
    await browser?.close();
    await program?.end();
  });
  for (const [width, height] of [[1280, 900], [768, 1024], [360, 740]]) {
    test(`${language} at ${width} px: every text is seen whole, in its button and beside all others; every choice shows its longest`, async () => {
      const p = await open(browser, program.url + '/', { locale: language, viewport: { width, height }, hasTouch: width < 800, isMobile: width < 800 });
      const wrong = new Map();
      const look = async (where) => {
        for (const fault of await cut(p)) if (!wrong.has(fault)) wrong.set(fault, where);
      };
      for (const part of looks) {
        await p.goto(program.url + part.path);
        await p.locator('main h1').first().waitFor();
        if (part.ready) await p.locator(part.ready).first().waitFor();
        await quiet(p);
        await look(part.name);
        await p.emulateMedia({ colorScheme: 'dark' });
        await drawn(p);
        await look(`${part.name}, dark`);
        await p.emulateMedia({ colorScheme: 'light' });
        await unfold(p);
        await look(`${part.name}, unfolded`);
        for (const [name, ...presses] of part.open) {
          for (const press of presses) await p.locator(press).first().click();
          await quiet(p);
          await unfold(p);
          await look(`${part.name}, ${name}`);
        }
        await shot(p, `whole-${language}-${width}-${part.name}`, { fullPage: true });
      }
      await p.context().close();
      assert.deepEqual([...wrong].map(([fault, where]) => `${where}: ${fault}`), []);
    });
  }
}
