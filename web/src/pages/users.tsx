// Users: the own account for everybody, the users for administrators, and the access tokens. In: the session. Out: a page.
import { Account } from '../components/account';
import { Way } from '../components/who';
import { Tokens } from '../components/tokens';
import { UserList } from '../components/user-list';
import { Section } from '../components/section';
import { useGateway } from '../gateway';
import { whoWords } from '../state/session';

export function UsersPage() {
  const { session } = useGateway();
  const info = session.info.value;
  const why = session.mayNot('administrator');
  return (
    <main class="page narrow users-page">
      <h1 tabIndex={-1}>Users</h1>
      <p class="account-line">
        <span data-field="account">{info ? `You are ${whoWords(info)}.` : 'The gateway has not said who you are.'}</span> <Way />
      </p>
      {info?.first_sign_in && (
        <p class="card form" data-field="no-account">
          <span>
            Nobody has an account yet. The gateway printed a one-time sign-in code on its standard output at its first start; whoever has it makes the first administrator: <a href="/sign-in">first sign-in</a>. If the code is lost, start the gateway with{' '}
            <code class="mono">--set users.new_code=true</code>.
          </span>
        </p>
      )}
      {info?.user && info.via === 'cookie' && (
        <Section title="Your password">
          <Account user={info.user} />
        </Section>
      )}
      <Section title="All users">{why ? <p class="card form" data-field="users-barred">{why}</p> : <UserList key={info?.user ?? ''} />}</Section>
      <Section title="Tokens" help="door-http#tokens-for-programs">
        <Tokens key={info?.user ?? ''} />
      </Section>
    </main>
  );
}
