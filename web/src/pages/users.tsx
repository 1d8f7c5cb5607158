// Users: the own account for everybody, the users for administrators, and the access tokens. In: the session. Out: a page.
import { Account } from '../components/account';
import { Way } from '../components/who';
import { Tokens } from '../components/tokens';
import { UserList } from '../components/user-list';
import { Section } from '../components/section';
import { useGateway } from '../gateway';
import { rich, t } from '../language';
import { whoText } from '../state/session';

export function UsersPage() {
  const { session } = useGateway();
  const info = session.info.value;
  const why = session.mayNot('administrator');
  return (
    <main class="page narrow users-page">
      <h1 tabIndex={-1}>{t('Users')}</h1>
      <p class="account-line">
        <span data-field="account">{info ? t('You are {text}.', { text: whoText(info) }) : t('The gateway has not said who you are.')}</span> <Way />
      </p>
      {info?.first_sign_in && (
        <p class="card form" data-field="no-account">
          <span>
            {rich('Nobody has an account yet. The gateway printed a one-time sign-in code on its standard output at its first start; whoever has it makes the first administrator: {link}. If the code is lost, start the gateway with {option}.', {
              link: <a href="/sign-in">{t('first sign-in')}</a>,
              option: <code class="mono">--set users.new_code=true</code>,
            })}
          </span>
        </p>
      )}
      {info?.user && info.via === 'cookie' && (
        <Section title={t('Your password')}>
          <Account user={info.user} />
        </Section>
      )}
      <Section title={t('All users')}>{why ? <p class="card form" data-field="users-barred">{why}</p> : <UserList key={info?.user ?? ''} />}</Section>
      <Section title={t('Tokens')} help="door-http#tokens-for-programs">
        <Tokens key={info?.user ?? ''} />
      </Section>
    </main>
  );
}
