// Narrow: whether the screen is a phone's, on which parts of a page are folded and long lists scroll in a window. In: the browser. Out: a signal.
import { signal } from '@preact/signals';

const media = globalThis.matchMedia?.('screen and (width < 720px)');
export const narrow = signal(media?.matches ?? false);
media?.addEventListener?.('change', () => (narrow.value = media.matches));

/** What a window of bounded height (class `window`) has beside it while it is one: the keyboard reaches it, and it has a name. */
export const windowOf = (name: string) => (narrow.value ? { tabIndex: 0, role: 'region' as const, 'aria-label': name } : {});
