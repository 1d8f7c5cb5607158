// Site wizard's memory: at which step it is, which line, drive and axis were chosen, what stands in the fields of a step that is not finished. In: the draft. Out: the
// step that is shown, the texts of a step. Kept over a reload; a step whose line, drive or axis is not there any more gives way to the one that makes it.
import { fieldsOf, freeName, freeNumber, type FieldSpec, type Room, type Texts } from '../text/site';
import { lineNameFor, numbered } from '../text/ports';
import type { DescriptionEntry } from '../api/descriptions';
import { chosenOf, driveOf, type Chosen } from '../text/description';
import type { Families } from '../text/options';
import { persisted } from './persisted';
import type { SiteDraft } from './site-draft';

/** Each step but the last two makes one of these. */
export const order: readonly Room[] = ['lines', 'drives', 'axes'];
export const steps = 5;
export const applyStep = 3;
export const moveStep = 4;
const step = persisted('wizard.step', '0');
export const chosen = { lines: persisted('wizard.line'), drives: persisted('wizard.drive'), axes: persisted('wizard.axis') };
/** A description of which a drive is to be made, as JSON; '': none. */
const described = persisted('wizard.description');
/** As JSON. */
const typed = { lines: persisted('wizard.typed.line'), drives: persisted('wizard.typed.drive'), axes: persisted('wizard.typed.axis') };
const keys: Record<Room, readonly string[]> = { lines: ['name', 'family', 'uri', 'bitrate'], drives: ['name', 'family', 'address', 'description', 'presence'], axes: ['name', 'unit', 'increments_per_unit', 'channel', 'position_min', 'position_max', 'velocity_max'] };

/** The family of a drive is asked for only where it is not that of its line. */
export const fieldsOfStep = (room: Room, texts: Texts): FieldSpec[] => fieldsOf[room].filter((f) => keys[room].includes(f.key) && (room !== 'drives' || f.key !== 'family' || texts.family));

export function chosenDescription(): Chosen | null {
  try {
    return JSON.parse(described.value || 'null') as Chosen | null;
  } catch {
    return null; // half of it is nothing
  }
}
/** The wizard makes a drive of this file, from the choice of its line on. */
export function begunWith(d: DescriptionEntry): void {
  described.value = JSON.stringify(chosenOf(d));
  typed.drives.value = '';
  persisted('site.wizard').value = 'open';
  goTo(0);
}

export const goTo = (n: number): void => void (step.value = String(n));

/** `at`: the step that is shown; `gone`: what the wanted one lacks. */
export function placeOf(draft: Pick<SiteDraft, 'draft' | 'rolledBack'>): { at: number; gone: Room | null } {
  const wanted = Math.min(Number(step.value) || 0, steps - 1);
  const missing = order.findIndex((room) => !(draft.draft.value[room] ?? []).some((e) => e.name === chosen[room].value));
  // What was rolled back by itself can be applied again from where one is.
  if (missing < 0 || missing >= wanted || (draft.rolledBack.value && wanted >= applyStep)) return { at: wanted, gone: null };
  return { at: missing, gone: order[missing] ?? null };
}

/** The step is done with this entry. */
export function choose(room: Room, name: string): void {
  chosen[room].value = name;
  typed[room].value = '';
  if (room === 'drives') described.value = '';
}
export const keepTyped = (room: Room, texts: Texts): void => void (typed[room].value = JSON.stringify(texts));
export function forget(): void {
  for (const s of [...Object.values(chosen), ...Object.values(typed), described]) s.value = '';
  goTo(0);
}

/** The fields of a step: what is proposed, and on top of it what was typed for the same line or drive before a reload. */
export function textsOf(room: Room, draft: SiteDraft, families: Families = new Map()): Texts {
  const proposed = first(room, draft, families);
  try {
    const before = JSON.parse(typed[room].peek() || '{}') as Texts;
    const same = before.line === proposed.line && before.drive === proposed.drive;
    return same ? { ...proposed, ...Object.fromEntries(Object.entries(before).filter(([k]) => keys[room].includes(k))) } : proposed;
  } catch {
    return proposed; // half of it is nothing
  }
}

function first(room: Room, draft: SiteDraft, families: Families): Texts {
  const site = draft.draft.peek();
  if (room === 'lines') return { name: lineNameFor('twin', site.lines), uri: 'twin', family: '' };
  if (room === 'drives') {
    const line = (site.lines ?? []).find((l) => l.name === chosen.lines.peek());
    const d = chosenDescription();
    return { name: numbered(site.drives, 'feeder'), line: chosen.lines.peek(), presence: 'auto', ...(d ? driveOf(d, line, site, families) : {}) };
  }
  return { name: freeName(site.axes, chosen.drives.peek() || 'axis'), drive: chosen.drives.peek(), number: String(freeNumber(site)), unit: 'mm', increments_per_unit: '', channel: '1' };
}
