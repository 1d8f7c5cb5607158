// Site, others: what somebody else has changed in the site, or has staged for it, while one types, and what can be done about it. In: the draft. Out: its steps.
// What was typed stays until it is dropped by its own button.
import { t } from '../language';
import { stagerOf, type SiteDraft } from '../state/site-draft';
import type { StageView } from '../state/stage-view';
import { useBarred } from './gate';
import { Icon } from './icon';
import { DifferenceList } from './site-differences';

/** Somebody else has changed the site meanwhile. */
export function Theirs({ draft }: { draft: SiteDraft }) {
  const theirs = draft.theirs.value;
  if (!theirs) return null;
  return (
    <div class="theirs" role="group" aria-label={t('Somebody else\'s change')} data-field="theirs">
      <p class="stage-count">
        <Icon name="triangle" />{' '}{t('Somebody else has changed the site meanwhile. What you typed is kept.')}
      </p>
      <DifferenceList list={theirs.changes} label={t('What somebody else changed')} />
      <div class="form-foot">
        <button type="button" class="button primary" onClick={() => void draft.adopt(true)}>
          {t('Put mine on top')}
        </button>
        <button type="button" class="button" onClick={() => void draft.adopt(false)}>
          {t('Drop mine')}
        </button>
      </div>
    </div>
  );
}

/** Somebody else has staged something. */
export function Rival({ draft, view: { changes, inView, busy } }: { draft: SiteDraft; view: StageView }) {
  const no = useBarred('engineer');
  const stage = draft.stage.value;
  const own = changes.length > 0;
  return (
    <div class="theirs" role="group" aria-label={t('What is staged')} data-field="rival">
      <p class="stage-count">
        <Icon name="triangle" />{' '}{t('{stage} has staged this; nothing of it is in force yet.', { stage: stagerOf(stage) })}
        {own && ` ${t('What you typed is kept.')}`}
      </p>
      <DifferenceList list={stage.diff ?? []} label={t('What is staged')} />
      <div class="form-foot">
        {own && (
          <button type="button" class="button" disabled={busy || draft.theirs.value !== null} {...no} onClick={() => void draft.check(true)}>
            {t('Check mine instead')}
          </button>
        )}
        {inView ? (
          <button type="button" class="button quiet" onClick={() => draft.view(false)}>
            {own ? t('Back to mine') : t('Leave it')}
          </button>
        ) : (
          <button type="button" class="button" {...no} onClick={() => draft.view(true)}>
            {t('Take theirs into view')}
          </button>
        )}
      </div>
    </div>
  );
}
