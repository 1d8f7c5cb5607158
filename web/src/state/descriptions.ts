// Descriptions of the gateway: the list that all parts of the page share, files on their way to it, and the removal of one. In: the HTTP door, files.
// Out: signals. A file is checked by the gateway alone; here only its name and size are looked at. Nothing is sent twice.
import { signal } from '@preact/signals';
import type { Client } from '../api/client';
import { DescriptionDoor, type DescriptionEntry } from '../api/descriptions';
import { asProblem } from '../api/problem';
import { t, theirs } from '../language';
import { largestFile, storedName } from '../text/description';
import { capital } from './commander';
import { quiet, refusal, type Reported } from './reported';
import { sizeText } from '../text/site-files';

/** One file that a person has chosen, and how it went. */
export interface Sent {
  file: string;
  /** Name under which it is stored; '' if it was not. */
  name: string;
  tone: Reported['tone'];
  text: string;
  /** Of the gateway, in its words. */
  faults: readonly string[];
}
type Door = Pick<DescriptionDoor, 'list' | 'add' | 'remove'>;

export class DescriptionShelf {
  /** null: not known yet. */
  readonly list = signal<DescriptionEntry[] | null>(null);
  /** Of the last choice, in its order. */
  readonly sent = signal<readonly Sent[]>([]);
  readonly busy = signal(false);
  readonly reported = signal<Reported>(quiet);

  constructor(private readonly door: Door) {}

  readonly load = async (): Promise<void> => void (this.list.value = await this.door.list());
  find = (name: string): DescriptionEntry | undefined => this.list.value?.find((d) => d.name === name);

  /** One file after the other. Out: those that are stored now. */
  async add(files: readonly File[]): Promise<DescriptionEntry[]> {
    if (this.busy.peek() || files.length === 0) return [];
    this.busy.value = true;
    this.sent.value = files.map((f) => ({ file: f.name, name: '', tone: 'busy', text: t('waits'), faults: [] }));
    const stored: DescriptionEntry[] = [];
    for (const [i, file] of files.entries()) {
      const tell = (how: Partial<Sent>) => (this.sent.value = this.sent.peek().map((s, k) => (k === i ? { ...s, ...how } : s)));
      tell({ text: t('is being read …') });
      const d = await this.one(file, tell);
      if (d) stored.push(d);
    }
    await this.load().catch(() => undefined);
    this.busy.value = false;
    return stored;
  }

  private async one(file: File, tell: (how: Partial<Sent>) => void): Promise<DescriptionEntry | null> {
    const refuse = (text: string) => (tell({ tone: 'refused', text }), null);
    const name = storedName(file.name);
    if (name === '') return refuse(t('is no EDS or DCF file by its name: such a name ends with .eds or .dcf.'));
    if (file.size > largestFile) return refuse(t('has {size}; at most {most} are taken.', { size: sizeText(file.size), most: sizeText(largestFile) }));
    try {
      const d = await this.door.add(name, file);
      const { length } = d.warnings;
      tell({ name, tone: 'good', text: length === 0 ? t('is stored without a warning.') : length === 1 ? t('is stored, with 1 warning.') : t('is stored, with {n} warnings.', { n: length }) });
      return d;
    } catch (error) {
      const p = asProblem(error);
      tell({ tone: 'refused', text: t('is not stored: {why}', { why: theirs(p.message) }), faults: (p.document.faults ?? []).map((f) => f.text).filter((f) => !p.message.includes(f)) });
      return null;
    }
  }

  /** The gateway refuses it while a drive uses it, and says which: in force, staged, or where a trial goes back to. */
  async remove(name: string): Promise<boolean> {
    this.reported.value = { tone: 'busy', text: t('Removing …') };
    try {
      await this.door.remove(name);
      this.reported.value = { tone: 'good', text: capital(t('{name} is deleted.', { name })) };
      await this.load().catch(() => undefined);
      return true;
    } catch (error) {
      this.reported.value = refusal(error);
      return false;
    }
  }
}

const shelves = new WeakMap<Client, { door: DescriptionDoor; shelf: DescriptionShelf }>();
/** One for all parts of the page. */
export function descriptionsOf(client: Client): { door: DescriptionDoor; shelf: DescriptionShelf } {
  let s = shelves.get(client);
  if (!s) {
    const door = new DescriptionDoor(client);
    shelves.set(client, (s = { door, shelf: new DescriptionShelf(door) }));
  }
  return s;
}
