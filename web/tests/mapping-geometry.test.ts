// The geometry of the register map: rows and folded gaps, cells, what fits, what collides, sizes, and the way of the keyboard.
import { describe, expect, it } from 'vitest';
import { cellsOf, firstFit, fitOf, nextSize, overlapping, piecesOf, resized, rowAt, rowsOf, shapeOf, stepTo, takenBy, type Placed } from '../src/text/mapping-geometry';

const at = (key: string, address: number, width = 1): Placed => ({ key, address, width });
const firsts = (spans: Placed[], perRow = 8, open: number[] = []) => rowsOf(spans, perRow, open).map((r) => (r.kind === 'row' ? r.first : `${r.first}–${r.last}`));

describe('rows', () => {
  it('of an empty table are the first one and all the rest, folded', () => {
    expect(firsts([])).toEqual([0, '8–65535']);
  });
  it('have each entry, the row behind it, and fold what lies between; short gaps stay open', () => {
    expect(firsts([at('a', 0, 2), at('b', 100)])).toEqual([0, 8, '16–95', 96, 104, '112–65535']);
    expect(firsts([at('a', 0, 2), at('b', 32)])).toEqual([0, 8, 16, 24, 32, 40, '48–65535']);
  });
  it('go to the last address and not beyond', () => {
    expect(firsts([at('a', 65535)])).toEqual([0, '8–65527', 65528]);
    expect(firsts([at('a', 65528, 8)], 16)).toEqual([0, '16–65519', 65520]);
  });
  it('are opened where somebody asks for a place', () => {
    expect(firsts([], 8, [4001])).toEqual([0, '8–3999', 4000, 4008, 4016, 4024, '4032–65535']);
  });
  it('are found by any address of theirs', () => {
    const rows = rowsOf([at('a', 0), at('b', 100)], 8);
    expect([0, 7, 8, 50, 96, 103, 60000].map((a) => rowAt(rows, a))).toEqual([0, 0, 1, 2, 3, 3, 5]);
  });
});

it('an entry that does not end in its row goes on in the next; every place of a row is in one cell', () => {
  const pieces = piecesOf([at('a', 6, 4), at('b', 11)], 8);
  expect(cellsOf(pieces.get(0)!, 0, 8).map((c) => (c.kind === 'free' ? c.first : `${c.of.key}${c.first}+${c.width}${c.head ? 'h' : ''}${c.tail ? 't' : ''}`))).toEqual([0, 1, 2, 3, 4, 5, 'a6+2h']);
  expect(cellsOf(pieces.get(1)!, 8, 8).map((c) => (c.kind === 'free' ? c.first : `${c.of.key}${c.first}+${c.width}${c.head ? 'h' : ''}${c.tail ? 't' : ''}`))).toEqual(['a8+2t', 10, 'b11+1ht', 12, 13, 14, 15]);
});

describe('what fits', () => {
  const all = [at('a', 0, 2), at('b', 4, 2), at('c', 8, 4)];
  it('collides with whoever has a place in common, but for what is lifted', () => {
    expect(takenBy(all, at('', 1, 3)).map((b) => b.key)).toEqual(['a']);
    expect(takenBy(all, at('', 1, 4)).map((b) => b.key)).toEqual(['a', 'b']);
    expect(takenBy(all, at('', 1, 4), new Set(['a']))).toEqual([all[1]]);
    expect(takenBy(all, at('', 2, 2))).toEqual([]);
  });
  it('is judged as a shape: each of its parts, and the end of the table', () => {
    const shape = shapeOf([at('x', 20, 2), at('y', 24, 2)]);
    expect(shape).toEqual([{ address: 0, width: 2 }, { address: 4, width: 2 }]);
    expect(fitOf(all, shape, 2)).toEqual({ taken: [], beyond: false }); // around b
    expect(fitOf(all, shape, 4).taken.map((b) => b.key)).toEqual(['b', 'c']);
    expect(fitOf(all, shape, 65530).beyond).toBe(false);
    expect(fitOf(all, shape, 65531).beyond).toBe(true);
  });
  it('has a first place, or none', () => {
    expect(firstFit(all, [{ address: 0, width: 2 }])).toBe(2);
    expect(firstFit(all, [{ address: 0, width: 4 }])).toBe(12);
    expect(firstFit(all, shapeOf([at('x', 0, 2), at('y', 4, 2)]))).toBe(2);
    expect(firstFit(all, [{ address: 0, width: 2 }], 5)).toBe(6);
    expect(firstFit(all, [{ address: 0, width: 2 }], 0, new Set(['a']))).toBe(0);
    expect(firstFit([at('all', 0, 65535)], [{ address: 0, width: 2 }])).toBe(null);
    expect(firstFit([at('all', 0, 65535)], [{ address: 0, width: 1 }])).toBe(65535);
  });
  it('never leaves out a place: as a search one by one says it', () => {
    let seed = 7;
    const random = (n: number) => (seed = (seed * 1103515245 + 12345) % 2147483648) % n;
    for (let round = 0; round < 200; round += 1) {
      const some = Array.from({ length: random(12) }, (_, i) => at(`${i}`, random(60), 1 + random(4)));
      const shape = shapeOf(Array.from({ length: 1 + random(3) }, (_, i) => at(`${i}`, random(10), 1 + random(4))));
      const from = random(20);
      let slow = from;
      while (fitOf(some, shape, slow).taken.length > 0) slow += 1;
      expect(firstFit(some, shape, from), JSON.stringify({ some, shape, from })).toBe(slow);
    }
  });
  it('what lies upon another is told, both of them', () => {
    expect([...overlapping([at('a', 0, 4), at('b', 1), at('c', 3), at('d', 4)])].sort()).toEqual(['a', 'b', 'c']);
    expect([...overlapping(all)]).toEqual([]);
  });
});

it('a size is one of its kind: 16, 32 and 64 bits, whole or real, signed or not; a text has any length; a bit has one', () => {
  expect([1, 2, 3, 4, 9, 0].map((w) => resized({ type: 'i32' }, w).type)).toEqual(['i16', 'i32', 'i32', 'i64', 'i64', 'i16']);
  expect([1, 3, 4].map((w) => resized({ type: 'f64' }, w).type)).toEqual(['f32', 'f32', 'f64']);
  expect(resized({ type: 'string', length: 16 }, 90)).toEqual({ type: 'string', length: 64 });
  expect(resized({ type: 'bool' }, 4)).toEqual({ type: 'bool' });
  expect([nextSize({ type: 'u16' }, 1), nextSize({ type: 'u64' }, 1), nextSize({ type: 'f32' }, -1), nextSize({ type: 'string', length: 4 }, -1)]).toEqual([{ type: 'u32' }, { type: 'u64' }, { type: 'f32' }, { type: 'string', length: 3 }]);
});

describe('the keyboard', () => {
  const all = [at('a', 2, 4), at('b', 100, 2)];
  const rows = rowsOf(all, 8);
  const go = (from: number, way: Parameters<typeof stepTo>[4], loose = false) => stepTo(rows, all, 8, from, way, loose);
  it('goes over an entry and a folded gap in one step, over free places one by one', () => {
    expect([go(0, 'ArrowRight'), go(1, 'ArrowRight'), go(2, 'ArrowRight'), go(15, 'ArrowRight'), go(16, 'ArrowRight'), go(100, 'ArrowRight')]).toEqual([1, 2, 6, 16, 96, 102]);
    expect([go(6, 'ArrowLeft'), go(96, 'ArrowLeft'), go(16, 'ArrowLeft'), go(0, 'ArrowLeft'), go(102, 'ArrowLeft')]).toEqual([2, 16, 15, 0, 100]);
  });
  it('carries place by place', () => {
    expect([go(2, 'ArrowRight', true), go(5, 'ArrowLeft', true)]).toEqual([3, 4]);
  });
  it('goes up and down in its column, by pages, to the ends of the row and of what there is', () => {
    expect([go(3, 'ArrowDown'), go(11, 'ArrowUp'), go(11, 'ArrowDown'), go(3, 'ArrowUp'), go(3, 'PageDown'), go(3, 'Home'), go(3, 'End'), go(3, 'Last'), go(100, 'First')]).toEqual([11, 3, 16, 3, 112, 0, 7, 100, 0]);
    expect(go(65535, 'ArrowRight')).toBe(65535);
  });
});
