// Mock stream: one connection of a page to the mock door's stream. In: what the page says, and turns of a clock. Out: messages, by topic and period.
// A stand-in for the page's author: a state is told when it has changed, and once a second while its drive is online.

const again_ms = 1000;

export class MockStream {
  /** @param {import('./door.mjs').MockDoor} door @param {(text: string) => void} send */
  constructor(door, send) {
    this.door = door;
    this.send = send;
    /** @type {Map<string, {period: number, next: number}>} */
    this.topics = new Map();
    /** @type {Map<string, {text: string, at: number}>} */
    this.sent = new Map();
    /** @type {Map<string, number>} */
    this.framesSent = new Map();
    this.alarmsTold = 0;
    const { world, recipes } = door;
    this.onEvent = (/** @type {import('../../src/api/types').GatewayEvent} */ e) => this.topics.has('events') && this.tell('events', e);
    this.onSite = () => this.topics.has('site') && this.tell('site', { revision: world.revision });
    this.onRun = (/** @type {import('../../src/api/types').RecipeReport} */ r) => this.topics.has('recipes') && this.tell('recipes', r);
    world.listeners.push(this.onEvent);
    world.siteListeners.push(this.onSite);
    recipes.listeners.push(this.onRun);
  }

  /** @param {string} text @param {number} now_ms */
  hear(text, now_ms) {
    const r = JSON.parse(text);
    for (const t of r.unsubscribe ?? []) this.topics.delete(t);
    for (const t of r.subscribe ?? []) {
      this.topics.set(t, { period: r.period_ms ?? 100, next: 0 });
      if (t === 'site') this.tell('site', { revision: this.door.world.revision });
      else this.look(t, true, now_ms);
    }
  }

  /** @param {number} now_ms */
  turn(now_ms) {
    for (const [t, s] of this.topics) {
      if (now_ms < s.next) continue;
      s.next = now_ms + s.period;
      this.look(t, false, now_ms);
    }
  }

  end() {
    const { world, recipes } = this.door;
    world.listeners = world.listeners.filter((l) => l !== this.onEvent);
    world.siteListeners = world.siteListeners.filter((l) => l !== this.onSite);
    recipes.listeners = recipes.listeners.filter((l) => l !== this.onRun);
  }

  /** @param {string} topic @param {unknown} data */
  tell(topic, data) {
    this.send(JSON.stringify({ topic, at: Date.now() * 1e6, data }));
  }

  /** @param {string} topic @param {any} document @param {boolean} always @param {number} now_ms */
  state(topic, document, always, now_ms) {
    const text = JSON.stringify({ ...document, at: null });
    const before = this.sent.get(topic);
    if (!always && before && before.text === text && (!document.online || now_ms - before.at < again_ms)) return;
    this.sent.set(topic, { text, at: now_ms });
    this.tell(topic, document);
  }

  /** @param {string} topic @param {boolean} always @param {number} now_ms */
  look(topic, always, now_ms) {
    const { world, alarms } = this.door;
    if (topic === 'alarms') {
      if (always || this.alarmsTold !== alarms.change) this.tell('alarms', alarms.document());
      this.alarmsTold = alarms.change;
      return;
    }
    const [kind, name, rest] = topic.split('/');
    if (rest === 'frames') {
      const frames = (world.frames.get(name ?? '') ?? []).filter((f) => always || f.sequence > (this.framesSent.get(topic) ?? 0));
      this.framesSent.set(topic, frames.at(-1)?.sequence ?? this.framesSent.get(topic) ?? 0);
      if (frames.length > 0 || always) this.tell(topic, { missed: 0, frames });
      return;
    }
    const of = (/** @type {Iterable<string>} */ all) => (name === '*' ? [...all] : [...all].filter((n) => n === name));
    if (kind === 'axes') for (const n of of(world.axes.keys())) this.state(`axes/${n}`, this.door.axis(n), always, now_ms);
    if (kind === 'drives') for (const n of of(world.drives.keys())) this.state(`drives/${n}`, world.driveOf(n).document(), always, now_ms);
    if (kind === 'lines') for (const n of of(world.site.lines.map((l) => l.name))) this.state(`lines/${n}`, world.line(n), always, now_ms);
  }
}
