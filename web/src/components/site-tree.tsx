// Site tree: lines, the drives on each, the axes of each, with what they are now beside what the draft says. In: the draft, the store. Out: forms that
// change the draft; nothing is sent from here. A line can be folded; one with a fault or an open form below it is never hidden.
import { useSignal, type Signal } from '@preact/signals';
import { marked } from './marked';
import type { ComponentChildren } from 'preact';
import { useGateway } from '../gateway';
import { midSentence, t, theirs } from '../language';
import { axisPath, linePath } from '../router';
import type { SiteDraft } from '../state/site-draft';
import { stateWord, type Word } from '../text/axis';
import { placeOf, sameDocument, type Entry, type Room, type Site } from '../text/site';
import { branchText, hangingText, summaryOf, treeOf, type DriveBranch } from '../text/site-tree';
import { EntryForm, forms, openForm, type Open } from './site-entries';
import { useBarred } from './gate';
import { Icon } from './icon';
import { lineWord, presenceWord } from './lines';
import { SimulatedMark } from './name';
import { Pill } from './pill';
import { Section } from './section';

interface Fault {
  room: Room;
  name: string;
  key: string;
  text: string;
}
interface Tree {
  draft: SiteDraft;
  site: Site;
  faults: Fault[];
  /** Beside a line's name, and under it: its scan. */
  extra?: ((line: Entry) => ComponentChildren) | undefined;
  below?: ((line: Entry) => ComponentChildren) | undefined;
}

const shown: Record<Room, { change: (name: string) => string; remove: (name: string) => string }> = {
  lines: { change: (name) => t('Change line {name}', { name }), remove: (name) => t('Remove line {name}', { name }) },
  drives: { change: (name) => t('Change drive {name}', { name }), remove: (name) => t('Remove drive {name}', { name }) },
  axes: { change: (name) => t('Change axis {name}', { name }), remove: (name) => t('Remove axis {name}', { name }) },
};

export function SiteTree({ draft, extra, below }: Pick<Tree, 'draft' | 'extra' | 'below'>) {
  const no = useBarred('engineer');
  const folded = useSignal<ReadonlySet<string>>(new Set());
  const site = draft.draft.value;
  const checked = draft.checked.value;
  const faults = draft.faults.value.flatMap((f): Fault[] => {
    const place = checked ? placeOf(f.pointer, checked) : null;
    return place ? [{ ...place, text: theirs(`${f.text}; ${f.remedy}`) }] : [];
  });
  const tree: Tree = { draft, site, faults, extra, below };
  const { lines, lostDrives, lostAxes } = treeOf(site);
  const fold = (name: string) => {
    const next = new Set(folded.peek());
    if (!next.delete(name)) next.add(name);
    folded.value = next;
  };
  const open = { lines: forms.lines.value, drives: forms.drives.value, axes: forms.axes.value };
  const isHeld = (drives: readonly DriveBranch[]) =>
    drives.some((d) => open.drives?.own === d.drive.name || d.axes.some((a) => open.axes?.own === a.name) || faults.some((f) => f.name === d.drive.name || d.axes.some((a) => a.name === f.name)));
  return (
    <Section
      title={t('Lines, drives and axes')}
      class="site-tree"
      help="changing-a-site"
      beside={
        <>
          <button type="button" class="button" {...no} onClick={() => openForm('lines', site, null)}>
            <Icon name="plus" size={14} /> {t('Add a line')}
          </button>
          <button type="button" class="button" {...no} onClick={() => openForm('drives', site, null)}>
            <Icon name="plus" size={14} /> {t('Add a drive')}
          </button>
          <button type="button" class="button" {...no} onClick={() => openForm('axes', site, null)}>
            <Icon name="plus" size={14} /> {t('Add an axis')}
          </button>
        </>
      }
    >
      <div class="card">
        {lines.length + lostDrives.length + lostAxes.length === 0 && <p class="empty">{t('Nothing yet: begin with a line.')}</p>}
        <ul class="tree" aria-label={t('The site')}>
          {lines.map(({ line, drives }) => {
            const shut = folded.value.has(line.name) && !isHeld(drives);
            return (
              <Node key={line.name} room="lines" e={line} tree={tree} fold={drives.length > 0 ? { shut, toggle: () => fold(line.name), text: branchText(drives.length, drives.reduce((n, d) => n + d.axes.length, 0)) } : undefined}>
                {!shut && <Drives of={drives} tree={tree} label={t('Drives on {line}', { line: line.name })} />}
                <NewBelow room="drives" preset={{ line: line.name }} tree={tree} text={t('New drive on {line}', { line: line.name })} />
              </Node>
            );
          })}
        </ul>
        {lostDrives.length > 0 && (
          <div class="tree-lost">
            <p class="form-told is-fault">{t('Their line is not there:')}</p>
            <Drives of={lostDrives} tree={tree} label={t('Drives without a line')} />
          </div>
        )}
        {lostAxes.length > 0 && (
          <div class="tree-lost">
            <p class="form-told is-fault">{t('Their drive is not there:')}</p>
            <ul class="tree" aria-label={t('Axes without a drive')}>
              {lostAxes.map((a) => (
                <Node key={a.name} room="axes" e={a} tree={tree} />
              ))}
            </ul>
          </div>
        )}
        {(['lines', 'drives', 'axes'] as const).map((room) => {
          const o = open[room];
          if (!o || (o.own !== null && (site[room] ?? []).some((e) => e.name === o.own))) return null;
          return (
            <div key={room} class="row">
              <EntryForm room={room} draft={draft} own={null} open={forms[room] as Signal<Open>} gateway={[]} />
            </div>
          );
        })}
      </div>
    </Section>
  );
}

function Drives({ of, tree, label }: { of: readonly DriveBranch[]; tree: Tree; label: string }) {
  if (of.length === 0) return null;
  return (
    <ul class="tree" aria-label={label}>
      {of.map(({ drive, axes }) => (
        <Node key={drive.name} room="drives" e={drive} tree={tree}>
          {axes.length > 0 && (
            <ul class="tree" aria-label={t('Axes of {drive}', { drive: drive.name })}>
              {axes.map((a) => (
                <Node key={a.name} room="axes" e={a} tree={tree} />
              ))}
            </ul>
          )}
          <NewBelow room="axes" preset={{ drive: drive.name }} tree={tree} text={t('New axis of {drive}', { drive: drive.name })} />
        </Node>
      ))}
    </ul>
  );
}

function NewBelow({ room, preset, tree, text }: { room: Room; preset: Record<string, string>; tree: Tree; text: string }) {
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

function Node({ room, e, tree, fold, children }: NodeProps) {
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
          <button type="button" class="button small quiet square" aria-label={shown[room].change(e.name)} title={t('Change')} {...no} onClick={() => openForm(room, site, e)}>
            <Icon name="pencil" size={14} />
          </button>
          <button type="button" class="button small quiet square" aria-label={shown[room].remove(e.name)} title={t('Remove from the draft')} {...no} onClick={() => (removing.value = true)}>
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
  const reported = (word: Word, live: boolean): Word => (live ? word : { ...word, tone: 'muted', text: t('Was {state}', { state: midSentence(word.text) }) });
  if (room === 'axes') {
    const a = store.axis(name)?.value;
    return a ? <Pill label={t('State')} id="tree-state" word={stateWord(a.data, store.trustOf(a))} /> : null;
  }
  const live = (epoch: number) => store.connected.value && epoch === store.connection.value.epoch;
  if (room === 'drives') {
    const d = store.drive(name)?.value;
    return d ? <Pill label={t('Presence')} id="tree-state" word={reported(presenceWord(d.data), live(d.epoch))} /> : null;
  }
  const l = store.line(name)?.value;
  return l ? <Pill label={t('State')} id="tree-state" word={reported(lineWord(l.data.status.state), live(l.epoch))} /> : null;
}
