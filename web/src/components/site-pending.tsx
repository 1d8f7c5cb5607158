// Site pending: a restored copy that waits for the next start: what it is, since when, from whom, and the way to drop it. In: the door. Out: a notice,
// or nothing. Only administrators are told, so nobody else's page asks. Another administrator may lay one down or drop it: it is asked for again.
import { t } from '../language';
import { signal, useSignal } from '@preact/signals';
import { useEffect } from 'preact/hooks';
import type { Pending, SiteDoor } from '../api/site';
import { useGateway } from '../gateway';
import { quiet, tellOf, type Reported } from '../state/reported';
import { pendingText } from '../text/site-files';
import { Tell } from './form';
import { Icon } from './icon';
import { useLoaded } from './loaded';

const lookAgain_ms = 10_000;
/** Counts up when this page has laid one down. */
const laid = signal(0);
export const lookAtPending = () => void (laid.value += 1);

export function PendingRestore({ door }: { door: SiteDoor }) {
  const { session, store } = useGateway();
  const may = session.info.value?.role === 'administrator'; // not before the role is known
  const now = useSignal<Pending | null>(null);
  const asked = useSignal(false);
  const reported = useSignal<Reported>(quiet);
  const look = async () => void (now.value = may ? await door.pending() : null);
  useLoaded(look, [door, may, laid.value]);
  useEffect(() => {
    if (!may) return;
    const timer = setInterval(() => {
      if (!document.hidden && store.connected.peek()) void look().catch(() => undefined);
    }, lookAgain_ms);
    return () => clearInterval(timer);
  }, [door, may]);
  const drop = async () => {
    await tellOf(reported, t('Dropping it …'), () => door.dropPending(), t('Dropped: the next start goes on with the database as it is.'));
    asked.value = false;
    await look().catch(() => undefined);
  };
  const waits = may && now.value?.waiting === true;
  if (!waits && reported.value.tone === 'none') return null;
  return (
    <section class={`card pending-restore${waits ? ' is-waiting' : ''}`} aria-label={t('Restore that waits')} data-field="pending">
      {waits && now.value && (
        <>
          <p class="stage-count">
            <Icon name="triangle" />{' '}{t('A restore waits: it takes effect with the next start.')}
          </p>
          <p class="where" data-field="pending-what">
            {pendingText(now.value)}
          </p>
        </>
      )}
      <div class="form-foot">
        {waits && !asked.value && (
          <button type="button" class="button" onClick={() => (asked.value = true)}>
            {t('Drop the restore …')}
          </button>
        )}
        {waits && asked.value && (
          <>
            <span>{t('The copy is taken away; the next start goes on with the database as it is.')}</span>
            <button type="button" class="button" onClick={() => void drop()}>
              {t('Drop it')}
            </button>
            <button type="button" class="button quiet" onClick={() => (asked.value = false)}>
              {t('Leave it')}
            </button>
          </>
        )}
        <Tell reported={reported.value} field="pending-told" />
      </div>
    </section>
  );
}
