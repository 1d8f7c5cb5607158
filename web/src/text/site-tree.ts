// The site as a tree: lines, the drives on each, the axes of each; what belongs to nothing that is there stands apart. In: a site. Out: places. Pure.
import type { Entry, Room, Site } from './site';
import { t } from '../language';
import { formatExact } from './number';

export interface DriveBranch {
  drive: Entry;
  axes: Entry[];
}
export interface LineBranch {
  line: Entry;
  drives: DriveBranch[];
}
export interface SiteTree {
  lines: LineBranch[];
  /** Drives whose line, and axes whose drive, is not there: a fault that the gateway will name. */
  lostDrives: DriveBranch[];
  lostAxes: Entry[];
}

export function treeOf(site: Site): SiteTree {
  const lines = site.lines ?? [];
  const drives = site.drives ?? [];
  const axes = site.axes ?? [];
  const branch = (drive: Entry): DriveBranch => ({ drive, axes: axes.filter((a) => a.drive === drive.name) });
  return {
    lines: lines.map((line) => ({ line, drives: drives.filter((d) => d.line === line.name).map(branch) })),
    lostDrives: drives.filter((d) => !lines.some((l) => l.name === d.line)).map(branch),
    lostAxes: axes.filter((a) => !drives.some((d) => d.name === a.drive)),
  };
}

/** "2 drives, 3 axes". */
export function branchText(drives: number, axes: number): string {
  const d = drives === 1 ? t('1 drive') : t('{n} drives', { n: drives });
  const a = axes === 1 ? t('1 axis') : t('{n} axes', { n: axes });
  return t('{drives}, {axes}', { drives: d, axes: a });
}

/** What an entry is, in one line; what its place in the tree says already is left out. */
export function summaryOf(room: Room, e: Entry): string {
  const say = (...parts: unknown[]) => parts.filter((p) => p !== undefined && p !== null && p !== '').join(' · ');
  if (room === 'lines') return say(e.family, e.uri, e.bitrate ? `${String(e.bitrate)} bit/s` : '');
  if (room === 'drives') return say(e.address === undefined ? t('factory address') : t('address {address}', { address: String(e.address) }), e.family, e.presence ?? 'auto');
  return say(
    t('no. {number}', { number: String(e.number) }),
    t('channel {channel}', { channel: String(e.channel ?? 1) }),
    e.group,
    e.unit ? t('{n} increments per {unit}', { n: formatExact(Number(e.increments_per_unit ?? 1)), unit: String(e.unit) }) : t('increments'),
  );
}

/** What goes with an entry that is taken out. */
export function hangingText(site: Site, room: Room, name: string): string {
  const drives = room === 'lines' ? (site.drives ?? []).filter((d) => d.line === name).map((d) => d.name) : room === 'drives' ? [name] : [];
  const axes = room === 'axes' ? [name] : (site.axes ?? []).filter((a) => drives.includes(a.drive as string)).map((a) => a.name);
  const mappings = (site.mappings ?? []).filter((m) => axes.includes(m.axis as string)).length;
  const parts = [
    room === 'lines' && drives.length > 0 ? t('drives {names}', { names: drives.join(', ') }) : '',
    room !== 'axes' && axes.length > 0 ? t('axes {names}', { names: axes.join(', ') }) : '',
    mappings > 0 ? t('{n} mappings', { n: mappings }) : '',
  ].filter(Boolean);
  const what = { lines: t('Remove line {name}', { name }), drives: t('Remove drive {name}', { name }), axes: t('Remove axis {name}', { name }) }[room];
  return parts.length > 0 ? t('{what}, and with it {hanging}?', { what, hanging: parts.join('; ') }) : `${what}?`;
}
