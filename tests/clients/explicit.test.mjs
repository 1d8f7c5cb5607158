// Explicit messages by two client libraries: identity, assemblies, parameters browsed and written, with and without a connection.
// In: DEVICE, the gateway's address. Out: assertions. Never depends on what another file has left behind.
import assert from "node:assert/strict";
import { once } from "node:events";
import { test } from "node:test";
import ethernetIp from "ethernet-ip";
import st from "st-ethernet-ip";

const device = process.env.DEVICE;
const PARAMETER = 0x0f;

const shortString = (bytes) => {
  assert.equal(bytes[0], bytes.length - 1);
  return bytes.subarray(1).toString();
};

async function controller(connected, work) {
  const c = new st.Controller(connected);
  await c.connect(device, connected ? 0 : Buffer.alloc(0), false);
  try {
    return await work(c);
  } finally {
    await c.disconnect();
  }
}

/** One request by the other library: { service, generalStatusCode, data } */
async function ask(client, service, path, data = Buffer.alloc(0)) {
  const { MessageRouter } = ethernetIp.EthernetIP.CIP;
  const answer = once(client, "SendRRData Received");
  client.write_cip(MessageRouter.build(service, path, data));
  const [items] = await answer;
  return MessageRouter.parse(items[1].data);
}
async function plain(work) {
  const client = new ethernetIp.EthernetIP.ENIP();
  await client.connect(device);
  try {
    return await work(client);
  } finally {
    client.destroy();
    await once(client, "close");
  }
}
const instances = (client) => ask(client, 0x0e, Buffer.from([0x20, PARAMETER, 0x24, 0, 0x30, 2])).then((a) => a.data.readUInt16LE(0));

for (const connected of [false, true]) {
  test(`st-ethernet-ip reads and writes, ${connected ? "over a connection" : "unconnected"}`, () =>
    controller(connected, async (c) => {
      assert.equal(shortString(await c.getAttributeSingle(1, 1, 7)), "axisgate");
      assert.equal((await c.getAttributeSingle(4, 101, 4)).readUInt16LE(0), 32);
      assert.equal((await c.getAttributeSingle(4, 101, 3)).length, 32);
      await assert.rejects(c.getAttributeSingle(4, 77, 3), "there is no such assembly");
      // Registers 32..47: profile velocity alone moves nothing.
      const output = Buffer.alloc(32);
      output.writeUInt32LE(connected ? 1234 : 4321, 8);
      await c.setAttributeSingle(4, 151, 3, output);
      const readBack = async () => (await c.getAttributeSingle(4, 151, 3)).readUInt32LE(8);
      const end = Date.now() + 5000;
      while ((await readBack()) !== (connected ? 1234 : 4321)) assert.ok(Date.now() < end, "the written value does not come back");
    }));
}

test("st-ethernet-ip browses every Parameter object and writes one", async () => {
  const count = await plain(instances);
  assert.ok(count > 20, `${count} parameters`);
  await controller(false, async (c) => {
    const names = new Set();
    let values = 0;
    let written = 0;
    for (let i = 1; i <= count; i++) {
      const name = shortString(await c.getAttributeSingle(PARAMETER, i, 7));
      const size = (await c.getAttributeSingle(PARAMETER, i, 6))[0];
      const readOnly = ((await c.getAttributeSingle(PARAMETER, i, 4)).readUInt16LE(0) & 0x10) !== 0;
      names.add(name);
      const value = await c.getAttributeSingle(PARAMETER, i, 1).catch(() => null);
      if (!value) continue;
      values++;
      if (size > 0) assert.equal(value.length, size, `${name} has the size that its descriptor says`);
      if (name === "ramp_unit" && !readOnly && written === 0) {
        const other = Buffer.from(value);
        other[0] ^= 1;
        await c.setAttributeSingle(PARAMETER, i, 1, other);
        assert.deepEqual(await c.getAttributeSingle(PARAMETER, i, 1), other);
        await c.setAttributeSingle(PARAMETER, i, 1, value);
        assert.deepEqual(await c.getAttributeSingle(PARAMETER, i, 1), value);
        written++;
      }
    }
    assert.ok(names.size > 20, `${names.size} names`);
    assert.ok(values > count / 2, `${values} of ${count} have a value`);
    assert.equal(written, 1, "one was written and read back");
  });
});

test("ethernet-ip reads the classes and is told what there is not", () =>
  plain(async (client) => {
    const { LOGICAL } = ethernetIp.EthernetIP.CIP.EPATH.segments;
    const path = (classId, instance, attribute) =>
      Buffer.concat([LOGICAL.build(LOGICAL.types.ClassID, classId), LOGICAL.build(LOGICAL.types.InstanceID, instance), LOGICAL.build(LOGICAL.types.AttributeID, attribute)]);
    const name = await ask(client, 0x0e, path(1, 1, 7));
    assert.equal(name.generalStatusCode, 0);
    assert.equal(shortString(name.data), "axisgate");
    const all = await ask(client, 0x01, path(1, 1, 1).subarray(0, 4));
    assert.equal(all.data.readUInt16LE(2), 12, "a communications adapter");
    const last = await instances(client);
    assert.equal((await ask(client, 0x0e, path(PARAMETER, last, 7))).generalStatusCode, 0);
    assert.equal((await ask(client, 0x0e, path(PARAMETER, last + 1, 7))).generalStatusCode, 0x16);
    assert.equal((await ask(client, 0x0e, path(0x99, 1, 1))).generalStatusCode, 0x05);
    assert.equal((await ask(client, 0x10, path(1, 1, 7), Buffer.from([0]))).generalStatusCode, 0x0e);
    const output = await ask(client, 0x10, path(4, 152, 3), Buffer.alloc(31));
    assert.equal(output.generalStatusCode, 0x13, "one byte is missing");
  }));
