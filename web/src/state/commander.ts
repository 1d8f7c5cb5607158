// Commander: what people tell an axis, and the answer in words. In: commands of tiles and keys. Out: requests, one note per axis.
// A stop never waits: it goes past the queue of the page, drops what waits there, and is said again when a motion that was still on
// its way has been answered, so that it cannot be overtaken. It may be said while the page is not live; nothing else may.
// What was taken is followed until its axis shows how it ended; a refusal goes with its cause. Never repeats a motion by itself.
import { signal, type Signal } from '@preact/signals';
import type { Client } from '../api/client';
import { asProblem, Problem } from '../api/problem';
import type { Axis, Command, CommandAnswer } from '../api/types';
import { t } from '../language';
import { causeOf, isWatched, outcomeOf, type Watched } from '../text/outcome';
import { plain } from '../text/plain';
import { reasonWord } from '../text/reason';

/** `partly`: taken, but not by all who were meant. */
export type NoteTone = 'none' | 'busy' | 'good' | 'partly' | 'refused';
export interface Note {
  tone: NoteTone;
  text: string;
}
const quiet: Note = { tone: 'none', text: '' };
const goodStays_ms = 20_000;

const motions = new Set(['move_absolute', 'move_relative', 'move_velocity', 'home', 'enable']);
const isMotion = (c: Command) => motions.has(c.command);

export class Commander {
  /** The answer to "stop all". */
  readonly stopReport: Signal<Note> = signal(quiet);
  private readonly notes = new Map<string, Signal<Note>>();
  private readonly onTheirWay = new Map<string, number>();
  private readonly stopsWanted = new Set<string>();
  private readonly serial = new Map<string, number>();
  private readonly watched = new Map<string, Watched & { text: string; mine: number }>();
  /** Refusals, and what their axis showed then: with another it is over. */
  private readonly causes = new Map<string, { note: Note; reason: string; cause: string }>();

  constructor(
    private readonly client: Pick<Client, 'command' | 'dropWaitingCommands' | 'axes'>,
    /** Why commands other than stops cannot be given now; empty: they can. */
    private readonly blocked: () => string = () => '',
    /** Nobody answers for the axis: what the gateway takes for it, it takes alone. */
    private readonly offline: (axis: string) => boolean = () => false,
    /** The axis as it was last told, and the gateway's clock. */
    private readonly known: (axis: string) => Axis | undefined = () => undefined,
    private readonly now_ms: () => number = Date.now,
  ) {}

  /** The axis as it is now: a command that was taken may have ended, a refusal may have lost its cause. */
  look(axis: Axis): void {
    const { name } = axis;
    const w = this.watched.get(name);
    if (w) {
      const outcome = this.serial.get(name) === w.mine ? outcomeOf(w, axis) : { tone: 'none' as const, text: '' };
      if (outcome) this.watched.delete(name);
      if (outcome?.text) this.tell(name, outcome.tone, t('{what}: {how}', { what: w.text, how: outcome.text }), 'interrupted', axis);
      else if (outcome && this.serial.get(name) === w.mine) this.note(name).value = quiet;
    }
    const r = this.causes.get(name);
    if (!r) return;
    const over = r.reason === 'blocked' ? this.blocked() === '' : causeOf(r.reason, axis) !== r.cause;
    if (this.note(name).peek() !== r.note) this.causes.delete(name);
    else if (over) {
      this.causes.delete(name);
      this.note(name).value = quiet;
    }
  }

  note(axis: string): Signal<Note> {
    let n = this.notes.get(axis);
    if (!n) this.notes.set(axis, (n = signal(quiet)));
    return n;
  }

  /** `reason`: the gateway's word for a refusal, by which it is known when it is over. */
  tell(axis: string, tone: NoteTone, text: string, reason = '', now = this.known(axis)): void {
    const n = this.note(axis);
    n.value = { tone, text };
    this.fade(n);
    const cause = reason === 'blocked' ? reason : causeOf(reason, now);
    if (tone === 'refused' && cause) this.causes.set(axis, { note: n.peek(), reason, cause });
    else this.causes.delete(axis);
  }

  /** What was told of the axis is over: the field that it was about has another text. */
  forget(axis: string, reported: Note): void {
    if (this.note(axis).peek() === reported) this.note(axis).value = quiet;
  }

  /** Without a connection nothing green stands: what was accepted may be otherwise by now. */
  forgetGood(): void {
    for (const n of this.notes.values()) if (n.peek().tone === 'good') n.value = quiet;
  }

  /** Good news leaves after a while, so that it is not read as the answer to something later. Refusals stay until the next command. */
  private fade(of: Signal<Note>): void {
    const reported = of.peek();
    if (reported.tone !== 'good' && reported.tone !== 'partly') return;
    setTimeout(() => {
      if (of.peek() === reported) of.value = quiet;
    }, goodStays_ms);
  }

  async send(axis: string, command: Command, text: string): Promise<CommandAnswer | Problem> {
    const why = isStop(command) ? '' : this.blocked();
    const mine = this.begin(axis);
    if (why) {
      this.tell(axis, 'refused', t('{what}: not sent. {why}', { what: text, why }), 'blocked');
      return new Problem('cancelled', why);
    }
    this.tell(axis, 'busy', t('{what} …', { what: text }));
    if (isMotion(command)) this.onTheirWay.set(axis, (this.onTheirWay.get(axis) ?? 0) + 1);
    let result: CommandAnswer | Problem;
    try {
      result = await this.client.command(axis, command, isStop(command));
    } catch (error) {
      result = asProblem(error);
    }
    if (isMotion(command)) this.arrived(axis);
    if (this.serial.get(axis) !== mine) return result;
    this.tell(axis, ...noteOf(text, result), 'result' in result ? '' : result.reason);
    if ('result' in result && isWatched(command)) this.watched.set(axis, { command, text, mine, taken_ms: this.now_ms(), moved: false, target: undefined });
    return result;
  }

  /** Stops one axis: the quick stop; a drive that has none gets a halt. */
  async stop(axis: string): Promise<Problem | null> {
    this.client.dropWaitingCommands(t('a stop came first'));
    if ((this.onTheirWay.get(axis) ?? 0) > 0) this.stopsWanted.add(axis);
    const mine = this.begin(axis);
    this.tell(axis, 'busy', t('Stop …'));
    const problem = await this.stopOnce(axis);
    if (this.serial.get(axis) === mine) {
      if (!problem && this.offline(axis)) this.tell(axis, 'partly', t('Stop: sent, but the axis is offline: nobody confirms it'));
      else if (!problem) this.tell(axis, 'good', t('Stop: accepted'));
      else this.tell(axis, 'refused', t('Stop NOT confirmed: {why}', { why: problem.text }));
    }
    return problem;
  }

  /** `known` null: the page does not know yet which axes there are; the gateway is asked first. */
  async stopAll(known: readonly string[] | null): Promise<void> {
    let axes = known ?? [];
    if (!known) {
      this.stopReport.value = { tone: 'busy', text: t('Stopping all axes …') };
      try {
        axes = (await this.client.axes(true)).map((a) => a.name);
      } catch (error) {
        this.stopReport.value = { tone: 'refused', text: t('NOT stopped: the gateway did not say which axes there are. {why}', { why: capital(asProblem(error).text) }) };
        return;
      }
    }
    if (axes.length === 0) {
      this.stopReport.value = { tone: 'good', text: t('There is no axis to stop.') };
      return;
    }
    this.stopReport.value = { tone: 'busy', text: axes.length === 1 ? t('Stopping 1 axis …') : t('Stopping {n} axes …', { n: axes.length }) };
    const answers = await Promise.all(axes.map(async (a) => ({ axis: a, problem: await this.stop(a) })));
    const away = answers.filter((a) => this.offline(a.axis));
    const bad = answers.filter((a) => a.problem && !this.offline(a.axis));
    const good = axes.length - bad.length - away.length;
    if (bad.length === 0 && away.length > 0) {
      this.stopReport.value = { tone: 'partly', text: t('Stop accepted by {good} of {all}; {away} offline: nobody confirms {names}.', { good, all: axes.length, away: away.length, names: some(away) }) };
      this.fade(this.stopReport);
    } else if (bad.length === 0) {
      this.stopReport.value = { tone: 'good', text: axes.length === 1 ? t('Stop accepted by the axis.') : t('Stop accepted by all {n} axes.', { n: axes.length }) };
      this.fade(this.stopReport);
    } else {
      const why = bad[0]?.problem?.text ?? '';
      this.stopReport.value = { tone: 'refused', text: away.length > 0 ? t('Stop accepted by {good} of {all}; {away} offline. NOT confirmed by {names}: {why}', { good, all: axes.length, away: away.length, names: some(bad), why }) : t('Stop accepted by {good} of {all}. NOT confirmed by {names}: {why}', { good, all: axes.length, names: some(bad), why }) };
    }
  }

  private async stopOnce(axis: string): Promise<Problem | null> {
    try {
      await this.client.command(axis, { command: 'quick_stop' }, true);
      return null;
    } catch (error) {
      const problem = asProblem(error);
      if (problem.reason !== 'not_supported') return problem;
    }
    try {
      await this.client.command(axis, { command: 'halt' }, true);
      return null;
    } catch (error) {
      return asProblem(error);
    }
  }

  /** A motion has been answered. If a stop was said meanwhile, it is said again now. */
  private arrived(axis: string): void {
    const left = (this.onTheirWay.get(axis) ?? 1) - 1;
    this.onTheirWay.set(axis, left);
    if (left === 0 && this.stopsWanted.delete(axis)) void this.stopOnce(axis);
  }

  private begin(axis: string): number {
    const mine = (this.serial.get(axis) ?? 0) + 1;
    this.serial.set(axis, mine);
    return mine;
  }
}

const isStop = (c: Command) => c.command === 'quick_stop' || c.command === 'halt' || c.command === 'disable';

function noteOf(text: string, result: CommandAnswer | Problem): [NoteTone, string] {
  if ('result' in result) {
    const published = [result.reason && reasonWord(result.reason), plain(result.text)].filter(Boolean).join('. ');
    const how = result.result === 'done' ? t('done') : t('accepted');
    return ['good', published ? t('{what}: {how}. {more}', { what: text, how, more: published }) : t('{what}: {how}', { what: text, how })];
  }
  const failed = result.document.result === 'failed' || result.kind !== 'answered';
  const why = capital(result.text);
  return ['refused', failed ? t('{what}: failed. {why}', { what: text, why }) : t('{what}: refused. {why}', { what: text, why })];
}

const some = (all: readonly { axis: string }[]): string => {
  const names = all.slice(0, 4).map((a) => a.axis).join(', ');
  return all.length > 4 ? t('{names} and {n} more', { names, n: all.length - 4 }) : names;
};

export const capital = (s: string): string => s.charAt(0).toUpperCase() + s.slice(1);
