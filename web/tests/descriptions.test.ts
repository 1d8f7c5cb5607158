// Files on their way to the gateway, the removal of one, and the values of a DCF on their way to a drive: what is sent, what is said, what is never sent.
import { describe, expect, it } from 'vitest';
import type { Description } from '../src/api/descriptions';
import { Problem } from '../src/api/problem';
import type { AxisParameter } from '../src/api/types';
import { ConfiguredList, isConfigured } from '../src/state/configured';
import { DescriptionShelf } from '../src/state/descriptions';

const file = (name: string, size = 10) => new File([new Uint8Array(size)], name);
const stored = (name: string, warnings = 0) => ({ name, warnings: Array.from({ length: warnings }, (_, i) => ({ line: i, text: 'odd' })), used_by: [] }) as unknown as Description;

describe('files', () => {
  function shelf(refuse: Record<string, Problem> = {}) {
    const added: string[] = [];
    const s = new DescriptionShelf({
      list: async () => added.map((n) => stored(n)),
      add: async (name) => {
        if (refuse[name]) throw refuse[name];
        added.push(name);
        return stored(name, name === 'odd.eds' ? 2 : 0);
      },
      remove: async (name) => {
        throw new Problem('answered', `description ${name} is named by lift (in force): change the site first`, 409);
      },
    });
    return { s, added };
  }
  it('go one by one, several at once, each with its word', async () => {
    const { s, added } = shelf({ 'bad.eds': new Problem('answered', 'the file is faulty', 422, { faults: [{ text: 'line 3: 6040h is missing' }, { text: 'the file is faulty' }] } as never) });
    const done = await s.add([file('Good One.EDS'), file('odd.eds'), file('bad.eds'), file('note.txt'), file('large.eds', (1 << 20) + 1)]);
    expect(done.map((d) => d.name)).toEqual(['Good-One.eds', 'odd.eds']);
    expect(added).toEqual(['Good-One.eds', 'odd.eds']);
    expect(s.sent.value.map((x) => [x.file, x.tone, x.text])).toEqual([
      ['Good One.EDS', 'good', 'is stored without a warning.'], ['odd.eds', 'good', 'is stored, with 2 warnings.'], ['bad.eds', 'refused', 'is not stored: the file is faulty'],
      ['note.txt', 'refused', expect.stringContaining('no EDS or DCF')], ['large.eds', 'refused', expect.stringContaining('1.0 MiB')],
    ]);
    expect(s.sent.value[2]?.faults).toEqual(['line 3: 6040h is missing']);
    expect([s.busy.value, s.list.value?.length]).toEqual([false, 2]);
  });
  it('are not sent while others are on their way', async () => {
    const { s, added } = shelf();
    const first = s.add([file('a.eds')]);
    expect(await s.add([file('b.eds')])).toEqual([]);
    await first;
    expect(added).toEqual(['a.eds']);
  });
  it('that a drive uses stay, and the drive is named', async () => {
    const { s } = shelf();
    expect(await s.remove('a.eds')).toBe(false);
    expect(s.reported.value).toMatchObject({ tone: 'refused', text: expect.stringContaining('named by lift') });
  });
});

describe('values of a DCF', () => {
  const parameter = (id: string, more: Partial<AxisParameter> = {}) => ({ id, name: id, access: 'RW', live: false, addressing: false, quality: 'good', value: 1, configured: 2, written_at: null, allowed: null, unit: null, ...more }) as unknown as AxisParameter;
  it('are those that configure the drive and can be read back', () => {
    const { configured: _, ...none } = parameter('a');
    expect([parameter('a'), none as AxisParameter, parameter('a', { access: 'R' }), parameter('a', { access: 'W' }), parameter('a', { live: true }), parameter('a', { addressing: true })].map(isConfigured)).toEqual([true, false, false, false, false, false]);
  });
  function list(rows: AxisParameter[], refused = '') {
    const written: [string, unknown][] = [];
    const l = new ConfiguredList(
      {
        parameters: async () => rows,
        parameter: async (_axis, id) => {
          const p = rows.find((r) => r.id === id)!;
          if (p.quality === 'unknown') throw new Problem('answered', 'no answer', 504);
          return p;
        },
        writeParameter: async (_axis, id, value) => {
          if (id === refused) throw new Problem('answered', 'the drive refuses it', 409);
          written.push([id, value]);
          return {} as never;
        },
      },
      'lift',
    );
    return { l, written };
  }
  it('are read from the drive first; the newer ones of the gateway are not chosen; nothing is written before it was shown', async () => {
    const { l, written } = list([parameter('same', { value: 2 }), parameter('other'), parameter('newer', { written_at: '2026-01-01T00:00:00Z' } as never), parameter('silent', { quality: 'unknown' })]);
    await l.load();
    expect([l.of.value, l.differing.value]).toEqual([4, null]);
    await l.write();
    expect(written).toEqual([]);
    await l.look();
    expect(l.differing.value?.map((r) => r.p.id)).toEqual(['other', 'newer']);
    expect([[...l.chosen.value], l.unread.value]).toEqual([['other'], ['silent']]);
    l.choose('newer');
    l.choose('other');
    await l.write();
    expect(written).toEqual([['newer', 2]]);
    expect(l.differing.value?.map((r) => r.p.id)).toEqual(['other']);
  });
  it('end at the first refusal; those behind it stay chosen', async () => {
    const { l, written } = list([parameter('a'), parameter('b'), parameter('c')], 'b');
    await l.load();
    await l.look();
    await l.write();
    expect(written).toEqual([['a', 2]]);
    expect([...l.chosen.value]).toEqual(['b', 'c']);
    expect(l.reported.value).toMatchObject({ tone: 'refused', text: 'b: the drive refuses it. 1 were written before it; 1 behind it were not sent.' });
  });
});
