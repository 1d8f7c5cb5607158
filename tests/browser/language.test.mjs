// Languages: chosen by the browser or by the reader, loaded only then; what the gateway says is English in each, and marked so; the conditions of every
// twin have names in it. Each part of the page in each language is gone through in whole-*.test.mjs.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { after, before, test } from 'node:test';
import { launch, open, until } from './lib/browser.mjs';
import { furnish } from './lib/parts.mjs';
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

test('a refusal is marked as English within the sentence of the page, on the axis, in a form and in a field', async () => {
  const p = await open(browser, program.url + '/axes/slide.x/', { locale: 'de' });
  const marked = async (where, words) => {
    const said = p.locator(`${where} [lang=en]`).first();
    await until(`${where} says it`, async () => words.test(await said.innerText().catch(() => '')) || (await p.locator(where).first().innerText().catch(() => '')));
    const whole = await p.locator(where).filter({ has: p.locator('[lang=en]') }).first().innerText();
    assert.ok(whole.length > (await said.innerText()).length + 3, `${whole}: the sentence around it is German`);
    assert.doesNotMatch(whole, /[\u2068\u2069]/, 'the signs are not shown');
  };
  await p.locator('[data-live=true]').first().waitFor();
  await p.getByLabel('Ziel', { exact: true }).fill('3'); // of an axis that is not enabled
  await p.getByLabel('Ziel', { exact: true }).press('Enter');
  await marked('main .result-refused', /\w+ \w+/);
  await p.goto(program.url + '/axes/feeder/simulation');
  const load = p.locator('[data-hand=position] input').first();
  await load.fill('99999999999');
  await load.press('Enter');
  await marked('.hand .result', /\w+ \w+/);
  await p.context().close();
});

test('each condition of each twin has a name in German and in Chinese', async () => {
  const demo = JSON.parse(readFileSync(new URL('../../deploy/examples/demo-site.json', import.meta.url), 'utf8'));
  const all = await Program.start({ site: { ...demo, drives: demo.drives.map(({ description, ...d }) => d) } });
  try {
    const lines = demo.lines.map((l) => l.name);
    const names = async (locale) => {
      const p = await open(browser, all.url, { locale });
      const found = new Map();
      for (const line of lines) {
        await p.goto(`${all.url}/lines/${line}`);
        await p.locator('[data-hand]').first().waitFor();
        for (const [id, name] of await p.locator('[data-hand]').evaluateAll((l) => l.map((e) => [e.dataset.hand, e.querySelector('.hand-name').firstChild.data]))) found.set(`${line} ${id}`, name);
      }
      await p.context().close();
      return found;
    };
    const english = await names('en');
    assert.ok(new Set([...english.values()]).size > 50, `${english.size} conditions`);
    for (const locale of ['de', 'zh']) {
      const said = await names(locale);
      assert.deepEqual([...said.keys()].sort(), [...english.keys()].sort());
      const same = [...said].filter(([id, name]) => name === english.get(id) && name !== 'Position');
      assert.deepEqual(same, [], locale);
      if (locale === 'zh') assert.deepEqual([...said].filter(([, name]) => !/\p{Script=Han}/u.test(name)), []);
    }
  } finally {
    await all.end();
  }
});
