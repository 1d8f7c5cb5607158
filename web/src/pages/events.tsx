// Events and alarms: what waits for somebody, and what happened, newest first, by severity, axis, kind and text; as files exactly what is shown.
// In: the gateway's newest 1000 that fit, and the store's for what has come since. Out: a page.
import { t } from '../language';
import { useSignal } from '@preact/signals';
import { useEffect } from 'preact/hooks';
import type { GatewayEvent } from '../api/types';
import { AlarmSection } from '../components/alarms';
import { EventList } from '../components/events';
import { useNamed } from '../components/name';
import { Section } from '../components/section';
import { useGateway } from '../gateway';
import { windowOf } from '../state/narrow';
import { persisted } from '../state/persisted';
import { asked, eventFile, gathered } from '../text/alarm';
import { plainWord } from '../text/plain';

const least = persisted('events.severity', 'info');
const axis = persisted('events.axis');
const kind = persisted('events.kind');
const text = persisted('events.text');
/** As many as the gateway gives at once. */
const most = 1000;

function save(events: readonly GatewayEvent[], format: 'csv' | 'text'): void {
  const url = URL.createObjectURL(new Blob([eventFile(events, format)], { type: format === 'csv' ? 'text/csv' : 'text/plain' }));
  const link = document.createElement('a');
  link.href = url;
  link.download = format === 'csv' ? 'events.csv' : 'events.txt';
  link.click();
  setTimeout(() => URL.revokeObjectURL(url), 10_000);
}

export function EventsPage() {
  const { client, store } = useGateway();
  const named = useNamed();
  const had = useSignal<{ list: GatewayEvent[]; more: boolean }>({ list: [], more: false });
  const epoch = store.connection.value.epoch;
  const filter = { least: least.value, axis: axis.value, kind: kind.value, text: text.value };
  useEffect(() => {
    if (epoch === 0) return;
    let here = true;
    client.events({ limit: most, ...asked(filter) }).then((list) => here && (had.value = { list, more: list.length >= most }), () => undefined);
    return () => {
      here = false;
    };
  }, [client, epoch, least.value, axis.value, kind.value]);
  const shown = gathered(had.value.list, store.events.value, filter, most);
  const filtered = filter.least !== 'info' || filter.axis !== '' || filter.kind !== '' || filter.text.trim() !== '';
  const nothing = filtered && shown.length === 0;
  // How many there are without the filter: asked only where the filter hides all of them.
  const whole = useSignal<GatewayEvent[]>([]);
  useEffect(() => {
    if (epoch > 0 && nothing) client.events({ limit: most }).then((list) => (whole.value = list), () => undefined);
  }, [client, epoch, nothing]);
  const inAll = gathered([...whole.value, ...had.value.list], store.events.value, { least: 'info', axis: '', kind: '', text: '' }, most).length;
  const clear = () => {
    least.value = 'info';
    for (const f of [axis, kind, text]) f.value = '';
  };
  const kinds = [...new Set([...had.value.list, ...store.events.value].map((e) => e.kind).concat( ...kind.value ? [kind.value] : []))].sort();
  return (
    <main class="page narrow">
      <h1 tabIndex={-1}>{t('Events and alarms')}</h1>
      <AlarmSection />
      <Section title={t('Events: {n} shown, newest first', { n: shown.length })}>
        <div class="event-filters" role="group" aria-label={t('Filter of the events')}>
          <label class="select">
            <span>{t('Severity')}</span>
            <select value={least.value} onChange={(e) => (least.value = e.currentTarget.value)}>
              <option value="info">{t('all')}</option>
              <option value="warning">{t('warnings and alarms')}</option>
              <option value="alarm">{t('alarms')}</option>
            </select>
          </label>
          <label class="select">
            <span>{t('Axis')}</span>
            <select value={axis.value} onChange={(e) => (axis.value = e.currentTarget.value)}>
              <option value="">{t('all')}</option>
              {store.axisNames.value.map((n) => (
                <option key={n} value={n}>
                  {named(n)}
                </option>
              ))}
            </select>
          </label>
          <label class="select">
            <span>{t('Kind')}</span>
            <select value={kind.value} onChange={(e) => (kind.value = e.currentTarget.value)}>
              <option value="">{t('all')}</option>
              {kinds.map((k) => (
                <option key={k} value={k}>
                  {plainWord(k)}
                </option>
              ))}
            </select>
          </label>
          <input class="search" type="search" placeholder={t('Text')} aria-label={t('Text in the event')} value={text.value} onInput={(e) => (text.value = e.currentTarget.value)} />
          <span class="event-files">
            <button type="button" class="button" onClick={() => save(shown, 'csv')}>
              {t('Save {n} as CSV', { n: shown.length })}
            </button>
            <button type="button" class="button" onClick={() => save(shown, 'text')}>
              {t('Save {n} as text', { n: shown.length })}
            </button>
          </span>
        </div>
        {had.value.more && (
          <p class="where" data-field="more-events">
            {t('There are more than {most}: these are {n}. Choose severity, axis or kind to reach further back, or ask the API for pages (GET /api/v1/events?before=).', { most, n: text.value.trim() ? t('what fits among the newest {most}', { most }) : t('the newest {most}', { most }) })}
          </p>
        )}
        {filtered && (
          <p class="filtered" role="status" data-field="filtered">
            <span>{nothing ? t('No event matches the filter; {n} in all.', { n: inAll >= most ? t('{most} or more', { most }) : inAll }) : t('A filter is on: not all events are shown.')}</span>
            <button type="button" class="button small" onClick={clear}>
              {t('Clear the filter')}
            </button>
          </p>
        )}
        {!nothing && (
          <div class="card window" {...windowOf(t('Events'))}>
            <EventList events={shown} limit={most} />
          </div>
        )}
      </Section>
    </main>
  );
}
