// User list: who can sign in, with role; for administrators. In: GET /users. Out: added, changed, disabled and deleted users.
// A deletion is asked for, a role is chosen and then saved: an arrow key on the choice alone changes nobody's rights. A password is typed by the administrator and never shown again.
import { useState } from 'preact/hooks';
import { asProblem } from '../api/problem';
import type { Role, User } from '../api/types';
import { useGateway } from '../gateway';
import { t } from '../language';
import { passwordFault, roles, roleWord, userFault } from '../state/session';
import { quiet, type Reported } from '../state/reported';
import { clockTime } from '../text/time';
import { useLoaded } from './loaded';
import { DeleteButton } from './ask';
import { Choice, Tell, TextField } from './form';

export const roleChoices = roles.map((r) => ({ value: r, text: roleWord(r) }));

export function UserList() {
  const { client, session } = useGateway();
  const [users, setUsers] = useState<User[] | null>(null);
  const [reported, setReported] = useState<Reported>(quiet);
  const [chosen, setChosen] = useState<Record<string, string>>({});
  const [renewing, setRenewing] = useState('');
  const [name, setName] = useState('');
  const [role, setRole] = useState<string>('operator');
  const [password, setPassword] = useState('');
  const [fresh, setFresh] = useState('');

  const list = async () => setUsers(await client.call<User[]>('/users'));
  const act = async (text: string, work: () => Promise<unknown>): Promise<boolean> => {
    setReported({ tone: 'busy', text: `${text} …` });
    try {
      await work();
      setReported({ tone: 'good', text: t('{what}: done.', { what: text }) });
      await list();
      return true;
    } catch (error) {
      setReported({ tone: 'refused', text: `${text}: ${asProblem(error).text}` });
      return false;
    } finally {
      void session.ask(); // it may have been oneself
    }
  };
  const why = useLoaded(list);

  const at = (n: string) => `/users/${encodeURIComponent(n)}`;
  const patch = (n: string, text: string, body: object) => act(text, () => client.call(at(n), { method: 'PATCH', body }));
  const saveRole = async (n: string, to: string) => {
    if (await patch(n, t('Role of {name}: {role}', { name: n, role: roleWord(to as Role) }), { role: to })) setChosen(({ [n]: _, ...rest }) => rest);
  };
  const renew = async (n: string) => {
    if (renewing !== n) {
      setFresh('');
      return setRenewing(n);
    }
    const fault = passwordFault(fresh, fresh);
    if (fault) return setReported({ tone: 'refused', text: fault });
    if (await patch(n, t('New password of {name}', { name: n }), { password: fresh })) setRenewing('');
    setFresh((now) => (now === fresh ? '' : now));
  };
  const add = async (event: Event) => {
    event.preventDefault();
    const fault = userFault(name) || passwordFault(password, password);
    if (fault) return setReported({ tone: 'refused', text: fault });
    if (await act(t('Add {name}', { name }), () => client.call('/users', { method: 'POST', body: { name, role: role as Role, password } }))) setName((now) => (now === name ? '' : now));
    setPassword((now) => (now === password ? '' : now));
  };

  return (
    <div class="card form">
      <ul class="access-list">
        {why && <li>{why}</li>}
        {users?.length === 0 && <li>{t('There are no users yet.')}</li>}
        {users?.map((u) => (
          <li key={u.name} data-user={u.name} class="access-row">
            <span class="access-name">
              <b>{u.name}</b> <span class="access-more">{[(chosen[u.name] ?? u.role) !== u.role ? t('still {role}', { role: roleWord(u.role) }) : '', u.enabled ? '' : t('disabled'), u.last_sign_in_at ? t('last sign-in {time}', { time: clockTime(u.last_sign_in_at) }) : t('never signed in')].filter(Boolean).join(' · ')}</span>
            </span>
            <span class="access-acts">
              <select
                aria-label={t('Role of {name}', { name: u.name })}
                value={chosen[u.name] ?? u.role}
                onChange={(e) => {
                  const to = e.currentTarget.value;
                  setChosen((c) => ({ ...c, [u.name]: to }));
                }}
              >
                {roles.map((r) => (
                  <option key={r} value={r}>
                    {roleWord(r)}
                  </option>
                ))}
              </select>
              {(chosen[u.name] ?? u.role) !== u.role && (
                <button type="button" class="button primary" aria-label={t('Save the role of {name}: {role} in place of {old}', { name: u.name, role: roleWord(chosen[u.name] as Role), old: roleWord(u.role) })} onClick={() => void saveRole(u.name, chosen[u.name] as string)}>
                  {t('Save role')}
                </button>
              )}
              <button type="button" class="button" aria-label={u.enabled ? t('Bar {name}', { name: u.name }) : t('Admit {name}', { name: u.name })} onClick={() => void patch(u.name, u.enabled ? t('Bar {name}', { name: u.name }) : t('Admit {name}', { name: u.name }), { enabled: !u.enabled })}>
                {u.enabled ? t('Bar') : t('Admit')}
              </button>
              {renewing === u.name && <input type="password" aria-label={t('New password of {name}', { name: u.name })} autocomplete="new-password" value={fresh} onInput={(e) => setFresh(e.currentTarget.value)} />}
              <button type="button" class="button" aria-label={renewing === u.name ? t('Set the password of {name}', { name: u.name }) : t('Give {name} a new password', { name: u.name })} onClick={() => void renew(u.name)}>
                {renewing === u.name ? t('Set password') : t('New password')}
              </button>
              <DeleteButton name={u.name} class="" onYes={() => void act(t('Delete {name}', { name: u.name }), () => client.call(at(u.name), { method: 'DELETE' }))} />
            </span>
          </li>
        ))}
      </ul>
      <form aria-label={t('Add a user')} onSubmit={(e) => void add(e)}>
        <div class="form-grid">
          <TextField label={t('Name')} value={name} onText={setName} hint={t('a-z, 0-9, point, _ - and @')} />
          <Choice label={t('Role')} value={role} onChoice={setRole} choices={roleChoices} />
          <TextField label={t('Password')} password fill="new-password" value={password} onText={setPassword} hint={t('At least 12 characters.')} />
        </div>
        <div class="form-foot">
          <button type="submit" class="button primary">
            {t('Add user')}
          </button>
          <Tell reported={reported} field="users-told" />
        </div>
      </form>
    </div>
  );
}
