// Code: a part of the page that has a bundle of its own, which is fetched when the part is shown for the first time. In: how it is fetched. Out: the part,
// or why it is not there: then it is asked for again when a person wants it, or when the gateway is back. What has been fetched stays for the visit.
import { signal, type ReadonlySignal } from '@preact/signals';
import { t } from '../language';
import { followUpgrade, type Upgrade } from './upgrade';

export type CodeState<C> = { at: 'waiting' } | { at: 'there'; part: C } | { at: 'missing'; away: boolean; why: string };

export class Code<C> {
  private readonly now = signal<CodeState<C>>({ at: 'waiting' });
  private asking = false;

  constructor(
    private readonly fetch: () => Promise<C>,
    private readonly upgraded: () => Promise<Upgrade> = followUpgrade,
  ) {}

  get state(): ReadonlySignal<CodeState<C>> {
    return this.now;
  }

  /** Fetches it, unless it is there or on its way. Never fails: why it is missing is its state. */
  async want(): Promise<void> {
    if (this.asking || this.now.peek().at === 'there') return;
    this.asking = true;
    this.now.value = { at: 'waiting' };
    try {
      this.now.value = { at: 'there', part: await this.fetch() };
    } catch {
      const found = await this.upgraded();
      if (found === 'away') this.now.value = { at: 'missing', away: true, why: t('This part of the page is not loaded yet, and the gateway cannot be reached.') };
      if (found === 'same') this.now.value = { at: 'missing', away: false, why: t('The gateway has not sent this part of the page.') };
    } finally {
      this.asking = false;
    }
  }
}
