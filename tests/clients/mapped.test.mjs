// A class 1 scanner of others on a pair of assemblies that the site maps itself: values in their units, a parameter, an axis moved by it.
// In: DEVICE, LOCAL; both ends have UDP 2222. Out: assertions. Never 100+n or 150+n.
import assert from "node:assert/strict";
import { test } from "node:test";
import { setTimeout as sleep } from "node:timers/promises";
import st from "st-ethernet-ip";
import { undisturbed, until } from "./until.mjs";

const { DEVICE, LOCAL } = process.env;

test("st-ethernet-ip's scanner holds a freely mapped pair and moves an axis by it", async () => {
  const scanner = new st.IO.Scanner(2222, LOCAL);
  const connection = scanner.addConnection(
    {
      configInstance: { assembly: 199, size: 0, data: Buffer.alloc(0) },
      outputInstance: { assembly: 310, size: 16 },
      inputInstance: { assembly: 300, size: 10 },
    },
    10,
    DEVICE,
  );
  const out = connection.outputData;
  const status = () => connection.inputData.readUInt16LE(4);
  const position = () => connection.inputData.readFloatLE(0); // mm
  await undisturbed(connection, async () => {
    out.fill(0);
    await until(() => connection.connected && connection.OTsequenceNum > 20, () => `connected ${connection.connected}, ${connection.OTsequenceNum} datagrams`);

    for (const [word, state] of [[0x06, 0x21], [0x07, 0x23], [0x0f, 0x27]]) {
      out.writeUInt16LE(word, 0);
      out.writeInt16LE(1, 2);
      await until(() => (status() & 0x6f) === state, () => `status word ${status().toString(16)} instead of state ${state.toString(16)}`);
    }
    out.writeUInt32LE(4321, 12);
    await until(() => connection.inputData.readUInt32LE(6) === 4321, () => `AC is ${connection.inputData.readUInt32LE(6)}`);
    const target = Math.round(position()) + 25;
    out.writeFloatLE(target, 4);
    out.writeFloatLE(50, 8);
    await sleep(50);
    assert.ok(Math.abs(position() - target) > 20, "a target alone moves nothing");
    out.writeUInt16LE(0x1f, 0);
    await until(() => Math.abs(position() - target) < 0.02, () => `position ${position()} instead of ${target}`);
  });
  connection.run = false;
  await sleep(10 * 32 + 300); // its place is free for the next file
});
