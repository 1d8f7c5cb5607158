// Wizard form: one step that makes a line, a drive or an axis: take one that is there, or describe a new one. In: the draft, what is kept of the step. Out: an entry in
// the draft. What is typed is kept over a reload.
import { useSignal } from '@preact/signals';
import { useEffect, useRef } from 'preact/hooks';
import { useGateway } from '../gateway';
import { t } from '../language';
import type { SiteDraft } from '../state/site-draft';
import { chosen, choose, chosenDescription, fieldsOfStep, keepTyped, textsOf } from '../state/site-wizard';
import { lineNameFor } from '../text/ports';
import { checkEntry, withEntry, type Room, type Texts } from '../text/site';
import { DriveOfFile } from './drive-description';
import { EntryField } from './site-entries';

const kinds = [
  { id: 'twin', text: t('No drive yet: simulate it'), uri: 'twin' },
  { id: 'can', text: t('CAN'), uri: 'can:can0' },
  { id: 'serial', text: t('Serial port, RS-485'), uri: 'serial:/dev/ttyUSB0?baud=9600&rs485=1' },
  { id: 'tcp', text: t('Network, TCP'), uri: 'tcp:192.0.2.10:8888' },
  { id: 'udp', text: t('Network, UDP'), uri: 'udp:192.0.2.10:503' },
];
const kindOf = (uri: string) => uri.split(':')[0] ?? '';
const nouns: Record<Room, string> = { lines: t('line'), drives: t('drive'), axes: t('axis') };
const newText: Record<Room, string> = { lines: t('a new line'), drives: t('a new drive'), axes: t('a new axis') };

export function StepForm({ room, draft, back, next }: { room: Room; draft: SiteDraft; back: (() => void) | null; next: () => void }) {
  const site = draft.draft.value;
  const list = site[room] ?? [];
  // A drive of the chosen line, an axis of the chosen drive.
  const fitting = list.filter((e) => (room === 'lines' ? true : room === 'drives' ? e.line === chosen.lines.value : e.drive === chosen.drives.value));
  // A drive that is to be made of a file is a new one.
  const asNew = room === 'drives' && chosenDescription() !== null;
  const use = useSignal(asNew ? '' : fitting.some((e) => e.name === chosen[room].peek()) ? chosen[room].peek() : (fitting[0]?.name ?? ''));
  const { store } = useGateway();
  const texts = useSignal<Texts>(textsOf(room, draft, store.families.value));
  const touched = useSignal(false);
  const form = useRef<HTMLFormElement>(null);
  useEffect(() => {
    // What a scan added is chosen.
    if (use.peek() === '' && fitting.length > 0 && room === 'drives' && !touched.peek() && !asNew) use.value = fitting[0]!.name;
  }, [fitting.length]);
  const { entry, faults } = checkEntry(room, texts.value, site, null);
  const set = (key: string) => (text: string) => {
    const before = texts.peek();
    const next = { ...before, [key]: text };
    // A name that nobody has typed goes with the line.
    if (room === 'lines' && key === 'uri' && before.name === lineNameFor(before.uri ?? '', site.lines)) next.name = lineNameFor(text, site.lines);
    texts.value = next;
    keepTyped(room, next);
  };
  const word = nouns[room];
  const submit = () => {
    if (use.value !== '') {
      chosen[room].value = use.value;
      return next();
    }
    touched.value = true;
    if (!entry) return void requestAnimationFrame(() => form.current?.querySelector<HTMLElement>('.is-wrong')?.focus());
    draft.edit(withEntry(site, room, entry, null));
    choose(room, entry.name);
    next();
  };
  return (
    <form
      ref={form}
      class="form"
      noValidate
      aria-label={t('Wizard: {word}', { word })}
      onSubmit={(e) => {
        e.preventDefault();
        submit();
      }}
    >
      {fitting.length > 0 && (
        <fieldset class="choices">
          <legend>{t('Take one that is there, or describe a new one')}</legend>
          {fitting.map((e) => (
            <label key={e.name} class="check">
              <input type="radio" name={`wizard-${room}`} checked={use.value === e.name} onChange={() => (use.value = e.name)} /> {e.name}
            </label>
          ))}
          <label class="check">
            <input type="radio" name={`wizard-${room}`} checked={use.value === ''} onChange={() => (use.value = '')} />{' '}{newText[room]}
          </label>
        </fieldset>
      )}
      {use.value === '' && room === 'lines' && (
        <fieldset class="choices">
          <legend>{t('What kind of line is it?')}</legend>
          {kinds.map((k) => (
            <label key={k.id} class="check">
              <input type="radio" name="wizard-kind" checked={kindOf(texts.value.uri ?? '') === k.id} onChange={() => set('uri')(k.uri)} /> {k.text}
            </label>
          ))}
        </fieldset>
      )}
      {use.value === '' && (
        <div class="form-grid">
          {fieldsOfStep(room, texts.value).map((f) => (
            <EntryField key={f.key} f={f} site={site} texts={texts.value} onText={set(f.key)} fault={touched.value || (texts.value[f.key] ?? '') !== '' ? faults[f.key] : undefined} />
          ))}
        </div>
      )}
      {use.value === '' && room === 'drives' && (
        <DriveOfFile
          line={(site.lines ?? []).find((l) => l.name === chosen.lines.value)}
          site={site}
          onTexts={(made) => {
            texts.value = { ...texts.peek(), ...made };
            keepTyped(room, texts.peek());
          }}
        />
      )}
      {use.value === '' && touched.value && (faults.line || faults.drive) && <p class="form-told is-fault">{faults.line ?? faults.drive}</p>}
      <div class="form-foot">
        {back && (
          <button type="button" class="button" onClick={back}>
            {t('Back')}
          </button>
        )}
        <button type="submit" class="button primary">
          {t('Next')}
        </button>
      </div>
    </form>
  );
}
