// A browser with 30 plots open, in tabs of their own: each has one feed, on which no topic comes oftener than it asked; together they keep within
// that, the gateway holds nothing back for them, and all of it is gone with the browser. In: the program. Out: counts.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { after, before, test } from 'node:test';
import { becomes, launch, open, until } from './lib/browser.mjs';
import { isMock, Program } from './lib/program.mjs';

const plots = 30;
const skip = isMock && 'the stand-in has no figures';
let program, browser;
before(async () => {
  program = await Program.start();
  browser = await launch();
});
after(async () => {
  await browser?.close();
  await program?.end();
});
const figure = async (name) => {
  const text = await (await fetch(`${program.url}/metrics`)).text();
  return [...text.matchAll(new RegExp(`^axisgate_http_${name}(?:\\{[^}]*\\})? (\\S+)$`, 'gm'))].reduce((sum, m) => sum + Number(m[1]), 0);
};
const resident_MB = () => Number(/VmRSS:\s+(\d+) kB/.exec(readFileSync(`/proc/${program.process.child.pid}/status`, 'utf8'))[1]) / 1024;

test('30 plots of a moving axis: one feed each, no topic oftener than asked, nothing kept', { skip }, async () => {
  await program.command('feeder', { command: 'enable' });
  await until('enabled', async () => (await program.axis('feeder')).state === 'operation_enabled');
  // Small ones: thirty large pictures that nobody sees are the most of the work.
  const first = await open(browser, `${program.url}/axes/feeder/scope`, { viewport: { width: 480, height: 400 } });
  await first.locator('.scope canvas').first().waitFor();
  const before_MB = resident_MB();
  const context = first.context();
  const feeds = []; // of each tab: what it asked for, and what came
  for (let i = 0; i < plots; i += 1) {
    const page = await context.newPage();
    page.on('websocket', (w) => {
      const feed = { asked: new Map(), came: new Map() };
      feeds.push(feed);
      w.on('framesent', ({ payload }) => {
        const { subscribe = [], unsubscribe = [], period_ms = 100 } = JSON.parse(payload);
        for (const topic of unsubscribe) feed.asked.delete(topic);
        for (const topic of subscribe) feed.asked.set(topic, period_ms);
      });
      w.on('framereceived', ({ payload }) => {
        const { topic, at } = JSON.parse(payload);
        if (!feed.came.has(topic)) feed.came.set(topic, []);
        feed.came.get(topic).push(at);
      });
    });
    await page.goto(`${program.url}/axes/feeder/scope`, { waitUntil: 'commit' });
    // One after the other: thirty that start at once wait for each other, and none is ready in time on a slow machine.
    await until(`tab ${i} looks closely`, async () => feeds[i]?.asked.has('axes/feeder') || [...(feeds[i]?.asked.keys() ?? [])], 30_000);
  }
  await becomes('each has a feed', () => figure('stream_clients'), plots + 1);
  assert.equal(feeds.length, plots, 'one each');
  await program.command('feeder', { command: 'move_relative', position: 100, velocity: 20 });
  for (const f of feeds) f.came.clear();
  const sent = await figure('stream_frames_sent_total');
  const began = Date.now();
  await new Promise((r) => setTimeout(r, 4000)); // what is measured is a rate
  const seconds = (Date.now() - began) / 1000;
  const rate = ((await figure('stream_frames_sent_total')) - sent) / seconds;
  const wrong = [];
  for (const [i, f] of feeds.entries()) {
    assert.ok(f.asked.size <= 10, `${f.asked.size} topics`);
    for (const [topic, times] of f.came) {
      const period = f.asked.get(topic) ?? f.asked.get(topic.replace(/\/.*/, '/*'));
      // By the gateway's own clock: what waited in a busy browser comes all at once.
      const [first, last] = [times[0], times.at(-1)].map((ns) => ns / 1e6);
      if (period && !/^(events|alarms|site|recipes)$/.test(topic) && times.length > (last - first) / period + 3) wrong.push(`tab ${i}: ${topic} came ${times.length} times in ${last - first} ms for ${period} ms`);
    }
  }
  assert.deepEqual(wrong, []);
  // Of a tab at most: the axis looked at 20 times a second, the other one 10 times, two drives and a line twice each, alarms and news once.
  const most = (plots + 1) * (20 + 10 + 2 * 2 + 2 + 2);
  assert.ok(rate > plots && rate < most, `${rate} messages a second, ${most} are asked for`);
  assert.ok(resident_MB() - before_MB < 32, `${before_MB} MB before, ${resident_MB()} MB with ${plots} plots`);
  assert.equal(await figure('stream_closed_total'), 0, 'nobody was too slow');
  await context.close();
  await becomes('all are gone', () => figure('stream_clients'), 0);
});
