// Site history: the states that were applied before, newest first, page by page. In: the draft, the door. Out: a list; a difference on demand; a
// restore, which is staged and then checked and applied like every change. Changes of one's own are never dropped for it unasked.
import { t } from '../language';
import { marked } from './marked';
import { useSignal } from '@preact/signals';
import { asProblem } from '../api/problem';
import type { HistoryEntry, SiteDoor } from '../api/site';
import { useGateway } from '../gateway';
import { capital } from '../state/commander';
import type { SiteDraft } from '../state/site-draft';
import { refusal } from '../state/reported';
import { differenceOf, type Difference } from '../text/site';
import { sizeText } from '../text/site-files';
import { clockTime } from '../text/time';
import { useBarred } from './gate';
import { notOffered } from './form';
import { useLoaded } from './loaded';
import { Section } from './section';
import { DifferenceList } from './site-differences';

const absent = (status: number) => status === 404 || status === 405 || status === 501;
/** As many as are asked for at once. */
const atOnce = 50;

export function SiteHistory({ draft, door }: { draft: SiteDraft; door: SiteDoor }) {
  const no = useBarred('engineer');
  const { store } = useGateway();
  const list = useSignal<HistoryEntry[]>([]);
  /** Whether there may be older ones than the last of the list; `why`: what the gateway said when they were asked for. */
  const older = useSignal<{ more: boolean; busy: boolean; why: string }>({ more: false, busy: false, why: '' });
  const shown = useSignal<{ revision: number; changes: Difference[] } | null>(null);
  const revision = store.siteRevision.value;
  const onTrial = draft.stage.value.state === 'applied';
  const load = async () => {
    const first = await door.history(atOnce);
    const last = first.at(-1)?.revision ?? 0;
    // What was fetched before stays below, as long as it joins on.
    const had = list.peek();
    const joins = had.some((h) => h.revision === last);
    list.value = joins ? [...first, ...had.filter((h) => h.revision < last)] : first;
    if (!joins) older.value = { more: first.length >= atOnce, busy: false, why: '' };
  };
  const why = useLoaded(load, [door, revision], (p) => (absent(p.status) ? notOffered(t('a history of applied states')) : p.text));
  const ask = async () => {
    const before = list.peek().at(-1)?.revision;
    if (before === undefined || older.peek().busy) return;
    older.value = { more: true, busy: true, why: '' };
    try {
      const next = await door.history(atOnce, before);
      const least = list.peek().at(-1)?.revision ?? before;
      list.value = [...list.peek(), ...next.filter((h) => h.revision < least)];
      older.value = { more: next.length >= atOnce, busy: false, why: '' };
    } catch (error) {
      older.value = { more: true, busy: false, why: capital(asProblem(error).text) };
    }
  };
  const look = async (n: number) => {
    if (shown.value?.revision === n) return void (shown.value = null);
    try {
      shown.value = { revision: n, changes: differenceOf(draft.base.peek(), await door.old(n)) };
    } catch (error) {
      draft.reported.value = refusal(error);
    }
  };
  return (
    <Section title={t('Applied states')} class="site-history" fold={list.value.length}>
      <div class="card" data-field="history">
        {why ? (
          <p class="empty">{marked(why)}</p>
        ) : list.value.length === 0 ? (
          <p class="empty">{t('No earlier state is kept.')}</p>
        ) : (
          <>
            <ul class="rows" aria-label={t('Applied states')}>
              {list.value.map((h) => (
                <li key={h.revision} class="row" data-revision={h.revision}>
                  <div class="row-head">
                    <h3>
                      {t('Revision {revision}', { revision: h.revision })}{' '}
                      {h.revision === revision && (
                        <span class="flag" data-field="in-force">
                          {onTrial ? t('in force, on trial') : t('in force')}
                        </span>
                      )}
                    </h3>
                    <button type="button" class="button small" aria-expanded={shown.value?.revision === h.revision} aria-label={t('Difference to revision {revision}', { revision: h.revision })} onClick={() => void look(h.revision)}>
                      {t('Difference')}
                    </button>
                    <button type="button" class="button small" aria-label={t('Restore revision {revision}', { revision: h.revision })} {...no} onClick={() => void draft.restore(h.revision)}>
                      {t('Restore')}
                    </button>
                  </div>
                  <p class="where">
                    {clockTime(h.at)} {h.who ?? ''} · {sizeText(h.bytes)}
                  </p>
                  {draft.askRestore.value === h.revision && (
                    <p class="form-foot ask" role="group" aria-label={t('Restore revision {revision}', { revision: h.revision })}>
                      <span>{draft.changes.value.length === 1 ? t('One change of yours is not applied; restoring puts revision {revision} in their place.', { revision: h.revision }) : t('{n} changes of yours are not applied; restoring puts revision {revision} in their place.', { n: draft.changes.value.length, revision: h.revision })}</span>
                      <button type="button" class="button small" {...no} onClick={() => void draft.restore(h.revision, true)}>
                        {t('Drop mine and restore')}
                      </button>
                      <button type="button" class="button small quiet" onClick={() => (draft.askRestore.value = null)}>
                        {t('Keep mine')}
                      </button>
                    </p>
                  )}
                  {shown.value?.revision === h.revision && (shown.value.changes.length === 0 ? <p class="where">{t('It is the site that is in force.')}</p> : <DifferenceList list={shown.value.changes} label={t('What revision {revision} would change', { revision: h.revision })} />)}
                </li>
              ))}
            </ul>
            <div class="form-foot history-foot">
              <span class="where" role="status" data-field="history-count">
                {older.value.more
                  ? list.value.length === 1
                    ? t('One state shown; there may be older ones.')
                    : t('{n} states shown; there may be older ones.', { n: list.value.length })
                  : list.value.length === 1
                    ? t('One state, the oldest that is kept included.')
                    : t('{n} states, the oldest that is kept included.', { n: list.value.length })}
              </span>
              {older.value.more && (
                <button type="button" class="button" aria-disabled={older.value.busy} onClick={() => void ask()}>
                  {t('Older')}
                </button>
              )}
              {older.value.why && <span class="tell result-refused">{marked(older.value.why)}</span>}
            </div>
          </>
        )}
      </div>
    </Section>
  );
}
