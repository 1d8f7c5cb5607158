// Site node: a line, a drive or an axis in the tree of the site: what the draft says, what it is now, its faults, its form, what can be done with it. In: the tree, the
// entry. Out: a row, with what hangs on it below; changes of the draft.
import { useSignal, type Signal } from '@preact/signals';
import type { ComponentChildren } from 'preact';
import { useGateway } from '../gateway';
import { t } from '../language';
import { axisPath, linePath } from '../router';
import type { SiteDraft } from '../state/site-draft';
import { stateWord, wordOf } from '../text/axis';
import { sameDocument, type Entry, type Room, type Site } from '../text/site';
import { hangingText, summaryOf } from '../text/site-tree';
import { useBarred } from './gate';
import { Icon } from './icon';
import { lineWord, presenceWord } from './lines';
import { marked } from './marked';
import { SimulatedMark } from './name';
import { Pill } from './pill';
import { changeText, EntryForm, forms, openForm, type Open } from './site-entries';

export interface Fault {
  room: Room;
  name: string;
  key: string;
  text: string;
}
export interface Tree {
  draft: SiteDraft;
  site: Site;
  faults: Fault[];
  /** Beside a line's name, and under it: its scan. */
  extra?: ((line: Entry) => ComponentChildren) | undefined;
  below?: ((line: Entry) => ComponentChildren) | undefined;
}

const removeText: Record<Room, (name: string) => string> = {
  lines: (name) => t('Remove line {name}', { name }),
  drives: (name) => t('Remove drive {name}', { name }),
  axes: (name) => t('Remove axis {name}', { name }),
};

export function NewBelow({ room, preset, tree, text }: { room: Room; preset: Record<string, string>; tree: Tree; text: string }) {
  const no = useBarred('engineer');
  return (
    <button type="button" class="button small quiet tree-new" {...no} onClick={() => openForm(room, tree.site, null, preset)}>
      <Icon name="plus" size={12} /> {text}
    </button>
  );
}

interface NodeProps {
  room: Room;
  e: Entry;
  tree: Tree;
  fold?: { shut: boolean; toggle: () => void; text: string } | undefined;
  children?: ComponentChildren;
}

export function Node({ room, e, tree, fold, children }: NodeProps) {
  const { draft, site, extra, below } = tree;
  const no = useBarred('engineer');
  const removing = useSignal(false);
  const open = forms[room].value;
  const own = tree.faults.filter((f) => f.room === room && f.name === e.name);
  const old = (draft.base.value[room] ?? []).find((x) => x.name === e.name);
  const mark = !old ? t('new') : sameDocument(old, e) ? '' : t('changed');
  const href = !old ? '' : room === 'lines' ? linePath(e.name) : room === 'axes' ? axisPath(e.name) : '';
  return (
    <li class={`tree-node tree-${room}`} data-entry={`${room}/${e.name}`}>
      <div class="tree-row">
        {fold ? (
          <button type="button" class={`button small quiet square tree-fold${fold.shut ? ' is-shut' : ''}`} aria-expanded={!fold.shut} aria-label={t('What is on {line}', { line: e.name })} onClick={fold.toggle}>
            <Icon name="chevron" size={14} />
          </button>
        ) : (
          <span class="tree-fold" />
        )}
        <h3>
          {href ? <a href={href}>{e.name}</a> : e.name} {room !== 'lines' && old && <SimulatedMark of={e.name} kind={room === 'axes' ? 'axis' : 'drive'} />} {mark && <span class="flag">{mark}</span>}
        </h3>
        {old && <State room={room} name={e.name} />}
        <span class="where tree-summary">
          <span class="mono">{summaryOf(room, e)}</span>
          {fold && fold.shut && ` · ${fold.text}`}
        </span>
        <span class="tree-acts">
          {room === 'lines' && extra?.(e)}
          <button type="button" class="button small quiet square" aria-label={changeText[room](e.name)} title={t('Change')} {...no} onClick={() => openForm(room, site, e)}>
            <Icon name="pencil" size={14} />
          </button>
          <button type="button" class="button small quiet square" aria-label={removeText[room](e.name)} title={t('Remove from the draft')} {...no} onClick={() => (removing.value = true)}>
            <Icon name="bin" size={14} />
          </button>
        </span>
      </div>
      {own.map((f) => (
        <p key={f.key} class="form-told is-fault">
          {f.key.replaceAll('_', ' ')}: {marked(f.text)}
        </p>
      ))}
      {removing.value && (
        <p class="form-foot ask">
          <span>{hangingText(site, room, e.name)}</span>
          <button
            type="button"
            class="button small"
            onClick={() => {
              removing.value = false;
              if (forms[room].peek()?.own === e.name) forms[room].value = null;
              draft.remove(room, e.name);
            }}
          >
            {t('Remove')}
          </button>
          <button type="button" class="button small quiet" onClick={() => (removing.value = false)}>
            {t('Leave it')}
          </button>
        </p>
      )}
      {room === 'lines' && below?.(e)}
      {open?.own === e.name && <EntryForm room={room} draft={draft} own={e} open={forms[room] as Signal<Open>} gateway={own} />}
      {children}
    </li>
  );
}

/** What it is now, at the gateway: of the site in force, not of the draft. */
function State({ room, name }: { room: Room; name: string }) {
  const { store } = useGateway();
  if (room === 'axes') {
    const a = store.axis(name)?.value;
    return a ? <Pill label={t('State')} id="tree-state" word={stateWord(a.data, store.trustOf(a))} /> : null;
  }
  const live = (epoch: number) => store.connected.value && epoch === store.connection.value.epoch;
  if (room === 'drives') {
    const d = store.drive(name)?.value;
    return d ? <Pill label={t('Presence')} id="tree-state" word={wordOf(presenceWord(d.data), live(d.epoch))} /> : null;
  }
  const l = store.line(name)?.value;
  return l ? <Pill label={t('State')} id="tree-state" word={wordOf(lineWord(l.data.status.state), live(l.epoch))} /> : null;
}
