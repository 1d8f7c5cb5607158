// The handbook in the browser: from the page to its chapter, the search, both themes, desk and phone, without script; nothing serious for axe-core.
// In: the program. Out: judgements; nothing that the content security policy refuses happens on the way.
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { becomes, launch, look, open, visits } from './lib/browser.mjs';
import { Program } from './lib/program.mjs';

let program, browser;
before(async () => {
  program = await Program.start();
  browser = await launch();
});
after(async () => {
  await browser?.close();
  await program?.end();
});

test('the page leads to the chapter that it is about, in a tab of its own, and the page stays', async () => {
  const page = await open(browser, `${program.url}/mappings`);
  await page.locator('main h1').waitFor();
  const [help] = await Promise.all([page.waitForEvent('popup'), page.locator('[data-field=help]').click()]);
  await help.locator('main h1', { hasText: 'Registers of your own' }).waitFor();
  assert.equal(new URL(help.url()).pathname, '/help/map.html');
  assert.equal(await help.locator('.book [aria-current=page]').innerText(), 'Registers of your own');
  assert.equal(new URL(page.url()).pathname, '/mappings');
  const at = page.getByRole('link', { name: "Help: Profiles: another device's registers" });
  assert.equal(await at.getAttribute('href'), '/help/profiles.html');
  assert.deepEqual(page.faults(), []);
  await page.context().close();
});

test('chapters are turned, and a word is found with its heading', async () => {
  const page = await open(browser, `${program.url}/help/`);
  await page.getByRole('link', { name: 'Installing a gateway →' }).click();
  await page.locator('main h1', { hasText: 'Installing a gateway' }).waitFor();
  await page.getByRole('link', { name: 'Wiring →' }).click();
  await page.locator('main h1', { hasText: 'Wiring' }).waitFor();
  const field = page.getByRole('searchbox', { name: 'Search the handbook' });
  await page.keyboard.press('/');
  await field.fill('dissectors wireshark');
  await page.getByRole('link', { name: 'Trouble: In Wireshark' }).click();
  await becomes('the heading', () => new URL(page.url()).pathname + new URL(page.url()).hash, '/help/trouble.html#in-wireshark');
  await field.fill('<b>zzz</b>');
  await page.getByText('Nothing found').waitFor({ state: 'attached' });
  assert.deepEqual(page.faults(), []);
  await page.context().close();
});

test('the theme that was chosen on the page holds here', async () => {
  const page = await open(browser, `${program.url}/`);
  await page.getByRole('button', { name: 'Dark theme' }).click();
  await page.goto(`${program.url}/help/fleet.html`);
  await becomes('dark', () => page.evaluate(() => document.documentElement.dataset.theme), 'dark');
  assert.deepEqual(page.faults(), []);
  await page.context().close();
});

test('without script a chapter is whole', async () => {
  const page = await open(browser, `${program.url}/help/family-mcode.html`, { javaScriptEnabled: false });
  await page.locator('main h1', { hasText: 'Lexium MCode' }).waitFor();
  assert.ok((await page.locator('main pre').count()) > 0 && (await page.locator('.book a').count()) > 30);
  await page.locator('.book').getByRole('link', { name: 'Trouble' }).click();
  await page.locator('main h1', { hasText: 'Trouble' }).waitFor();
  await page.context().close();
});

test('light and dark, desk and phone: pictures for people, nothing serious for axe-core, nothing wider than the screen', async () => {
  for (const { device } of visits) {
    const page = await open(browser, `${program.url}/help/`, { ...device, bypassCSP: true });
    for (const [name, path] of [['contents', ''], ['trouble', 'trouble.html'], ['modbus', 'gateway-doors-modbus.html']]) {
      await page.goto(`${program.url}/help/${path}`);
      await page.locator('main h1').waitFor();
      assert.deepEqual(await look(page, `help-${name}`, {}), [], path);
    }
    assert.deepEqual(page.faults(), []);
    await page.context().close();
  }
});
