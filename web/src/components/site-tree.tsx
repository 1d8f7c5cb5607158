// Site tree: lines, the drives on each, the axes of each, with what they are now beside what the draft says. In: the draft, the store. Out: forms that
// change the draft; nothing is sent from here. A line can be folded; one with a fault or an open form below it is never hidden.
import { useSignal, type Signal } from '@preact/signals';
import { t, theirs } from '../language';
import { toggledIn } from '../state/toggled';
import { placeOf } from '../text/site';
import { branchText, treeOf, type DriveBranch } from '../text/site-tree';
import { useBarred } from './gate';
import { Icon } from './icon';
import { Section } from './section';
import { addText, EntryForm, forms, openForm, type Open } from './site-entries';
import { NewBelow, Node, type Fault, type Tree } from './site-node';

const rooms = ['lines', 'drives', 'axes'] as const;

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
          {rooms.map((room) => (
            <button key={room} type="button" class="button" {...no} onClick={() => openForm(room, site, null)}>
              <Icon name="plus" size={14} /> {addText[room]}
            </button>
          ))}
        </>
      }
    >
      <div class="card">
        {lines.length + lostDrives.length + lostAxes.length === 0 && <p class="empty">{t('Nothing yet: begin with a line.')}</p>}
        <ul class="tree" aria-label={t('The site')}>
          {lines.map(({ line, drives }) => {
            const shut = folded.value.has(line.name) && !isHeld(drives);
            return (
              <Node key={line.name} room="lines" e={line} tree={tree} fold={drives.length > 0 ? { shut, toggle: () => (folded.value = toggledIn(folded.peek(), line.name)), text: branchText(drives.length, drives.reduce((n, d) => n + d.axes.length, 0)) } : undefined}>
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
        {rooms.map((room) => {
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
