// Recipe draft: one recipe as forms and as JSON at once, with what the gateway finds wrong in it, and the way to the gateway and back. In: what is typed, on either
// side. Out: requests, only when they are asked for. The forms always show the last text that was JSON; what was typed is never overwritten unseen.
import { computed, signal, type Signal } from '@preact/signals';
import type { Client } from '../api/client';
import { Problem } from '../api/problem';
import type { Fault } from '../api/types';
import { t } from '../language';
import { documentOf, unknownAxes, unknownText, type RecipeDocument } from '../text/recipe';
import { capital, type Note } from './commander';
import { RecipeFile, type RecipeClash, type RecipeOutcome } from './recipe-file';
import { quiet } from './reported';

const checkAfter_ms = 300;
const textOf = (d: RecipeDocument) => JSON.stringify(d, null, 2);

export class RecipeDraft {
  readonly text = signal('');
  readonly document: Signal<RecipeDocument | null> = signal(null);
  /** Why the text is no JSON. */
  readonly textFault = signal('');
  readonly faults: Signal<readonly Fault[]> = signal([]);
  /** The text that the gateway has. */
  readonly stored = signal('');
  readonly result: Signal<Note> = signal(quiet);
  readonly clash: Signal<(RecipeClash & { act: 'save' | 'remove' }) | null> = signal(null);
  readonly unsaved = computed(() => this.document.value !== null && this.text.value !== this.stored.value);
  private readonly file: RecipeFile;

  constructor(
    private readonly client: Pick<Client, 'whole' | 'checkRecipe'>,
    private readonly name: string,
    /** The axes of the site; null: they are not known yet. */
    private readonly axes: () => readonly string[] | null,
  ) {
    this.file = new RecipeFile(client, name);
  }

  /** Once only: after that, what is typed stands against the state that was read, and the gateway tells whether it still is the one. */
  readonly load = async (): Promise<void> => {
    if (this.document.peek()) return;
    const d = await this.file.read();
    this.put(d ?? { description: '', steps: [] });
    if (d) this.stored.value = this.text.peek();
  };

  /** From the forms. */
  readonly put = (d: RecipeDocument): void => {
    this.document.value = d;
    this.text.value = textOf(d);
    this.textFault.value = '';
  };
  /** From the text. */
  type(typed: string): void {
    const read = documentOf(typed);
    if ('document' in read) this.document.value = read.document;
    this.textFault.value = 'fault' in read ? read.fault : '';
    this.text.value = typed;
  }

  /** The gateway says what is wrong, shortly after the last change. Out: how to end it. */
  checkSoon(): (() => void) | undefined {
    const d = this.document.peek();
    if (!d || d.steps.length === 0 || this.textFault.peek()) return;
    let here = true;
    const timer = setTimeout(() => {
      this.client.checkRecipe(this.name, d).then(
        () => here && (this.faults.value = []),
        (e) => here && (this.faults.value = e instanceof Problem ? faultsOf(e) : []),
      );
    }, checkAfter_ms);
    return () => {
      here = false;
      clearTimeout(timer);
    };
  }

  async save(): Promise<void> {
    const d = this.document.peek();
    if (!d || this.textFault.peek()) return;
    const sent = this.text.peek();
    const outcome = await this.file.save(d);
    this.clash.value = outcome.good || !outcome.clash ? null : { ...outcome.clash, act: 'save' };
    if (outcome.good) {
      this.stored.value = sent;
      this.faults.value = [];
      const axes = this.axes();
      const nobody = axes ? unknownAxes(d, axes) : [];
      this.result.value = nobody.length > 0 ? { tone: 'partly', text: t('Saved. But {nobody}', { nobody: unknownText(nobody) }) } : { tone: 'good', text: t('Saved.') };
    } else if (!outcome.clash) {
      this.faults.value = faultsOf(outcome.problem);
      this.result.value = { tone: 'refused', text: capital(outcome.problem.text) };
    }
  }
  /** Goes on from what somebody else has made of it. */
  adopt(): void {
    const now = this.clash.peek()?.now ?? null;
    this.clash.value = null;
    this.put(now ?? { description: '', steps: [] });
    this.stored.value = now ? this.text.peek() : '';
    this.result.value = { tone: 'none', text: t('In view is what the gateway has now.') };
  }
  /** Whether it is gone. */
  async remove(): Promise<boolean> {
    const outcome: RecipeOutcome = this.file.there ? await this.file.remove() : { good: true };
    if (outcome.good) return true;
    this.clash.value = outcome.clash ? { ...outcome.clash, act: 'remove' } : null;
    this.result.value = { tone: 'refused', text: capital(outcome.problem.text) };
    return false;
  }
}

const faultsOf = (p: Problem): Fault[] => (p.document.faults ?? []) as Fault[];
