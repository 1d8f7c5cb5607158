// The book of mappings: what the gateway has, what this page changed in this session, and the way back. In: the HTTP door. Out: signals.
// Each change is made against the revision that was just read, so that nobody's work is overwritten unseen; undo puts back exactly the entries
// that the change touched, and refuses in words if somebody else has changed one of them since. At most 50 changes can be undone.
import { signal, type Signal } from '@preact/signals';
import type { MappingDoor, MappingImport, MappingList } from '../api/mappings';
import { asProblem, Problem } from '../api/problem';
import { midSentence, t } from '../language';
import { cellsOf, columns, differenceText, sameMapping, type Mapping, type MappingPoint, type MappingSpec } from '../text/mapping';
import { csvOf } from '../text/table-text';

const mostUndo = 50;

/** Entries by id before and after; null: not there. */
export interface Change {
  text: string;
  entries: Map<string, { before: Mapping | null; after: Mapping | null }>;
}

/** Somebody else was quicker: what it was when it was opened, what it is now. */
export interface Clash {
  id: string;
  text: string;
  now: Mapping | null;
}

export type Outcome = { good: true; text: string } | { good: false; text: string; problem?: Problem; clash?: Clash };

export class MappingBook {
  readonly rows: Signal<Mapping[]> = signal([]);
  readonly points: Signal<MappingPoint[]> = signal([]);
  readonly hash = signal('');
  readonly changes: Signal<Change[]> = signal([]);

  constructor(private readonly door: MappingDoor) {}

  async load(): Promise<void> {
    await this.read();
    if (this.points.peek().length === 0) this.points.value = await this.door.points();
  }

  add(spec: MappingSpec): Promise<Outcome> {
    return this.change(t('Added {point} of {axis}', { point: spec.point, axis: spec.axis ?? '' }), (list) => this.door.add(spec, list.revision));
  }

  /** `opened`: the entry as it was when the editing began; null: take whatever is there now. */
  async replace(id: string, spec: MappingSpec, opened: Mapping | null, text = t('Changed {id}', { id })): Promise<Outcome> {
    return this.change(text, (list) => {
      unchanged(list, opened ? [opened] : [], id);
      return this.door.replace(id, { ...spec, id }, list.revision);
    });
  }

  /** All or none of them: those with the id of a present entry take its place. `opened`: these entries as they were when they were picked up. */
  place(specs: readonly MappingSpec[], text: string, opened: readonly Mapping[] = []): Promise<Outcome> {
    return this.change(text, async (list) => {
      unchanged(list, opened);
      return (await this.door.table(csvOf([columns, ...specs.map((s) => cellsOf(s as Partial<Mapping>))]), { replace: false, dryRun: false, revision: list.revision })).revision;
    });
  }

  remove(id: string): Promise<Outcome> {
    return this.change(t('Removed {id}', { id }), (list) => this.door.remove(id, list.revision));
  }

  /** Several at once, so that one undo brings all of them back. */
  removeAll(gone: readonly Mapping[]): Promise<Outcome> {
    if (gone.length === 1) return this.remove(gone[0]!.id);
    return this.change(t('Removed {n} mappings', { n: gone.length }), async (list) => {
      unchanged(list, gone);
      const ids = new Set(gone.map((m) => m.id));
      const left = list.rows.filter((m) => !ids.has(m.id));
      return (await this.door.table(csvOf([columns, ...left.map(cellsOf)]), { replace: true, dryRun: false, revision: list.revision })).revision;
    });
  }

  table(csv: string, replace: boolean): Promise<Outcome> {
    return this.change(replace ? t('Replaced all by a table') : t('Added a table'), async (list) => (await this.door.table(csv, { replace, dryRun: false, revision: list.revision })).revision);
  }

  async dryRun(csv: string, replace: boolean): Promise<MappingImport | Problem> {
    try {
      return (await this.door.table(csv, { replace, dryRun: true })).report;
    } catch (error) {
      return asProblem(error);
    }
  }

  template(axis: string, unit: number, address: number): Promise<Outcome> {
    return this.change(t('Added the standard map of {axis}', { axis }), async () => {
      await this.door.template({ template: 'standard_map', axis, unit, address, dry_run: false });
      return '';
    });
  }

  async undo(): Promise<Outcome> {
    const last = this.changes.peek().at(-1);
    if (!last) return { good: false, text: t('There is nothing to undo.') };
    try {
      const now = await this.read();
      const byId = new Map(now.rows.map((m) => [m.id, m]));
      for (const [id, e] of last.entries) {
        if (!sameMapping(byId.get(id) ?? null, e.after)) {
          return { good: false, text: t('Not undone: somebody else has changed {id} since ({difference}). Nothing was touched.', { id, difference: differenceText(e.after, byId.get(id)) }) };
        }
      }
      const restored = now.rows.flatMap((m) => {
        const e = last.entries.get(m.id);
        return e ? (e.before ? [e.before] : []) : [m];
      });
      for (const e of last.entries.values()) if (e.before && !byId.has(e.before.id)) restored.push(e.before);
      await this.door.table(csvOf([columns, ...restored.map(cellsOf)]), { replace: true, dryRun: false, revision: now.revision });
      this.changes.value = this.changes.peek().slice(0, -1);
      await this.read();
      return { good: true, text: t('Undone: {what}.', { what: midSentence(last.text) }) };
    } catch (error) {
      const problem = asProblem(error);
      return { good: false, text: t('Not undone: {why}', { why: problem.text }), problem };
    }
  }

  private async change(text: string, act: (list: MappingList) => Promise<string>): Promise<Outcome> {
    try {
      const before = await this.read();
      const revision = await act(before);
      const after = await this.read().catch(() => null);
      // Only if nobody came between is the difference of the two lists our own.
      if (after && (revision === '' || revision === after.revision)) this.remember(text, before.rows, after.rows);
      return { good: true, text: `${text}.` };
    } catch (error) {
      if (error instanceof ClashError) return { good: false, text: error.clash.text, clash: error.clash };
      const problem = asProblem(error);
      return { good: false, text: problem.text, problem };
    }
  }

  private remember(text: string, before: Mapping[], after: Mapping[]): void {
    const entries: Change['entries'] = new Map();
    const old = new Map(before.map((m) => [m.id, m]));
    for (const m of after) if (!sameMapping(old.get(m.id), m)) entries.set(m.id, { before: old.get(m.id) ?? null, after: m });
    const left = new Set(after.map((m) => m.id));
    for (const m of before) if (!left.has(m.id)) entries.set(m.id, { before: m, after: null });
    if (entries.size > 0) this.changes.value = [...this.changes.peek(), { text, entries }].slice(-mostUndo);
  }

  private async read(): Promise<MappingList> {
    const list = await this.door.list();
    this.rows.value = list.rows;
    this.hash.value = list.hash;
    return list;
  }
}

/** What was opened is still what is there, or the difference is thrown. */
function unchanged(list: MappingList, opened: readonly Mapping[], only?: string): void {
  for (const o of opened) {
    const now = list.rows.find((m) => m.id === (only ?? o.id)) ?? null;
    if (!sameMapping(now, o)) throw new ClashError({ id: o.id, now, text: t('Somebody else has changed {id} meanwhile: {difference}.', { id: o.id, difference: differenceText(o, now) }) });
  }
}

class ClashError extends Error {
  constructor(readonly clash: Clash) {
    super(clash.text);
  }
}
