// App: the frame around whatever page the address names. In: the route. Out: the whole page.
import { useEffect, useRef } from 'preact/hooks';
import { Head } from './components/frame';
import { later } from './components/later';
import { Spoken } from './components/spoken';
import { Strip } from './components/strip';
import { route } from './router';
import { Overview } from './pages/overview';
import { SignInPage } from './pages/sign-in';
import { useGateway } from './gateway';
import { rich, t } from './language';
import { titleOf } from './text/title';

// The overview and the sign-in are what a visit begins with; every other page has a bundle of its own.
const AxisPage = later(() => import('./pages/axis').then((m) => m.AxisPage));
const LinesPage = later(() => import('./pages/lines').then((m) => m.LinesPage));
const LinePage = later(() => import('./pages/lines').then((m) => m.LinePage));
const RecipesPage = later(() => import('./pages/recipes').then((m) => m.RecipesPage));
const RecipePage = later(() => import('./pages/recipe').then((m) => m.RecipePage));
const RecorderPage = later(() => import('./pages/recorder').then((m) => m.RecorderPage));
const EventsPage = later(() => import('./pages/events').then((m) => m.EventsPage));
const GatewayPage = later(() => import('./pages/gateway').then((m) => m.GatewayPage));
const ReportPage = later(() => import('./pages/report').then((m) => m.ReportPage));
const FleetPage = later(() => import('./pages/fleet').then((m) => m.FleetPage));
const MappingsPage = later(() => import('./pages/mappings').then((m) => m.MappingsPage));
const ParametersPage = later(() => import('./pages/parameters').then((m) => m.ParametersPage));
const SitePage = later(() => import('./pages/site').then((m) => m.SitePage));
const DescriptionsPage = later(() => import('./pages/descriptions').then((m) => m.DescriptionsPage));
const DescriptionPage = later(() => import('./pages/description').then((m) => m.DescriptionPage));
const UsersPage = later(() => import('./pages/users').then((m) => m.UsersPage));

export function App() {
  const title = titleOf(route.value);
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
    case 'descriptions': return <DescriptionsPage />;
    case 'description': return <DescriptionPage key={r.name} name={r.name} other={r.other} />;
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
