// Frame: head, navigation, strip and regions that every page shares. In: the store and the route. Out: what is around a page.
// The strip under the head is always there, so that nothing moves when the connection is lost: its words change, not its place.
import { useEffect } from 'preact/hooks';
import { signal } from '@preact/signals';
import { useGateway } from '../gateway';
import { route, type Route } from '../router';
import { axesFilter } from '../state/axes-filter';
import { tick } from '../state/clock';
import { dark, nextTheme } from '../state/theme';
import { helpOfPage } from '../text/help';
import { duration } from '../text/time';
import { Icon, type IconName } from './icon';
import { lastKnownWords } from './axis-tile';
import { StopAll } from './stop';
import { Trial } from './trial';
import { Who } from './who';

const places: { path: string; text: string; icon: IconName; pages: Route['page'][] }[] = [
  { path: '/', text: 'Axes', icon: 'axis', pages: ['overview', 'axis', 'parameters'] },
  { path: '/lines', text: 'Lines', icon: 'lines', pages: ['lines', 'line'] },
  { path: '/mappings', text: 'Mappings', icon: 'table', pages: ['mappings'] },
  { path: '/site', text: 'Site', icon: 'site', pages: ['site'] },
  { path: '/recipes', text: 'Recipes', icon: 'play', pages: ['recipes', 'recipe'] },
  { path: '/recorder', text: 'Recorder', icon: 'clock', pages: ['recorder'] },
  { path: '/events', text: 'Events', icon: 'list', pages: ['events'] },
  { path: '/gateway', text: 'Gateway', icon: 'box', pages: ['gateway', 'report'] },
];
/** Where the gateway is in a domain with others. */
const fleet: (typeof places)[number] = { path: '/fleet', text: 'Fleet', icon: 'site', pages: ['fleet'] };

/** How many alarms nobody has acknowledged; nothing when there are none. */
function AlarmBadge() {
  const n = useGateway().store.alarms.value?.unacknowledged ?? 0;
  if (n === 0) return null;
  return (
    <span class="alarm-badge" data-field="alarm-badge">
      {n > 99 ? '99+' : n}
      <span class="visually-hidden"> unacknowledged alarms</span>
    </span>
  );
}

export function Navigation() {
  const page = route.value.page;
  const inFleet = useGateway().store.about.value?.doors?.some((d) => d.name === 'dds') ?? false;
  return (
    <nav class={`nav${inFleet ? ' with-fleet' : ''}`} aria-label="Pages">
      {(inFleet ? [...places, fleet] : places).map((p) => (
        <a key={p.path} href={p.path} aria-current={p.pages.includes(page) ? 'page' : undefined}>
          <Icon name={p.icon} />
          <span>{p.text}</span>
          {p.path === '/events' && <AlarmBadge />}
        </a>
      ))}
    </nav>
  );
}

function Connection() {
  const { store, session } = useGateway();
  const out = session.needed.value;
  const phase = out ? 'connecting' : store.connection.value.phase;
  const words = out ? 'Not signed in' : phase === 'live' ? 'Live' : phase === 'connecting' ? 'Connecting' : phase === 'silent' ? 'No answer' : 'Not connected';
  return (
    <span class={`connection is-${phase}`} role="status" aria-label={`Connection to the gateway: ${words}`} data-field="connection">
      <Icon name={phase === 'live' ? 'check' : phase === 'connecting' ? 'clock' : 'unplugged'} size={14} />
      <span>{words}</span>
    </span>
  );
}

function ThemeButton() {
  const toDark = !dark.value;
  return (
    <button type="button" class="button quiet square" aria-label={toDark ? 'Dark theme' : 'Light theme'} title={toDark ? 'Dark theme' : 'Light theme'} onClick={nextTheme}>
      <Icon name={toDark ? 'moon' : 'sun'} />
    </button>
  );
}

/** To the chapter about this page, in a tab of its own: what is typed or commanded here goes on. */
function HelpLink() {
  return (
    <a class="help-link" href={helpOfPage(route.value.page)} target="axisgate-help" data-field="help">
      Help
    </a>
  );
}

export function Head() {
  return (
    <header class="head">
      <a class="brand" href="/" aria-label="axisgate, overview">
        <svg viewBox="0 0 24 24" width="22" height="22" aria-hidden="true">
          <path d="M4 20V4h3v13h13v3z" fill="currentColor" />
          <path d="M11 13V9h4V5h5v8z" class="brand-accent" />
        </svg>
        <span>axisgate</span>
      </a>
      <Navigation />
      <Connection />
      <Who />
      <ThemeButton />
      <StopAll />
    </header>
  );
}

/** `filter`: what the axes are filtered by when the count is pressed; nothing to show, nothing to press. */
function Counted({ n, one, many, tone, filter }: { n: number; one: string; many: string; tone?: string; filter: string }) {
  const look = `counted${n > 0 && tone ? ` tone-${tone}` : ''}`;
  const words = (
    <>
      <b>{n}</b> {n === 1 ? one : many}
    </>
  );
  if (n === 0) return <span class={look}>{words}</span>;
  const show = () => {
    axesFilter.value = filter;
    // After the page that the link leads to is drawn.
    setTimeout(() => document.getElementById('axes')?.scrollIntoView(), 60);
  };
  return (
    <a class={look} href="/" title={filter ? `Show the axes that match “${filter}”` : 'Show all axes'} onClick={show}>
      {words}
    </a>
  );
}

export function Strip() {
  const gateway = useGateway();
  const { store, commander } = gateway;
  if (gateway.session.needed.value) {
    const said = commander.stopReport.value;
    return (
      <div class="strip" data-field="strip">
        <span class="strip-text">{gateway.session.stopBarred.value && <b data-field="stop-barred">{gateway.session.stopBarred.value}</b>} {gateway.session.ended.value ? 'Your session has ended: no values are shown until you sign in again.' : 'Not signed in: no values are shown. This gateway serves nobody without a sign-in.'}</span>
        <span class={`strip-stop result-${said.tone}`}>{said.text}</span>
        <HelpLink />
      </div>
    );
  }
  const c = store.connection.value;
  const stop = commander.stopReport.value;
  if (c.phase !== 'live') {
    const since = lastKnownWords(store);
    const first = c.lastLiveAt === 0;
    const silent = c.phase === 'silent';
    const next = silent ? 'Waiting for its next word.' : c.phase === 'waiting' ? `Next try in ${duration(Math.max(0, c.retryAt - tick.value))}.` : 'Trying now.';
    return (
      <div class="strip is-lost" data-field="strip">
        <Icon name="unplugged" />
        <span class="strip-text">
          <b>{first ? 'No connection to the gateway yet.' : silent ? 'No answer from the gateway.' : 'Connection lost.'}</b>{' '}
          {first ? '' : `All values are the last known ones, from ${since} ago. `}
          <span class="strip-more">
            {c.why && `${c.why.charAt(0).toUpperCase()}${c.why.slice(1)}. `}
            {next}
          </span>
          {stop.tone !== 'none' && <b> {stop.text}</b>}
        </span>
        {!silent && (
          <button type="button" class="button" onClick={() => gateway.stream.retryNow()}>
            Try now
          </button>
        )}
        <HelpLink />
      </div>
    );
  }
  const n = store.counts.value;
  return (
    <div class="strip" data-field="strip">
      <span class="strip-text">
        <Counted n={n.axes} one="axis" many="axes" filter="" />
        <Counted n={n.moving} one="moving" many="moving" tone="active" filter="moving" />
        <Counted n={n.fault} one="in fault" many="in fault" tone="fault" filter="in fault" />
        <Counted n={n.simulated} one="simulated" many="simulated" filter="simulated" />
        <Counted n={n.offline} one="offline" many="offline" tone="warning" filter="offline" />
      </span>
      <span class={`strip-stop result-${stop.tone}`}>{stop.text}</span>
      <Trial />
      <HelpLink />
    </div>
  );
}

/** What is spoken without being asked: alarms, the loss of the connection, the answer to "stop all". Seen by screen readers only. */
const spoken = signal('');
export function Spoken() {
  const { store, commander } = useGateway();
  useEffect(() => {
    let waiting = 0;
    let quietUntil = 0;
    const say = (text: string) => {
      waiting += 1;
      const now = performance.now();
      if (now < quietUntil) return; // a burst of alarms is told as a number, at its end
      quietUntil = now + 2000;
      spoken.value = text;
      waiting = 0;
      setTimeout(() => {
        if (waiting > 0) spoken.value = `${waiting} more alarms`;
        waiting = 0;
      }, 2000);
    };
    return store.onEvent((e) => {
      if (e.severity === 'alarm') say(`Alarm. ${e.axis ?? e.drive ?? e.line ?? ''}: ${e.text}`);
    });
  }, [store]);
  const phase = store.connection.value.phase;
  const lost = phase === 'waiting' || phase === 'silent' ? 'Connection to the gateway lost. Values are not live.' : '';
  return (
    <>
      <div class="visually-hidden" role="alert" data-field="spoken">
        {spoken.value}
      </div>
      <div class="visually-hidden" role="alert">
        {lost}
      </div>
      <div class="visually-hidden" role="status">
        {commander.stopReport.value.text}
      </div>
    </>
  );
}
