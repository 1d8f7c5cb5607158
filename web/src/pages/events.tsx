// Events and alarms: what waits for somebody, and what happened, newest first, by severity, axis, kind and text; both as files.
// In: the store (at most the 500 newest events; the files have up to 1000). Out: a page.
import { AlarmSection } from '../components/alarms';
import { EventList } from '../components/events';
import { Section } from '../components/section';
import { useGateway } from '../gateway';
import { kept } from '../state/kept';
import { exportPath, passes } from '../words/alarm';

const least = kept('events.severity', 'info');
const axis = kept('events.axis');
const kind = kept('events.kind');
const text = kept('events.text');

export function EventsPage() {
  const { store } = useGateway();
  const filter = { least: least.value, axis: axis.value, kind: kind.value, text: text.value };
  const shown = store.events.value.filter((e) => passes(e, filter));
  const kinds = [...new Set([...store.events.value.map((e) => e.kind), ...(kind.value ? [kind.value] : [])])].sort();
  return (
    <main class="page narrow">
      <h1 tabIndex={-1}>Events and alarms</h1>
      <AlarmSection />
      <Section title={`Events: ${shown.length} shown, newest first`}>
        <div class="event-filters" role="group" aria-label="Filter of the events">
          <label class="select">
            <span>Severity</span>
            <select value={least.value} onChange={(e) => (least.value = e.currentTarget.value)}>
              <option value="info">all</option>
              <option value="warning">warnings and alarms</option>
              <option value="alarm">alarms</option>
            </select>
          </label>
          <label class="select">
            <span>Axis</span>
            <select value={axis.value} onChange={(e) => (axis.value = e.currentTarget.value)}>
              <option value="">all</option>
              {store.axisNames.value.map((n) => (
                <option key={n} value={n}>
                  {n}
                </option>
              ))}
            </select>
          </label>
          <label class="select">
            <span>Kind</span>
            <select value={kind.value} onChange={(e) => (kind.value = e.currentTarget.value)}>
              <option value="">all</option>
              {kinds.map((k) => (
                <option key={k} value={k}>
                  {k}
                </option>
              ))}
            </select>
          </label>
          <input class="search" type="search" placeholder="Text" aria-label="Text in the event" value={text.value} onInput={(e) => (text.value = e.currentTarget.value)} />
          <span class="event-files">
            <a class="button" href={exportPath(filter, 'csv')} download="events.csv">
              Save as CSV
            </a>
            <a class="button" href={exportPath(filter, 'text')} download="events.txt">
              Save as text
            </a>
          </span>
        </div>
        <div class="card">
          <EventList events={shown} limit={500} />
        </div>
      </Section>
    </main>
  );
}
