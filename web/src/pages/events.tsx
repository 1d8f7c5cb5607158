// Events: what happened, newest first, by severity and axis. In: the store (at most the 500 newest). Out: a page.
import { EventList } from '../components/events';
import { Section } from '../components/section';
import { useGateway } from '../gateway';
import { kept } from '../state/kept';
import type { Severity } from '../api/types';

const least = kept('events.severity', 'info');
const axis = kept('events.axis');
const rank: Record<Severity, number> = { info: 0, warning: 1, alarm: 2 };

export function EventsPage() {
  const { store } = useGateway();
  const from = rank[least.value as Severity] ?? 0;
  const shown = store.events.value.filter((e) => rank[e.severity] >= from && (axis.value === '' || e.axis === axis.value));
  return (
    <main class="page narrow">
      <h1 tabIndex={-1}>Events</h1>
      <Section
        title={`${shown.length} shown, newest first`}
        beside={
          <>
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
          </>
        }
      >
        <div class="card">
          <EventList events={shown} limit={500} />
        </div>
      </Section>
    </main>
  );
}
