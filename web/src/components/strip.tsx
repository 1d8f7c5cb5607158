// Strip: the line under the head of every page: how many axes there are and how they are, or why nothing is live. In: the store, the session. Out: words, links.
// It is always there, so that nothing moves when the connection is lost: its words change, not its place.
import { useGateway } from '../gateway';
import { t } from '../language';
import { route } from '../router';
import { axesFilter } from '../state/axes-filter';
import { tick } from '../state/clock';
import { capital } from '../state/commander';
import { helpOfPage } from '../text/help';
import { duration } from '../text/time';
import { lastKnownText } from './axis-tile';
import { Icon } from './icon';
import { marked } from './marked';
import { Trial } from './trial';

/** To the chapter about this page, in a tab of its own: what is typed or commanded here goes on. */
function HelpLink() {
  return (
    <a class="help-link" href={helpOfPage(route.value.page)} target="axisgate-help" data-field="help">
      {t('Help')}
    </a>
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
  const { store, session } = useGateway();
  const out = session.needed.value;
  const live = store.connection.value.phase === 'live';
  return (
    <div class={`strip${out || live ? '' : ' is-lost'}`} data-field="strip">
      {out ? <SignedOut /> : live ? <Counts /> : <Lost />}
      <HelpLink />
    </div>
  );
}

/** The answer to "stop all". */
function StopTold() {
  const stop = useGateway().commander.stopReport.value;
  return <span class={`strip-stop result-${stop.tone}`}>{marked(stop.text)}</span>;
}

function SignedOut() {
  const { session } = useGateway();
  return (
    <>
      <span class="strip-text">{session.stopBarred.value && <b data-field="stop-barred">{session.stopBarred.value}</b>} {session.ended.value ? t('Your session has ended: no values are shown until you sign in again.') : t('Not signed in: no values are shown. This gateway serves nobody without a sign-in.')}</span>
      <StopTold />
    </>
  );
}

function Lost() {
  const { store, stream, commander } = useGateway();
  const c = store.connection.value;
  const stop = commander.stopReport.value;
  const first = c.lastLiveAt === 0;
  const silent = c.phase === 'silent';
  const next = silent ? t('Waiting for its next word.') : c.phase === 'waiting' ? t('Next try in {time}.', { time: duration(Math.max(0, c.retryAt - tick.value)) }) : t('Trying now.');
  return (
    <>
      <Icon name="unplugged" />
      <span class="strip-text">
        <b>{first ? t('No connection to the gateway yet.') : silent ? t('No answer from the gateway.') : t('Connection lost.')}</b>{' '}
        {first ? '' : t('All values are the last known ones, from {since} ago.', { since: lastKnownText(store) })}{' '}
        <span class="strip-more">
          {c.why && `${capital(c.why)}. `}
          {next}
        </span>
        {stop.tone !== 'none' && <b> {marked(stop.text)}</b>}
      </span>
      {!silent && (
        <button type="button" class="button" onClick={() => stream.retryNow()}>
          {t('Try now')}
        </button>
      )}
    </>
  );
}

function Counts() {
  const n = useGateway().store.counts.value;
  return (
    <>
      <span class="strip-text">
        <Counted n={n.axes} text={n.axes === 1 ? t('axis') : t('axes')} filter="" />
        <Counted n={n.moving} text={t('moving')} tone="active" filter={t('moving')} />
        <Counted n={n.fault} text={t('in fault')} tone="fault" filter={t('in fault')} />
        <Counted n={n.simulated} text={t('simulated')} filter={t('simulated')} />
        <Counted n={n.offline} text={t('offline')} tone="warning" filter={t('offline')} />
      </span>
      <StopTold />
      <Trial />
    </>
  );
}
