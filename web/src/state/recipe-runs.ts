// Recipe runs: the runs of one recipe: what is under way, those that were, and the ways to begin and to end one. In: the HTTP door, reports of the stream, what is
// typed for the recipe's parameters. Out: reports, how the last request went. What was typed stays, whatever becomes of the run. Never starts one by itself.
import { signal, type Signal } from '@preact/signals';
import type { Client } from '../api/client';
import type { RecipeReport, RecipeReportHead } from '../api/types';
import { t } from '../language';
import { argumentsOf, isOver, type RecipeDocument } from '../text/recipe';
import { quiet, refusal, type Reported } from './reported';

const begun = (n: number) => t('Run {n} has begun.', { n });

export class RecipeRuns {
  /** What is typed, by parameter. */
  readonly typed: Signal<Record<string, string>> = signal({});
  /** The newest, or the one that was looked for. */
  readonly report: Signal<RecipeReport | null> = signal(null);
  readonly runs: Signal<RecipeReportHead[]> = signal([]);
  readonly result: Signal<Reported> = signal(quiet);

  constructor(
    private readonly client: Pick<Client, 'recipeRuns' | 'recipeRun' | 'checkRun' | 'runRecipe' | 'cancelRun'>,
    private readonly name: string,
    private readonly parameters: () => NonNullable<RecipeDocument['parameters']>,
    /** How an axis is named in a sentence. */
    private readonly named: (axis: string) => string,
  ) {}

  /** With each connection anew: what ended while this page was away is told by no message any more. */
  readonly load = async (): Promise<void> => {
    const list = await this.client.recipeRuns(this.name);
    this.runs.value = list;
    const shown = this.report.peek();
    const n = shown ? (isOver(shown.state) ? null : shown.n) : list[0]?.n;
    if (n === null || n === undefined) return;
    const whole = await this.client.recipeRun(this.name, n);
    if (this.report.peek() === shown) this.take(whole);
  };

  /** What the stream tells, of any recipe. */
  heard(r: RecipeReport | undefined): void {
    if (r?.recipe !== this.name) return;
    this.take(r);
    if (isOver(r.state)) void this.client.recipeRuns(this.name).then((runs) => (this.runs.value = runs), () => undefined);
  }

  async start(dryRun: boolean): Promise<void> {
    this.result.value = { tone: 'none', text: dryRun ? t('Checking…') : t('Starting…') };
    try {
      const given = argumentsOf(this.parameters(), this.typed.peek());
      if (dryRun) {
        const c = await this.client.checkRun(this.name, given);
        this.result.value = { tone: 'good', text: t('Can run: {steps} steps, commands {n}.', { steps: c.steps, n: c.axes?.map(this.named).join(', ') || t('no axis') }) };
        return;
      }
      const first = await this.client.runRecipe(this.name, given);
      // A short run may have ended before its beginning was answered: what the stream has told of it is newer.
      if ((this.report.peek()?.n ?? 0) < first.n) this.report.value = first;
      const now = this.report.peek();
      this.result.value = { tone: 'good', text: isOver(now?.state ?? '') ? '' : begun(now?.n ?? 0) };
    } catch (error) {
      this.result.value = refusal(error);
    }
  }
  async cancel(n: number): Promise<void> {
    try {
      await this.client.cancelRun(this.name, n);
    } catch (error) {
      this.result.value = refusal(error);
    }
  }
  look(n: number): void {
    void this.client.recipeRun(this.name, n).then((w) => (this.report.value = w), () => undefined);
  }

  private take(r: RecipeReport): void {
    this.report.value = r;
    // "Run 1 has begun." is no news any more: its report says how it ended.
    if (isOver(r.state) && this.result.peek().text === begun(r.n)) this.result.value = quiet;
  }
}
