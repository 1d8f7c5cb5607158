// Sign in: with name and password, or for the first time with the code that the gateway has printed. In: what is typed. Out: a session.
// Shown in place of a page when the gateway knows nobody here; afterwards that page is there again as it was.
import { useEffect, useRef, useState } from 'preact/hooks';
import { LanguageChoice } from '../components/language';
import { Tell, TextField } from '../components/form';
import { useGateway } from '../gateway';
import { t } from '../language';
import { go, route } from '../router';
import { persisted } from '../state/persisted';
import { passwordFault, signInText, userFault } from '../state/session';
import { quiet, type Reported } from '../state/reported';

export function SignInPage() {
  const { session } = useGateway();
  const first = session.info.value?.first_sign_in ?? false;
  const ended = session.ended.value;
  const user = persisted('typed.user');
  const [code, setCode] = useState('');
  const [password, setPassword] = useState('');
  const [second, setSecond] = useState('');
  const [reported, setReported] = useState<Reported>(quiet);
  const head = useRef<HTMLHeadingElement>(null);
  useEffect(() => head.current?.focus({ preventScroll: true }), []);

  const send = async (event: Event) => {
    event.preventDefault();
    if (reported.tone === 'busy') return;
    const fault = first ? (code.trim() ? '' : t('The code is missing.')) || userFault(user.value) || passwordFault(password, second) : user.value ? '' : t('The name is missing.');
    if (fault) return setReported({ tone: 'refused', text: fault });
    setReported({ tone: 'busy', text: t('Signing in …') });
    const problem = await (first ? session.first(code.trim(), user.value, password) : session.signIn(user.value, password));
    // A wrong code says nothing about the passwords: typed twice, they stay.
    if (!problem || !first) {
      setPassword((now) => (now === password ? '' : now));
      setSecond('');
    }
    if (problem) return setReported({ tone: 'refused', text: signInText(problem) });
    setReported({ tone: 'good', text: t('Signed in.') });
    if (route.peek().page === 'sign-in') go('/');
  };
  return (
    <main class="page narrow sign-in">
      <h1 tabIndex={-1} ref={head}>
        {first ? t('First sign-in') : t('Sign in')}
      </h1>
      <form class="form card" aria-label={first ? t('First sign-in') : t('Sign in')} onSubmit={(e) => void send(e)}>
        {ended && (
          <p class="sign-in-ended" role="alert" data-field="session-ended">
            {ended}
          </p>
        )}
        {first && <p>{t('No user exists yet. The gateway printed a code on its standard output when it started for the first time. Whoever has it makes the first administrator here.')}</p>}
        {first && <TextField label={t('Code')} value={code} onText={setCode} mono placeholder="K7QF-2M9D-XW3E-8HTR" />}
        <TextField label={t('Name')} value={user.value} onText={(text) => (user.value = text)} fill="username" hint={first ? t('a-z, 0-9, point, _ - and @; at most 64') : undefined} />
        <TextField label={t('Password')} password value={password} onText={setPassword} fill={first ? 'new-password' : 'current-password'} hint={first ? t('At least 12 characters, none of the common ones.') : undefined} />
        {first && <TextField label={t('Password again')} password value={second} onText={setSecond} fill="new-password" />}
        <div class="form-foot">
          <button type="submit" class="button primary">
            {first ? t('Make the first administrator') : t('Sign in')}
          </button>
          {session.mayGoOn.value && (
            <button type="button" class="button" onClick={() => (session.goOn(), location.reload())}>
              {t('Go on without signing in')}
            </button>
          )}
          <Tell reported={reported} field="sign-in-told" />
        </div>
      </form>
      <LanguageChoice />
    </main>
  );
}
