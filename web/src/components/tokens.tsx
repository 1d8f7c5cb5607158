// Tokens: access for programs, with a role and an end. In: GET /tokens (the own ones; an administrator's: all). Out: made and deleted tokens.
// The secret is shown once, right after it was made, and is kept nowhere in the page.
import { useState } from 'preact/hooks';
import { asProblem } from '../api/problem';
import type { MadeToken, Token } from '../api/types';
import { useGateway } from '../gateway';
import { barred, roles } from '../state/session';
import { clockTime } from '../text/time';
import { useLoaded } from './loaded';
import { Choice, quiet, Tell, TextField, type Told } from './form';

const ends = [
  { value: '86400', text: 'in a day' },
  { value: '2592000', text: 'in 30 days' },
  { value: '31536000', text: 'in a year' },
  { value: '', text: 'never' },
];

export function Tokens() {
  const { client, session, store } = useGateway();
  const info = session.info.value;
  const [tokens, setTokens] = useState<Token[] | null>(null);
  const [made, setMade] = useState<MadeToken | null>(null);
  const [told, setTold] = useState<Told>(quiet);
  const [asked, setAsked] = useState('');
  const [name, setName] = useState('');
  const [role, setRole] = useState<string>('viewer');
  const [end, setEnd] = useState('2592000');
  const no = info && info.via !== 'cookie' ? 'A token belongs to a user: sign in with a password to make one.' : '';

  const list = async () => setTokens(await client.call<Token[]>('/tokens'));
  const why = useLoaded(list);
  const add = async (event: Event) => {
    event.preventDefault();
    if (!name.trim()) return setTold({ tone: 'refused', text: 'The name is missing.' });
    setTold({ tone: 'busy', text: 'Making …' });
    try {
      setMade(await client.call<MadeToken>('/tokens', { method: 'POST', body: { name: name.trim(), role, ...(end ? { expires_in_s: Number(end) } : {}) } }));
      setTold({ tone: 'good', text: 'Made. It is shown this once: copy it now.' });
      setName((now) => (now === name ? '' : now));
      await list();
    } catch (error) {
      setTold({ tone: 'refused', text: asProblem(error).words });
    }
  };
  const remove = async (t: Token) => {
    if (asked !== t.id) return setAsked(t.id);
    setAsked('');
    try {
      await client.call(`/tokens/${encodeURIComponent(t.id)}`, { method: 'DELETE' });
      if (made?.id === t.id) setMade(null);
      setTold({ tone: 'good', text: `Deleted ${t.name}.` });
      await list();
    } catch (error) {
      setTold({ tone: 'refused', text: asProblem(error).words });
    }
  };
  const copy = async (secret: string) => {
    try {
      await navigator.clipboard.writeText(secret);
      setTold({ tone: 'good', text: 'Copied.' });
    } catch {
      setTold({ tone: 'refused', text: 'The browser does not let the page copy: mark the text and copy it by hand.' });
    }
  };
  const may = roles.slice(0, info?.role ? roles.indexOf(info.role) + 1 : roles.length).map((r) => ({ value: r, text: r }));
  return (
    <div class="card form">
      <ul class="access-list">
        {why && <li>{why}</li>}
        {tokens?.length === 0 && <li>There are no tokens.</li>}
        {tokens?.map((t) => (
          <li key={t.id} data-token={t.name} class="access-row">
            <span class="access-name">
              <b>{t.name}</b>{' '}
              <span class="access-more">
                {t.role} · {t.owner} · {t.expires_at ? `${Date.parse(t.expires_at) <= store.gatewayNow_ms() ? 'expired' : 'ends'} ${clockTime(t.expires_at)}` : 'does not end'} · {t.last_used_at ? `used ${clockTime(t.last_used_at)}` : 'never used'}
              </span>
            </span>
            <span class="access-acts">
              <button type="button" class="button" aria-label={asked === t.id ? `Really delete token ${t.name}` : `Delete token ${t.name}`} onClick={() => void remove(t)} onBlur={() => setAsked('')}>
                {asked === t.id ? 'Really delete' : 'Delete'}
              </button>
            </span>
          </li>
        ))}
      </ul>
      {made && (
        <p class="access-secret">
          <code class="mono" data-field="secret">{made.token}</code>
          <button type="button" class="button" onClick={() => void copy(made.token)}>
            Copy
          </button>
          <button type="button" class="button quiet" onClick={() => setMade(null)}>
            Hide
          </button>
        </p>
      )}
      <form aria-label="Add a token" onSubmit={(e) => void add(e)}>
        <div class="form-grid">
          <TextField label="Name of the token" value={name} onText={setName} disabled={Boolean(no)} hint={no || undefined} />
          <Choice label="Role of the token" value={role} onChoice={setRole} choices={may} disabled={Boolean(no)} />
          <Choice label="It ends" value={end} onChoice={setEnd} choices={ends} disabled={Boolean(no)} />
        </div>
        <div class="form-foot">
          <button type="submit" class="button primary" {...barred(no)}>
            Add token
          </button>
          <Tell told={told} field="tokens-told" />
        </div>
      </form>
    </div>
  );
}
