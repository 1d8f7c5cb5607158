// Axis selection: one command for several axes: enable, home after a question, reset, stop. In: what is selected. Out: a command to each axis by
// itself, as its own tile would give it, and what each answered. Axes that are filtered away keep their selection: they are named, never forgotten.
// The bar is always there, so that nothing moves when something is selected.
import { useSignal } from '@preact/signals';
import { marked } from './marked';
import type { Command } from '../api/types';
import { useGateway } from '../gateway';
import { t } from '../language';
import { select, selectedOf, selection } from '../state/axes-selection';
import type { NoteTone } from '../state/commander';
import { Ask } from './ask';
import { useBarred } from './gate';
import { Icon } from './icon';
import { AxisName } from './name';

/** A box that selects one axis, or several at once: all, some or none of them. */
export function SelectBox({ names, label }: { names: readonly string[]; label: string }) {
  const n = names.filter((x) => selection.value.has(x)).length;
  return (
    <input
      type="checkbox"
      class="select-axis"
      aria-label={label}
      checked={n > 0 && n === names.length}
      ref={(box) => {
        if (box) box.indeterminate = n > 0 && n < names.length;
      }}
      onChange={(e) => select(names, e.currentTarget.checked)}
    />
  );
}

interface Given {
  text: string;
  axes: string[];
}

export function SelectionBar() {
  const { commander, store } = useGateway();
  const no = useBarred('operator');
  const given = useSignal<Given | null>(null);
  const asked = useSignal<string[] | null>(null);
  const names = selectedOf(store.axisNames.value);
  const none = names.length === 0;
  const off = none ? { disabled: true } : no;
  const all = (axes: string[], command: Command['command'], text: string) => {
    given.value = { text, axes };
    for (const a of axes) void commander.send(a, { command } as Command, text);
  };
  const stop = () => {
    given.value = { text: t('Stop'), axes: names };
    asked.value = null;
    for (const a of names) void commander.stop(a);
  };
  return (
    <div class="selection card" role="group" aria-label={t('Selected axes')} data-field="selection">
      <span class="selection-count" role="status">
        {none ? t('Nothing is selected') : names.length === 1 ? t('1 axis selected') : t('{n} axes selected', { n: names.length })}
      </span>
      <button type="button" class="button small" aria-label={t('Enable the selected axes')} {...off} onClick={() => all(names, 'enable', t('Enable'))}>
        {t('Enable')}
      </button>
      <button type="button" class="button small" aria-label={t('Home the selected axes')} {...off} onClick={() => (asked.value = names)}>
        {t('Home …')}
      </button>
      <button type="button" class="button small" aria-label={t('Reset faults of the selected axes')} {...off} onClick={() => all(names, 'reset_fault', t('Reset fault'))}>
        {t('Reset')}
      </button>
      <button type="button" class={`stop stop-small${none ? ' stop-calm' : ''}`} aria-label={t('Stop the selected axes')} disabled={none} onClick={stop}>
        <Icon name="octagon" size={14} /> {t('STOP')}
      </button>
      {!none && (
        <button type="button" class="button small quiet" onClick={() => (selection.value = new Set())}>
          {t('Select nothing')}
        </button>
      )}
      {asked.value && (
        <Ask
          field="selection-home"
          text={t('Home {axes}? Each of them moves, by the method of its drive, until it has found its zero.', { axes: asked.value.join(', ') })}
          yes={t('Home them')}
          onNo={() => (asked.value = null)}
          onYes={() => {
            const axes = asked.peek() ?? [];
            asked.value = null;
            all(axes, 'home', t('Home'));
          }}
        />
      )}
      {given.value && <Answers of={given.value} />}
    </div>
  );
}

const counted: Record<Exclude<NoteTone, 'none'>, (n: number) => string> = {
  refused: (n) => t('{n} refused', { n }),
  partly: (n) => t('{n} not confirmed', { n }),
  busy: (n) => t('{n} waiting', { n }),
  good: (n) => t('{n} good', { n }),
};

/** What each axis answered; open from the beginning where one has refused. */
function Answers({ of }: { of: Given }) {
  const { commander } = useGateway();
  const notes = of.axes.map((axis) => ({ axis, note: commander.note(axis).value }));
  const count = (tone: NoteTone) => notes.filter((n) => n.note.tone === tone).length;
  const published = (['refused', 'partly', 'busy', 'good'] as const).filter((tone) => count(tone) > 0).map((tone) => counted[tone](count(tone)));
  const bad = count('refused') + count('partly') > 0;
  return (
    <details class="selection-answers" open={bad || undefined} data-field="selection-answers">
      <summary class={bad ? 'is-fault' : ''}>{published.length > 0 ? t('{command}: {counts}', { command: of.text, counts: published.join(', ') }) : of.text}</summary>
      <ul aria-label={t('Answers of the axes')}>
        {notes.map(({ axis, note }) => (
          <li key={axis} class={`result-${note.tone}`} data-answer={axis}>
            <AxisName name={axis} /> <span>{marked(note.text || '–')}</span>
          </li>
        ))}
      </ul>
    </details>
  );
}
