// Read missing: all values of an axis; those that it has not told yet, or no longer tells, are read from its drive, one after the other.
// In: the door, the axis, an end. Out: the values, progress. What the drive refuses, and what was ended before its turn, stays not known.
import type { Client } from '../api/client';
import type { AxisParameter } from '../api/types';

export async function readMissing(client: Pick<Client, 'parameters' | 'parameter'>, axis: string, end: AbortSignal, progress: (done: number, of: number) => void): Promise<AxisParameter[]> {
  const list = await client.parameters(axis);
  const wanted = list.filter((p) => p.quality !== 'good' && p.access !== 'W' && !p.count);
  for (const [i, p] of wanted.entries()) {
    if (end.aborted) break;
    progress(i + 1, wanted.length);
    try {
      list[list.indexOf(p)] = await client.parameter(axis, p.id, {}, end);
    } catch {
      // Counted by whoever compares.
    }
  }
  return list;
}
