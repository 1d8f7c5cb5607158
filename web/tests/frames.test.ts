// Recorded frames: what is kept, what a filter lets through, and a frame byte by byte.
import { describe, expect, it } from 'vitest';
import { bytesOf, idText, joined, matches, mostFrames, type Frame } from '../src/state/frames';

const frame = (sequence: number, more: Partial<Frame> = {}): Frame => ({
  sequence,
  at: '2026-01-02T03:04:05.678901Z',
  to_drive: true,
  simulated: true,
  kind: 'can',
  id: 0x04280095,
  extended: true,
  remote: false,
  data: '0100',
  text: '04280095#0100',
  decoded: ['to node 5: MO[1]: motor on'],
  ...more,
});

describe('frames', () => {
  it('that come once more are taken once, and the oldest give way', () => {
    const a = joined([], [frame(1), frame(2)]);
    expect(joined(a, [frame(1), frame(2), frame(3)]).map((f) => f.sequence)).toEqual([1, 2, 3]);
    const many = Array.from({ length: mostFrames + 5 }, (_, i) => frame(i));
    expect(joined([], many)).toHaveLength(mostFrames);
    expect(joined([], many)[0]!.sequence).toBe(5);
  });
  it('are filtered by words that must be there and words that must not', () => {
    const f = frame(1);
    const fits = (text: string, direction: 'both' | 'to' | 'from' = 'both') => matches(f, { text, direction });
    expect(fits('')).toBe(true);
    expect(fits('motor NODE')).toBe(true);
    expect(fits('04280095')).toBe(true);
    expect(fits('motor -node')).toBe(false);
    expect(fits('-polled')).toBe(true);
    expect(fits('cable')).toBe(false);
    expect(fits('', 'to')).toBe(true);
    expect(fits('', 'from')).toBe(false);
  });
  it('byte by byte: hex, decimal, bits, letter', () => {
    expect(bytesOf('0141FF')).toEqual([
      { at: 0, hex: '01', decimal: 1, bits: '00000001', letter: 'SOH' },
      { at: 1, hex: '41', decimal: 65, bits: '01000001', letter: 'A' },
      { at: 2, hex: 'FF', decimal: 255, bits: '11111111', letter: '' },
    ]);
    expect(bytesOf('')).toEqual([]);
  });
  it('tell their identifier', () => {
    expect(idText(frame(1))).toBe('04280095 (extended, 29 bits), decimal 69730453');
    expect(idText(frame(1, { id: 5, extended: false, remote: true }))).toBe('005 (standard, 11 bits, remote), decimal 5');
    expect(idText(frame(1, { id: null }))).toBe('');
  });
});
