// Feed relay: stands between the page and the gateway and gives one axis 1000 samples a second in the live feed, which drives here are not
// asked for. In: the gateway's address, the axis. Out: an address for the browser. Everything else passes byte for byte, both ways.
// The samples are whole messages of the gateway with other values; while they are given, the gateway's own for this axis are held back.
// Never sends a sample before its time, and leaves none out when it was late itself. Bound: the samples it was asked for.
import { connect, createServer } from 'node:net';

/** Sample number n: a ramp that counts the samples (1 mm a second), and a drive that follows it with an error. */
export function sampleOf(n) {
  const target = n / 1000;
  const demand = Number((target + 2 * Math.sin(n / 150)).toFixed(6));
  return { target_position: target, position_demand: demand, position: Number((demand - 0.2 * Math.cos(n / 150)).toFixed(6)), velocity: Number((1 + 13 * Math.cos(n / 150)).toFixed(6)) };
}

/** One whole text frame, not masked. */
function frameOf(text) {
  const body = Buffer.from(text);
  const head = body.length < 126 ? Buffer.from([0x81, body.length]) : Buffer.from([0x81, 126, body.length >> 8, body.length & 0xff]);
  return Buffer.concat([head, body]);
}

class Feed {
  constructor(client, axis) {
    this.client = client;
    this.topic = `{"topic":"axes/${axis}",`;
    this.rest = Buffer.alloc(0);
    this.template = null;
    this.timer = null;
  }
  take(chunk) {
    this.rest = Buffer.concat([this.rest, chunk]);
    const out = [];
    for (;;) {
      if (this.rest.length < 2) break;
      let size = this.rest[1];
      let head = 2;
      if (size === 126) {
        if (this.rest.length < 4) break;
        size = this.rest.readUInt16BE(2);
        head = 4;
      } else if (size > 126) {
        if (this.rest.length < 10) break;
        size = Number(this.rest.readBigUInt64BE(2));
        head = 10;
      }
      if (this.rest.length < head + size) break;
      const frame = this.rest.subarray(0, head + size);
      this.rest = this.rest.subarray(head + size);
      const ours = frame[0] === 0x81 && frame.subarray(head, head + this.topic.length).toString() === this.topic;
      if (ours) this.template = JSON.parse(frame.subarray(head).toString());
      if (!ours || this.timer === null) out.push(frame);
    }
    if (out.length > 0) this.client.write(Buffer.concat(out));
  }
  /** `count` samples, one a millisecond; resolves when the last has been sent. */
  give(count) {
    const begun_ms = Date.now() + 5; // after whatever the gateway has told already
    let n = 0;
    return new Promise((resolve, reject) => {
      this.client.once('close', () => reject(new Error('the page closed the live feed')));
      this.timer = setInterval(() => {
        const due = Math.min(count, Date.now() - begun_ms);
        const out = [];
        for (; n < due; n += 1) {
          this.template.data = { ...this.template.data, ...sampleOf(n), moving: true };
          const { topic, data } = this.template;
          out.push(frameOf(`{"topic":${JSON.stringify(topic)},"at":${begun_ms + n}000000,"data":${JSON.stringify(data)}}`));
        }
        if (out.length > 0) this.client.write(Buffer.concat(out));
        if (n < count) return;
        clearInterval(this.timer);
        this.timer = null;
        resolve();
      }, 4);
    });
  }
  end() {
    clearInterval(this.timer);
  }
}

/** `feeds`: the live feeds that were opened through it, the newest last. */
export async function relayTo(url, axis) {
  const { hostname, port } = new URL(url);
  const feeds = [];
  const sockets = new Set();
  const server = createServer((client) => {
    const upstream = connect(Number(port), hostname);
    let head = Buffer.alloc(0);
    let feed = null;
    let plain = false;
    for (const s of [client, upstream]) {
      s.setNoDelay(true);
      sockets.add(s);
      s.on('error', () => {});
      s.on('close', () => {
        feed?.end();
        client.destroy();
        upstream.destroy();
        sockets.delete(s);
      });
    }
    client.pipe(upstream);
    // The first answer of a connection says whether it is the live feed.
    upstream.on('data', (chunk) => {
      if (plain) return client.write(chunk);
      if (feed) return feed.take(chunk);
      head = Buffer.concat([head, chunk]);
      const end = head.indexOf('\r\n\r\n');
      if (end < 0) return;
      if (!head.subarray(0, 13).toString().startsWith('HTTP/1.1 101 ')) {
        plain = true;
        return client.write(head);
      }
      client.write(head.subarray(0, end + 4));
      feeds.push((feed = new Feed(client, axis)));
      feed.take(head.subarray(end + 4));
    });
  });
  await new Promise((resolve) => server.listen(0, '127.0.0.1', resolve));
  return {
    url: `http://127.0.0.1:${server.address().port}`,
    feeds,
    close: () => {
      for (const s of sockets) s.destroy();
      server.close();
    },
  };
}
