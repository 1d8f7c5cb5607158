// A class 1 scanner of others moves an axis by its output assembly, and its silence ends the connection.
// In: DEVICE, LOCAL; both ends have UDP 2222. Out: assertions. Never two connections at a time: the package has one port for all.
import assert from "node:assert/strict";
import { test } from "node:test";
import { setTimeout as sleep } from "node:timers/promises";
import st from "st-ethernet-ip";
import { enabled, undisturbed, until } from "./until.mjs";

const { DEVICE, LOCAL } = process.env;

test("st-ethernet-ip's scanner holds a class 1 connection and moves an axis by it", async () => {
  const scanner = new st.IO.Scanner(2222, LOCAL);
  const connection = scanner.addConnection(
    {
      configInstance: { assembly: 199, size: 0, data: Buffer.alloc(0) },
      outputInstance: { assembly: 151, size: 32 },
      inputInstance: { assembly: 101, size: 32 },
    },
    10,
    DEVICE,
  );
  const out = connection.outputData;
  const status = () => connection.inputData.readUInt16LE(0);
  const position = () => connection.inputData.readInt32LE(4);
  await undisturbed(connection, async () => {
    await enabled(connection, status);
    const target = position() + 3200;
    out.writeInt32LE(target, 4);
    for (const at of [8, 12, 16]) out.writeUInt32LE(at === 8 ? 3200 : 32000, at);
    await sleep(50);
    assert.notEqual(position(), target, "a target alone moves nothing");
    out.writeUInt16LE(0x1f, 0);
    await until(() => position() === target, () => `position ${position()} instead of ${target}`);
  });

  const counted = async () => {
    const c = new st.Controller(false);
    await c.connect(DEVICE, Buffer.alloc(0), false);
    const n = (await c.getAttributeSingle(6, 1, 8)).readUInt16LE(0);
    await c.disconnect();
    return n;
  };
  const before = await counted();
  connection.run = false;  // the cable is pulled: nothing is sent any more
  await sleep(10 * 32 + 300);
  assert.equal(await counted(), before + 1, "the connection has timed out");
});
