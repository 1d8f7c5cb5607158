// Site draft: what is typed for the site, until it is applied; what the gateway says of it; and the way through stage, apply, keep or roll back.
// In: the HTTP door. Out: signals. The draft survives a change of page and a reload. Another person's change is shown, and mine are put on top of it
// only when I say so; only what was shown is applied, and what is typed meanwhile stays. A gateway without staging gets the whole document at once, after a dry run; that there is no roll back is said.
import { t } from '../language';
import { computed, effect, signal, type ReadonlySignal } from '@preact/signals';
import { asProblem, type Problem } from '../api/problem';
import type { Client } from '../api/client';
import { SiteDoor, type SiteFault, type Stage } from '../api/site';
import { differenceOf, rebase, sameDocument, withEntry, withoutEntry, type Difference, type Entry, type Room, type Site } from '../text/site';
import { holderName, personOf } from '../text/authority';
import { capital } from './commander';
import { persisted } from './persisted';
import { quiet, type Reported } from './reported';

const none: Stage = { state: 'none' };
/** Empty: an older gateway, where a stage cannot be told from another one. */
const idOf = (stage: Stage): string => (typeof stage.id === 'string' ? stage.id : '');
export const stagerOf = (stage: Stage): string => (stage.by && !/^local\b/.test(stage.by) ? holderName(stage.by) : capital(personOf(stage.by || 'local')));
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
  /** Connections that applying closes, as the gateway tells them; null: it could not say. */
  readonly closes = signal<NonNullable<Stage['closes']> | null>([]);
  readonly reported = signal<Reported>(quiet);
  /** Somebody else's stage stands in the way of mine: what is staged, and whether it is in view to be applied. */
  readonly rival = signal<{ inView: boolean } | null>(null);
  /** A revision that is to be restored over changes that are not applied: it is asked for first. */
  readonly askRestore = signal<number | null>(null);
  /** What was applied and rolled back because nobody kept it. */
  readonly rolledBack = signal<Site | null>(null);
  private tag = '';
  /** The stage that this page has shown. */
  private shown = '';
  private applied: Site | null = null;
  private moving = false;
  private readonly store = persisted('site.draft');

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

  /** What went wrong, if it was not read. */
  async load(): Promise<Problem | null> {
    if (this.moving) return null; // what comes of it is read at its end
    if (this.stage.peek().state === 'applied') await this.look();
    try {
      const { site, tag } = await this.door.read();
      if (this.moving) return null;
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
      if (this.state.peek() !== 'there') this.state.value = asProblem(error).text;
      return asProblem(error);
    }
    await this.look();
    return null;
  }

  /** What the gateway has staged or applied. */
  async look(): Promise<void> {
    if (this.offersStage.peek() === false || this.moving) return;
    try {
      const before = this.stage.peek();
      const now = await this.door.stage();
      if (this.moving) return;
      this.stage.value = now;
      this.offersStage.value = true;
      if (now.state === 'none') {
        this.rival.value = null;
        if (before.state !== 'none' && this.reported.peek().tone !== 'busy') this.reported.value = quiet;
      } else if (now.state === 'staged' && idOf(now) !== '' && idOf(now) !== this.shown && before.state === 'staged' && idOf(before) === this.shown && this.shown !== '') {
        // Mine was replaced: it is said before somebody presses Apply.
        this.contest(t('{now} has staged something else in place of what you checked.', { now: stagerOf(now) }));
      }
      if (before.state === 'applied' && (now.state === 'none' || now.state === 'staged')) await this.ended();
    } catch (error) {
      if (absent(asProblem(error))) this.offersStage.value = false;
    }
  }

  /** A trial is over without a word from this page: kept by somebody, or rolled back. */
  private async ended(): Promise<void> {
    const applied = this.applied;
    this.applied = null;
    const { site, tag } = await this.door.read();
    this.move(site, tag, this.base.peek());
    if (!applied || sameDocument(site, applied)) return;
    this.rolledBack.value = applied;
    this.reported.value = { tone: 'refused', text: t('Rolled back by itself: nobody pressed Keep in time.') };
  }

  /** Puts what was rolled back into the draft again, to be checked and applied anew. */
  again(): void {
    const site = this.rolledBack.peek();
    if (site) this.edit(site);
  }

  edit(site: Site): void {
    this.draft.value = site;
    this.rolledBack.value = null;
    this.reported.value = quiet;
  }
  put = (room: Room, entry: Entry, own: string | null) => this.edit(withEntry(this.draft.peek(), room, entry, own));
  remove = (room: Room, name: string) => this.edit(withoutEntry(this.draft.peek(), room, name));
  drop(): void {
    this.draft.value = this.base.peek();
    this.clear();
    this.rival.value = null;
  }

  /** Goes on from somebody else's site: with my changes on top, or without them. */
  async adopt(withMine: boolean): Promise<void> {
    const theirs = this.theirs.peek();
    if (!theirs) return;
    const { site, clashes } = withMine ? rebase(this.base.peek(), this.draft.peek(), theirs.site) : { site: theirs.site, clashes: [] };
    this.base.value = theirs.site;
    this.tag = theirs.tag;
    this.draft.value = site;
    this.clear();
    this.reported.value = {
      tone: 'good',
      text: !withMine ? t('Your changes are dropped.') : clashes.length > 0 ? t('Your changes stand on the newer site now. Both of you changed {names}: yours would win; look at the list.', { names: clashes.map((c) => c.what.split('/')[1]).join(', ') }) : t('Your changes stand on the newer site now.'),
    };
  }

  /** `replace`: also in place of what somebody else has staged. */
  async check(replace = false): Promise<boolean> {
    const draft = this.draft.peek();
    return this.tell(t('Checking …'), async () => {
      if (this.offersStage.peek() !== false) {
        try {
          const stage = await this.door.putStage(draft, this.tag, replace);
          this.offersStage.value = true;
          this.mine(stage);
          this.judge(draft, stage.faults ?? [], stage.disturbs ?? [], stage.closes);
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
    const sent = this.checked.peek() ?? this.draft.peek();
    return this.step(t('Applying …'), async () => {
      if (this.offersStage.peek() === false) {
        await this.door.replace(sent, { dryRun: false, tag: this.tag });
        const { site, tag } = await this.door.read();
        this.move(site, tag, sent);
        return t('Applied. This gateway does not roll back by itself.');
      }
      const theirs = this.rival.peek()?.inView === true;
      const r = await this.door.apply(confirm_within_s, this.shown);
      const stage = await this.door.stage().catch(() => ({ ...this.stage.peek(), ...r, state: confirm_within_s > 0 ? ('applied' as const) : ('none' as const) }));
      this.stage.value = r.confirm_by && !stage.confirm_by ? { ...stage, confirm_by: r.confirm_by } : stage;
      this.rival.value = null;
      const { site, tag } = await this.door.read();
      this.move(site, tag, theirs ? this.base.peek() : sent);
      const waits = this.stage.peek().state === 'applied';
      this.applied = waits ? site : null;
      return waits ? t('Applied. Keep it, or it is rolled back by itself.') : t('Applied.');
    });
  }

  confirm = () =>
    this.step(t('Keeping …'), async () => {
      await this.door.confirm();
      this.stage.value = none;
      this.applied = null;
      return t('Kept.');
    });
  /** Check, apply and keep, one after the other, where nothing that runs is disturbed by it; else it ends after the check, and what is disturbed is shown. */
  async applyAndKeep(): Promise<boolean> {
    if (!(await this.check()) || this.disturbs.peek().length > 0 || this.closes.peek()?.length !== 0) return false;
    // The trial lasts as long as the answer is on its way: a page that is cut off by its own change cannot keep it.
    return (await this.apply(60)) && (this.stage.peek().state !== 'applied' || (await this.confirm()));
  }
  rollBack = () =>
    this.step(t('Rolling back …'), async () => {
      await this.door.rollBack();
      this.stage.value = none;
      this.applied = null;
      const { site, tag } = await this.door.read();
      this.move(site, tag, this.base.peek());
      return t('Rolled back: the site is as it was before.');
    });
  discard = () =>
    this.tell(t('Discarding …'), async () => {
      await this.door.discard();
      this.stage.value = none;
      this.rival.value = null;
      this.clear();
      return t('Nothing is staged now. What you typed is still there.');
    });
  /** `sure`: changes that are not applied may go. */
  async restore(revision: number, sure = false): Promise<boolean> {
    if (!sure && this.changes.peek().length > 0) {
      this.askRestore.value = revision;
      return false;
    }
    this.askRestore.value = null;
    return this.tell(t('Staging …'), async () => {
      const document = await this.door.old(revision);
      // What was typed goes, so nothing has to be put on top of the newer site: the difference is the one to what is in force now.
      const newer = this.theirs.peek();
      if (newer) this.take(newer.site, newer.tag);
      try {
        const stage = await this.door.restore(revision);
        this.edit(document);
        this.mine(stage);
        this.judge(document, stage.faults ?? [], stage.disturbs ?? [], stage.closes);
      } catch (error) {
        // The way on is the same as for every draft: check it in place of theirs.
        if (asProblem(error).is('stage_taken')) this.edit(document);
        throw error;
      }
      return t('Revision {revision} is staged; nothing has been applied yet.', { revision });
    });
  }

  /** What somebody else has staged is looked at and can be applied; what I typed waits. Or back to mine. */
  view(theirs: boolean): void {
    this.rival.value = { inView: theirs };
    this.shown = theirs ? idOf(this.stage.peek()) : '';
    this.checked.value = null;
    this.reported.value = quiet;
  }

  /** The stage in the gateway is what this page has checked. */
  private mine(stage: Stage): void {
    this.stage.value = { ...stage, state: stage.state ?? 'staged' };
    this.shown = idOf(stage);
    this.rival.value = null;
  }
  private contest(text: string): void {
    this.rival.value = { inView: false };
    this.shown = '';
    this.checked.value = null;
    this.reported.value = { tone: 'refused', text };
  }
  private verdict(): string {
    const n = this.faults.peek().length;
    if (n > 0) throw new Error(faultText(n));
    return checkedText;
  }
  private judge(site: Site, faults: SiteFault[], disturbs: string[], closes: Stage['closes'] = []): void {
    this.faults.value = faults;
    this.checked.value = site;
    this.disturbs.value = disturbs;
    this.closes.value = closes;
  }
  private clear(): void {
    this.judge({}, [], []);
    this.checked.value = null;
    this.theirs.value = null;
    this.reported.value = quiet;
  }
  /** The site in force is another one now; what was typed since `from` is put on top of it. */
  private move(site: Site, tag: string, from: Site): void {
    const typed = this.draft.peek();
    this.take(site, tag);
    if (!sameDocument(typed, from)) this.draft.value = rebase(from, typed, site).site;
  }
  private take(site: Site, tag: string): void {
    this.tag = tag;
    this.base.value = site;
    this.draft.value = site;
    this.theirs.value = null;
    this.checked.value = null;
    this.faults.value = [];
  }
  /** A step that changes the site in force: nothing is read from outside before its end. */
  private async step(busy: string, act: () => Promise<string>): Promise<boolean> {
    this.moving = true;
    return this.tell(busy, () => act().finally(() => (this.moving = false)));
  }
  private async tell(busy: string, act: () => Promise<string>): Promise<boolean> {
    this.reported.value = { tone: 'busy', text: busy };
    this.rolledBack.value = null;
    try {
      this.reported.value = { tone: 'good', text: await act() };
      return true;
    } catch (error) {
      const p = asProblem(error);
      if (p.document.faults) this.judge(this.draft.peek(), p.document.faults, []);
      if (p.status === 412) await this.load();
      const n = p.document.faults?.length ?? 0;
      const text = n > 0 ? faultText(n) : p.kind === 'unreachable' && error instanceof Error ? error.message : p.status === 412 ? t('Somebody else has changed the site meanwhile; what you typed is kept.') : p.text;
      this.reported.value = { tone: 'refused', text: capital(text) };
      if (p.is('stage_replaced') || p.is('stage_taken')) await this.meet(p);
      return false;
    }
  }
  /** Somebody else's stage stands where mine should: it is read, to be shown. */
  private async meet(p: Problem): Promise<void> {
    const stage = await this.door.stage().catch(() => null);
    if (stage) this.stage.value = stage;
    if (stage?.state === 'none') {
      this.checked.value = null;
      this.shown = '';
      this.reported.value = { tone: 'refused', text: t('Nothing was applied: what you checked is not staged any more. Check it again.') };
    } else {
      const who = stage ? stagerOf(stage) : t('Somebody else');
      this.contest(t('{value} has staged another change. What you typed is kept.', { value: p.is('stage_replaced') ? t('Nothing was applied: {list}', { list: who.replace(/^Somebody/, 'somebody') }) : who }));
    }
  }
}

/** What is told when a check has found nothing. */
export const checkedText = t('Checked: it can be applied.');
const faultText = (n: number): string => (n === 1 ? t('One fault must be mended.') : t('{n} faults must be mended.', { n }));

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
