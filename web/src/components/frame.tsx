// Frame: head, navigation, strip and regions that every page shares. In: the store and the route. Out: what is around a page.
// The strip under the head is always there, so that nothing moves when the connection is lost: its words change, not its place.
import { useEffect } from 'preact/hooks';
import { marked } from './marked';
import { signal } from '@preact/signals';
import { useGateway } from '../gateway';
import { t } from '../language';
import { route, type Route } from '../router';
import { axesFilter } from '../state/axes-filter';
import { tick } from '../state/clock';
import { dark, nextTheme } from '../state/theme';
import { helpOfPage } from '../text/help';
import { duration } from '../text/time';
import { Icon, type IconName } from './icon';
import { LanguageChoice } from './language';
import { lastKnownText } from './axis-tile';
import { StopAll } from './stop';
import { Trial } from './trial';
import { Who } from './who';

const places: { path: string; text: string; icon: IconName; pages: Route['page'][] }[] = [
  { path: '/', text: t('Axes'), icon: 'axis', pages: ['overview', 'axis', 'parameters'] },
  { path: '/lines', text: t('Lines'), icon: 'lines', pages: ['lines', 'line'] },
  { path: '/mappings', text: t('Mappings'), icon: 'table', pages: ['mappings'] },
  { path: '/site', text: t('Site'), icon: 'site', pages: ['site'] },
  { path: '/recipes', text: t('Recipes'), icon: 'play', pages: ['recipes', 'recipe'] },
  { path: '/recorder', text: t('Recorder'), icon: 'clock', pages: ['recorder'] },
  { path: '/events', text: t('Events'), icon: 'list', pages: ['events'] },
  { path: '/gateway', text: t('Gateway'), icon: 'box', pages: ['gateway', 'report'] },
];
/** Where the gateway is in a domain with others. */
const fleet: (typeof places)[number] = { path: '/fleet', text: t('Fleet'), icon: 'site', pages: ['fleet'] };

/** How many alarms nobody has acknowledged; nothing when there are none. */
function AlarmBadge() {
  const n = useGateway().store.alarms.value?.unacknowledged ?? 0;
  if (n === 0) return null;
  return (
    <span class="alarm-badge" data-field="alarm-badge">
      <span aria-hidden="true">{n > 99 ? '99+' : n}</span>
      <span class="visually-hidden">{n === 1 ? t('1 unacknowledged alarm') : t('{n} unacknowledged alarms', { n })}</span>
    </span>
  );
}

export function Navigation() {
  const page = route.value.page;
  const inFleet = useGateway().store.about.value?.doors?.some((d) => d.name === 'dds') ?? false;
  return (
    <nav class={`nav${inFleet ? ' with-fleet' : ''}`} aria-label={t('Pages')}>
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
  const text = out ? t('Not signed in') : phase === 'live' ? t('Live') : phase === 'connecting' ? t('Connecting') : phase === 'silent' ? t('No answer') : t('Not connected');
  return (
    <span class={`connection is-${phase}`} role="status" aria-label={t('Connection to the gateway: {text}', { text })} data-field="connection">
      <Icon name={phase === 'live' ? 'check' : phase === 'connecting' ? 'clock' : 'unplugged'} size={14} />
      <span>{text}</span>
    </span>
  );
}

function ThemeButton() {
  const toDark = !dark.value;
  return (
    <button type="button" class="button quiet square" aria-label={toDark ? t('Dark theme') : t('Light theme')} title={toDark ? t('Dark theme') : t('Light theme')} onClick={nextTheme}>
      <Icon name={toDark ? 'moon' : 'sun'} />
    </button>
  );
}

/** To the chapter about this page, in a tab of its own: what is typed or commanded here goes on. */
function HelpLink() {
  return (
    <a class="help-link" href={helpOfPage(route.value.page)} target="axisgate-help" data-field="help">
      {t('Help')}
    </a>
  );
}

export function Head() {
  return (
    <div class="head">
      <a class="brand" href="/" aria-label={t('axisgate, overview')}>
        <svg viewBox="0 0 24 24" width="22" height="22" aria-hidden="true">
          <path d="M4 20V4h3v13h13v3z" fill="currentColor" />
          <path d="M11 13V9h4V5h5v8z" class="brand-accent" />
        </svg>
        <span>axisgate</span>
      </a>
      <Navigation />
      <Connection />
      <Who />
      <LanguageChoice />
      <ThemeButton />
      <StopAll />
    </div>
  );
}

/** `filter`: what the axes are filtered by when the count is pressed; nothing to show, nothing to press. */
function Counted({ n, text: what, tone, filter }: { n: number; text: string; tone?: string; filter: string }) {
  const look = `counted${n > 0 && tone ? ` tone-${tone}` : ''}`;
  const text = (
    <>
      <b>{n}</b> {what}
    </>
  );
  if (n === 0) return <span class={look}>{text}</span>;
  const show = () => {
    axesFilter.value = filter;
    // After the page that the link leads to is drawn.
    setTimeout(() => document.getElementById('axes')?.scrollIntoView(), 60);
  };
  return (
    <a class={look} href="/" title={filter ? t('Show the axes that match “{filter}”', { filter }) : t('Show all axes')} onClick={show}>
      {text}
    </a>
  );
}

export function Strip() {
  const gateway = useGateway();
  const { store, commander } = gateway;
  if (gateway.session.needed.value) {
    const published = commander.stopReport.value;
    return (
      <div class="strip" data-field="strip">
        <span class="strip-text">{gateway.session.stopBarred.value && <b data-field="stop-barred">{gateway.session.stopBarred.value}</b>} {gateway.session.ended.value ? t('Your session has ended: no values are shown until you sign in again.') : t('Not signed in: no values are shown. This gateway serves nobody without a sign-in.')}</span>
        <span class={`strip-stop result-${published.tone}`}>{marked(published.text)}</span>
        <HelpLink />
      </div>
    );
  }
  const c = store.connection.value;
  const stop = commander.stopReport.value;
  if (c.phase !== 'live') {
    const since = lastKnownText(store);
    const first = c.lastLiveAt === 0;
    const silent = c.phase === 'silent';
    const next = silent ? t('Waiting for its next word.') : c.phase === 'waiting' ? t('Next try in {time}.', { time: duration(Math.max(0, c.retryAt - tick.value)) }) : t('Trying now.');
    return (
      <div class="strip is-lost" data-field="strip">
        <Icon name="unplugged" />
        <span class="strip-text">
          <b>{first ? t('No connection to the gateway yet.') : silent ? t('No answer from the gateway.') : t('Connection lost.')}</b>{' '}
          {first ? '' : t('All values are the last known ones, from {since} ago.', { since })}{' '}
          <span class="strip-more">
            {c.why && `${c.why.charAt(0).toUpperCase()}${c.why.slice(1)}. `}
            {next}
          </span>
          {stop.tone !== 'none' && <b> {marked(stop.text)}</b>}
        </span>
        {!silent && (
          <button type="button" class="button" onClick={() => gateway.stream.retryNow()}>
            {t('Try now')}
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
        <Counted n={n.axes} text={n.axes === 1 ? t('axis') : t('axes')} filter="" />
        <Counted n={n.moving} text={t('moving')} tone="active" filter={t('moving')} />
        <Counted n={n.fault} text={t('in fault')} tone="fault" filter={t('in fault')} />
        <Counted n={n.simulated} text={t('simulated')} filter={t('simulated')} />
        <Counted n={n.offline} text={t('offline')} tone="warning" filter={t('offline')} />
      </span>
      <span class={`strip-stop result-${stop.tone}`}>{marked(stop.text)}</span>
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
        if (waiting > 0) spoken.value = waiting === 1 ? t('1 more alarm') : t('{n} more alarms', { n: waiting });
        waiting = 0;
      }, 2000);
    };
    return store.onEvent((e) => {
      if (e.severity === 'alarm') say(t('Alarm. {subject}: {text}', { subject: e.axis ?? e.drive ?? e.line ?? t('gateway'), text: e.text }));
    });
  }, [store]);
  const phase = store.connection.value.phase;
  const lost = phase === 'waiting' || phase === 'silent' ? t('Connection to the gateway lost. Values are not live.') : '';
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
