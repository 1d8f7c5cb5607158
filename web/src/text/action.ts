// Actions of a family as forms: what may be typed for each argument, what is sent, the same as one text for recipes. In: the catalogue's commands,
// texts. Out: fields, faults, the request's body. Pure. The gateway checks all of it again; what it has a default for may stay empty.
import type { components } from '../api/schema';
import { t } from '../language';
import { localFigures, parseNumber } from './number';

export type CatalogueCommand = components['schemas']['CatalogueCommand'];
export type CommandArgument = components['schemas']['CommandArgument'];

const whole: Record<string, [number, number]> = {
  u8: [0, 255], i8: [-128, 127], u16: [0, 65535], i16: [-32768, 32767], i24: [-8388608, 8388607],
  u32: [0, 4294967295], i32: [-2147483648, 2147483647],
};
const short = (n: number): string => localFigures(String(Number(n.toPrecision(12))));

export const isText = (a: CommandArgument): boolean => a.type === 'text' || a.type === 'bytes';
export const isFlag = (a: CommandArgument): boolean => a.type === 'bool';
/** "Entry if true" of entry_if_true, with its unit. */
export const labelOf = (a: CommandArgument): string => a.name.charAt(0).toUpperCase() + a.name.slice(1).replaceAll('_', ' ') + (a.unit ? `, ${a.unit}` : '');
/** From and to, in the argument's unit; null: any number, or no number at all. */
export function rangeOf(a: CommandArgument): [number, number] | null {
  if (isText(a) || isFlag(a)) return null;
  const own = whole[a.type];
  const low = a.min ?? (own ? own[0] * a.scale : -Infinity), high = a.max ?? (own ? own[1] * a.scale : Infinity);
  return Number.isFinite(low) || Number.isFinite(high) ? [low, high] : null;
}
export function hintOf(a: CommandArgument): string {
  const r = rangeOf(a);
  const range = !r ? '' : a.unit ? t('{from} to {to} {unit}.', { from: short(r[0]), to: short(r[1]), unit: a.unit }) : t('{from} to {to}.', { from: short(r[0]), to: short(r[1]) });
  return [a.description ?? '', range].filter(Boolean).join(' ');
}

/** What is wrong with what was typed; empty: nothing. */
export function argumentFault(a: CommandArgument, given: string | undefined): string {
  const typed = (given ?? '').trim();
  if (typed === '') return a.default !== null && a.default !== undefined ? '' : isText(a) ? t('A text is needed.') : t('A value is needed.');
  if (isText(a)) return '';
  if (isFlag(a)) return typed === 'true' || typed === 'false' ? '' : t('true or false.');
  const n = parseNumber(typed);
  if (!n.good) return n.why;
  if (a.scale === 1 && whole[a.type] && !Number.isInteger(n.value)) return t('A whole number.');
  const r = rangeOf(a);
  return r && (n.value < r[0] || n.value > r[1]) ? t('{from} to {to}.', { from: short(r[0]), to: short(r[1]) }) : '';
}
export const faultsOf = (c: CatalogueCommand, typed: Record<string, string>): Record<string, string> =>
  Object.fromEntries(c.arguments.map((a) => [a.name, argumentFault(a, typed[a.name])] as const).filter(([, fault]) => fault !== ''));

const valueOf = (a: CommandArgument, typed: string): boolean | number | string => {
  if (isText(a)) return typed;
  if (isFlag(a)) return typed === 'true';
  const n = parseNumber(typed);
  return n.good ? n.value : Number.NaN;
};
/** What is sent. A command that takes nothing by name may take one text. */
export function bodyOf(c: CatalogueCommand, typed: Record<string, string>, text = ''): { name: string; arguments?: Record<string, boolean | number | string>; argument?: string } {
  if (c.arguments.length === 0) return text.trim() === '' ? { name: c.name } : { name: c.name, argument: text };
  const given = c.arguments.filter((a) => (typed[a.name] ?? '').trim() !== '').map((a) => [a.name, valueOf(a, isText(a) ? (typed[a.name] ?? '') : (typed[a.name] ?? '').trim())] as const);
  return { name: c.name, arguments: Object.fromEntries(given) };
}
/** "factory defaults" of factory_defaults. */
export const nameOf = (c: CatalogueCommand): string => c.name.replaceAll('_', ' ');
/** What is asked before it is sent; empty: it does no harm. */
export const questionOf = (c: CatalogueCommand, axis: string): string => (c.confirm ? t('{action} on {axis}: {question} Run it?', { action: nameOf(c), axis, question: c.confirm }) : '');
/** The same as a recipe step's one text; empty where a text has blanks in it, which that form does not carry. */
export function recipeText(c: CatalogueCommand, typed: Record<string, string>): string {
  const texts = Object.entries(bodyOf(c, typed).arguments ?? {}).map(([name, value]) => `${name}=${value}`);
  return texts.some((w) => /[\s,;]/.test(w)) ? '' : texts.join(' ');
}

/** Those whose name, id or description has all the words. */
export function found(commands: readonly CatalogueCommand[], sought: string): CatalogueCommand[] {
  const texts = sought.toLowerCase().split(/\s+/).filter(Boolean);
  return commands.filter((c) => texts.every((w) => `${c.id} ${c.name} ${c.description ?? ''}`.toLowerCase().includes(w)));
}
