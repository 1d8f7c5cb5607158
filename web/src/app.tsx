// App: the frame around whatever page the address names. In: the route. Out: the whole page.
import { useEffect, useRef } from 'preact/hooks';
import { Head } from './components/frame';
import { Spoken } from './components/spoken';
import { Strip } from './components/strip';
import { route } from './router';
import { AxisPage, headingOf } from './pages/axis';
import { EventsPage } from './pages/events';
import { FleetPage } from './pages/fleet';
import { GatewayPage } from './pages/gateway';
import { LinePage, LinesPage } from './pages/lines';
import { MappingsPage } from './pages/mappings';
import { RecorderPage } from './pages/recorder';
import { RecipePage } from './pages/recipe';
import { RecipesPage } from './pages/recipes';
import { Overview } from './pages/overview';
import { ParametersPage } from './pages/parameters';
import { ReportPage } from './pages/report';
import { SitePage } from './pages/site';
import { SignInPage } from './pages/sign-in';
import { UsersPage } from './pages/users';
import { useGateway } from './gateway';
import { rich, t } from './language';

const titles = {
  overview: t('Axes'),
  lines: t('Lines and drives'),
  mappings: t('Mappings'),
  recipes: t('Recipes'),
  site: t('Site'),
  events: t('Events'),
  recorder: t('Recorder'),
  gateway: t('Gateway'),
  report: t('Commissioning report'),
  fleet: t('Fleet'),
  users: t('Users'),
  'sign-in': t('Sign in'),
  unknown: t('No such page'),
};

export function App() {
  const r = route.value;
  const title = r.page === 'parameters' ? t('Parameters of {name}', { name: r.name }) : r.page === 'axis' ? headingOf(r.name, r.tab) : r.page === 'line' || r.page === 'recipe' ? r.name : titles[r.page];
  useEffect(() => {
    document.title = `${title} · axisgate`;
  }, [title]);
  return (
    <>
      <a class="skip" href="#content">
        {t('To the content')}
      </a>
      <header class="top">
        <Head />
        <Strip />
      </header>
      <div id="content" class="content">
        <Signed />
      </div>
      <Spoken />
    </>
  );
}

/** While a sign-in is needed the page waits behind it, unseen and with all that was typed. A visit that begins without a role has no page yet. */
function Signed() {
  const { session } = useGateway();
  const needed = session.needed.value;
  const wasIn = useRef(false);
  if (!needed) wasIn.current = true;
  return (
    <>
      {needed && <SignInPage />}
      {wasIn.current && (
        <div hidden={needed}>
          <Page />
        </div>
      )}
    </>
  );
}

function Page() {
  const r = route.value;
  switch (r.page) {
    case 'overview': return <Overview />;
    case 'axis': return <AxisPage key={r.name} name={r.name} tab={r.tab} />;
    case 'lines': return <LinesPage />;
    case 'line': return <LinePage key={`${r.name} ${r.at_ms ?? ''}`} name={r.name} at_ms={r.at_ms} />;
    case 'recipes': return <RecipesPage />;
    case 'recipe': return <RecipePage key={r.name} name={r.name} />;
    case 'recorder': return <RecorderPage tab={r.tab} axis={r.axis} at_ms={r.at_ms} />;
    case 'events': return <EventsPage />;
    case 'gateway': return <GatewayPage />;
    case 'report': return <ReportPage />;
    case 'fleet': return <FleetPage />;
    case 'mappings': return <MappingsPage />;
    case 'parameters': return <ParametersPage key={r.name} name={r.name} />;
    case 'site': return <SitePage />;
    case 'users': return <UsersPage />;
    case 'sign-in': return <SignInPage />;
    case 'unknown':
      return (
        <main class="page narrow">
          <h1 tabIndex={-1}>{t('There is no such page')}</h1>
          <p>
            {rich('{path} names no page.', { path: <span class="mono">{r.path}</span> })} <a href="/">{t('All axes')}</a>
          </p>
        </main>
      );
  }
}
