// Overview: all axes as live tiles, or as rows where there are many, the lines, the drives, what happened last. In: the store. Out: the first page.
import { useComputed } from '@preact/signals';
import { AxisRow } from '../components/axis-row';
import { useGateway } from '../gateway';
import { AxisTile } from '../components/axis-tile';
import { ErrorList } from '../components/errors';
import { EventList } from '../components/events';
import { Why } from '../components/gate';
import { DriveList, Empty, LineList } from '../components/lines';
import { Section } from '../components/section';
import { axesFilter, axisMatches } from '../state/axes-filter';
import { persisted } from '../state/persisted';

/** '': as many as there are axes say. */
const view = persisted('axes.view');
const mostTiles = 12;
const bare = persisted('axes.controls', 'shown', 'browser');

export function Overview() {
  const { store } = useGateway();
  return (
    <main class="page overview">
      <h1 class="visually-hidden" tabIndex={-1}>
        Overview
      </h1>
      <div class="overview-main">
        <ErrorList />
        <Axes />
        <div class="side-by-side">
          <Section title="Lines">
            <LineList />
          </Section>
          <Section title="Drives">
            <DriveList />
          </Section>
        </div>
      </div>
      <aside class="overview-side">
        <Section title="Events" beside={<a href="/events">All events</a>}>
          <div class="card scroll" tabIndex={0} role="region" aria-label="Newest events">
            <EventList events={store.events.value} limit={60} />
          </div>
        </Section>
      </aside>
    </main>
  );
}

function Axes() {
  const { store } = useGateway();
  const all = store.axisNames.value;
  // A text of names, so that what follows is drawn anew only when another axis matches, not with every reading.
  const matching = useComputed(() =>
    store.axisNames.value
      .filter((n) => {
        const wanted = axesFilter.value;
        if (wanted.trim() === '') return true;
        const entry = store.axis(n)?.value;
        return entry !== undefined && axisMatches(entry.data, store.trustOf(entry), wanted);
      })
      .join('\n'),
  );
  const names = matching.value === '' ? [] : matching.value.split('\n');
  const hidden = bare.value === 'hidden';
  const rows = view.value === '' ? all.length > mostTiles : view.value === 'rows';
  const filtered = axesFilter.value.trim() !== '' && all.length > 0;

  return (
    <Section
      title="Axes"
      id="axes"
      beside={
        <>
          <input class="search" type="search" placeholder="Filter" aria-label="Filter axes by name, family, line, drive or state" value={axesFilter.value} onInput={(e) => (axesFilter.value = e.currentTarget.value)} />
          <button type="button" class="button quiet" aria-pressed={rows} onClick={() => (view.value = rows ? 'tiles' : 'rows')}>
            List
          </button>
          {!rows && (
            <button type="button" class="button quiet" aria-pressed={!hidden} onClick={() => (bare.value = hidden ? 'shown' : 'hidden')}>
              Motion controls
            </button>
          )}
        </>
      }
    >
      <Why need="operator" what="Every command but a stop" />
      {filtered && (
        <p class="filtered" role="status" data-field="filtered">
          <span>
            {names.length === 0 ? `No axis matches “${axesFilter.value.trim()}”; ${all.length} in all.` : `${names.length} of ${all.length} axes shown, filter: ${axesFilter.value.trim()}`}
          </span>
          <button type="button" class="button small" onClick={() => (axesFilter.value = '')}>
            Show all
          </button>
        </p>
      )}
      {names.length > 0 && rows ? (
        <ul class="axis-rows card">
          {names.map((n) => (
            <AxisRow key={n} name={n} />
          ))}
        </ul>
      ) : names.length > 0 ? (
        <div class="tiles">
          {names.map((n) => (
            <AxisTile key={n} name={n} bare={hidden} />
          ))}
        </div>
      ) : filtered ? null : store.listed.value ? (
        <NoAxis />
      ) : (
        <Empty text="Waiting for the gateway." />
      )}
    </Section>
  );
}

/** An empty site, and the way out of it for who may go it. */
function NoAxis() {
  const { session } = useGateway();
  const why = session.mayNot('engineer', 'Setting up lines, drives and axes');
  return (
    <p class="empty" data-field="no-axis">
      No axis is configured.{' '}
      {why ? (
        why
      ) : (
        <a href="/site" onClick={() => (persisted('site.wizard').value = 'open')}>
          Begin with the wizard: from a line to a moving axis
        </a>
      )}
    </p>
  );
}
