// Options of a family in words and fields: what each may say, what was typed for them, what an entry gets of it, what an increment is.
// In: the family's catalogue, text. Out: fields, faults, the members of `options`. Pure. What the family does not know stays until it is taken away;
// the gateway checks all of it again.
import { t, theirs } from '../language';
import type { components } from '../api/schema';
import { formatExact, parseNumber, typedNumber } from './number';
import type { FieldSpec, Room, Site, Texts } from './site';

/** What the page reads of a family's catalogue; older gateways do not tell all of it. */
export type Family = Partial<components['schemas']['Family']> & { name: string };
export type OptionSpec = NonNullable<components['schemas']['Family']['options']>[number];
type Freedom = components['schemas']['Family']['freedoms'][number];
export type Families = ReadonlyMap<string, Family>;

export const optionPrefix = 'options.';
/** "Home timeout, s" of home_timeout_s. */
const label = (o: OptionSpec) => (o.unit ? `${shown(o.name.replace(new RegExp(`_${o.unit.replace(/[^a-z]/gi, '.')}$`), ''))}, ${o.unit}` : shown(o.name));
const shown = (name: string) => (name.charAt(0).toUpperCase() + name.slice(1)).replaceAll('_', ' ');

/** The family that an entry is of, as it is typed: of a line its own, of a drive its own or its line's, of an axis its drive's. */
export function familyOf(room: Room, texts: Texts, site: Site): string {
  if (room === 'lines') return texts.family ?? '';
  const drive = room === 'drives' ? texts : (site.drives ?? []).find((d) => d.name === texts.drive);
  return String(drive?.family || ((site.lines ?? []).find((l) => l.name === drive?.line)?.family ?? ''));
}

/** What may be said at a line or a drive. A twin's options stand beside those of its drive, or of its line for all twins of that. */
export function optionsFor(family: Family | undefined, room: Room): readonly OptionSpec[] {
  if (room === 'axes') return [];
  const all = family?.options ?? [];
  const own = all.filter((o) => o.of.includes('twin') || o.of.includes(room === 'lines' ? 'line' : 'drive'));
  return [...own, ...(family?.freedoms ?? []).filter((f) => all.every((o) => o.name !== f.name)).map(freedomOption)];
}

/** A freedom is an option of the twin; what its numbers mean is in its hint. */
const freedomOption = ({ name, unit, min, max, default: standard, values, description }: Freedom): OptionSpec => {
  const meant = Object.entries(values);
  return { name, of: ['twin'], min, max, default: String(standard), description: [description, ...meant.map(([n, text]) => `${n}: ${text}`)].join('; '), ...(unit ? { unit } : {}), ...(meant.length > 0 ? { values: Object.keys(values) } : {}) };
};

const switchText = ['on', 'off', 'true', 'false', '1', '0'];
/** Six words for a switch are two to choose from. */
const choicesOf = (o: OptionSpec): readonly string[] => (o.values && switchText.every((w) => o.values?.includes(w)) ? o.values.filter((v) => v === 'on' || v === 'off') : (o.values ?? []));
const rangeOf = (o: OptionSpec): string => {
  const unit = o.unit ? ` ${o.unit}` : '';
  const published = (n: number) => `${formatExact(n)}${unit}`;
  if (o.min !== undefined && o.max !== undefined) return t('{min} to {max}', { min: formatExact(o.min), max: published(o.max) });
  return o.min !== undefined ? t('from {n}', { n: published(o.min) }) : o.max !== undefined ? t('up to {n}', { n: published(o.max) }) : '';
};

/** An option as a field of a form: its range, its default and its description are in its hint. */
export function optionField(o: OptionSpec, room: Room): FieldSpec {
  const own = o.of.includes(room === 'lines' ? 'line' : 'drive');
  const whole = o.min !== undefined || o.max !== undefined;
  const standard = o.default === null || o.default === undefined ? '' : `${typeof o.default === 'number' ? formatExact(o.default) : o.default}${o.unit ? ` ${o.unit}` : ''}`;
  const hint = [own ? '' : room === 'lines' ? t('Of all twins of this line') : t('Of its twin'), theirs(o.description), rangeOf(o), standard ? t('default {standard}', { standard }) : t('not given: as described')].filter(Boolean).join('. ');
  const f: FieldSpec = { key: optionPrefix + o.name, label: label(o), kind: o.values ? 'choice' : whole ? 'integer' : 'text', hint: `${hint}.` };
  if (o.min !== undefined) f.min = o.min;
  if (o.max !== undefined) f.max = o.max;
  if (o.values) f.choices = [{ value: '', text: standard ? t('default: {standard}', { standard }) : t('not given') }, ...choicesOf(o).map((value) => ({ value, text: value }))];
  else f.placeholder = standard;
  return f;
}

/** What is said of a value that is not the family's; empty: nothing. */
export function optionFault(o: OptionSpec, text: string): string {
  const typed = text.trim();
  if (typed === '') return '';
  if (o.values) return o.values.includes(typed) ? '' : t('One of {list}.', { list: o.values.join(', ') });
  if (o.min === undefined && o.max === undefined) return '';
  const p = parseNumber(typed);
  if (!p.good || !Number.isInteger(p.value)) return t('A whole number.');
  const n = p.value;
  return (o.min !== undefined && n < o.min) || (o.max !== undefined && n > o.max) ? `${shown(rangeOf(o))}.` : '';
}

/** Names that were typed, or were there, and are none of the family's: they count as not given, and stay until they are emptied. */
export const unknownOptions = (texts: Texts, specs: readonly OptionSpec[]): string[] =>
  Object.keys(texts).filter((k) => k.startsWith(optionPrefix) && !specs.some((o) => optionPrefix + o.name === k)).map((k) => k.slice(optionPrefix.length));

type Options = Record<string, string | number | boolean>;
const textOf = (v: unknown): string => (typeof v === 'number' ? typedNumber(v) : String(v));
/** Each member as a text of its own: a value may have commas and equal signs in it; a number has the reader's decimal sign. */
export const optionTexts = (options: unknown): Texts => (options && typeof options === 'object' ? Object.fromEntries(Object.entries(options).map(([k, v]) => [optionPrefix + k, textOf(v)])) : {});

/**
 * The members of `options` from their texts; what was not touched stays as it was written. What is a number by its catalogue, or was one, goes as
 * the gateway reads it; all else as it was typed, since lists such as "1:0.5,2:4" are the drive's own language.
 */
export function optionsFrom(texts: Texts, before: unknown, specs: readonly OptionSpec[] = []): Options {
  const old = (before ?? {}) as Options;
  const made: Options = {};
  for (const [key, text] of Object.entries(texts)) {
    if (!key.startsWith(optionPrefix)) continue;
    const name = key.slice(optionPrefix.length);
    const spec = specs.find((o) => o.name === name);
    const number = spec ? !spec.values && (spec.min !== undefined || spec.max !== undefined) : typeof old[name] === 'number';
    const p = number ? parseNumber(text) : undefined;
    if (name in old && textOf(old[name]) === text) made[name] = old[name] as string | number | boolean;
    else if (text.trim() !== '') made[name] = p?.good ? String(p.value) : text.trim();
  }
  return made;
}

/** "Options of uim342: 9; set: crc, notify". */
export function optionsTitle(family: string, specs: readonly OptionSpec[], texts: Texts): string {
  const set = Object.keys(texts).filter((k) => k.startsWith(optionPrefix) && (texts[k] ?? '').trim() !== '').map((k) => k.slice(optionPrefix.length));
  const of = family ? t('Options of {family}', { family }) : t('Options');
  const list = set.join(', ');
  if (specs.length === 0) return set.length > 0 ? t('{of}; set: {list}', { of, list }) : of;
  return set.length > 0 ? t('{of}: {n}; set: {list}', { of, n: specs.length, list }) : t('{of}: {n}, none set', { of, n: specs.length });
}

/** What an increment of the drive is, beside the field that asks how many of them make a unit. */
export function incrementHint(family: Family | undefined, unit: string): string {
  const what = unit.trim() ? t('how many increments of the drive make one {unit}', { unit: unit.trim() }) : t('how many increments of the drive make one unit');
  const own = family?.position_unit;
  if (typeof own !== 'string' || own === '') return what;
  return t('{what}; one increment of {name} is {own}', { what, name: family?.name ?? '', own: /^\d/.test(own) ? own : t('one {own}', { own }) });
}
