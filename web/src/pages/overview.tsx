// Overview: all axes as live tiles, the lines, the drives, what happened last. In: the store. Out: the first page.
import { useGateway } from '../gateway';
import { AxisTile } from '../components/axis-tile';
import { WrongList } from '../components/wrong';
import { EventList } from '../components/events';
import { Why } from '../components/gate';
import { DriveList, Empty, LineList } from '../components/lines';
import { Section } from '../components/section';
import { kept } from '../state/kept';

const filter = kept('axes.filter');
const bare = kept('axes.controls', 'shown', 'browser');

export function Overview() {
  const { store } = useGateway();
  return (
    <main class="page overview">
      <h1 class="visually-hidden" tabIndex={-1}>
        Overview
      </h1>
      <div class="overview-main">
        <WrongList />
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
  const wanted = filter.value.trim().toLowerCase();
  const names = wanted === '' ? all : all.filter((n) => matches(n, wanted));
  const hidden = bare.value === 'hidden';

  function matches(name: string, text: string): boolean {
    const a = store.axis(name)?.peek().data;
    return [name, a?.family, a?.line, a?.drive].some((s) => s?.toLowerCase().includes(text));
  }

  return (
    <Section
      title="Axes"
      beside={
        <>
          <input class="search" type="search" placeholder="Filter" aria-label="Filter axes by name, family, line or drive" value={filter.value} onInput={(e) => (filter.value = e.currentTarget.value)} />
          <button type="button" class="button quiet" aria-pressed={!hidden} onClick={() => (bare.value = hidden ? 'shown' : 'hidden')}>
            Motion controls
          </button>
        </>
      }
    >
      <Why need="operator" what="Every command but a stop" />
      {names.length > 0 ? (
        <div class="tiles">
          {names.map((n) => (
            <AxisTile key={n} name={n} bare={hidden} />
          ))}
        </div>
      ) : all.length > 0 ? (
        <Empty text={`No axis matches “${filter.value}”.`} />
      ) : store.listed.value ? (
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
        <a href="/site" onClick={() => (kept('site.wizard').value = 'open')}>
          Begin with the wizard: from a line to a moving axis
        </a>
      )}
    </p>
  );
}
