// A recipe in words and as a tree that can be edited. In: the document as the gateway keeps it. Out: a changed copy, the fields of each step, words.
// Never changes a document in place, and keeps members that it does not know.
import { t } from '../language';
import { localFigures, parseNumber, typedNumber } from './number';
import { plain, plainWord } from './plain';
import { duration } from './time';
import type { Word } from './axis';

export type Json = null | boolean | number | string | Json[] | { [key: string]: Json };
export type Step = { [word: string]: Json };
export interface RecipeParameter {
  type: string;
  default?: Json;
  min?: number;
  max?: number;
  unit?: string;
  description?: string;
}
export interface RecipeDocument {
  description?: string;
  parameters?: Record<string, RecipeParameter>;
  timeout_s?: number;
  on_failure?: 'halt' | 'quick_stop';
  steps: Step[];
  [other: string]: unknown;
}

export type FieldKind = 'axis' | 'text' | 'value' | 'number' | 'flag' | 'command' | 'register_type' | 'input';
export interface StepField {
  key: string;
  label: string;
  kind: FieldKind;
  optional?: boolean;
}
export interface StepKind {
  word: string;
  label: string;
  fields: StepField[];
  /** How a new one begins. */
  fresh: Json;
  condition?: 'own' | 'condition' | 'until';
  lists?: string[];
}

const axis: StepField = { key: 'axis', label: t('Axis'), kind: 'axis' };
const wait: StepField = { key: 'wait_s', label: t('Wait up to, s'), kind: 'number', optional: true };
export const stepKinds: StepKind[] = [
  { word: 'enable', label: t('Enable'), fields: [axis, wait], fresh: { axis: '' } },
  { word: 'disable', label: t('Disable'), fields: [axis, wait], fresh: { axis: '' } },
  { word: 'home', label: t('Home'), fields: [axis, { key: 'method', label: t('Method'), kind: 'number', optional: true }, wait], fresh: { axis: '' } },
  {
    word: 'command',
    label: t('Command'),
    fields: [
      axis,
      { key: 'command', label: t('Command'), kind: 'command' },
      { key: 'position', label: t('Position'), kind: 'number', optional: true },
      { key: 'velocity', label: t('Velocity'), kind: 'number', optional: true },
      { key: 'acceleration', label: t('Acceleration'), kind: 'number', optional: true },
      { key: 'deceleration', label: t('Deceleration'), kind: 'number', optional: true },
      wait,
    ],
    fresh: { axis: '', command: 'move_absolute', position: 0, wait_s: 30 },
  },
  { word: 'set_parameter', label: t('Set a parameter'), fields: [axis, { key: 'parameter', label: t('Parameter'), kind: 'text' }, { key: 'value', label: t('Value'), kind: 'value' }], fresh: { axis: '', parameter: '', value: 0 } },
  { word: 'read_parameter', label: t('Read a parameter'), fields: [axis, { key: 'parameter', label: t('Parameter'), kind: 'text' }], fresh: { axis: '', parameter: '' } },
  { word: 'action', label: t('Action of the family'), fields: [axis, { key: 'name', label: t('Name'), kind: 'text' }, { key: 'argument', label: t('Argument'), kind: 'text', optional: true }, wait], fresh: { axis: '', name: '' } },
  {
    word: 'write_register',
    label: t('Write a register'),
    fields: [
      { key: 'unit', label: t('Unit ID'), kind: 'number' },
      { key: 'address', label: t('Address'), kind: 'number' },
      { key: 'type', label: t('Type'), kind: 'register_type', optional: true },
      { key: 'value', label: t('Value'), kind: 'value' },
    ],
    fresh: { unit: 1, address: 34, value: 0 },
  },
  {
    word: 'simulate',
    label: t('Simulate (rehearse a fault)'),
    fields: [axis, { key: 'input', label: t('Condition'), kind: 'input' }, { key: 'value', label: t('Value'), kind: 'value' }],
    fresh: { axis: '', input: 'stall', value: true },
  },
  { word: 'wait_for', label: t('Wait for'), fields: [{ key: 'timeout_s', label: t('At most, s'), kind: 'number', optional: true }], condition: 'own', fresh: { axis: '', point: 'moving', is: false, timeout_s: 30 } },
  { word: 'check', label: t('Check'), fields: [{ key: 'text', label: t('Said if not'), kind: 'text', optional: true }], condition: 'own', fresh: { axis: '', point: 'fault', is: false } },
  { word: 'wait_s', label: t('Wait, seconds'), fields: [{ key: '', label: t('Seconds'), kind: 'number' }], fresh: 1 },
  { word: 'if', label: t('If'), fields: [], condition: 'condition', lists: ['then', 'else'], fresh: { condition: { axis: '', point: 'referenced', is: false }, then: [], else: [] } },
  { word: 'repeat', label: t('Repeat'), fields: [{ key: 'times', label: t('Times'), kind: 'number' }], condition: 'until', lists: ['steps'], fresh: { times: 2, steps: [] } },
  { word: 'message', label: t('Message'), fields: [{ key: '', label: t('Text'), kind: 'text' }], fresh: '' },
];
export const points = [
  'state', 'moving', 'target_reached', 'referenced', 'fault', 'warning', 'internal_limit', 'position', 'position_demand', 'following_error', 'velocity', 'target_position', 'position_increments',
  'online', 'simulated', 'stale', 'mode', 'error_code', 'native', 'statusword', 'authority',
];
export const comparisons: { key: string; label: string }[] = [
  { key: 'is', label: t('is') }, { key: 'is_not', label: t('is not') }, { key: 'at_least', label: '≥' }, { key: 'at_most', label: '≤' }, { key: 'above', label: '>' }, { key: 'below', label: '<' },
];
export const commands = ['move_absolute', 'move_relative', 'move_velocity', 'set_position', 'halt', 'quick_stop', 'reset_fault', 'enable', 'disable', 'home'];

const motion = ['velocity', 'acceleration', 'deceleration'];
const takes: Record<string, readonly string[]> = { move_absolute: ['position', ...motion], move_relative: ['position', ...motion], move_velocity: motion, set_position: ['position'] };
/** The fields that a step has use for; a field that is not of its command is shown only while something stands in it. */
export function fieldsOfStep(kind: StepKind, body: unknown): StepField[] {
  if (kind.word !== 'command') return kind.fields;
  const there = (body ?? {}) as Record<string, unknown>;
  const own = takes[String(there.command)] ?? [];
  const moves = [...motion, 'position'];
  return kind.fields.filter((f) => !moves.includes(f.key) || own.includes(f.key) || there[f.key] !== undefined);
}
/** The body of a command step under another command: what that one does not take is gone. */
export function withCommand(body: { [key: string]: Json }, command: string): { [key: string]: Json } {
  const own = takes[command] ?? [];
  return Object.fromEntries(Object.entries({ ...body, command }).filter(([k]) => ![...motion, 'position'].includes(k) || own.includes(k)));
}
/** What a motion field is counted in; empty where the axis, and with it the unit, is not known. */
export function unitOfField(key: string, unit: string | null): string {
  if (unit === null) return '';
  return key === 'position' ? unit : key === 'velocity' ? `${unit}/s` : key === 'acceleration' || key === 'deceleration' ? `${unit}/s²` : '';
}
/** The axis that a step means: the one it names, or by "${name}" what is chosen for that parameter, else its default; null: nobody knows yet. */
export function axisMeant(named: string, parameters: RecipeDocument['parameters'], chosen: Readonly<Record<string, string>> = {}): string | null {
  const name = /^\$\{([\w.-]+)\}$/.exec(named)?.[1];
  if (name === undefined) return named;
  const value = chosen[name] || parameters?.[name]?.default;
  return typeof value === 'string' && value !== '' ? value : null;
}

/** Every text in a document that may be a name. */
export function namesIn(document: unknown): Set<string> {
  const found = new Set<string>();
  const walk = (value: unknown): void => {
    if (typeof value === 'string') found.add(value);
    else if (value !== null && typeof value === 'object') Object.values(value).forEach(walk);
  };
  walk(document);
  return found;
}

/** What the forms call a step of this word. */
export const stepLabel = (word: string): string => stepKinds.find((k) => k.word === word)?.label ?? plainWord(word);

export function kindOf(step: Step): StepKind | undefined {
  return stepKinds.find((k) => k.word in step);
}

export function freshStep(word: string, axisName: string): Step {
  const kind = stepKinds.find((k) => k.word === word) as StepKind;
  const body = structuredClone(kind.fresh);
  const fill = (j: Json): void => {
    if (j === null || typeof j !== 'object' || Array.isArray(j)) return;
    if (j['axis'] === '') j['axis'] = axisName;
    for (const v of Object.values(j)) fill(v);
  };
  fill(body);
  return { [word]: body };
}

/** Where a step stands: ["steps", 2, "if", "then", 0]. */
export type Path = (string | number)[];
export const pointerOf = (path: Path): string => path.map((p) => `/${String(p).replaceAll('~', '~0').replaceAll('/', '~1')}`).join('');

/** What a step is called: `Step 2.1` for the first within the second; the sides of an `if` by name, since both begin to count at 1. */
export const titleOf = (path: Path): string =>
  t('Step {n}', { n: path
    .flatMap((p) => (typeof p === 'number' ? [String(p + 1)] : p === 'then' || p === 'else' ? [p] : []))
    .join('.')
    .replace(/\.(then|else)\./g, (_, side: string) => ` ${side === 'then' ? t('then') : t('else')} `) });

export function at(document: unknown, path: Path): unknown {
  return path.reduce<unknown>((o, key) => (o as Record<string | number, unknown> | undefined)?.[key], document);
}

/** A copy of the document in which `change` has worked on what stands at the path. */
export function changed(document: RecipeDocument, path: Path, change: (there: never) => unknown): RecipeDocument {
  const copy = structuredClone(document);
  const last = path.at(-1) as string | number;
  const parent = at(copy, path.slice(0, -1)) as Record<string | number, unknown>;
  const value = change(parent[last] as never);
  if (value === undefined) delete parent[last];
  else parent[last] = value;
  return copy;
}

export function moved(document: RecipeDocument, list: Path, from: number, by: -1 | 1): RecipeDocument {
  return changed(document, list, (steps: Step[]) => {
    const to = from + by;
    if (to < 0 || to >= steps.length) return steps;
    const next = [...steps];
    [next[from], next[to]] = [next[to] as Step, next[from] as Step];
    return next;
  });
}
export const removed = (document: RecipeDocument, list: Path, i: number): RecipeDocument => changed(document, list, (steps: Step[]) => steps.filter((_, k) => k !== i));
export const added = (document: RecipeDocument, list: Path, step: Step): RecipeDocument => changed(document, list, (steps: Step[] | undefined) => [...(steps ?? []), step]);

/** What was typed as a value: a number, true or false where it reads as one, else a text ("${name}" stays a text). */
export function valueOf(typed: string): Json | undefined {
  const trimmed = typed.trim();
  if (trimmed === '') return undefined;
  if (trimmed === 'true' || trimmed === 'false') return trimmed === 'true';
  // In the reader's figures; what may be two numbers there stays as it was typed, and the gateway says that it is none.
  if (!/^[-+]?[\d.,]*\d[\d.,]*(e[-+]?\d+)?$/i.test(trimmed)) return trimmed;
  const number = parseNumber(trimmed);
  return number.good ? number.value : trimmed;
}
export const typedOf = (value: unknown): string =>
  value === undefined || value === null ? '' : typeof value === 'string' ? value : typeof value === 'number' ? typedNumber(value) : JSON.stringify(value);

export const parameterTypes = ['number', 'integer', 'boolean', 'text', 'axis'] as const;
const mostParameters = 64;
const typeNames: Record<(typeof parameterTypes)[number], string> = { number: t('number'), integer: t('whole number'), boolean: t('yes or no'), text: t('text'), axis: t('axis') };
export const parameterTypeName = (type: string): string => typeNames[type as keyof typeof typeNames] ?? type;

/** Why a parameter cannot have this name; empty: it can. */
export function parameterFault(document: RecipeDocument, name: string): string {
  if (!/^[A-Za-z0-9_.-]{1,64}$/.test(name)) return t('A name has 1 to 64 letters, digits, - _ .');
  const known = Object.keys(document.parameters ?? {});
  if (known.includes(name)) return t('There is a parameter {name} already.', { name });
  return known.length >= mostParameters ? t('A recipe has at most {mostParameters} parameters.', { mostParameters }) : '';
}

/** What was typed as a default, by the type; undefined: no default, the run must be given one. */
export function defaultOf(type: string, typed: string): Json | undefined {
  if (typed.trim() === '') return undefined;
  return type === 'text' || type === 'axis' ? typed : valueOf(typed);
}

/** The parameter with some members changed, or a new one; a member that became undefined is taken away. */
export function withParameter(document: RecipeDocument, name: string, more: Partial<Record<keyof RecipeParameter, Json | undefined>>): RecipeDocument {
  const copy = structuredClone(document);
  const next: Record<string, Json | undefined> = { ...(copy.parameters?.[name] as Record<string, Json> | undefined), ...more };
  for (const [k, v] of Object.entries(next)) if (v === undefined) delete next[k];
  copy.parameters = { ...copy.parameters, [name]: next as unknown as RecipeParameter };
  return ordered(copy);
}

export function withoutParameter(document: RecipeDocument, name: string): RecipeDocument {
  const copy = structuredClone(document);
  delete copy.parameters?.[name];
  if (copy.parameters && Object.keys(copy.parameters).length === 0) delete copy.parameters;
  return copy;
}

/** The parameter under another name, in its place; every "${old}" in the steps becomes "${new}". */
export function renamedParameter(document: RecipeDocument, from: string, to: string): RecipeDocument {
  const inside = (j: Json): Json => {
    if (typeof j === 'string') return j.replaceAll(`\${${from}}`, () => `\${${to}}`);
    if (Array.isArray(j)) return j.map(inside);
    return j === null || typeof j !== 'object' ? j : Object.fromEntries(Object.entries(j).map(([k, v]) => [k, inside(v)]));
  };
  const copy = structuredClone(document);
  copy.steps = inside(copy.steps) as Step[];
  copy.parameters = Object.fromEntries(Object.entries(copy.parameters ?? {}).map(([k, v]) => [k === from ? to : k, v]));
  return copy;
}

/** Parameters stand before the steps that use them, for who reads the JSON. */
function ordered({ steps, ...rest }: RecipeDocument): RecipeDocument {
  return { ...rest, steps };
}

/** Whether a difference can be allowed: only numbers (and what stands for one) are compared within a tolerance. */
export function takesTolerance(op: string, value: unknown): boolean {
  return (op === 'is' || op === 'is_not') && (typeof value === 'number' || (typeof value === 'string' && value.includes('${')));
}

/** A document read from text, or what is wrong with the text. */
export function documentOf(text: string): { document: RecipeDocument } | { fault: string } {
  try {
    const d = JSON.parse(text) as RecipeDocument;
    if (typeof d !== 'object' || d === null || Array.isArray(d)) return { fault: t('A recipe is a JSON object.') };
    if (!Array.isArray(d.steps) || d.steps.some((s) => typeof s !== 'object' || s === null || Array.isArray(s))) return { fault: t('"steps" must be a list of objects.') };
    return { document: d };
  } catch (error) {
    return { fault: error instanceof Error ? error.message : t('This is not JSON.') };
  }
}
/** What differs between two recipes, by place: "/steps/2/wait_s: 1 → 2". */
export function recipeDifferences(before: unknown, after: unknown, place = ''): string[] {
  if (JSON.stringify(before) === JSON.stringify(after)) return [];
  const inner = (v: unknown): v is Record<string, unknown> => typeof v === 'object' && v !== null;
  if (inner(before) && inner(after) && Array.isArray(before) === Array.isArray(after)) {
    return [...new Set([...Object.keys(before), ...Object.keys(after)])].flatMap((k) => recipeDifferences(before[k], after[k], `${place}/${k}`));
  }
  const published = (v: unknown) => (v === undefined ? t('nothing') : JSON.stringify(v));
  return [`${place}: ${published(before)} → ${published(after)}`];
}
/** Without what the gateway adds by itself. */
export function editable(document: RecipeDocument): RecipeDocument {
  const copy = structuredClone(document);
  for (const key of ['name', 'changed_at', 'changed_by']) delete copy[key];
  return copy;
}

/** "AC of feeder = 20000": what a step of a report is about, without its number and its word. */
export function stepWhat(s: { label?: string; step: string }): string {
  const published = (s.label ?? '').replace(/^Step [^:]*: /, '');
  return published.startsWith(s.step) ? published.slice(s.step.length).trim() : published;
}
/** How long a step took, as exactly as one compares steps: "12 ms", "0.85 s", "2 min". */
export const tookText = (ms: number): string => (ms < 0 ? '' : ms < 100 ? t('{n} ms', { n: Math.round(ms) }) : ms < 10_000 ? t('{n} s', { n: localFigures((ms / 1000).toFixed(2)) }) : duration(ms));
/** A step of the document in one line, for the folded form: "feeder, Move to, 12". */
export function stepSummary(step: Step): string {
  const kind = kindOf(step);
  const body = kind ? step[kind.word] : undefined;
  const parts: string[] = [];
  const put = (v: unknown): void => {
    if (v === null || v === undefined || v === '') return;
    if (Array.isArray(v)) parts.push(v.length === 1 ? t('1 step') : t('{n} steps', { n: v.length }));
    else if (typeof v === 'object') for (const [k, x] of Object.entries(v)) put(typeof x === 'number' && comparisons.some((c) => c.key === k) ? `${comparisons.find((c) => c.key === k)?.label} ${x}` : x);
    else parts.push(plain(String(v)));
  };
  put(body);
  if (typeof step['comment'] === 'string' && step['comment']) parts.push(`“${step['comment']}”`);
  return parts.join(', ');
}

/** How much of a run was carried out: the step in which a run ended that is not done was not. */
export function doneOf(r: { state: string; of: number; begun: number }): number {
  if (r.state === 'done') return r.of;
  const before = Math.max(0, Math.min(r.begun, r.of) - 1);
  return r.state === 'running' ? Math.min(r.begun, r.of) : before;
}

export interface Unknown {
  pointer: string;
  title: string;
  axis: string;
}
/** Steps that name an axis which the site does not have. What comes by a parameter without a default is not known before the run. */
export function unknownAxes(document: RecipeDocument, axes: readonly string[]): Unknown[] {
  const found: Unknown[] = [];
  const look = (body: unknown, path: Path) => {
    const named = (body as { axis?: unknown } | null | undefined)?.axis;
    const meant = typeof named === 'string' && named !== '' ? axisMeant(named, document.parameters) : null;
    if (meant !== null && !axes.includes(meant)) found.push({ pointer: pointerOf(path), title: titleOf(path), axis: meant });
  };
  const walk = (list: Path) => {
    const steps = at(document, list);
    if (!Array.isArray(steps)) return;
    (steps as Step[]).forEach((s, i) => {
      const kind = kindOf(s);
      if (!kind) return;
      const path = [...list, i];
      const body = s[kind.word];
      look(kind.condition === 'condition' || kind.condition === 'until' ? (body as { [k: string]: Json } | null)?.[kind.condition] : body, path);
      for (const l of kind.lists ?? []) walk([...path, kind.word, l]);
    });
  };
  walk(['steps']);
  return found;
}
/** "Step 2 names foo, which is no axis of this site"; each step of it once, at most five. */
export function unknownText(list: readonly Unknown[]): string {
  const published = list.slice(0, 5).map((u) => t('{title} names {axis}, which is no axis of this site', { title: u.title, axis: u.axis }));
  return t('{steps}. A run would be refused.', { steps: [...published, ...(list.length > 5 ? [t('and {n} more', { n: list.length - 5 })] : [])].join('; ') });
}

export function runWord(state: string): Word {
  switch (state) {
    case 'running': return { text: t('Running'), icon: 'arrow-right', tone: 'active', long: t('The run goes on') };
    case 'stopping': return { text: t('Stopping'), icon: 'pause', tone: 'warning', long: t('Axes that the run has set in motion are being stopped') };
    case 'done': return { text: t('Done'), icon: 'check', tone: 'good', long: t('Every step was carried out') };
    case 'cancelled': return { text: t('Cancelled'), icon: 'stop', tone: 'warning', long: t('The run was ended before its end') };
    case 'interrupted': return { text: t('Interrupted'), icon: 'triangle', tone: 'warning', long: t('The gateway ended while it was under way; nobody has seen its end') };
    case 'failed': return { text: t('Failed'), icon: 'triangle', tone: 'fault', long: t('A step failed') };
    default: return { text: t('Not run'), icon: 'circle-dashed', tone: 'muted', long: t('Not carried out') };
  }
}

/** Whether a run has ended. */
export const isOver = (state: string): boolean => state !== 'running' && state !== 'stopping';

/** What is typed for the parameters of a run; what is not typed is left to its default. */
export function argumentsOf(parameters: NonNullable<RecipeDocument['parameters']>, typed: Readonly<Record<string, string>>): Record<string, Json> {
  const out: Record<string, Json> = {};
  for (const [key, p] of Object.entries(parameters)) {
    const entered = typed[key];
    if (entered === undefined || entered === '') continue;
    out[key] = p.type === 'text' || p.type === 'axis' ? entered : (valueOf(entered) ?? entered);
  }
  return out;
}

const isAt = (pointer: string, place: string) => pointer === place || pointer.startsWith(`${place}/`);
/** Faults that stand beside no step and no parameter. */
export const faultsElsewhere = <F extends { pointer: string }>(faults: readonly F[], d: RecipeDocument): F[] =>
  faults.filter((f) => !f.pointer.startsWith('/steps/') && !Object.keys(d.parameters ?? {}).some((p) => isAt(f.pointer, `/parameters/${p}`)));
/** Faults of a step itself, and whether there is any in it, its inner steps included. */
export function faultsOfStep<F extends { pointer: string }>(faults: readonly F[], pointer: string, kind: StepKind | undefined): { mine: F[]; any: boolean } {
  const inner = kind?.lists?.map((l) => `${pointer}/${kind.word}/${l}/`) ?? [];
  const all = faults.filter((f) => isAt(f.pointer, pointer));
  return { mine: all.filter((f) => !inner.some((p) => f.pointer.startsWith(p))), any: all.length > 0 };
}

/** The places of all steps of a list and of those within them. */
export const placesOf = (document: RecipeDocument, list: Path): string[] =>
  ((at(document, list) ?? []) as Step[]).flatMap((s, i) => {
    const kind = kindOf(s);
    return [pointerOf([...list, i]), ...(kind?.lists ?? []).flatMap((l) => placesOf(document, [...list, i, kind!.word, l]))];
  });
