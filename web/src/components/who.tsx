// Who: who one is to the gateway, with the role; the way to the own account, to the sign-in, and out. In: the session. Out: a piece of the head.
import { useGateway } from '../gateway';
import { t } from '../language';
import { whoText } from '../state/session';
import { Icon } from './icon';

export function Who() {
  const { session } = useGateway();
  const info = session.info.value;
  // While a sign-in is needed the head says that, and nothing else beside it.
  if (!info?.role || session.needed.value) return null;
  const text = whoText(info);
  return (
    <span class="who" data-field="who">
      <a class="who-name" href="/users" title={t('{text}: account, users and tokens', { text })} aria-label={t('You are {text}. Account, users and tokens', { text })}>
        <Icon name="person" size={15} />
        <span>{text}</span>
      </a>
      <Way />
    </span>
  );
}

/** The way in, or out; in the head where there is room, and always on the page of users. */
export function Way() {
  const { session } = useGateway();
  const info = session.info.value;
  if (info?.via === 'local') {
    return (
      <a class="button quiet who-way" href="/sign-in">
        {t('Sign in')}
      </a>
    );
  }
  if (info?.via !== 'cookie') return null;
  return (
    <button type="button" class="button quiet who-way" onClick={() => void session.signOut()}>
      {t('Sign out')}
    </button>
  );
}
