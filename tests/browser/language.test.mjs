// Languages: chosen by the browser or by the reader, loaded only then; what the gateway says is English in each, and marked so; the conditions of every
// twin have names in it. Each part of the page in each language is gone through in whole-*.test.mjs.
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { launch, open, shot, tooWide } from './lib/browser.mjs';
import { furnish, parts } from './lib/parts.mjs';
import { Program } from './lib/program.mjs';

const words = { en: ['Axes', 'Stop all'], de: ['Achsen', 'Alle stoppen'], zh: ['轴', '全部停止'] };
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

test('the language is the browser’s, its table is loaded only then, and another one can be chosen', async () => {
  for (const [locale, language] of [['de-CH', 'de'], ['zh-CN', 'zh'], ['fr', 'en']]) {
    const p = await open(browser, program.url + '/users', { locale });
    const loaded = [];
    p.on('request', (r) => loaded.push(...(/\/(de|zh)-[\w-]+\.js$/.exec(r.url())?.slice(1) ?? [])));
    await p.reload();
    await p.locator('main h1').first().waitFor();
    assert.equal(await p.evaluate(() => document.documentElement.lang), language);
    assert.deepEqual(loaded, language === 'en' ? [] : [language]);
    assert.equal((await p.locator('.nav a').first().innerText()).trim(), words[language][0]);
    await p.evaluate((l) => localStorage.setItem('axisgate.language', l), language === 'de' ? 'zh' : 'de');
    await p.reload();
    await p.locator('main h1').first().waitFor();
    assert.equal((await p.locator('.nav a').first().innerText()).trim(), words[language === 'de' ? 'zh' : 'de'][0], 'what is chosen holds after a reload');
    await p.context().close();
  }
});

test('what the gateway says is marked as English; what it names by an identifier is told in the reader’s language', async () => {
  const p = await open(browser, program.url + '/events', { locale: 'de' });
  for (const [path, selector] of [['/events', '.event-what [lang=en]'], ['/events', '.alarm-what [lang=en]'], ['/axes/feeder', '.error-help [lang=en]'], ['/axes/feeder/parameters', '.name [lang=en]']]) {
    await p.goto(program.url + path);
    await p.locator(selector).first().waitFor();
    assert.match(await p.locator(selector).first().innerText(), /[A-Za-z]{3}/, `${path} ${selector}`);
  }
  await p.goto(program.url + '/axes/feeder');
  await p.locator('.bits li').first().waitFor();
  const bits = await p.locator('.bits li').allTextContents();
  assert.ok(bits.some((b) => b.includes('Störung')) && bits.some((b) => b.includes('Fernsteuerung')), bits.join());
  assert.ok(!bits.some((b) => /Fault|Warning|Remote|Stale|Referenced|Simulated/.test(b)), bits.join());
  await p.context().close();
});
