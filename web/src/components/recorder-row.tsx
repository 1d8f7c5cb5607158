// Recorder row: a capture or a recording in its list: its state, what it is, what can be done with it, another name and an end. And the list around them, with
// the room that they take. In: words, what is done. Out: rows; nothing is asked by itself.
import { useSignal } from '@preact/signals';
import type { ComponentChildren } from 'preact';
import { t, theirs } from '../language';
import { capital } from '../state/commander';
import type { Word } from '../text/axis';
import { bytesText } from '../text/recorder';
import { DeleteButton } from './ask';
import { useBarred } from './gate';
import { Empty } from './lines';
import { marked } from './marked';
import { Pill } from './pill';
import { RenameForm } from './rename-form';
import { Section } from './section';

interface KeptProps {
  title: string;
  /** The title over an empty list is the list's name as well. */
  name: string;
  disk: { disk_bytes: number; disk_most_bytes: number; disk_fault?: string | null | undefined } | null;
  empty: string;
  n: number;
  children: ComponentChildren;
}

/** What is kept on the disk, and how full that is. */
export function KeptSection({ title, name, disk, empty, n, children }: KeptProps) {
  return (
    <Section title={title} beside={disk && <span class="where">{t('{disk_bytes} of {disk_most_bytes}', { disk_bytes: bytesText(disk.disk_bytes), disk_most_bytes: bytesText(disk.disk_most_bytes) })}</span>}>
      {disk?.disk_fault && <p class="notice tone-fault">{marked(theirs(capital(disk.disk_fault)))}</p>}
      {n === 0 ? (
        <Empty text={empty} />
      ) : (
        <ul class="card rows" aria-label={name}>
          {children}
        </ul>
      )}
    </Section>
  );
}

interface RowProps {
  name: string;
  word: Word;
  /** Attributes by which the row is found. */
  marks: Record<`data-${string}`, string>;
  about: ComponentChildren;
  buttons: ComponentChildren;
  /** Whether it may have another name now. */
  renames?: boolean;
  /** Out: whether it is called so now. */
  rename: (to: string) => Promise<boolean>;
  /** Another way to its end than to delete it. */
  instead?: ComponentChildren;
  remove: () => void;
}

export function RecorderRow({ name, word, marks, about, buttons, renames = true, rename, instead, remove }: RowProps) {
  const no = useBarred('operator');
  const renaming = useSignal(false);
  return (
    <li class="row recorder-row" {...marks}>
      <Pill word={word} label={t('State')} />
      <span class="recorder-what">
        <b>{name}</b>
        <span class="where"> {about}</span>
      </span>
      <span class="recorder-buttons">
        {buttons}
        {renames && (
          <button type="button" class="button quiet" {...no} aria-expanded={renaming.value} aria-label={t('Rename {name}', { name })} onClick={() => (renaming.value = !renaming.value)}>
            {t('Rename')}
          </button>
        )}
        {instead ?? <DeleteButton name={name} no={no} onYes={remove} />}
      </span>
      {renaming.value && <RenameForm name={name} rename={(to) => void rename(to).then((good) => good && (renaming.value = false))} />}
    </li>
  );
}
