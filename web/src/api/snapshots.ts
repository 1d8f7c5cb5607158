// Snapshots at the HTTP door: the parameter database of an axis: save, compare, restore. In: a client. Out: documents.
import type { Client } from './client';
import type { MaybeValue } from './types';

export interface Snapshot {
  n: number;
  name: string;
  comment?: string | null;
  at?: string;
  who?: string | null;
  from?: string;
  /** Of the drives that it was taken of; null: taken by an older program. */
  family?: string | null;
  /** How many. */
  values?: number;
  parameters?: number | unknown[];
}
export interface DiffRow {
  parameter: string;
  name: string;
  unit: string | null;
  snapshot: MaybeValue;
  other: MaybeValue;
  /** false: nobody said what it is there. An older gateway does not tell. */
  other_known?: boolean;
  same: boolean;
  writable: boolean;
}
export interface RestoreChange {
  parameter: string;
  from: MaybeValue;
  to: MaybeValue;
}
export interface RestoreReport {
  changes?: RestoreChange[];
  skipped?: { parameter: string; why: string }[];
  changed?: (RestoreChange | string)[];
  failed?: { parameter: string; reason: string }[];
}

const part = encodeURIComponent;

export class SnapshotDoor {
  constructor(
    private readonly client: Client,
    private readonly axis: string,
  ) {}
  private path = (rest = '') => `/axes/${part(this.axis)}/snapshots${rest}`;

  list = () => this.client.call<Snapshot[]>(this.path());
  /** Reading all parameters from a drive on a slow line takes its time. */
  save = (body: { name: string; comment: string; from: string }) => this.client.call<Snapshot>(this.path(), { method: 'POST', body, timeout_ms: 180_000 });
  remove = (n: number) => this.client.call<void>(this.path(`/${n}`), { method: 'DELETE' });
  diff = (n: number, other: string) => this.client.call<{ with: string; text?: string; rows: DiffRow[] }>(this.path(`/${n}/diff?with=${part(other)}`), { timeout_ms: 180_000 });
  restore = (n: number, body: { parameters?: string[]; dry_run: boolean; include_live?: boolean }) => this.client.call<RestoreReport>(this.path(`/${n}/restore`), { method: 'POST', body, timeout_ms: 180_000 });
}
