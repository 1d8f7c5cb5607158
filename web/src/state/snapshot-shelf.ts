// Snapshot shelf: the snapshots of an axis: listed, saved, looked at before they are restored, restored, removed. In: the HTTP door. Out: the list, what a restore
// would change, how the last request went. A restore is never sent before its changes have been told; what acts at once goes only if that is chosen.
import { signal, type Signal } from '@preact/signals';
import type { RestoreReport, Snapshot, SnapshotDoor } from '../api/snapshots';
import type { AxisParameter } from '../api/types';
import { t } from '../language';
import { parametersText } from '../text/transfer';
import { emptied } from './persisted';
import { quiet, tellOf, type Reported } from './reported';
import { toggledIn } from './toggled';

/** Names and units of parameters, by id. */
export type Shapes = ReadonlyMap<string, AxisParameter>;
export interface Restoring {
  snapshot: Snapshot;
  report: RestoreReport;
  /** Parameters that are to be written. */
  chosen: ReadonlySet<string>;
}

export class SnapshotShelf {
  readonly list: Signal<Snapshot[]> = signal([]);
  readonly reported: Signal<Reported> = signal(quiet);
  readonly restoring: Signal<Restoring | null> = signal(null);
  /** Whether what acts at once is restored, too. */
  readonly live = signal(false);
  readonly shapes: Signal<Shapes> = signal(new Map());

  constructor(
    private readonly door: Pick<SnapshotDoor, 'list' | 'save' | 'restore' | 'remove'>,
    private readonly parameters: () => Promise<AxisParameter[]>,
    private readonly listed: (list: Snapshot[]) => void,
  ) {}

  readonly load = async (): Promise<void> => {
    this.list.value = await this.door.list();
    this.listed(this.list.value);
  };

  /** `from`: of the device, or as stored. What is typed meanwhile stays. */
  save(name: Signal<string>, comment: Signal<string>, from: string): Promise<boolean> {
    return this.tell(from === 'device' ? t('Reading all parameters from the drive …') : t('Saving …'), async () => {
      const sent = { name: name.peek(), comment: comment.peek() };
      const s = await this.door.save({ name: sent.name.trim(), comment: sent.comment.trim(), from });
      emptied(name, sent.name);
      emptied(comment, sent.comment);
      await this.again();
      return t('Saved as {n}.', { n: s.n });
    });
  }

  /** What a restore would change; nothing is written. */
  look(s: Snapshot, withLive = this.live.peek()): Promise<boolean> {
    return this.tell(t('Comparing with the drive …'), async () => {
      const report = await this.door.restore(s.n, withLive ? { dry_run: true, include_live: true } : { dry_run: true });
      // Names and units only: what is to be written is in the report.
      if (this.shapes.peek().size === 0) this.shapes.value = new Map((await this.parameters().catch(() => [])).map((x) => [x.id, x]));
      this.live.value = withLive;
      this.restoring.value = { snapshot: s, report, chosen: new Set((report.changes ?? []).map((c) => c.parameter)) };
      return report.changes?.length ? t('Nothing has been changed yet.') : t('The drive has all values of {name} already.', { name: s.name });
    });
  }
  /** A mark that is changed while changes are in sight: they are looked at again. */
  setLive(on: boolean): void {
    this.live.value = on;
    const r = this.restoring.peek();
    if (r) void this.look(r.snapshot, on);
  }
  choose(parameter: string): void {
    const r = this.restoring.peek();
    if (r) this.restoring.value = { ...r, chosen: toggledIn(r.chosen, parameter) };
  }

  async restore(): Promise<void> {
    const r = this.restoring.peek();
    if (!r || r.chosen.size === 0) return;
    await this.tell(t('Writing {size} …', { size: parametersText(r.chosen.size) }), async () => {
      const done = await this.door.restore(r.snapshot.n, { parameters: [...r.chosen], dry_run: false, ...(this.live.peek() ? { include_live: true } : {}) });
      this.restoring.value = null;
      const failed = done.failed ?? [];
      if (failed.length > 0) throw new Error(t('{n} written; NOT written: {n2}', { n: done.changed?.length ?? 0, n2: failed.map((f) => `${f.parameter} (${f.reason})`).join(', ') }));
      return t('{n} restored from {name}.', { n: parametersText(done.changed?.length ?? r.chosen.size), name: r.snapshot.name });
    });
  }
  remove(s: Snapshot): Promise<boolean> {
    return this.tell(t('Removing …'), async () => {
      await this.door.remove(s.n);
      await this.again();
      return t('{name} is deleted.', { name: s.name });
    });
  }

  /** What was done is done, whether or not the list can be read after it. */
  private again = () => this.load().catch(() => undefined);
  private tell = (busy: string, act: () => Promise<string>) => tellOf(this.reported, busy, act, (text) => text);
}
