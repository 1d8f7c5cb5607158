// Site entries: the form of a line, a drive or an axis of the draft. In: the draft, which form is open. Out: the draft, changed; nothing is sent from here.
// Faults of the gateway's last check stand beside their field. What is typed in an open form stays while the page is elsewhere.
import { gatewayText, t } from '../language';
import { signal, useSignal, type Signal } from '@preact/signals';
import { useEffect, useRef } from 'preact/hooks';
import { useGateway } from '../gateway';
import { familyOf, incrementHint, optionsFor } from '../text/options';
import type { SiteDraft } from '../state/site-draft';
import { portKind } from '../text/ports';
import { checkEntry, fieldsOf, freeNumber, textsOfEntry, uriKinds, type Entry, type FieldSpec, type Room, type Site, type Texts } from '../text/site';
import { Choice, Switch, TextField } from './form';
import { BootTexts, DescriptionChoice } from './drive-description';
import { Increments } from './increments';
import { OptionFields } from './option-fields';
import { PortChoice } from './port-choice';

export interface Open {
  /** The entry being changed; null: a new one. */
  own: string | null;
  texts: Texts;
}
export const forms: Record<Room, Signal<Open | null>> = { lines: signal(null), drives: signal(null), axes: signal(null) };
export function openForm(room: Room, site: Site, entry: Entry | null, preset: Texts = {}): void {
  const texts = { ...textsOfEntry(room, entry), ...preset };
  if (!entry && room === 'axes' && !texts.number) texts.number = String(freeNumber(site));
  forms[room].value = { own: entry?.name ?? null, texts };
}

export const changeText: Record<Room, (name: string) => string> = {
  lines: (name) => t('Change line {name}', { name }),
  drives: (name) => t('Change drive {name}', { name }),
  axes: (name) => t('Change axis {name}', { name }),
};
export const addText: Record<Room, string> = { lines: t('Add a line'), drives: t('Add a drive'), axes: t('Add an axis') };

interface FormProps {
  room: Room;
  draft: SiteDraft;
  own: Entry | null;
  open: Signal<Open>;
  gateway: { key: string; text: string }[];
}

export function EntryForm({ room, draft, own, open, gateway }: FormProps) {
  const touched = useSignal(false);
  const moreOpen = useRef(false);
  const form = useRef<HTMLFormElement>(null);
  const site = draft.draft.value;
  const { texts } = open.value;
  const { store } = useGateway();
  const family = familyOf(room, texts, site);
  const options = optionsFor(store.families.value.get(family), room);
  const { entry, faults } = checkEntry(room, texts, site, own, options);
  useEffect(() => form.current?.querySelector<HTMLElement>('input, select')?.focus(), []);
  const close = () => ((open as Signal<Open | null>).value = null);
  const fault = (f: FieldSpec): string | undefined => {
    const mine = faults[f.key];
    if (mine && (touched.value || (texts[f.key] ?? '').trim() !== '')) return mine;
    return gateway.find((g) => g.key === f.key)?.text;
  };
  const set = (key: string, text: string | null) => {
    const { [key]: _, ...rest } = open.value.texts;
    open.value = { ...open.value, texts: text === null ? rest : { ...open.value.texts, [key]: text } };
  };
  const field = (f: FieldSpec) => <EntryField key={f.key} f={f} site={site} texts={texts} fault={fault(f)} onText={(t) => set(f.key, t)} />;
  const more = fieldsOf[room].filter((f) => f.more);
  return (
    <form
      ref={form}
      class="form entry-form"
      noValidate
      aria-label={own ? changeText[room](own.name) : addText[room]}
      onSubmit={(e) => {
        e.preventDefault();
        touched.value = true;
        if (!entry) {
          requestAnimationFrame(() => form.current?.querySelector<HTMLElement>('.is-wrong')?.focus());
          return;
        }
        close();
        draft.put(room, entry, own?.name ?? null);
      }}
    >
      <div class="form-grid">{fieldsOf[room].filter((f) => !f.more).map(field)}</div>
      {room === 'drives' && <BootTexts texts={texts} options={options} />}
      {room !== 'axes' && <OptionFields room={room} family={family} specs={options} texts={texts} onText={set} fault={(key) => gateway.find((g) => g.key === key)?.text} />}
      {more.length > 0 && (
        <details open={(moreOpen.current ||= more.some((f) => fault(f) !== undefined)) || undefined}>
          <summary>{room === 'lines' ? t('Timing: times and retries') : t('More')}</summary>
          <div class="form-grid">{more.map(field)}</div>
        </details>
      )}
      <div class="form-foot">
        <button type="submit" class="button primary">
          {t('Save to draft')}
        </button>
        <button type="button" class="button quiet" onClick={close}>
          {t('Cancel')}
        </button>
      </div>
    </form>
  );
}

interface FieldProps {
  f: FieldSpec;
  site: Site;
  texts: Texts;
  fault: string | undefined;
  onText: (t: string) => void;
}

export function EntryField({ f, site, texts, fault, onText }: FieldProps) {
  const { store } = useGateway();
  const text = texts[f.key] ?? '';
  const hint = f.key === 'increments_per_unit' ? incrementHint(store.families.value.get(familyOf('axes', texts, site)), texts.unit ?? '') : f.hint;
  const names = (list: readonly { name: string }[] | undefined) => [{ value: '', text: t('choose') }, ...(list ?? []).map((e) => ({ value: e.name, text: e.name }))];
  const common = { label: f.label, fault, ...(hint === undefined ? {} : { hint }) };
  switch (f.kind) {
    case 'line': return <Choice {...common} value={text} onChoice={onText} choices={names(site.lines)} />;
    case 'drive': return <Choice {...common} value={text} onChoice={onText} choices={names(site.drives)} />;
    case 'family': return <Choice {...common} class="wide" value={text} onChoice={onText} choices={[{ value: '', text: t('choose') }, ...(store.about.value?.families ?? []).map((n) => ({ ...gatewayText, value: n, text: store.familyTitles.value.get(n) ? `${store.familyTitles.value.get(n)} (${n})` : n }))]} />;
    case 'description': return <DescriptionChoice label={f.label} hint={f.hint} fault={fault} family={store.families.value.get(familyOf('drives', texts, site))} value={text} onText={onText} />;
    case 'switch': return <Switch {...common} on={text === 'true'} onSwitch={(on) => onText(on ? 'true' : '')} />;
    case 'choice': return <Choice {...common} value={text} onChoice={onText} choices={f.choices ?? []} />;
    default: {
      const field = (
        <TextField
          {...common}
          class={f.key === 'uri' ? 'wide' : ''}
          value={text}
          onText={onText}
          number={f.kind === 'integer' || f.kind === 'number'}
          {...(f.placeholder === undefined ? {} : { placeholder: f.placeholder })}
          {...(f.key === 'uri' ? { offers: uriKinds.map((value) => ({ value })) } : {})}
        />
      );
      if (f.key === 'uri' && (text === '' || portKind(text) !== '')) {
        return (
          <>
            {field}
            <PortChoice uri={text} own={texts.name ?? ''} onUri={onText} />
          </>
        );
      }
      if (f.key === 'increments_per_unit') {
        return (
          <>
            {field}
            <Increments unit={texts.unit ?? ''} onTake={onText} />
          </>
        );
      }
      return field;
    }
  }
}
