// A recipe at the gateway: read, saved and removed against the state that was last seen, so that nobody's work is overwritten unseen.
// In: the HTTP door. Out: the document, or what somebody else has made of it meanwhile; what was typed is never touched here.
// A gateway that names no states (no ETag) takes the last one that is saved, as it always did.
import type { Client } from '../api/client';
import { asProblem, Problem } from '../api/problem';
import { t } from '../language';
import { editable, type RecipeDocument } from '../text/recipe';

export interface RecipeClash {
  /** null: it is not there any more. */
  now: RecipeDocument | null;
  text: string;
}
export type RecipeOutcome = { good: true } | { good: false; problem: Problem; clash?: RecipeClash };

export class RecipeFile {
  /** The gateway has one of this name. */
  there = false;
  private tag = '';
  private readonly path: string;

  constructor(
    private readonly client: Pick<Client, 'whole'>,
    private readonly name: string,
  ) {
    this.path = `/recipes/${encodeURIComponent(name)}`;
  }

  /** null: there is none of this name yet. */
  async read(): Promise<RecipeDocument | null> {
    try {
      const r = await this.client.whole(this.path);
      this.tag = r.head.get('etag') ?? '';
      this.there = true;
      return editable(JSON.parse(r.text) as RecipeDocument);
    } catch (error) {
      if (asProblem(error).status !== 404) throw error;
      this.tag = '';
      this.there = false;
      return null;
    }
  }

  async save(document: object): Promise<RecipeOutcome> {
    return this.act(async () => {
      const r = await this.client.whole(this.path, { method: 'PUT', body: document, headers: this.meant() });
      this.tag = r.head.get('etag') ?? '';
      this.there = true;
    });
  }

  async remove(): Promise<RecipeOutcome> {
    return this.act(async () => {
      await this.client.whole(this.path, { method: 'DELETE', headers: this.meant() });
      this.there = false;
    });
  }

  private meant(): Record<string, string> {
    if (!this.there) return { 'if-none-match': '*' };
    return this.tag ? { 'if-match': this.tag } : {};
  }

  /** After a clash the state that was found is the one the next attempt is made against. */
  private async act(work: () => Promise<void>): Promise<RecipeOutcome> {
    try {
      await work();
      return { good: true };
    } catch (error) {
      const problem = asProblem(error);
      if (problem.status !== 412) return { good: false, problem };
      const was = this.there;
      try {
        const now = await this.read();
        const text = !now ? t('Somebody else has deleted {name} meanwhile.', { name: this.name }) : was ? t('Somebody else has changed {name} meanwhile.', { name: this.name }) : t('Somebody else has made a recipe {name} meanwhile.', { name: this.name });
        return { good: false, problem, clash: { now, text } };
      } catch {
        return { good: false, problem };
      }
    }
  }
}
