// Events, newest first: severity in words and icon, what happened, to what, by whom. In: events. Out: a list.
// Severity is a word and a shape before it is a colour.
import { gatewayText, t, theirs } from '../language';
import { marked } from './marked';
import type { GatewayEvent, Severity } from '../api/types';
import { withoutSubject } from '../text/alarm';
import { plainWord } from '../text/plain';
import { clockTime } from '../text/time';
import { useComputed } from '@preact/signals';
import { useGateway } from '../gateway';
import { groupsOf, inUnits, type Scale } from '../text/event';
import { ErrorHelp } from './error-help';
import { Icon, type IconName } from './icon';
import { memo } from './memo';
import { AxisName, DriveName } from './name';

const marks: Record<Severity, { icon: IconName; text: string; tone: string }> = {
  info: { icon: 'info', text: t('Info'), tone: 'muted' },
  warning: { icon: 'triangle', text: t('Warning'), tone: 'warning' },
  alarm: { icon: 'bell', text: t('Alarm'), tone: 'fault' },
};

function subject(e: GatewayEvent) {
  if (e.axis) return <AxisName name={e.axis} />;
  return e.drive ? <DriveName name={e.drive} /> : (e.line ?? null);
}

function ItemView({ event, scale }: { event: GatewayEvent; scale?: Scale | undefined }) {
  const m = marks[event.severity];
  const about = subject(event);
  const text = inUnits(withoutSubject(event.text, event.axis ?? event.drive ?? event.line ?? ''), scale);
  const change = event.parameter ? `${event.parameter}: ${event.old ?? t('not known')} → ${event.new ?? ''}` : '';
  return (
    <li class={`event tone-${m.tone}`} data-severity={event.severity}>
      <span class="event-mark" title={m.text}>
        <Icon name={m.icon} size={14} />
        <span class={event.severity === 'info' ? 'visually-hidden' : ''}>{m.text}</span>
      </span>
      <time dateTime={event.at} title={event.at}>
        {clockTime(event.at)}
      </time>
      <span class="event-what">
        {about && <b>{about} </b>}
        {text ? <span {...gatewayText}>{text}</span> : <span>{change || plainWord(event.kind)}</span>}
        {event.text && change && <span class="event-change mono"> {change}</span>}
        {event.code ? <span class="mono">{' '}{t('(code {code})', { code: event.code })}</span> : null}
        {event.code && event.severity !== 'info' ? (
          <details class="event-help">
            <summary>{t('what to do')}</summary>
            <ErrorHelp axis={event.axis} drive={event.drive} code={event.code} />
          </details>
        ) : null}
        {event.who && <span class="event-who">{' '}{marked(t('by {who}', { who: theirs(event.who) }))}</span>}
      </span>
    </li>
  );
}

/** An event never changes, only the unit of its axis does: a thousand of them are drawn once. */
export const EventItem = memo(ItemView, (a, b) => a.event === b.event && a.scale?.unit === b.scale?.unit && a.scale?.increments_per_unit === b.scale?.increments_per_unit);

/** What one bulk edit wrote: a line with the count, each write on request. */
function EventGroup({ events, scale }: { events: GatewayEvent[]; scale?: Scale | undefined }) {
  const newest = events[0] as GatewayEvent;
  return (
    <li class="event tone-muted" data-severity="info" data-field="event-group">
      <span class="event-mark" title={t('Info')}>
        <Icon name="info" size={14} />
        <span class="visually-hidden">{t('Info')}</span>
      </span>
      <time dateTime={newest.at} title={newest.at}>
        {clockTime(newest.at)}
      </time>
      <div class="event-what">
        <b>{subject(newest)} </b>
        {t('{n} parameters written', { n: events.length })}
        <span class="event-who">{' '}{marked(t('by {who}', { who: theirs(newest.who ?? '') }))}</span>
        <details>
          <summary>{t('each of them')}</summary>
          <ol class="events">
            {events.map((e) => (
              <EventItem key={e.id} event={e} scale={scale} />
            ))}
          </ol>
        </details>
      </div>
    </li>
  );
}

export function EventList({ events, limit }: { events: GatewayEvent[]; limit: number }) {
  const { store } = useGateway();
  // As text: it is another only when a unit is, not with every reading.
  const reported = useComputed(() => JSON.stringify(store.axisNames.value.map((n) => { const a = store.axis(n)?.value.data; return [n, { unit: a?.unit ?? '', increments_per_unit: a?.increments_per_unit ?? 0 }]; })));
  const scales = new Map(JSON.parse(reported.value) as [string, Scale][]);
  if (events.length === 0) return <p class="empty"><Icon name="info" />{' '}{t('Nothing has happened yet.')}</p>;
  return (
    <ol class="events">
      {groupsOf(events.slice(0, limit)).map((g) => {
        const newest = g[0] as GatewayEvent;
        const scale = newest.axis ? scales.get(newest.axis) : undefined;
        // By its oldest: a group that grows stays the one that was opened.
        return g.length === 1 ? <EventItem key={newest.id} event={newest} scale={scale} /> : <EventGroup key={`of ${g.at(-1)?.id}`} events={g} scale={scale} />;
      })}
    </ol>
  );
}
