// Account: a new password for oneself. In: the old one, the new one twice. Out: a change at the gateway, which ends all sessions of the user.
import { useState } from 'preact/hooks';
import { asProblem } from '../api/problem';
import { useGateway } from '../gateway';
import { t } from '../language';
import { passwordFault, signInText } from '../state/session';
import { quiet, type Reported } from '../state/reported';
import { Tell, TextField } from './form';

export function Account({ user }: { user: string }) {
  const { client, session } = useGateway();
  const [old, setOld] = useState('');
  const [fresh, setFresh] = useState('');
  const [second, setSecond] = useState('');
  const [reported, setReported] = useState<Reported>(quiet);
  const send = async (event: Event) => {
    event.preventDefault();
    const fault = old ? passwordFault(fresh, second) : t('The old password is missing.');
    if (fault) return setReported({ tone: 'refused', text: fault });
    setReported({ tone: 'busy', text: t('Changing …') });
    try {
      await client.call(`/users/${encodeURIComponent(user)}/password`, { method: 'PUT', body: { old, new: fresh } });
      setReported({ tone: 'good', text: t('Changed. Sign in with the new password.') });
      for (const clear of [setOld, setFresh, setSecond]) clear('');
      void session.ask();
    } catch (error) {
      setReported({ tone: 'refused', text: signInText(asProblem(error)) });
    }
  };
  return (
    <form class="form card" aria-label={t('Your password')} onSubmit={(e) => void send(e)}>
      <div class="form-grid">
        <TextField label={t('Old password')} password fill="current-password" value={old} onText={setOld} />
        <TextField label={t('New password')} password fill="new-password" value={fresh} onText={setFresh} hint={t('At least 12 characters. All your sessions end.')} />
        <TextField label={t('New password again')} password fill="new-password" value={second} onText={setSecond} />
      </div>
      <div class="form-foot">
        <button type="submit" class="button">
          {t('Change the password')}
        </button>
        <Tell reported={reported} field="password-told" />
      </div>
    </form>
  );
}
