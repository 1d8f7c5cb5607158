// Site draft: what is typed for the site, until it is applied; what the gateway says of it; and the way through stage, apply, keep or roll back.
// In: the HTTP door. Out: signals. The draft survives a change of page and a reload. Another person's change is shown, and mine are put on top of it
// only when I say so. A gateway without staging gets the whole document at once, after a dry run; that there is no roll back is said.
import { computed, effect, signal, type ReadonlySignal } from '@preact/signals';
import { asProblem, type Problem } from '../api/problem';
import type { Client } from '../api/client';
import { SiteDoor, type SiteFault, type Stage } from '../api/site';
import { differenceOf, rebase, sameDocument, withEntry, withoutEntry, type Difference, type Entry, type Room, type Site } from '../words/site';
import { kept } from './kept';

export interface Told {
  tone: 'none' | 'busy' | 'good' | 'refused';
  text: string;
}
const none: Stage = { state: 'none' };
const absent = (p: Problem) => p.status === 404 || p.status === 405 || p.status === 501;

export class SiteDraft {
  /** 'waiting', 'there', or why it is not there. */
  readonly state = signal<string>('waiting');
  /** The site in force that the draft began from. */
  readonly base = signal<Site>({});
  readonly draft = signal<Site>({});
  readonly changes: ReadonlySignal<Difference[]>;
  /** Somebody else's site, while the draft still stands on an older one. */
  readonly theirs = signal<{ site: Site; tag: string; changes: Difference[] } | null>(null);
  readonly stage = signal<Stage>(none);
  /** null: not known yet. */
  readonly offersStage = signal<boolean | null>(null);
  /** Faults of the last check, for the document `checked`. */
  readonly faults = signal<SiteFault[]>([]);
  readonly checked = signal<Site | null>(null);
  readonly disturbs = signal<string[]>([]);
  readonly told = signal<Told>({ tone: 'none', text: '' });
  private tag = '';
  private readonly store = kept('site.draft');

  constructor(private readonly door: SiteDoor) {
    this.changes = computed(() => differenceOf(this.base.value, this.draft.value));
    try {
      const saved = JSON.parse(this.store.peek() || 'null') as { tag: string; base: Site; draft: Site } | null;
      if (saved) [this.tag, this.base.value, this.draft.value] = [saved.tag, saved.base, saved.draft];
    } catch {
      // Half a draft is none.
    }
  }

  /** Keeps the draft in the tab while it differs. Gives back the function that ends it. */
  keep(): () => void {
    return effect(() => {
      this.store.value = this.changes.value.length > 0 ? JSON.stringify({ tag: this.tag, base: this.base.value, draft: this.draft.value }) : '';
    });
  }

  async load(): Promise<void> {
    try {
      const { site, tag } = await this.door.read();
      const fresh = this.tag === '' || this.changes.peek().length === 0;
      if (fresh || sameDocument(site, this.draft.peek())) {
        this.take(site, tag);
      } else if (tag !== this.tag) {
        const changes = differenceOf(this.base.peek(), site);
        if (changes.length === 0) this.tag = tag;
        else this.theirs.value = { site, tag, changes };
      }
      this.state.value = 'there';
    } catch (error) {
      if (this.state.peek() !== 'there') this.state.value = asProblem(error).words;
    }
    await this.look();
  }

  /** What the gateway has staged or applied. */
  async look(): Promise<void> {
    if (this.offersStage.peek() === false) return;
    try {
      const before = this.stage.peek().state;
      this.stage.value = await this.door.stage();
      this.offersStage.value = true;
      if (before === 'applied' && this.stage.peek().state === 'none') await this.load();
    } catch (error) {
      if (absent(asProblem(error))) this.offersStage.value = false;
    }
  }

  edit(site: Site): void {
    this.draft.value = site;
    this.told.value = { tone: 'none', text: '' };
  }
  put = (room: Room, entry: Entry, own: string | null) => this.edit(withEntry(this.draft.peek(), room, entry, own));
  remove = (room: Room, name: string) => this.edit(withoutEntry(this.draft.peek(), room, name));
  drop(): void {
    this.draft.value = this.base.peek();
    this.clear();
  }

  /** Goes on from somebody else's site: with my changes on top, or without them. */
  async adopt(withMine: boolean): Promise<void> {
    const t = this.theirs.peek();
    if (!t) return;
    const { site, clashes } = withMine ? rebase(this.base.peek(), this.draft.peek(), t.site) : { site: t.site, clashes: [] };
    this.base.value = t.site;
    this.tag = t.tag;
    this.draft.value = site;
    this.clear();
    this.told.value = {
      tone: 'good',
      text: !withMine ? 'Your changes are dropped.' : clashes.length > 0 ? `Your changes stand on the newer site now. Both of you changed ${clashes.map((c) => c.what.split('/')[1]).join(', ')}: yours would win; look at the list.` : 'Your changes stand on the newer site now.',
    };
  }

  async check(): Promise<boolean> {
    const draft = this.draft.peek();
    return this.tell('Checking …', async () => {
      if (this.offersStage.peek() !== false) {
        try {
          const stage = await this.door.putStage(draft, this.tag);
          this.offersStage.value = true;
          this.stage.value = { ...stage, state: stage.state ?? 'staged' };
          this.judge(draft, stage.faults ?? [], stage.disturbs ?? []);
          return this.verdict();
        } catch (error) {
          if (!absent(asProblem(error))) throw error;
          this.offersStage.value = false;
        }
      }
      const r = await this.door.replace(draft, { dryRun: true, tag: this.tag });
      this.judge(draft, r.faults, []);
      return this.verdict();
    });
  }

  async apply(confirm_within_s: number): Promise<boolean> {
    const draft = this.draft.peek();
    return this.tell('Applying …', async () => {
      if (this.offersStage.peek() === false) {
        await this.door.replace(draft, { dryRun: false, tag: this.tag });
        const { site, tag } = await this.door.read();
        this.take(site, tag);
        return 'Applied. This gateway does not roll back by itself.';
      }
      const r = await this.door.apply(confirm_within_s);
      const stage = await this.door.stage().catch(() => ({ ...this.stage.peek(), ...r, state: confirm_within_s > 0 ? ('applied' as const) : ('none' as const) }));
      this.stage.value = r.confirm_by && !stage.confirm_by ? { ...stage, confirm_by: r.confirm_by } : stage;
      const { site, tag } = await this.door.read();
      this.take(site, tag);
      return this.stage.peek().state === 'applied' ? 'Applied. Keep it, or it is rolled back by itself.' : 'Applied.';
    });
  }

  confirm = () =>
    this.tell('Keeping …', async () => {
      await this.door.confirm();
      this.stage.value = none;
      return 'Kept.';
    });
  rollBack = () =>
    this.tell('Rolling back …', async () => {
      await this.door.rollBack();
      this.stage.value = none;
      const { site, tag } = await this.door.read();
      this.take(site, tag);
      return 'Rolled back: the site is as it was before.';
    });
  discard = () =>
    this.tell('Discarding …', async () => {
      await this.door.discard();
      this.stage.value = none;
      this.clear();
      return 'Nothing is staged now. What you typed is still there.';
    });
  restore = (revision: number) =>
    this.tell('Staging …', async () => {
      const stage = await this.door.restore(revision);
      const document = await this.door.old(revision);
      this.draft.value = document;
      this.stage.value = { ...stage, state: stage.state ?? 'staged' };
      this.judge(document, stage.faults ?? [], stage.disturbs ?? []);
      return `Revision ${revision} is staged; nothing has been applied yet.`;
    });

  private verdict(): string {
    const n = this.faults.peek().length;
    if (n > 0) throw new Error(faultWords(n));
    return 'Checked: it can be applied.';
  }
  private judge(site: Site, faults: SiteFault[], disturbs: string[]): void {
    this.faults.value = faults;
    this.checked.value = site;
    this.disturbs.value = disturbs;
  }
  private clear(): void {
    this.judge({}, [], []);
    this.checked.value = null;
    this.theirs.value = null;
    this.told.value = { tone: 'none', text: '' };
  }
  private take(site: Site, tag: string): void {
    this.tag = tag;
    this.base.value = site;
    this.draft.value = site;
    this.theirs.value = null;
    this.checked.value = null;
    this.faults.value = [];
  }
  private async tell(busy: string, act: () => Promise<string>): Promise<boolean> {
    this.told.value = { tone: 'busy', text: busy };
    try {
      this.told.value = { tone: 'good', text: await act() };
      return true;
    } catch (error) {
      const p = asProblem(error);
      if (p.document.faults) this.judge(this.draft.peek(), p.document.faults, []);
      if (p.status === 412) await this.load();
      const n = p.document.faults?.length ?? 0;
      const words = n > 0 ? faultWords(n) : p.kind === 'unreachable' && error instanceof Error ? error.message : p.status === 412 ? 'Somebody else has changed the site meanwhile; what you typed is kept.' : p.words;
      this.told.value = { tone: 'refused', text: words.charAt(0).toUpperCase() + words.slice(1) };
      return false;
    }
  }
}

const faultWords = (n: number): string => (n === 1 ? 'One fault must be mended.' : `${n} faults must be mended.`);

const drafts = new WeakMap<Client, { door: SiteDoor; draft: SiteDraft }>();
/** The one draft of a page; the head and the part of the site look at the same stage. */
export function draftOf(client: Client): { door: SiteDoor; draft: SiteDraft } {
  let d = drafts.get(client);
  if (!d) {
    const door = new SiteDoor(client);
    drafts.set(client, (d = { door, draft: new SiteDraft(door) }));
    d.draft.keep();
  }
  return d;
}
