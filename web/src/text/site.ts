// A site in words and forms: fields of lines, drives and axes, what was typed for them, what differs between two sites, and one person's changes put
// on top of another's. In: documents, text. Out: entries, faults per field, differences. Pure. Members that the page does not know are kept.
import { midSentence, t } from '../language';
import { causeNames, causeText, failSafeHint } from './fail-safe';
import { formatExact, parseNumber, typedNumber } from './number';
import { optionFault, optionPrefix, optionsFrom, optionTexts, type OptionSpec } from './options';
import { presences } from './presence';

export type Entry = { name: string } & Record<string, unknown>;
export interface Site {
  lines?: Entry[];
  drives?: Entry[];
  axes?: Entry[];
  mappings?: ({ id?: string } & Record<string, unknown>)[];
  /** Units of the Modbus door that answer in their own way; absent: none. */
  modbus_units?: ({ unit?: number } & Record<string, unknown>)[];
}
export const rooms = ['lines', 'drives', 'axes'] as const;
export type Room = (typeof rooms)[number];
export const oneOf: Record<Room | 'mappings' | 'modbus_units', string> = { lines: t('line'), drives: t('drive'), axes: t('axis'), mappings: t('mapping'), modbus_units: t('Modbus unit') };

export interface FieldSpec {
  /** Where it stands in the entry; "timing.retries" in an object of it. */
  key: string;
  label: string;
  kind: 'name' | 'text' | 'integer' | 'number' | 'choice' | 'switch' | 'line' | 'drive' | 'family' | 'address' | 'description';
  required?: boolean;
  min?: number;
  max?: number;
  above?: number;
  choices?: readonly { value: string; text: string }[];
  hint?: string;
  placeholder?: string;
  /** Rarely needed: folded away. */
  more?: boolean;
}

const timing = (key: string, label: string, min: number, max: number, hint: string): FieldSpec => ({ key: `timing.${key}`, label, kind: 'integer', min, max, more: true, placeholder: t("the family's"), hint });
export const uriKinds = ['twin', 'can:can0', 'serial:/dev/ttyUSB0?baud=9600&rs485=1', 'tcp:192.0.2.10:8888', 'tcp-listen:127.0.0.1:4001', 'udp:192.0.2.10:503', 'pty:/run/axisgate/drive', 'dds'];

const failSafeActions = [
  { value: '', text: t('the default') },
  { value: 'nothing', text: t('nothing') },
  { value: 'halt', text: t('halt') },
  { value: 'quick_stop', text: t('quick stop') },
  { value: 'disable', text: t('switch off') },
];

const nameHint = t('letters, digits, - _ and .; it is in addresses, registers’ lists and recipes');
export const fieldsOf: Record<Room, readonly FieldSpec[]> = {
  lines: [
    { key: 'name', label: t('Name'), kind: 'name', required: true, hint: nameHint },
    { key: 'family', label: t('Family'), kind: 'family', hint: t('of its drives; may be empty on a CAN line whose drives each name theirs') },
    { key: 'uri', label: 'URI', kind: 'text', required: true, placeholder: 'can:can0', hint: t('where the line is: {forms}; “twin”: embedded drives alone; “dds”: axes of other gateways (family remote)', { forms: 'can:can0, serial:/dev/ttyUSB0?baud=9600, tcp:HOST:PORT' }) },
    { key: 'bitrate', label: t('Bit rate'), kind: 'integer', min: 0, max: 100000000, hint: t('bit/s; empty: from the URI, or the family’s') },
    timing('reply_timeout_ms', t('Reply time-out, ms'), 0, 60000, t('how long an answer is waited for')),
    timing('poll_period_ms', t('Poll period, ms'), 0, 60000, t('how often each drive is asked')),
    timing('pause_ms', t('Pause, ms'), 0, 10000, t('silence of the line between two exchanges')),
    timing('stale_after_ms', t('Stale after, ms'), 0, 600000, t('data older than this is told as stale')),
    timing('retries', t('Retries'), -1, 20, t('how often an exchange without an answer is repeated; −1: as the family has it')),
    timing('silent_limit', t('Silent limit'), 1, 1000, t('after so many exchanges without an answer a drive is offline')),
    timing('retry_pause_min_ms', t('First retry pause, ms'), 1, 600000, t('until an offline drive is asked again')),
    timing('retry_pause_max_ms', t('Longest retry pause, ms'), 1, 600000, t('the pauses grow up to this')),
  ],
  drives: [
    { key: 'name', label: t('Name'), kind: 'name', required: true, hint: nameHint },
    { key: 'line', label: t('Line'), kind: 'line', required: true, hint: t('that it hangs on') },
    { key: 'family', label: t('Family'), kind: 'family', hint: t('empty: the line’s; several can share a CAN line'), more: true },
    { key: 'address', label: t('Address'), kind: 'address', hint: t('empty: the factory address') },
    { key: 'description', label: t('Description'), kind: 'description', hint: t('the maker’s EDS or DCF, whose objects become the parameters of the axis; none: the objects of the standard') },
    { key: 'presence', label: t('Presence'), kind: 'choice', choices: presences, hint: t('who serves its axes: the drive if it answers and else its model (auto), the drive alone (device), the model alone (twin); on a line dds the drive is the other gateway’s axis') },
  ],
  axes: [
    { key: 'name', label: t('Name'), kind: 'name', required: true, hint: nameHint },
    { key: 'drive', label: t('Drive'), kind: 'drive', required: true, hint: t('that moves it') },
    { key: 'channel', label: t('Channel'), kind: 'integer', min: 1, max: 256, placeholder: '1', hint: t('which axis of the drive; most drives have one') },
    { key: 'number', label: t('Number'), kind: 'integer', required: true, min: 1, max: 1024, hint: t('place in the register map') },
    { key: 'group', label: t('Machine part'), kind: 'text', hint: t('axes of one part stand together; empty: none') },
    { key: 'unit', label: t('Unit'), kind: 'text', placeholder: t('increments'), hint: t('such as mm or deg') },
    { key: 'increments_per_unit', label: t('Increments per unit'), kind: 'number', above: 0, hint: t('how many increments of the drive make one unit') },
    { key: 'position_min', label: t('Lowest position'), kind: 'number', hint: t('software limit, in unit') },
    { key: 'position_max', label: t('Highest position'), kind: 'number', hint: t('software limit, in unit') },
    { key: 'velocity_max', label: t('Highest speed'), kind: 'number', above: 0, hint: t('in unit/s') },
    { key: 'acceleration_max', label: t('Highest acceleration'), kind: 'number', above: 0, hint: t('in unit/s²') },
    ...causeNames.map((c): FieldSpec => ({ key: `fail_safe.${c}`, label: t('Fail-safe: {cause}', { cause: midSentence(causeText(c)) }), kind: 'choice', more: true, choices: failSafeActions, hint: failSafeHint })),
    { key: 'fail_safe.watchdog_ms', label: t('Silent after, ms'), kind: 'integer', min: 0, max: 600000, more: true, placeholder: t('the gateway\'s'), hint: t('0: silence is not watched') },
    {
      key: 'stored_parameters',
      label: t('Stored parameters'),
      kind: 'choice',
      more: true,
      hint: t('when the drive answers: compared with what was written through the gateway, and with the values of its DCF; or written where they differ'),
      choices: [{ value: '', text: t('not looked at') }, { value: 'compare', text: t('compared') }, { value: 'write', text: t('compared and written') }],
    },
    { key: 'trend_on_disk', label: t('Trends on the disk'), kind: 'switch', more: true, hint: t('they outlive a restart of the gateway') },
    { key: 'authority_mode', label: t('Authority'), kind: 'choice', more: true, hint: t('free: a command needs no lease; lease: a command takes the axis for a while, and others are refused'), choices: [{ value: '', text: t('as the gateway has it') }, { value: 'free', text: t('free') }, { value: 'lease', text: t('lease') }] },
  ],
};

export type Texts = Record<string, string>;

const at = (entry: Record<string, unknown>, key: string): unknown => key.split('.').reduce<unknown>((o, k) => (o as Record<string, unknown> | null | undefined)?.[k], entry);

export function textsOfEntry(room: Room, entry: Entry | null): Texts {
  const own = Object.fromEntries(
    fieldsOf[room].map((f) => {
      const v = entry ? at(entry, f.key) : undefined;
      if ((v === undefined || v === null) && f.key === 'presence') return [f.key, 'auto'];
      return [f.key, v === undefined || v === null ? '' : typeof v === 'number' ? typedNumber(v) : String(v)];
    }),
  );
  return room === 'axes' ? own : { ...own, ...optionTexts(entry?.options) };
}

function readField(f: FieldSpec, text: string): { value: unknown; why: string } {
  const typed = text.trim();
  if (typed === '') return { value: undefined, why: f.required ? t('This is needed.') : '' };
  switch (f.kind) {
    case 'name':
      return { value: typed, why: /^[A-Za-z0-9_.-]{1,64}$/.test(typed) ? '' : t('1 to 64 letters, digits, - _ and .') };
    case 'integer':
    case 'number': {
      const p = parseNumber(typed);
      if (!p.good) return { value: undefined, why: p.why };
      const low = f.min !== undefined && p.value < f.min;
      const high = f.max !== undefined && p.value > f.max;
      if (f.kind === 'integer' && !Number.isInteger(p.value)) return { value: undefined, why: t('A whole number.') };
      if (low || high) return { value: undefined, why: t('From {min} to {max}.', { min: f.min === undefined ? '−∞' : formatExact(f.min), max: f.max === undefined ? '∞' : formatExact(f.max) }) };
      if (f.above !== undefined && p.value <= f.above) return { value: undefined, why: t('Above {above}.', { above: formatExact(f.above) }) };
      return { value: p.value, why: '' };
    }
    case 'address':
      return { value: /^\d+$/.test(typed) ? Number(typed) : typed, why: '' };
    case 'switch':
      return { value: typed === 'true', why: '' };
    default:
      return { value: typed, why: '' };
  }
}

/** From what was typed to an entry. `own`: the entry that is being changed; null: a new one. `options`: those of its family. */
export function checkEntry(room: Room, texts: Texts, site: Site, own: Entry | null, options: readonly OptionSpec[] = []): { entry: Entry | null; faults: Texts } {
  const faults: Texts = {};
  const entry: Record<string, unknown> = structuredClone(own ?? {});
  for (const f of fieldsOf[room]) {
    const { value, why } = readField(f, texts[f.key] ?? '');
    if (why) faults[f.key] = why;
    const [first = '', second] = f.key.split('.');
    if (second === undefined) {
      if (value === undefined) delete entry[first];
      else entry[first] = value;
    } else {
      const inner = { ...((entry[first] as Record<string, unknown> | null) ?? {}) };
      if (value === undefined) delete inner[second];
      else inner[second] = value;
      if (Object.keys(inner).length === 0) delete entry[first];
      else entry[first] = inner;
    }
  }
  if (room !== 'axes') {
    entry.options = optionsFrom(texts, own?.options, options);
    if (Object.keys(entry.options as object).length === 0) delete entry.options;
    for (const o of options) {
      const why = optionFault(o, texts[optionPrefix + o.name] ?? '');
      if (why) faults[optionPrefix + o.name] = why;
    }
  }
  const others = (site[room] ?? []).filter((e) => e.name !== own?.name);
  const taken = (key: string, text: string, same: (e: Entry) => boolean) => {
    const o = others.find(same);
    if (o && !faults[key]) faults[key] = `${text} ${o.name}.`;
  };
  taken('name', { lines: t('There is already a line'), drives: t('There is already a drive'), axes: t('There is already an axis') }[room], (e) => e.name === entry.name);
  if (room === 'drives' && entry.line !== undefined && !(site.lines ?? []).some((l) => l.name === entry.line)) faults.line ??= t('There is no line {line}.', { line: String(entry.line) });
  if (room === 'drives' && entry.address !== undefined) taken('address', t('The same address on this line has'), (e) => e.line === entry.line && (e.family ?? '') === (entry.family ?? '') && String(e.address) === String(entry.address));
  if (room === 'axes') {
    if (entry.drive !== undefined && !(site.drives ?? []).some((d) => d.name === entry.drive)) faults.drive ??= t('There is no drive {drive}.', { drive: String(entry.drive) });
    taken('number', t('This number has'), (e) => e.number === entry.number);
    taken('channel', t('This channel of the drive has'), (e) => e.drive === entry.drive && (e.channel ?? 1) === (entry.channel ?? 1));
    // Left empty it would be 1, and every move would be wrong by the whole factor.
    const unit = String(entry.unit ?? '').trim();
    if (!['', 'inc', 'increments'].includes(unit) && entry.increments_per_unit === undefined) faults.increments_per_unit ??= t('How many increments make one {unit}?', { unit });
    const { position_min: low, position_max: high } = entry as { position_min?: number; position_max?: number };
    if (low !== undefined && high !== undefined && low >= high) faults.position_max ??= t('The highest position lies above the lowest.');
  }
  return { entry: Object.keys(faults).length === 0 ? (entry as Entry) : null, faults };
}

/** Puts an entry into the site; a new name is followed by everything that refers to it. */
export function withEntry(site: Site, room: Room, entry: Entry, own: string | null): Site {
  const next: Site = { ...site, [room]: own === null ? [...(site[room] ?? []), entry] : (site[room] ?? []).map((e) => (e.name === own ? entry : e)) };
  if (own === null || own === entry.name) return next;
  if (room === 'lines') next.drives = (site.drives ?? []).map((d) => (d.line === own ? { ...d, line: entry.name } : d));
  if (room === 'drives') next.axes = (site.axes ?? []).map((a) => (a.drive === own ? { ...a, drive: entry.name } : a));
  if (room === 'axes') next.mappings = (site.mappings ?? []).map((m) => (m.axis === own ? { ...m, axis: entry.name } : m));
  return next;
}

/** Takes an entry out, with everything that hangs on it. */
export function withoutEntry(site: Site, room: Room, name: string): Site {
  const gone = { lines: new Set<unknown>(), drives: new Set<unknown>(), axes: new Set<unknown>() };
  gone[room].add(name);
  for (const d of site.drives ?? []) if (gone.lines.has(d.line)) gone.drives.add(d.name);
  for (const a of site.axes ?? []) if (gone.drives.has(a.drive)) gone.axes.add(a.name);
  const next: Site = { ...site };
  for (const r of rooms) next[r] = (site[r] ?? []).filter((e) => !gone[r].has(e.name));
  next.mappings = (site.mappings ?? []).filter((m) => !gone.axes.has(m.axis));
  return next;
}

export interface Difference {
  kind: 'added' | 'removed' | 'changed';
  what: string;
  before: Record<string, unknown> | null;
  after: Record<string, unknown> | null;
}

const keyOf = (room: string, e: Record<string, unknown>, i: number): string => (room === 'mappings' ? String(e.id ?? `${e.unit}/${e.table ?? ''}/${e.address}`) : String((room === 'modbus_units' ? e.unit : e.name) ?? i));
const allRooms = [...rooms, 'mappings', 'modbus_units'] as const;
const indexOf = (site: Site, room: (typeof allRooms)[number]) => new Map((site[room] ?? []).map((e, i) => [keyOf(room, e, i), e as Record<string, unknown>]));

export function sameDocument(a: unknown, b: unknown): boolean {
  if (a === b) return true;
  if (typeof a !== 'object' || typeof b !== 'object' || a === null || b === null || Array.isArray(a) !== Array.isArray(b)) return false;
  const keys = new Set([...Object.keys(a), ...Object.keys(b)]);
  return [...keys].every((k) => sameDocument((a as Record<string, unknown>)[k], (b as Record<string, unknown>)[k]));
}

export function differenceOf(before: Site, after: Site): Difference[] {
  return allRooms.flatMap((room) => {
    const a = indexOf(before, room);
    const b = indexOf(after, room);
    const list: Difference[] = [];
    for (const [k, e] of a) if (!b.has(k)) list.push({ kind: 'removed', what: `${room}/${k}`, before: e, after: null });
    for (const [k, e] of b) {
      const old = a.get(k);
      if (!old) list.push({ kind: 'added', what: `${room}/${k}`, before: null, after: e });
      else if (!sameDocument(old, e)) list.push({ kind: 'changed', what: `${room}/${k}`, before: old, after: e });
    }
    return list;
  });
}

const shown = (v: unknown): string => (v === undefined || v === null ? t('nothing') : typeof v === 'object' ? JSON.stringify(v) : typeof v === 'number' ? typedNumber(v) : String(v));

/** "axis feeder: unit mm → deg, number 1 → 2". */
export function differenceText(d: { kind: string; what: string; before?: Record<string, unknown> | null | undefined; after?: Record<string, unknown> | null | undefined }): string {
  const [room = '', ...rest] = d.what.split('/');
  const name = `${oneOf[room as Room] ?? room} ${rest.join('/')}`;
  const before = d.before ?? {};
  const after = d.after ?? {};
  if (d.kind === 'changed') {
    const keys = [...new Set([...Object.keys(before), ...Object.keys(after)])].filter((k) => !sameDocument(before[k], after[k]));
    return `${name}: ${keys.map((k) => `${k.replaceAll('_', ' ')} ${shown(before[k])} → ${shown(after[k])}`).join(', ')}`;
  }
  const members = Object.entries(d.kind === 'added' ? after : before).filter(([k]) => k !== 'name' && k !== 'id');
  return `${name}${members.length > 0 ? `: ${members.map(([k, v]) => `${k.replaceAll('_', ' ')} ${shown(v)}`).join(', ')}` : ''}`;
}

/** My changes (from `base` to `mine`) put on top of what somebody else made of the base. `clashes`: entries that both changed; mine stand. */
export function rebase(base: Site, mine: Site, theirs: Site): { site: Site; clashes: Difference[] } {
  const changes = differenceOf(base, mine);
  const touched = new Map(differenceOf(base, theirs).map((d) => [d.what, d]));
  const site: Site = {};
  for (const room of allRooms) {
    const list = new Map(indexOf(theirs, room));
    for (const c of changes) {
      if (!c.what.startsWith(`${room}/`)) continue;
      const key = c.what.slice(room.length + 1);
      if (c.after) list.set(key, c.after);
      else list.delete(key);
    }
    if (room !== 'modbus_units' || list.size > 0) (site as Record<string, unknown>)[room] = [...list.values()];
  }
  const clashes = changes.flatMap((c) => {
    const t = touched.get(c.what);
    return t && !sameDocument(t.after, c.after) ? [t] : [];
  });
  return { site, clashes };
}

/** Where a fault of the gateway belongs: "/axes/2/number" is the number of the third axis. */
export function placeOf(pointer: string, site: Site): { room: Room; name: string; key: string } | null {
  const [, room, index, ...key] = pointer.split('/');
  if (!rooms.includes(room as Room)) return null;
  const entry = site[room as Room]?.[Number(index)];
  return entry ? { room: room as Room, name: entry.name, key: key.join('.') } : null;
}

/** A name that is not taken yet: the wish, or the wish with a number. */
export function freeName(list: readonly Entry[] | undefined, wish: string): string {
  const taken = new Set((list ?? []).map((e) => e.name));
  const clean = wish.replace(/[^A-Za-z0-9_.-]/g, '-').slice(0, 60) || 'new';
  for (let i = 1; ; i += 1) {
    const name = i === 1 ? clean : `${clean}${i}`;
    if (!taken.has(name)) return name;
  }
}
export function freeNumber(site: Site): number {
  const taken = new Set((site.axes ?? []).map((a) => a.number));
  let n = 1;
  while (taken.has(n)) n += 1;
  return n;
}

/** A text as a site document, or why it is none. The gateway checks the rest. */
export function readSite(text: string): Site | string {
  let d: unknown;
  try {
    d = JSON.parse(text);
  } catch (error) {
    return t('This is not JSON: {why}', { why: error instanceof Error ? error.message : t('it cannot be read') });
  }
  if (typeof d !== 'object' || d === null || Array.isArray(d)) return t('A site is an object with lines, drives, axes and mappings.');
  const fault = Object.entries(d).find(([k, v]) => !(allRooms as readonly string[]).includes(k) || !(v === null || Array.isArray(v)));
  if (fault) return t('“{key}” is no list of a site: {lists}.', { key: fault[0], lists: 'lines, drives, axes, mappings, modbus_units' });
  for (const room of rooms) {
    const bad = ((d as Site)[room] ?? []).findIndex((e) => typeof e?.name !== 'string');
    if (bad >= 0) return t('{room}: entry {n} has no name.', { room, n: bad + 1 });
  }
  const site = d as Site;
  return { lines: site.lines ?? [], drives: site.drives ?? [], axes: site.axes ?? [], mappings: site.mappings ?? [], ...(site.modbus_units?.length ? { modbus_units: site.modbus_units } : {}) };
}
