// Recipe rehearsal: the newest rehearsal of one recipe against specimens, the ways to begin and to end one, and the specimens in words. In: the HTTP door.
// Out: the report with all rows so far, how the last request went. Rows that are here are not asked for again.
import { signal, type Signal } from '@preact/signals';
import type { Client } from '../api/client';
import type { RecipeRehearsal } from '../api/types';
import { t } from '../language';
import { quiet, refusal, type Reported } from './reported';

export type RehearsalClient = Pick<Client, 'recipeRehearsal' | 'rehearseRecipe' | 'cancelRehearsal' | 'specimen'>;
/** The words of a specimen in each family of the recipe. */
export type Words = readonly { family: string; specimen: string; words: readonly string[] }[];

export const isUnderWay = (r: RecipeRehearsal | null): boolean => r?.state === 'running' || r?.state === 'cancelling';

export class RecipeRehearsing {
  readonly report: Signal<RecipeRehearsal | null> = signal(null);
  readonly reported: Signal<Reported> = signal(quiet);
  /** What is typed as the specimens. */
  readonly typed: Signal<string> = signal('1..100');
  /** The specimen whose words are shown; empty: none. */
  readonly opened: Signal<string> = signal('');
  readonly words: Signal<Words> = signal([]);

  constructor(
    private readonly client: RehearsalClient,
    private readonly name: string,
  ) {}

  readonly load = async (): Promise<void> => void (this.report.value = await this.client.recipeRehearsal(this.name, 0));

  /** The rows since the last answer. */
  readonly look = async (): Promise<void> => {
    const known = this.report.peek();
    if (!known) return;
    const now = await this.client.recipeRehearsal(this.name, known.specimens.length).catch(() => null);
    if (!now || this.report.peek() !== known) return;
    // Another client has begun another one meanwhile: its rows are not a continuation of these.
    if (now.began_at !== known.began_at) return void (await this.load().catch(() => undefined));
    this.report.value = { ...now, specimens: [...known.specimens, ...now.specimens] };
  };

  async start(given: Record<string, unknown>): Promise<void> {
    this.reported.value = { tone: 'busy', text: t('Checking…') };
    try {
      this.report.value = await this.client.rehearseRecipe(this.name, { specimens: this.typed.peek().trim() || '1..100', arguments: given });
      this.reported.value = quiet;
      this.opened.value = '';
    } catch (error) {
      this.reported.value = refusal(error);
    }
  }

  async cancel(): Promise<void> {
    try {
      const now = await this.client.cancelRehearsal(this.name);
      this.report.value = now;
    } catch (error) {
      this.reported.value = refusal(error);
    }
  }

  /** Shows the words of this specimen in these families, or hides them. */
  async open(specimen: string, families: readonly string[]): Promise<void> {
    const fixed = (this.report.peek()?.families ?? {}) as Record<string, string>;
    this.words.value = [];
    if (this.opened.peek() === specimen) return void (this.opened.value = '');
    this.opened.value = specimen;
    try {
      const told = await Promise.all(families.map((f) => this.client.specimen(f, fixed[f] ?? specimen)));
      if (this.opened.peek() === specimen) this.words.value = told.map((s) => ({ family: s.family, specimen: s.specimen, words: s.words }));
    } catch (error) {
      this.reported.value = refusal(error);
    }
  }
}
