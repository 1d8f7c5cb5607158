// Tokens: access for programs, with a role and an end. In: GET /tokens (the own ones; an administrator's: all). Out: made and deleted tokens.
// The secret is shown once, right after it was made, and is kept nowhere in the page.
import { useState } from 'preact/hooks';
import type { MadeToken, Token } from '../api/types';
import { useGateway } from '../gateway';
import { t } from '../language';
import { barred, roles, roleWord } from '../state/session';
import { quiet, refusal, type Reported } from '../state/reported';
import { clockTime } from '../text/time';
import { useLoaded } from './loaded';
import { DeleteButton } from './ask';
import { Choice, Tell, TextField } from './form';

const ends = [
  { value: '86400', text: t('in a day') },
  { value: '2592000', text: t('in 30 days') },
  { value: '31536000', text: t('in a year') },
  { value: '', text: t('never') },
];

export function Tokens() {
  const { client, session, store } = useGateway();
  const info = session.info.value;
  const [tokens, setTokens] = useState<Token[] | null>(null);
  const [made, setMade] = useState<MadeToken | null>(null);
  const [reported, setReported] = useState<Reported>(quiet);
  const [name, setName] = useState('');
  const [role, setRole] = useState<string>('viewer');
  const [end, setEnd] = useState('2592000');
  const no = info && info.via !== 'cookie' ? t('A token belongs to a user: sign in with a password to make one.') : '';

  const list = async () => setTokens(await client.call<Token[]>('/tokens'));
  const why = useLoaded(list);
  const add = async (event: Event) => {
    event.preventDefault();
    if (!name.trim()) return setReported({ tone: 'refused', text: t('The name is missing.') });
    setReported({ tone: 'busy', text: t('Making …') });
    try {
      setMade(await client.call<MadeToken>('/tokens', { method: 'POST', body: { name: name.trim(), role, ...(end ? { expires_in_s: Number(end) } : {}) } }));
      setReported({ tone: 'good', text: t('Made. It is shown this once: copy it now.') });
      setName((now) => (now === name ? '' : now));
      await list();
    } catch (error) {
      setReported(refusal(error));
    }
  };
  const remove = async (k: Token) => {
    try {
      await client.call(`/tokens/${encodeURIComponent(k.id)}`, { method: 'DELETE' });
      if (made?.id === k.id) setMade(null);
      setReported({ tone: 'good', text: t('{name} is deleted.', { name: k.name }) });
      await list();
    } catch (error) {
      setReported(refusal(error));
    }
  };
  const copy = async (secret: string) => {
    try {
      await navigator.clipboard.writeText(secret);
      setReported({ tone: 'good', text: t('Copied.') });
    } catch {
      setReported({ tone: 'refused', text: t('The browser does not let the page copy: mark the text and copy it by hand.') });
    }
  };
  const may = roles.slice(0, info?.role ? roles.indexOf(info.role) + 1 : roles.length).map((r) => ({ value: r, text: roleWord(r) }));
  return (
    <div class="card form">
      <ul class="access-list">
        {why && <li>{why}</li>}
        {tokens?.length === 0 && <li>{t('There are no tokens.')}</li>}
        {tokens?.map((k) => (
          <li key={k.id} data-token={k.name} class="access-row">
            <span class="access-name">
              <b>{k.name}</b>{' '}
              <span class="access-more">
                {roleWord(k.role)} · {k.owner} · {!k.expires_at ? t('does not end') : Date.parse(k.expires_at) <= store.gatewayNow_ms() ? t('expired {time}', { time: clockTime(k.expires_at) }) : t('ends {time}', { time: clockTime(k.expires_at) })} · {k.last_used_at ? t('used {time}', { time: clockTime(k.last_used_at) }) : t('never used')}
              </span>
            </span>
            <span class="access-acts">
              <DeleteButton name={k.name} class="" onYes={() => void remove(k)} />
            </span>
          </li>
        ))}
      </ul>
      {made && (
        <p class="access-secret">
          <code class="mono" data-field="secret">{made.token}</code>
          <button type="button" class="button" onClick={() => void copy(made.token)}>
            {t('Copy')}
          </button>
          <button type="button" class="button quiet" onClick={() => setMade(null)}>
            {t('Hide')}
          </button>
        </p>
      )}
      <form aria-label={t('Add a token')} onSubmit={(e) => void add(e)}>
        <div class="form-grid">
          <TextField label={t('Name of the token')} value={name} onText={setName} disabled={Boolean(no)} hint={no || undefined} />
          <Choice label={t('Role of the token')} value={role} onChoice={setRole} choices={may} disabled={Boolean(no)} />
          <Choice label={t('It ends')} value={end} onChoice={setEnd} choices={ends} disabled={Boolean(no)} />
        </div>
        <div class="form-foot">
          <button type="submit" class="button primary" {...barred(no)}>
            {t('Add token')}
          </button>
          <Tell reported={reported} field="tokens-told" />
        </div>
      </form>
    </div>
  );
}
