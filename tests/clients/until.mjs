// Until: waits for what a scanner is yet to hear.
// In: a condition, what to say if it never holds, how long. Out: nothing, or an assertion that says it. Never waits longer.
import assert from "node:assert/strict";
import { setTimeout as sleep } from "node:timers/promises";

export async function until(condition, what, limit = 10_000) {
  const end = Date.now() + limit;
  while (!condition()) {
    assert.ok(Date.now() < end, what());
    await sleep(5);
  }
}
