// Profiles by a Modbus library of others: a PA-CONTROL's command sequence and a Lexium's registers move the same axis of a third maker.
// In: DEVICE, the gateway's address; units 20 and 21 of the site are languages of the axis lift. Out: assertions. Never leaves it enabled.
import assert from "node:assert/strict";
import { test } from "node:test";
import { setTimeout as sleep } from "node:timers/promises";
import ModbusRTU from "modbus-serial";

const PORT = 1502;

async function unit(number, work) {
  const client = new ModbusRTU();
  await client.connectTCP(process.env.DEVICE, { port: PORT });
  client.setID(number);
  client.setTimeout(5000);
  try {
    return await work(client);
  } finally {
    await new Promise((closed) => client.close(closed));
  }
}
async function wait(read, good, what) {
  const end = Date.now() + 20_000;
  for (;;) {
    const got = await read();
    if (good(got)) return got;
    assert.ok(Date.now() < end, `${what}: ${JSON.stringify(got)}`);
    await sleep(10);
  }
}
const real = (value) => {
  const bytes = Buffer.alloc(4);
  bytes.writeFloatBE(value);
  return [bytes.readUInt16BE(0), bytes.readUInt16BE(2)];
};

test("modbus-serial speaks a PA-CONTROL's sequence to an axis of another maker", () =>
  unit(20, async (client) => {
    let toggle = 0;
    const ask = async (code, parameter = 0, data = [0, 0]) => {
      toggle ^= 0x8000;
      await client.writeRegisters(0, [...data, parameter, code | toggle]);
      const read = async () => (await client.readInputRegisters(0, 4)).data;
      const image = await wait(read, (i) => (i[3] & 0x8000) === toggle && (i[3] & 0x6000) !== 0, `end of ${code.toString(16)}`);
      return { error: image[3] & 0x4000 ? image[3] & 0x1fff : 0, image };
    };
    assert.equal((await ask(0x0a94, 1, real(1))).error, 0x14, "nothing moves before the release");
    for (const [code, parameter, data] of [[0x0603], [0x0a83, 1], [0x0a85, 1], [0x0a87, 1, real(12.5)]])
      assert.equal((await ask(code, parameter, data)).error, 0, code.toString(16));
    const { error, image } = await ask(0x190c, 1);
    assert.equal(error, 0);
    assert.deepEqual(image.slice(0, 2), real(12.5), "the position that it was sent to");
    assert.equal((await ask(0x0a87, 3, real(1))).error, 0x20, "an axis that is not there");
    assert.equal((await ask(0x0a81)).error, 0);
  }));

test("modbus-serial drives the axis as a Lexium", () =>
  unit(21, async (client) => {
    const holding = async (address, count) => (await client.readHoldingRegisters(address, count)).data;
    await client.writeRegister(28, 1); // DE
    await wait(() => holding(28, 1), ([on]) => on === 1, "DE");
    const [low, high] = await holding(87, 2); // P, low word first
    const target = ((high << 16) | low) + 16000;
    const words = [target & 0xffff, (target >>> 16) & 0xffff];
    await client.writeRegisters(67, words); // MA
    await wait(() => holding(87, 2), (p) => p[0] === words[0] && p[1] === words[1], "MA");
    await wait(() => holding(74, 1), ([moving]) => moving === 0, "MV");
    await assert.rejects(client.writeRegister(75, 1), (e) => e.modbusCode === 4, "an output that is not there");
    assert.equal((await holding(33, 1))[0], 37, "ER says why");
    await client.writeRegister(28, 0);
    await wait(() => holding(28, 1), ([on]) => on === 0, "DE");
  }));
