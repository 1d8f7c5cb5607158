// Report: everything that the commissioning report shows, read at once. In: the gateway's documents. Out: one value. No drive is asked: what is not known is left open.
import type { Client } from '../api/client';
import { FailSafeDoor, type Rehearsal } from '../api/fail-safe';
import { MappingDoor, type MappingList } from '../api/mappings';
import { RecorderDoor } from '../api/recorder';
import type { AxisParameter, CaptureWithRows, Drive, Line } from '../api/types';
import type { MappingPoint } from '../text/mapping';
import { parameterReport, type ParameterReport, type SnapshotValues } from '../text/report';

const mostCaptures = 3;

export interface WholeReport {
  at: string;
  lines: Line[];
  drives: Drive[];
  mappings: MappingList;
  points: MappingPoint[];
  rehearsal: Rehearsal;
  /** Captures with their rows. */
  drawn: CaptureWithRows[];
  axes: { name: string; list: AxisParameter[]; snapshot: SnapshotValues | null; report: ParameterReport }[];
}

export async function readReport(client: Client, names: readonly string[]): Promise<WholeReport> {
  const [map, recorder] = [new MappingDoor(client), new RecorderDoor(client)];
  const [lines, drives, mappings, points, rehearsal, captures] = await Promise.all([client.lines(), client.drives(), map.list(), map.points(), new FailSafeDoor(client).rehearsal(), recorder.captures()]);
  const axes: WholeReport['axes'] = [];
  for (const name of names) {
    const path = `/axes/${encodeURIComponent(name)}/snapshots`;
    const [list, snapshots] = await Promise.all([client.parameters(name), client.call<{ n: number }[]>(path)]);
    const newest = snapshots.reduce<number | null>((n, s) => (n === null || s.n > n ? s.n : n), null);
    const snapshot = newest === null ? null : await client.call<SnapshotValues>(`${path}/${newest}`);
    axes.push({ name, list, snapshot, report: parameterReport(list, snapshot) });
  }
  const done = captures.captures.filter((c) => c.state === 'done' && !c.fault && c.bytes > 0).slice(0, mostCaptures);
  const drawn = await Promise.all(done.map((c) => recorder.capture(c.name)));
  return { at: new Date().toISOString(), lines, drives, mappings, points, rehearsal, drawn, axes };
}
