// Words about a site that is checked, applied, and waits to be kept: whose it is, who may keep it, what applying does to the axes, why it cannot be
// applied yet. In: the stage as the gateway tells it, the sites before and after. Out: sentences. Pure.
import { t } from '../language';
import type { Stage } from '../api/site';
import { personOf } from './authority';
import type { Site } from './site';

/** `barred`: why this page may not keep it; empty: it may. */
export function appliedText(stage: Pick<Stage, 'by' | 'client'>, tab: string, barred: string): string {
  const client = stage.client ?? '';
  if (client !== '' && tab !== '' && (client === tab || client.endsWith(` ${tab}`))) return t('Applied by this page.');
  const by = stage.by ?? '';
  const page = /(?:^| )(page-\S+)$/.exec(client)?.[1];
  const who = by === '' ? t('Applied by somebody else') : t('Applied by {by}', { by: personOf(by) });
  const first = page ? t('{who} (from the page {page}).', { who, page }) : `${who}.`;
  return barred ? `${first} ${barred}` : first;
}

/** Axes that are taken out are not disturbed for a moment: they are gone. Either way the gateway brings to rest first what moves of them. */
export function disturbedText(disturbs: readonly string[], before: Site, after: Site): string {
  const there = new Set((after.axes ?? []).map((a) => a.name));
  const gone = (before.axes ?? []).map((a) => a.name).filter((n) => !there.has(n));
  const shaken = disturbs.filter((n) => !gone.includes(n));
  const published = [gone.length > 0 ? t('Applying removes {list}.', { list: gone.join(', ') }) : '', shaken.length > 0 ? t('Applying disturbs for a moment: {list}.', { list: shaken.join(', ') }) : ''];
  if (gone.length + shaken.length > 0) published.push(t('What of it moves is stopped first.'));
  return published.filter(Boolean).join(' ');
}

/** Connections that applying closes: those whose own bytes would be others. */
export function closedText(closes: Stage['closes']): string {
  if (closes === null) return t('Which connections applying closes could not be asked; check again.');
  if (!closes || closes.length === 0) return '';
  const list = closes.map((c) => (c.axes.length > 0 ? t('{peer} (commands {axes})', { peer: c.peer, axes: c.axes.join(', ') }) : c.peer));
  return t('Applying closes EtherNet/IP connections, because their bytes change: {list}.', { list: list.join('; ') });
}

/** What to do before Apply can be pressed. */
export function applyBarred(why: { inView: boolean; theirs: boolean; faults: boolean }): string {
  if (why.theirs) return t('Decide first about what somebody else has changed.');
  if (why.faults) return why.inView ? t('It has faults, so it cannot be applied.') : t('Mend the faults, then check again.');
  return t('Check first.');
}
