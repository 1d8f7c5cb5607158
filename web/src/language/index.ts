// Language: which one the page speaks, and its sentences. The English text is its own key; German and Chinese are tables that are loaded only when
// chosen, before any other module of the page runs: so a sentence may stand in a constant. A change of the language loads the page again.
// In: the reader's choice, else the browser's languages. Out: text; the attribute lang of the document.
import { keep, kept } from '../state/kept'; // no signals: this module is read before the rest of the page

export const languages = { en: 'English', de: 'Deutsch', zh: '中文' } as const;
export type Language = keyof typeof languages;
export type Table = Readonly<Record<string, string>>;
type Values = Readonly<Record<string, string | number>>;

const tables: Record<Exclude<Language, 'en'>, () => Promise<{ table: Table }>> = {
  de: () => import('./de'),
  zh: () => import('./zh'),
};
let spoken: Language = 'en';
let table: Table = {};

const known = (tag: string): Language | undefined => (Object.keys(languages) as Language[]).find((l) => tag.toLowerCase().split('-')[0] === l);

/** The language chosen, or the first of the browser's that there is, or English. */
export const languageOf = (chosen: string, browser: readonly string[]): Language => known(chosen) ?? browser.map(known).find((l) => l !== undefined) ?? 'en';
export const language = (): Language => spoken;

/** Loads the table; one that does not come leaves the page English. To be awaited before the rest of the page is loaded. */
export async function startLanguage(browser: readonly string[] = globalThis.navigator?.languages ?? []): Promise<void> {
  const wanted = languageOf(kept('language', '', 'browser'), browser);
  if (wanted !== 'en') {
    const loaded = await tables[wanted]().catch(() => undefined);
    if (loaded) [spoken, table] = [wanted, loaded.table];
  }
  document.documentElement.lang = spoken;
}

/** Keeps the choice in this browser and loads the page again. */
export function chooseLanguage(l: Language): void {
  keep('language', l, '', 'browser');
  location.reload();
}

/** A sentence in the reader's language: the English one with "{name}" where values go. A sentence without a translation stays English. */
export function t(text: string, values?: Values): string {
  const published = table[text] ?? text;
  return values === undefined ? published : published.replace(/\{(\w+)\}/g, (all, name: string) => (name in values ? String(values[name]) : all));
}

/** A word that is made of a name of the API, such as `fault_cleared` or a condition of a twin: which there are is listed in scripts/language-lists.mjs. */
export const word = (english: string): string => table[english] ?? english;

/** A sentence with elements in it: t() whose values may be links, marks or fields. Out: what Preact draws, in the order of the language. */
export function rich<T>(text: string, values: Readonly<Record<string, T>>): (string | T)[] {
  return (table[text] ?? text).split(/(\{\w+\})/).map((part) => {
    const name = /^\{(\w+)\}$/.exec(part)?.[1];
    return name !== undefined && name in values ? (values[name] as T) : part;
  });
}

/** A word of the page within a sentence: English begins it small; the tables' words keep their case, since German nouns begin large everywhere. */
export const midSentence = (text: string): string => (spoken === 'en' && !/^(Modbus|EtherNet|DDS|[A-Z]{2})/.test(text) ? text.charAt(0).toLowerCase() + text.slice(1) : text);

/** Upon an element that shows what the gateway, a catalogue or a drive says itself: English in every language, and read so by a screen reader. */
export const gatewayText = { lang: 'en' } as const;

/** The same where such words become a piece of a sentence of the page: they stand between the signs that Unicode has for a foreign piece of text, which
 * no reader sees, and which `marked()` turns into that attribute where the sentence is drawn. */
export const theirs = (text: string): string => (spoken === 'en' || text === '' ? text : `\u2068${text}\u2069`);

/** For tests: the sentences of a table, or English again. */
export function speak(l: Language, sentences: Table = {}): void {
  [spoken, table] = [l, sentences];
}
