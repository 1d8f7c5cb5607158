// Keep or back: the two ways out of a site on trial, where there is room for whole words, with how the last of them went. In: the draft. Out: two requests,
// each when its button is pressed; barred, with the reason, for who may not.
import { useGateway } from '../gateway';
import { t } from '../language';
import type { SiteDraft } from '../state/site-draft';
import { barred } from '../state/session';
import { Tell } from './form';
import { useBarred } from './gate';
import { keepBarred } from './trial';

export function KeepOrBack({ draft, primary }: { draft: SiteDraft; primary: boolean }) {
  const { session, tab } = useGateway();
  const busy = draft.reported.value.tone === 'busy';
  return (
    <>
      <button type="button" class={`button${primary ? ' primary' : ''}`} disabled={busy} {...barred(keepBarred(draft, session, tab.name.value))} onClick={() => void draft.confirm()}>
        {t('Keep')}
      </button>
      <button type="button" class="button" disabled={busy} {...useBarred('engineer')} onClick={() => void draft.rollBack()}>
        {t('Roll back now')}
      </button>
      <Tell reported={draft.reported.value} field="stage-told" />
    </>
  );
}
