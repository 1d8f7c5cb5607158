// Upgrade: whether the gateway has another page by now than this tab has begun with. Every bundle has a name of its own for each content, so a tab that
// is older than the gateway asks for bundles that are gone. Such a tab loads itself once for each page that it finds, and never again for the same one.
// In: the first script that index.html names, here and at the gateway. Out: whether the tab is being loaded again.
import { keep, kept } from './kept';

export type Upgrade = 'reloading' | 'same' | 'away';

/** What is asked and done; a test has its own. */
export interface Around {
  /** Address of the first script of this tab. */
  mine(): string;
  /** index.html as the gateway has it now; fails while the gateway is away. */
  index(): Promise<string>;
  reload(): void;
  /** For which page this tab has been loaded again, over a reload; '' also where the browser keeps nothing. */
  loadedFor(): string;
  /** False: the browser keeps nothing. */
  loadFor(script: string): boolean;
}

/** Address of the first script that index.html names; '' if it names none. */
export const firstScript = (html: string): string => /<script\b[^>]*\bsrc="([^"]+)"/.exec(html)?.[1] ?? '';

const name = 'upgrade.loaded_for';
export const around: Around = {
  mine: () => document.querySelector('script[type=module][src]')?.getAttribute('src') ?? '',
  index: async () => {
    const answer = await fetch('/', { cache: 'no-store' });
    if (!answer.ok) throw new Error(`${answer.status}`);
    return answer.text();
  },
  reload: () => location.reload(),
  loadedFor: () => kept(name, '', 'session'),
  loadFor: (script) => {
    keep(name, script, '', 'session');
    return kept(name, '', 'session') === script;
  },
};

/** Loads the tab again if the gateway has another page. Without a memory that outlives the reload nothing is reloaded: it might never end. */
export async function followUpgrade(at: Around = around): Promise<Upgrade> {
  const [html, mine] = [await at.index().catch(() => null), at.mine()];
  if (html === null) return 'away';
  const theirs = firstScript(html);
  if (theirs === '' || mine === '' || theirs === mine || at.loadedFor() === theirs || !at.loadFor(theirs)) return 'same';
  at.reload();
  return 'reloading';
}
