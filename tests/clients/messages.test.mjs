// Explicit messages alone move an axis: st-ethernet-ip writes its output assembly, reads its input assembly, stops it in flight, without a connection
// and over one. In: DEVICE, the gateway's address. Out: assertions. The axis is switched off at the end, and nothing of another file is needed.
import assert from "node:assert/strict";
import { test } from "node:test";
import st from "st-ethernet-ip";

const device = process.env.DEVICE;
const [OUTPUT, INPUT] = [153, 103];

/** Registers of an output assembly: control word, mode 1, target, velocity, acceleration, deceleration. */
function image(word, target = 0) {
  const out = Buffer.alloc(32);
  out.writeUInt16LE(word, 0);
  out.writeInt16LE(1, 2);
  out.writeInt32LE(target, 4);
  out.writeUInt32LE(32000, 8);
  out.writeUInt32LE(320000, 12);
  out.writeUInt32LE(320000, 16);
  return out;
}

for (const connected of [false, true]) {
  test(`st-ethernet-ip moves an axis by messages, ${connected ? "over a connection" : "unconnected"}`, async () => {
    const c = new st.Controller(connected);
    await c.connect(device, connected ? 0 : Buffer.alloc(0), false);
    const write = (word, target) => c.setAttributeSingle(4, OUTPUT, 3, image(word, target));
    const seen = async () => {
      const data = await c.getAttributeSingle(4, INPUT, 3);
      return { state: data.readUInt16LE(0) & 0x6f, position: data.readInt32LE(4) };
    };
    const until = async (condition, what) => {
      const end = Date.now() + 10_000;
      for (let now = await seen(); !condition(now); now = await seen()) assert.ok(Date.now() < end, `${what}: ${JSON.stringify(now)}`);
    };
    try {
      for (const [word, state] of [[0x06, 0x21], [0x07, 0x23], [0x0f, 0x27]]) {
        await write(word);
        await until((s) => s.state === state, `control word ${word}`);
      }
      const begin = (await seen()).position;
      await write(0x1f, begin + 6400);
      await until((s) => s.position === begin + 6400, "the set-point");
      await write(0x0f, begin + 6400);
      await write(0x1f, begin + 3200000);
      await until((s) => s.position > begin + 8000, "the long motion");
      await write(0x10f, begin + 3200000);
      let before = NaN;
      await until((s) => s.position === before || ((before = s.position), false), "the halt");
      assert.ok(before < begin + 3200000, "in flight");
      await assert.rejects(c.setAttributeSingle(4, OUTPUT, 3, image(0).subarray(0, 30)), "two bytes are missing");
    } finally {
      await write(0x06);
      await until((s) => s.state !== 0x27, "switched off");
      await write(0);
      await c.disconnect();
    }
  });
}
