// The name of a tab: kept by a reload, never shared by two open tabs, whatever copied the session of the first; late answers count too.
import { signal } from '@preact/signals';
import { describe, expect, it } from 'vitest';
import { Tab, type TabChannel } from '../src/state/tab';

/** Channels of one browser: what one says all others hear, when `deliver` is called. */
function browser() {
  const open: (TabChannel & { asleep?: boolean })[] = [];
  const published: { from: TabChannel; data: unknown; to: (TabChannel & { asleep?: boolean })[] }[] = [];
  const channel = (): TabChannel & { asleep?: boolean } => {
    const c: TabChannel & { asleep?: boolean } = { onmessage: null, postMessage: (data) => published.push({ from: c, data, to: open.filter((o) => o !== c) }) };
    open.push(c);
    return c;
  };
  const deliver = () => {
    for (let i = 0; i < published.length; i += 1) {
      const m = published[i]!;
      m.to = m.to.filter((o) => {
        if (!open.includes(o)) return false;
        if (o.asleep) return true;
        o.onmessage?.({ data: m.data } as MessageEvent);
        return false;
      });
    }
    for (let i = published.length - 1; i >= 0; i -= 1) if (published[i]!.to.length === 0) published.splice(i, 1);
  };
  const close = (c: TabChannel) => open.splice(open.indexOf(c), 1);
  return { channel, deliver, close };
}

describe('a tab', () => {
  it('makes itself a name, and keeps it through a reload', async () => {
    const b = browser();
    const session = signal('');
    const c = b.channel();
    const first = new Tab(session, c, 0);
    expect(first.name.value).toMatch(/^page-[0-9a-z]{6}$/);
    b.deliver();
    b.close(c); // the document is gone; its session is not
    const again = new Tab(signal(session.value), b.channel(), 0);
    b.deliver();
    await again.settled;
    expect(again.name.value).toBe(first.name.value);
  });
  it('that was duplicated takes a name of its own, and the first keeps its', async () => {
    const b = browser();
    const session = signal('');
    const first = new Tab(session, b.channel(), 0);
    const name = first.name.value;
    const copy = signal(name);
    const second = new Tab(copy, b.channel(), 1_000_000);
    b.deliver();
    await second.settled; // by the answer: the wait has not ended
    expect(first.name.value).toBe(name);
    expect(second.name.value).not.toBe(name);
    expect(copy.value).toBe(second.name.value);
    expect(session.value).toBe(name);
  });
  it('is told by one that slept, too', () => {
    const b = browser();
    const sleeper = b.channel();
    const first = new Tab(signal(''), sleeper, 0);
    sleeper.asleep = true;
    const second = new Tab(signal(first.name.value), b.channel(), 0);
    b.deliver();
    expect(second.name.value).toBe(first.name.value);
    sleeper.asleep = false;
    b.deliver();
    expect(second.name.value).not.toBe(first.name.value);
  });
  it('of which two copies open at once leaves no two with one name', () => {
    const b = browser();
    const two = [new Tab(signal('page-aaaaaa'), b.channel(), 0), new Tab(signal('page-aaaaaa'), b.channel(), 0), new Tab(signal('page-bbbbbb'), b.channel(), 0)];
    b.deliver();
    expect(new Set(two.map((t) => t.name.value)).size).toBe(3);
    expect(two[2]!.name.value).toBe('page-bbbbbb');
  });
  it('waits for nobody where there is no channel, and believes no nonsense', async () => {
    const alone = new Tab(signal('page-aaaaaa'), null);
    await alone.settled;
    expect(alone.name.value).toBe('page-aaaaaa');
    const b = browser();
    const c = b.channel();
    const t = new Tab(signal('page-aaaaaa'), c, 0);
    for (const data of [null, 'x', {}, { kind: 'mine', name: 'page-aaaaaa', nonce: 'other' }, { kind: 'mine', name: 'page-aaaaaa', nonce: 7 }]) c.onmessage?.({ data } as MessageEvent);
    await t.settled;
    expect(t.name.value).toBe('page-aaaaaa');
  });
});
