// Profile texts: what a person types into the form of a profile, as an entry of the site, or what is wrong with it. In: texts. Out: an entry, or
// faults by field; the registers of a language as rows to read. Pure.
import type { Language, LanguageRegister, Profile, ProfileEntry } from '../api/profiles';
import { t } from '../language';
import { addressText, type Base } from './address';
import { parseNumber } from './number';

export interface ProfileDraft {
  unit: string;
  language: string;
  axes: readonly string[];
  counts: string;
  velocity: string;
  acceleration: string;
  /** EtherNet/IP instances; empty: none. */
  input: string;
  output: string;
  object: string;
}
export type ProfileFaults = Partial<Record<keyof ProfileDraft, string>>;

const above = (text: string): number | null | 'wrong' => {
  if (text.trim() === '') return null;
  const p = parseNumber(text);
  return p.good && p.value > 0 ? p.value : 'wrong';
};

const place = (text: string): number | null | 'wrong' => {
  const n = above(text);
  return typeof n === 'number' && !(Number.isInteger(n) && n <= 65535) ? 'wrong' : n;
};

/** `taken`: units that have mappings, or a profile of another one. */
export function readProfile(d: ProfileDraft, languages: readonly Language[], taken: ReadonlyMap<number, string>): { unit: number; entry: ProfileEntry } | { faults: ProfileFaults } {
  const faults: ProfileFaults = {};
  const unit = parseNumber(d.unit);
  const n = unit.good && Number.isInteger(unit.value) && unit.value >= 2 && unit.value <= 254 ? unit.value : null;
  if (n === null) faults.unit = t('A whole number from 2 to 254.');
  else if (taken.has(n)) faults.unit = t('Unit {n} has {what}.', { n, what: taken.get(n) ?? '' });
  const language = languages.find((l) => l.language === d.language);
  if (!language) faults.language = t('Choose a language.');
  const axes = d.axes.filter((a) => a !== '');
  if (axes.length === 0) faults.axes = t('Choose an axis.');
  else if (language && axes.length > language.axes) faults.axes = language.axes === 1 ? t('{title} has one axis.', { title: language.title }) : t('{title} has at most {n} axes.', { title: language.title, n: language.axes });
  else if (new Set(axes).size < axes.length) faults.axes = t('Each axis once.');
  const numbers = { counts: above(d.counts), velocity: above(d.velocity), acceleration: above(d.acceleration) };
  for (const k of ['counts', 'velocity', 'acceleration'] as const) if (numbers[k] === 'wrong') faults[k] = t('A number above 0, or nothing.');
  const instances = { input: place(d.input), output: place(d.output), object: place(d.object) };
  for (const k of ['input', 'output', 'object'] as const) if (instances[k] === 'wrong') faults[k] = t('A whole number from 1 to {most}, or nothing.', { most: k === 'object' ? 255 : 65535 });
  if (typeof instances.object === 'number' && instances.object > 255) faults.object = t('A whole number from 1 to {most}, or nothing.', { most: 255 });
  if (Object.keys(faults).length > 0 || n === null || !language) return { faults };
  const number = (v: number | null | 'wrong') => (typeof v === 'number' ? v : undefined);
  const more = { counts_per_unit: number(numbers.counts), velocity: number(numbers.velocity), acceleration: number(numbers.acceleration) };
  const given = Object.fromEntries(Object.entries(more).filter(([, v]) => v !== undefined));
  const entry: ProfileEntry = { language: language.language, axes: axes.map((axis) => ({ axis, ...given })) };
  if (typeof instances.input === 'number') entry.input_assembly = instances.input;
  if (typeof instances.output === 'number') entry.output_assembly = instances.output;
  if (typeof instances.object === 'number' && language.language === 'lexium') entry.object_instance = instances.object;
  return { unit: n, entry };
}

/** Counts, speed and ramp of the axes, where the entry says them. */
export function profileText(p: Profile): string {
  return p.axes
    .map((a) => {
      const more = [a.counts_per_unit != null && t('{n} counts per unit', { n: a.counts_per_unit }), a.velocity != null && t('{n} units/s', { n: a.velocity }), a.acceleration != null && t('{n} units/s²', { n: a.acceleration })].filter(Boolean);
      return more.length > 0 ? `${a.axis} (${more.join(', ')})` : a.axis;
    })
    .join(', ');
}

/** Where it stands on EtherNet/IP; empty: nowhere. */
export function instanceText(p: Profile): string {
  const parts = [p.input_assembly != null && t('input assembly {n}', { n: p.input_assembly }), p.output_assembly != null && t('output assembly {n}', { n: p.output_assembly }), p.object_instance != null && t('objects with instance {n}', { n: p.object_instance })];
  return parts.filter(Boolean).join(', ');
}

const accessText = { R: t('read'), W: t('write'), RW: t('read and write') } as const;
export interface RegisterRow {
  key: string;
  where: string;
  name: string;
  type: string;
  access: string;
  text: string;
  /** On EtherNet/IP: "66h 1 7"; empty: it has no attribute. */
  object: string;
}
/** The registers of a language that a profile of so many axes has. */
export function registerRows(language: Language, axes: number, base: Base): RegisterRow[] {
  const width = (r: LanguageRegister) => (r.type === 'u16' || r.type === 'i16' ? 1 : 2);
  return language.registers
    .filter((r) => (r.axis ?? 0) <= axes)
    .map((r) => {
      const table = r.tables[0] ?? 'holding_registers';
      const from = addressText(table, r.address, base);
      return {
        key: `${table}${r.address}`,
        where: width(r) === 1 ? from : `${from}, ${addressText(table, r.address + 1, base)}`,
        name: r.name,
        type: r.type,
        access: r.tables.length === 1 && table === 'input_registers' ? t('{access}, input register', { access: accessText[r.access] }) : accessText[r.access],
        text: r.description,
        object: r.object ? t('class {class}h, attribute {attribute}', { class: r.object.class.toString(16).toUpperCase(), attribute: r.object.attribute }) : '',
      };
    });
}
