// Until: waits for what a scanner is yet to receive. Enabled: an axis by its outputs. Undisturbed: a scenario on a connection that the scanner itself does not give up.
// In: a condition, what to say if it never holds, how long; a connection. Out: nothing, or an assertion that says it. Never waits longer.
import assert from "node:assert/strict";
import { setTimeout as sleep } from "node:timers/promises";

export async function until(condition, what, limit = 10_000) {
  const end = Date.now() + limit;
  while (!condition()) {
    assert.ok(Date.now() < end, what());
    await sleep(5);
  }
}

/** From nothing to operation enabled in mode 1, by the control word and the mode at the head of its outputs. `status`: reads the status word. */
export async function enabled(connection, status) {
  const out = connection.outputData;
  out.fill(0);
  await until(() => connection.connected && connection.OTsequenceNum > 20, () => `connected ${connection.connected}, ${connection.OTsequenceNum} datagrams`);
  for (const [word, state] of [[0x06, 0x21], [0x07, 0x23], [0x0f, 0x27]]) {
    out.writeUInt16LE(word, 0);
    out.writeInt16LE(1, 2);
    await until(() => (status() & 0x6f) === state, () => `status word ${status().toString(16)} instead of state ${state.toString(16)}`);
  }
}

/**
 * The scanner of the package looks once a second, and gives a connection up of which it had no datagram for 40 ms: on a machine that stood still
 * that long, nobody else is at fault. A connection that was opened anew begins with what stands in its first image, so the scenario begins anew,
 * too, three times at most. A fault on a connection that lived counts at once.
 */
export async function undisturbed(connection, scenario) {
  for (let left = 3; ; left--) {
    let lost = 0;
    const count = () => (lost += 1);
    connection.on("disconnected", count);
    try {
      return await scenario();
    } catch (fault) {
      if (lost === 0 || left === 1) throw fault;
      console.log(`# the scanner gave its connection up: ${fault.message}`);
    } finally {
      connection.off("disconnected", count);
    }
  }
}
