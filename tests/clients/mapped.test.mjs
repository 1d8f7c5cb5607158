// A class 1 scanner of others on a pair of assemblies that the site maps itself: values in their units, a parameter, an axis moved by it.
// In: DEVICE, LOCAL; both ends have UDP 2222. Out: assertions. Never 100+n or 150+n.
import assert from "node:assert/strict";
import { test } from "node:test";
import { setTimeout as sleep } from "node:timers/promises";
import st from "st-ethernet-ip";
import { enabled, undisturbed, until } from "./until.mjs";

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
    await enabled(connection, status);
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
