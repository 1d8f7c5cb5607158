// Site entries: lines, drives or axes of the draft as rows, each with its form. In: the draft. Out: the draft, changed; nothing is sent from here.
// Faults of the gateway's last check stand at their entry and beside their field. What is typed in an open form stays while the page is elsewhere.
import { signal, useSignal, type Signal } from '@preact/signals';
import type { ComponentChildren } from 'preact';
import { useEffect, useRef } from 'preact/hooks';
import { useGateway } from '../gateway';
import { familyOf, incrementHint, optionsFor } from '../text/options';
import type { SiteDraft } from '../state/site-draft';
import { checkEntry, fieldsOf, freeNumber, oneOf, placeOf, sameDocument, textsOfEntry, uriKinds, type Entry, type FieldSpec, type Room, type Site, type Texts } from '../text/site';
import { Choice, TextField } from './form';
import { useBarred } from './gate';
import { Icon } from './icon';
import { SimulatedMark } from './name';
import { OptionFields } from './option-fields';
import { Section } from './section';

interface Open {
  /** The entry being changed; null: a new one. */
  own: string | null;
  texts: Texts;
}
const forms: Record<Room, Signal<Open | null>> = { lines: signal(null), drives: signal(null), axes: signal(null) };
export function openForm(room: Room, site: Site, entry: Entry | null, preset: Texts = {}): void {
  const texts = { ...textsOfEntry(room, entry), ...preset };
  if (!entry && room === 'axes' && !texts.number) texts.number = String(freeNumber(site));
  forms[room].value = { own: entry?.name ?? null, texts };
}

const titles: Record<Room, string> = { lines: 'Lines', drives: 'Drives', axes: 'Axes' };

/** `extra`: beside the name; `below`: under the entry. */
export function SiteEntries({ room, draft, extra, below }: { room: Room; draft: SiteDraft; extra?: (entry: Entry) => ComponentChildren; below?: (entry: Entry) => ComponentChildren }) {
  const no = useBarred('engineer');
  const site = draft.draft.value;
  const list = site[room] ?? [];
  const open = forms[room].value;
  const removing = useSignal('');
  const before = new Map((draft.base.value[room] ?? []).map((e) => [e.name, e]));
  const faults = draft.faults.value.flatMap((f) => {
    const place = draft.checked.value ? placeOf(f.pointer, draft.checked.value) : null;
    return place?.room === room ? [{ ...place, text: `${f.text}; ${f.remedy}` }] : [];
  });
  return (
    <Section
      title={titles[room]}
      class={`entries entries-${room}`}
      beside={
        <button type="button" class="button" {...no} onClick={() => openForm(room, site, null)}>
          <Icon name="plus" size={14} /> Add {room === 'axes' ? 'an' : 'a'} {oneOf[room]}
        </button>
      }
    >
      <div class="card">
        {list.length === 0 && !open && <p class="empty">None yet.</p>}
        <ul class="rows" aria-label={titles[room]}>
          {list.map((e) => {
            const own = faults.filter((f) => f.name === e.name);
            const old = before.get(e.name);
            const mark = !old ? 'new' : sameDocument(old, e) ? '' : 'changed';
            return (
              <li key={e.name} class="row" data-entry={`${room}/${e.name}`}>
                <div class="row-head">
                  <h3>
                    {e.name} {room !== 'lines' && old && <SimulatedMark of={e.name} kind={room === 'axes' ? 'axis' : 'drive'} />} {mark && <span class="flag">{mark}</span>}
                  </h3>
                  {extra?.(e)}
                  <button type="button" class="button small quiet square" aria-label={`Change ${oneOf[room]} ${e.name}`} title="Change" {...no} onClick={() => openForm(room, site, e)}>
                    <Icon name="pencil" size={14} />
                  </button>
                  <button type="button" class="button small quiet square" aria-label={`Remove ${oneOf[room]} ${e.name}`} title="Remove from the draft" {...no} onClick={() => (removing.value = e.name)}>
                    <Icon name="bin" size={14} />
                  </button>
                </div>
                <p class="where mono">{summary(room, e)}</p>
                {own.map((f) => (
                  <p key={f.key} class="form-told is-fault">
                    {f.key.replaceAll('_', ' ')}: {f.text}
                  </p>
                ))}
                {removing.value === e.name && (
                  <p class="form-foot ask">
                    <span>{hanging(site, room, e.name)}</span>
                    <button
                      type="button"
                      class="button small"
                      onClick={() => {
                        removing.value = '';
                        if (forms[room].peek()?.own === e.name) forms[room].value = null;
                        draft.remove(room, e.name);
                      }}
                    >
                      Remove
                    </button>
                    <button type="button" class="button small quiet" onClick={() => (removing.value = '')}>
                      Leave it
                    </button>
                  </p>
                )}
                {below?.(e)}
                {open?.own === e.name && <EntryForm room={room} draft={draft} own={e} open={forms[room] as Signal<Open>} gateway={own} />}
              </li>
            );
          })}
        </ul>
        {open && (open.own === null || !list.some((e) => e.name === open.own)) && (
          <div class="row">
            <EntryForm room={room} draft={draft} own={null} open={forms[room] as Signal<Open>} gateway={[]} />
          </div>
        )}
      </div>
    </Section>
  );
}

function summary(room: Room, e: Entry): string {
  const say = (...parts: unknown[]) => parts.filter((p) => p !== undefined && p !== null && p !== '').join(' · ');
  if (room === 'lines') return say(e.family, e.uri, e.bitrate ? `${String(e.bitrate)} bit/s` : '');
  if (room === 'drives') return say(`line ${String(e.line)}`, e.address === undefined ? 'factory address' : `address ${String(e.address)}`, e.presence ?? 'auto');
  return say(`no. ${String(e.number)}`, `drive ${String(e.drive)}`, `channel ${String(e.channel ?? 1)}`, e.unit ? `${String(e.increments_per_unit ?? 1)} increments per ${String(e.unit)}` : 'increments');
}

function hanging(site: Site, room: Room, name: string): string {
  const drives = room === 'lines' ? (site.drives ?? []).filter((d) => d.line === name).map((d) => d.name) : room === 'drives' ? [name] : [];
  const axes = room === 'axes' ? [name] : (site.axes ?? []).filter((a) => drives.includes(a.drive as string)).map((a) => a.name);
  const mappings = (site.mappings ?? []).filter((m) => axes.includes(m.axis as string)).length;
  const parts = [room === 'lines' && drives.length > 0 ? `drives ${drives.join(', ')}` : '', room !== 'axes' && axes.length > 0 ? `axes ${axes.join(', ')}` : '', mappings > 0 ? `${mappings} mappings` : ''].filter(Boolean);
  return `Remove ${oneOf[room]} ${name}${parts.length > 0 ? `, and with it ${parts.join('; ')}` : ''}?`;
}

interface FormProps {
  room: Room;
  draft: SiteDraft;
  own: Entry | null;
  open: Signal<Open>;
  gateway: { key: string; text: string }[];
}

function EntryForm({ room, draft, own, open, gateway }: FormProps) {
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
      aria-label={own ? `Change ${oneOf[room]} ${own.name}` : `Add ${room === 'axes' ? 'an' : 'a'} ${oneOf[room]}`}
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
      {room !== 'axes' && <OptionFields room={room} family={family} specs={options} texts={texts} onText={set} fault={(key) => gateway.find((g) => g.key === key)?.text} />}
      {more.length > 0 && (
        <details open={(moreOpen.current ||= more.some((f) => fault(f) !== undefined)) || undefined}>
          <summary>{room === 'lines' ? 'Timing: times and retries' : 'More'}</summary>
          <div class="form-grid">{more.map(field)}</div>
        </details>
      )}
      <div class="form-foot">
        <button type="submit" class="button primary">
          Save to draft
        </button>
        <button type="button" class="button quiet" onClick={close}>
          Cancel
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
  const names = (list: readonly { name: string }[] | undefined) => [{ value: '', text: 'choose' }, ...(list ?? []).map((e) => ({ value: e.name, text: e.name }))];
  const common = { label: f.label, fault, ...(hint === undefined ? {} : { hint }) };
  switch (f.kind) {
    case 'line': return <Choice {...common} value={text} onChoice={onText} choices={names(site.lines)} />;
    case 'drive': return <Choice {...common} value={text} onChoice={onText} choices={names(site.drives)} />;
    case 'family': return <Choice {...common} value={text} onChoice={onText} choices={[{ value: '', text: 'choose' }, ...(store.about.value?.families ?? []).map((n) => ({ value: n, text: store.familyTitles.value.get(n) ? `${store.familyTitles.value.get(n)} (${n})` : n }))]} />;
    case 'choice': return <Choice {...common} value={text} onChoice={onText} choices={f.choices ?? []} />;
    default:
      return (
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
  }
}
