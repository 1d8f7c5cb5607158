// Whole: every part of the page in one language at eight widths, with its folds, forms, dialogs and modes: every text is seen whole and is in the reader's
// words, the page never scrolls sideways, and the stop of all can be pressed. In: the language; lib/cut.mjs and lib/said.mjs say what is wrong. Out: a test
// for each kind of screen; pictures. A file for each language, since each goes through the whole page, and loads each part once for all that is judged.
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { drawn, launch, open, pictured, quiet, shot, tooWide } from './browser.mjs';
import { cut, unfold } from './cut.mjs';
import { furnish, parts, typed } from './parts.mjs';
import { Program } from './program.mjs';
import { english, underscored } from './said.mjs';

/** By part: steps with a name and what is pressed, one after the other; each begins where the one before it ended. */
const steps = {
  overview: [['rows', 'main .button.quiet[aria-pressed] >> nth=-1 >> visible=true']],
  mappings: [['template', 'main button[aria-expanded=false]:not(.help-button) >> nth=0'], ['paste', '.map-dialog header button', 'main button[aria-expanded=false]:not(.help-button) >> nth=1'], ['form', '.map-dialog header button', '[data-mapping]'], ['hmi', 'main .group button[aria-pressed=false] >> nth=0']],
  site: [['line', '.site-tree .section-head .button >> nth=0'], ['drive', '.site-tree .section-head .button >> nth=1'], ['axis', '.site-tree .section-head .button >> nth=2'], ['wizard', 'main .page-head button, main .section-head button']],
};
const more = [
  { name: 'second axis', path: '/axes/slide.x/' },
  { name: 'trends', path: '/recorder', ready: 'main canvas' },
  { name: 'captures', path: '/recorder/captures/feeder' },
  { name: 'recordings', path: '/recorder/recordings' },
  { name: 'report', path: '/report' },
  { name: 'fleet', path: '/fleet' },
];
const looks = [...parts, ...more].map((p) => ({ ...p, open: steps[p.name] ?? [] }));

const stopWords = { en: 'Stop all', de: 'Alle stoppen', zh: '全部停止' };

/** The stop of all and the navigation, at both ends of the page: whole, on top, where a hand looks for it. What is wrong, in words. */
const stops = (page, words) =>
  page.evaluate((said) => {
    const wrong = [];
    for (const y of [1e6, 0]) {
      scrollTo(0, y);
      const stop = document.querySelector('.stop-all');
      const r = stop.getBoundingClientRect();
      const whole = r.left >= 0 && r.right <= innerWidth + 0.5 && r.top >= 0 && r.bottom <= innerHeight + 0.5;
      // On a phone it lies across the foot, elsewhere it is in the head.
      const there = innerWidth <= 480 ? r.top > innerHeight - 250 : r.top < 100;
      if (!whole || !there || !stop.contains(document.elementFromPoint(r.x + r.width / 2, r.y + r.height / 2)) || !stop.innerText.includes(said)) wrong.push(`the stop "${stop.innerText}" is at ${JSON.stringify(r)}`);
    }
    const nav = document.querySelector('.nav');
    if (nav.scrollWidth > nav.clientWidth) wrong.push(`${nav.scrollWidth - nav.clientWidth} px of the navigation are out of sight`);
    return wrong;
  }, words);

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
  // A desk with a mouse, and a hand-held screen that is turned: each part is loaded once for it. `also`: widths at which the page as it opens is looked at.
  for (const [what, touch, widths, also] of [['a desk', false, [1280], [1440, 1024, 900]], ['a touch screen', true, [768, 360], [390, 320]]]) {
    test(`${language} on ${what}, ${widths.join(' and ')} px: every text is seen whole, in its button and beside all others, in the reader's words; the stop is there, also at ${also.join(' and ')} px`, async () => {
      const p = await open(browser, program.url + '/', { locale: language, viewport: { width: widths[0], height: 900 }, hasTouch: touch, isMobile: touch });
      const wrong = new Map();
      const note = (faults, where) => faults.forEach((f) => wrong.has(f) || wrong.set(f, where));
      const look = async (where) => {
        for (const width of widths) {
          if (widths.length > 1) await p.setViewportSize({ width, height: 900 });
          await drawn(p);
          note(await cut(p), `${where} at ${width} px`);
        }
        // The words are the same at every width.
        if (!touch) note(await (language === 'en' ? underscored(p) : english(p, typed)), where);
      };
      for (const part of looks) {
        await p.goto(program.url + part.path);
        await p.locator('main h1').first().waitFor();
        if (part.ready) await p.locator(part.ready).first().waitFor();
        await quiet(p);
        for (const width of [...also, ...widths]) {
          await p.setViewportSize({ width, height: 900 });
          await drawn(p);
          const wide = await tooWide(p);
          note([...(wide > 0 ? [`${part.path} is ${wide} px too wide`] : []), ...(await stops(p, stopWords[language]))], `${part.name} at ${width} px`);
          if (pictured && [1440, 768, 390].includes(width)) {
            for (const colorScheme of ['dark', 'light']) {
              await p.emulateMedia({ colorScheme });
              await drawn(p);
              await shot(p, `${language}-${width}-${colorScheme}-${part.name}`, { fullPage: true });
            }
          }
        }
        await look(part.name);
        await p.emulateMedia({ colorScheme: 'dark' });
        await unfold(p);
        await look(`${part.name}, unfolded and dark`);
        await p.emulateMedia({ colorScheme: 'light' });
        for (const [name, ...presses] of part.open) {
          for (const press of presses) await p.locator(press).first().click();
          await quiet(p);
          await unfold(p);
          await look(`${part.name}, ${name}`);
        }
      }
      await p.context().close();
      assert.deepEqual([...wrong].map(([fault, where]) => `${where}: ${fault}`), []);
    });
  }
}
