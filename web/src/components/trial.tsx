// Trial: a site that is applied and waits to be kept: how long still, and the way forward and back, in the head of every part. In: the stage at
// the gateway, asked after each change of the site and every few seconds while one waits. Out: words and two buttons; nothing while none waits.
import { t } from '../language';
import { useSignal } from '@preact/signals';
import { useEffect } from 'preact/hooks';
import { useGateway } from '../gateway';
import { draftOf, type SiteDraft } from '../state/site-draft';
import { tick } from '../state/clock';
import type { Session } from '../state/session';
import { personOf } from '../text/authority';
import { Icon } from './icon';

/** Somebody else may have kept it or taken it back: that changes no revision that the page is told of. */
const askAgain_ms = 3_000;

/** Seconds until the gateway takes it back by itself, counted down each second. */
export function useTrialRest(draft: SiteDraft): number {
  const { store } = useGateway();
  const by = draft.stage.value.confirm_by;
  if (!by) return 0;
  void tick.value;
  return Math.max(0, Math.ceil((Date.parse(by) - store.gatewayNow_ms()) / 1000));
}

/** Why this page may not keep it; the gateway takes that from who applied it alone. */
export function keepBarred(draft: SiteDraft, session: Session, tab = ''): string {
  const role = session.mayNot('engineer', t('Keeping the site'));
  const by = draft.stage.value.by ?? '';
  const info = session.info.value;
  if (role || !by || !info) return role;
  const client = draft.stage.value.client ?? '';
  if (client && tab) return client === tab || client.endsWith(` ${tab}`) ? '' : t('Only the page of {by} that applied it can keep it; take it back and apply it from here if need be.', { by: personOf(by) });
  const me = info.user ?? (info.via === 'local' ? 'local' : '');
  return !me || by === me || by.startsWith(`${me} `) ? '' : t('Only {by}, who applied it, can keep it.', { by: personOf(by) });
}

export function Trial() {
  const { client, session, store, tab } = useGateway();
  const { draft } = draftOf(client);
  const epoch = store.connection.value.epoch;
  const revision = store.siteRevision.value;
  const waits = draft.stage.value.state === 'applied';
  const rest = useTrialRest(draft);
  const over = waits && rest === 0;
  const busy = useSignal(false);
  const out = session.needed.value;
  useEffect(() => {
    if (epoch > 0 && !out) void draft.look();
  }, [draft, epoch, revision, over, out]);
  useEffect(() => {
    if (!waits || out) return;
    const timer = setInterval(() => {
      if (!document.hidden && store.connected.peek()) void draft.look();
    }, askAgain_ms);
    return () => clearInterval(timer);
  }, [draft, waits, out]);
  if (!waits || out) return null;
  const act = async (what: () => Promise<boolean>) => {
    busy.value = true;
    await what();
    busy.value = false;
  };
  const mayNot = session.mayNot('engineer', t('Rolling the site back'));
  const mayNotKeep = keepBarred(draft, session, tab.name.value);
  const off = (why: string) => ({ disabled: busy.value || why !== '', ...(why ? { title: why, 'aria-description': why } : {}) });
  return (
    <span class="trial" role="group" aria-label={t('Site on trial')} data-field="trial">
      <Icon name="clock" size={14} />
      <a href="/site" class="trial-words" data-field="trial-rest">
        {t('Site on trial:')}{' '}<b>{rest} s</b>
      </a>
      <button type="button" class="button" aria-label={t('Keep the applied site')} {...off(mayNotKeep)} onClick={() => void act(draft.confirm)}>
        {t('Keep')}
      </button>
      <button type="button" class="button" aria-label={t('Roll back the applied site')} {...off(mayNot)} onClick={() => void act(draft.rollBack)}>
        {t('Roll back')}
      </button>
      <span class="visually-hidden" role="alert">
        {rest === 20 || rest === 10 ? t('The change of the site is rolled back in {rest} seconds.', { rest }) : ''}
      </span>
    </span>
  );
}
