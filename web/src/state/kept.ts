// Kept: a text in the browser's storage by a name. In: name, text. Out: the text, also after a reload. Never fails: without storage nothing is kept.
export type Where = 'session' | 'browser';

/** What is kept under the name; `first` where nothing is, or where storage is forbidden. */
export function kept(name: string, first: string, where: Where): string {
  try {
    return storageOf(where).getItem(keyOf(name)) ?? first;
  } catch {
    return first;
  }
}

/** Keeps the text; one that is as at first takes no room. A storage that is full or forbidden keeps nothing. */
export function keep(name: string, text: string, first: string, where: Where): void {
  try {
    if (text === first) storageOf(where).removeItem(keyOf(name));
    else storageOf(where).setItem(keyOf(name), text);
  } catch {
    // This visit only.
  }
}

const keyOf = (name: string): string => `axisgate.${name}`;
const storageOf = (where: Where): Storage => (where === 'session' ? globalThis.sessionStorage : globalThis.localStorage);
