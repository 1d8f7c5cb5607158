// Parameter table: the parameters of one axis as rows: listed, read, read again without being asked, written, and which of them a filter shows. In: the HTTP
// door, what is typed in a row. Out: rows, each with its value and how its last request went. Reading all goes one by one and can be ended; a slow
// drive is not flooded. What was typed stays until the drive took it. Never reads a clock of its own.
import { signal, type Signal } from '@preact/signals';
import type { Client } from '../api/client';
import type { AxisParameter, GatewayEvent } from '../api/types';
import { t } from '../language';
import { readValue, sameValue, searchRank, valueText } from '../text/parameter';
import { isMarked, type Marked } from '../text/transfer';
import { capital } from './commander';
import { quiet, refusal, type Reported } from './reported';
import { dueNext } from './reread';

export interface Row {
  data: Signal<AxisParameter>;
  note: Signal<Reported>;
  /** What is typed; null: the field shows nothing of its own. */
  typed: Signal<string | null>;
  /** The value that was asked about before it is written: the drive is reached by this parameter. */
  asked: Signal<string | null>;
  /** When reading it without being asked was last refused, by the gateway's clock. */
  refused_ms: number | null;
}
export const newRow = (p: AxisParameter): Row => ({ data: signal(p), note: signal(quiet), typed: signal(null), asked: signal(null), refused_ms: null });

export const isLongArray = (p: AxisParameter) => p.count !== null && p.count > 0 && !/\]$/.test(p.id);
export const receivedAt = (p: AxisParameter): number | null => (p.at === null ? null : Date.parse(p.at));
const isReadable = (p: AxisParameter) => p.access !== 'W' && !isLongArray(p);

export interface Filter {
  search: string;
  group: string;
}
/** Whether a row is looked for, whatever its value is. */
export const isSought = (row: Row, { search, group }: Filter): boolean => searchRank(row.data.peek(), search) !== null && (group === '' || row.data.peek().group === group);

/** The rows that are shown: the best fit of what is searched first, equals in the order of the manual. */
export const matching = (rows: readonly Row[], filter: Filter, mark: Marked): Row[] =>
  rows
    .filter((row) => isSought(row, filter) && isMarked(row.data.peek(), mark))
    .map((row) => ({ row, rank: searchRank(row.data.peek(), filter.search) ?? 0 }))
    .sort((x, y) => x.rank - y.rank)
    .map(({ row }) => row);

export class ParameterTable {
  readonly rows: Signal<Row[]> = signal([]);
  /** Else why the list is not there. */
  readonly loaded: Signal<'waiting' | 'there' | string> = signal('waiting');
  /** How far reading all of them is; null: it is not under way. */
  readonly progress: Signal<{ done: number; of: number } | null> = signal(null);
  /** What was read before is old: a command, or a lost connection, has come since. The gateway's clock. */
  readonly since_ms = signal(0);
  private reading: AbortController | null = null;

  constructor(
    private readonly client: Pick<Client, 'parameters' | 'parameter' | 'writeParameter'>,
    private readonly axis: string,
    /** The gateway's clock. */
    private readonly now_ms: () => number,
  ) {}

  /** A row that is known stays, with what is typed in it. */
  async load(end: AbortSignal): Promise<void> {
    try {
      const list = await this.client.parameters(this.axis, {}, end);
      const before = new Map(this.rows.peek().map((r) => [r.data.peek().id, r]));
      this.rows.value = list.map((p) => {
        const known = before.get(p.id);
        if (known) known.data.value = p;
        return known ?? newRow(p);
      });
      this.loaded.value = 'there';
    } catch (error) {
      if (!end.aborted && this.rows.peek().length === 0) this.loaded.value = refusal(error).text;
    }
  }

  /** From now on what was read is old. */
  age(): void {
    this.since_ms.value = this.now_ms();
  }

  /** After a command first what was read before it; after a change by anybody that parameter, and those whose unit and range hang on it. */
  heard(e: Pick<GatewayEvent, 'axis' | 'kind' | 'parameter'>): void {
    if (e.axis !== this.axis) return;
    if (e.kind === 'command') this.age();
    if (!e.parameter) return;
    for (const row of this.rows.peek()) {
      const { id, alternate } = row.data.peek();
      if (id !== e.parameter && alternate?.parameter !== e.parameter) continue;
      void this.client.parameter(this.axis, id, { cached: true }).then((p) => (row.data.value = p), () => undefined);
    }
  }

  readonly read = async (row: Row, end?: AbortSignal): Promise<void> => {
    row.note.value = { tone: 'busy', text: t('Reading …') };
    row.refused_ms = null;
    try {
      const p = await this.client.parameter(this.axis, row.data.peek().id, {}, end);
      row.data.value = p;
      row.note.value = p.quality === 'stale' ? { tone: 'refused', text: capital(p.text || 'stale') } : quiet;
    } catch (error) {
      row.note.value = end?.aborted ? quiet : refusal(error);
    }
  };

  async readAll(rows: readonly Row[]): Promise<void> {
    const { signal: end } = (this.reading = new AbortController());
    const wanted = rows.filter((r) => isReadable(r.data.peek()));
    this.progress.value = { done: 0, of: wanted.length };
    for (const [i, row] of wanted.entries()) {
      if (end.aborted) break;
      await this.read(row, end);
      this.progress.value = { done: i + 1, of: wanted.length };
    }
    this.progress.value = null;
    this.reading = null;
  }
  endReading(): void {
    this.reading?.abort();
  }

  /** Without being asked, one of those on the screen: an answer is shown, a refusal leaves what is there, and its age tells the rest. Out: whether one was due. */
  async rereadDue(onScreen: ReadonlySet<string>, end: AbortSignal): Promise<boolean> {
    const wanted = this.reading ? [] : this.rows.peek().filter((r) => onScreen.has(r.data.peek().id) && isReadable(r.data.peek()) && r.note.peek().tone !== 'busy');
    const row = dueNext(wanted.map((of) => ({ of, at_ms: receivedAt(of.data.peek()), refused_ms: of.refused_ms })), this.now_ms(), this.since_ms.peek())?.of;
    if (!row) return false;
    try {
      const p = await this.client.parameter(this.axis, row.data.peek().id, {}, end);
      row.refused_ms = p.quality === 'good' ? null : this.now_ms();
      row.data.value = p;
    } catch {
      row.refused_ms = this.now_ms();
    }
    return true;
  }

  /** What is typed in the row; by which the drive is reached, only after a question. */
  readonly write = async (row: Row): Promise<void> => {
    const p = row.data.peek();
    const sent = row.typed.peek();
    const value = readValue(sent ?? '', p);
    if (!value.good) return void (row.note.value = { tone: 'refused', text: value.why });
    if (p.addressing && row.asked.peek() !== sent) {
      row.asked.value = sent;
      row.note.value = quiet;
      return;
    }
    row.asked.value = null;
    row.note.value = { tone: 'busy', text: t('Writing …') };
    try {
      const answer = await this.client.writeParameter(this.axis, p.id, value.value);
      row.data.value = { ...row.data.peek(), value: answer.value, quality: 'good' };
      row.note.value = { tone: 'good', text: sameValue(answer.value, value.value) ? t('Written.') : t('Written; the drive took {value}.', { value: valueText(answer.value, p) }) };
      if (row.typed.peek() === sent) row.typed.value = null; // what was typed since then stays
      row.data.value = await this.client.parameter(this.axis, p.id, { cached: true });
    } catch (error) {
      if (row.note.peek().tone === 'good') return; // it was written; only the look afterwards failed
      row.note.value = refusal(error);
    }
  };

  /** The next elements of an array, below it. */
  readonly open = async (row: Row): Promise<void> => {
    const p = row.data.peek();
    const known = this.rows.peek().filter((r) => r.data.peek().id.startsWith(`${p.id}[`));
    row.note.value = { tone: 'busy', text: t('Listing …') };
    try {
      const list = await this.client.parameters(this.axis, { array: p.id, first: (p.first ?? 0) + known.length });
      const at = this.rows.peek().indexOf(row) + known.length + 1;
      this.rows.value = this.rows.peek().toSpliced(at, 0, ...list.map(newRow));
      row.note.value = { tone: 'none', text: t('{n} of {count} elements are listed below.', { n: known.length + list.length, count: p.count ?? 0 }) };
    } catch (error) {
      row.note.value = refusal(error);
    }
  };
}
