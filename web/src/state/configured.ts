// Configured values: what the DCF of a drive gives to its parameters, beside what the drive has: a list that a person sees, chooses from, and has written.
// In: the HTTP door. Out: signals. Nothing is written before it was shown; the first refusal ends the writing, and what was not sent stays chosen.
import { signal } from '@preact/signals';
import type { Client } from '../api/client';
import { asProblem } from '../api/problem';
import type { AxisParameter, Value } from '../api/types';
import { t } from '../language';
import { sameValue } from '../text/parameter';
import { parametersText } from '../text/transfer';
import { quiet, refusal, type Reported } from './reported';
import { toggledIn } from './toggled';

/** A value of the file that the gateway may write: what acts at once, or is how the drive is reached, is never one. */
export const isConfigured = (p: AxisParameter): boolean => p.configured !== undefined && p.configured !== null && p.access === 'RW' && !p.live && !p.addressing;

export interface Differing {
  /** With the value that the drive has now. */
  p: AxisParameter;
  wanted: Value;
}
type Door = Pick<Client, 'parameters' | 'parameter' | 'writeParameter'>;

export class ConfiguredList {
  /** How many values of the file can be compared; null: not known yet. */
  readonly of = signal<number | null>(null);
  /** Those in which the drive differs; null: not compared yet. */
  readonly differing = signal<readonly Differing[] | null>(null);
  readonly unread = signal<readonly string[]>([]);
  readonly chosen = signal<ReadonlySet<string>>(new Set());
  readonly reported = signal<Reported>(quiet);
  readonly busy = signal(false);
  private wanted: AxisParameter[] = [];

  constructor(
    private readonly door: Door,
    private readonly axis: string,
  ) {}

  readonly load = async (): Promise<void> => {
    this.wanted = (await this.door.parameters(this.axis)).filter(isConfigured);
    this.of.value = this.wanted.length;
  };

  /** Reads each of them from the drive. A value that was written through the gateway is newer than the file, so it is not chosen by itself. */
  async look(): Promise<void> {
    if (this.busy.peek()) return;
    this.busy.value = true;
    const [rows, unread]: [Differing[], string[]] = [[], []];
    for (const [i, known] of this.wanted.entries()) {
      this.reported.value = { tone: 'busy', text: t('Reading {id}: {done} of {n} …', { id: known.id, done: i + 1, n: this.wanted.length }) };
      try {
        const p = await this.door.parameter(this.axis, known.id);
        const wanted = (p.configured ?? known.configured) as Value;
        if (p.quality !== 'good') unread.push(p.id);
        else if (!sameValue(p.value, wanted)) rows.push({ p, wanted });
      } catch {
        unread.push(known.id);
      }
    }
    this.differing.value = rows;
    this.unread.value = unread;
    this.chosen.value = new Set(rows.filter((r) => r.p.written_at === null).map((r) => r.p.id));
    const n = this.wanted.length - unread.length;
    this.reported.value = { tone: unread.length > 0 ? 'refused' : 'good', text: rows.length === 0 ? t('The drive has {n} of {of} values of the file.', { n, of: this.wanted.length }) : t('{differ} of {n} values differ. Nothing has been written.', { differ: rows.length, n }) };
    this.busy.value = false;
  }

  choose(id: string): void {
    this.chosen.value = toggledIn(this.chosen.peek(), id);
  }

  async write(): Promise<void> {
    const rows = (this.differing.peek() ?? []).filter((r) => this.chosen.peek().has(r.p.id));
    if (this.busy.peek() || rows.length === 0) return;
    this.busy.value = true;
    let done = 0;
    try {
      for (const { p, wanted } of rows) {
        this.reported.value = { tone: 'busy', text: t('Writing {id}: {done} of {n} …', { id: p.id, done: done + 1, n: rows.length }) };
        await this.door.writeParameter(this.axis, p.id, wanted);
        done += 1;
        this.differing.value = (this.differing.peek() ?? []).filter((r) => r.p.id !== p.id);
        this.chosen.value = new Set([...this.chosen.peek()].filter((id) => id !== p.id));
      }
      this.reported.value = { tone: 'good', text: t('{done} written.', { done: parametersText(done) }) };
    } catch (error) {
      const id = rows[done]?.p.id ?? '';
      const left = rows.length - done - 1;
      this.reported.value = { ...refusal(error), text: t('{id}: {text}. {done} were written before it; {left} behind it were not sent.', { id, text: asProblem(error).text, done, left }) };
    }
    this.busy.value = false;
  }
}
