// Frame: head and navigation that every page shares. In: the store and the route. Out: what is above and beside a page.
import { useGateway } from '../gateway';
import { t } from '../language';
import { route, type Route } from '../router';
import { dark, nextTheme } from '../state/theme';
import { Icon, type IconName } from './icon';
import { LanguageChoice } from './language';
import { StopAll } from './stop';
import { Who } from './who';

const places: { path: string; text: string; icon: IconName; pages: Route['page'][] }[] = [
  { path: '/', text: t('Axes'), icon: 'axis', pages: ['overview', 'axis', 'parameters'] },
  { path: '/lines', text: t('Lines'), icon: 'lines', pages: ['lines', 'line'] },
  { path: '/mappings', text: t('Mappings'), icon: 'table', pages: ['mappings'] },
  { path: '/site', text: t('Site'), icon: 'site', pages: ['site', 'descriptions', 'description'] },
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
