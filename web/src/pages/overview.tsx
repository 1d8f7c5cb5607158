// Overview: all axes as live tiles, or as rows where there are many, the lines, the drives, what happened last. In: the store. Out: the first page.
import { signal, useComputed } from '@preact/signals';
import { useMemo } from 'preact/hooks';
import { AxisTable } from '../components/axis-row';
import { SelectBox, SelectionBar } from '../components/axis-selection';
import { useGateway } from '../gateway';
import { t } from '../language';
import { AxisTile } from '../components/axis-tile';
import { ErrorList } from '../components/errors';
import { EventList } from '../components/events';
import { Why } from '../components/gate';
import { DriveList, Empty, LineList } from '../components/lines';
import { Section } from '../components/section';
import { axesFilter, axisMatches } from '../state/axes-filter';
import { persisted } from '../state/persisted';
import { asConfigured, grouped, sorted, sortKeys, type Order, type SortKey } from '../text/axis-list';

/** '': as many as there are axes say. */
const view = persisted('axes.view');
const mostTiles = 12;
const bare = persisted('axes.controls', 'shown', 'browser');
const apart = persisted('axes.groups', 'yes', 'browser');
const order = signal<Order>(asConfigured);
/** Counts up when an order by live values is wanted anew. */
const again = signal(0);

const orders: readonly { value: string; text: string }[] = [
  { value: 'number', text: t('as in the site') },
  { value: 'name', text: t('by name') },
  { value: 'name down', text: t('by name, backward') },
  { value: 'position', text: t('by position, lowest first') },
  { value: 'position down', text: t('by position, highest first') },
  { value: 'velocity down', text: t('by speed, fastest first') },
  { value: 'velocity', text: t('by speed, slowest first') },
  { value: 'state', text: t('what needs you first') },
  { value: 'state down', text: t('what needs you last') },
  { value: 'number down', text: t('as in the site, backward') },
];
function chooseOrder(value: string): void {
  const [by = 'number', down] = value.split(' ');
  order.value = { by: sortKeys.find((k) => k === by) ?? ('number' satisfies SortKey), down: down === 'down' };
  again.value += 1;
}

export function Overview() {
  const { store } = useGateway();
  return (
    <main class="page overview">
      <h1 class="visually-hidden" tabIndex={-1}>
        {t('Overview')}
      </h1>
      <div class="overview-main">
        <ErrorList />
        <Axes />
        <div class="side-by-side">
          <Section title={t('Lines')}>
            <LineList />
          </Section>
          <Section title={t('Drives')} fold={store.driveNames.value.length}>
            <DriveList />
          </Section>
        </div>
      </div>
      <aside class="overview-side">
        <Section title={t('Events')} beside={<a href="/events">{t('All events')}</a>}>
          <div class="card scroll" tabIndex={0} role="region" aria-label={t('Newest events')}>
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
  // In the order of the moment in which it was asked for: a value that comes moves no row.
  const names = useMemo(() => sorted((matching.value === '' ? [] : matching.value.split('\n')).flatMap((n) => store.axis(n)?.peek().data ?? []), order.value), [matching.value, order.value, again.value]);
  const parts = useComputed(() => store.axisNames.value.map((n) => store.axis(n)?.value.data.group ?? '').join('\n'));
  const groupOf = new Map(all.map((n, i) => [n, parts.value.split('\n')[i] ?? '']));
  const hasGroups = [...groupOf.values()].some((g) => g !== '');
  const groups = apart.value === 'yes' ? grouped(names, (n) => groupOf.get(n) ?? '') : [{ group: '', names }];
  const hidden = bare.value === 'hidden';
  const rows = view.value === '' ? all.length > mostTiles : view.value === 'rows';
  const filtered = axesFilter.value.trim() !== '' && all.length > 0;

  return (
    <Section
      title={t('Axes')}
      id="axes"
      beside={
        <>
          <input class="search" type="search" placeholder={t('Filter')} aria-label={t('Filter axes by name, family, line, drive or state')} value={axesFilter.value} onInput={(e) => (axesFilter.value = e.currentTarget.value)} />
          {names.length > 1 && (
            <label class="select">
              <span>{t('Order')}</span>
              <select value={`${order.value.by}${order.value.down ? ' down' : ''}`} onChange={(e) => chooseOrder(e.currentTarget.value)}>
                {orders.map((o) => (
                  <option key={o.value} value={o.value}>
                    {o.text}
                  </option>
                ))}
              </select>
            </label>
          )}
          {hasGroups && (
            <button type="button" class="button quiet" aria-pressed={apart.value === 'yes'} onClick={() => (apart.value = apart.value === 'yes' ? 'no' : 'yes')}>
              {t('By machine part')}
            </button>
          )}
          <button type="button" class="button quiet" aria-pressed={rows} onClick={() => (view.value = rows ? 'tiles' : 'rows')}>
            {t('List')}
          </button>
          {!rows && (
            <button type="button" class="button quiet" aria-pressed={!hidden} onClick={() => (bare.value = hidden ? 'shown' : 'hidden')}>
              {t('Motion controls')}
            </button>
          )}
        </>
      }
    >
      <Why need="operator" what={t('Every command but a stop')} />
      {filtered && (
        <p class="filtered" role="status" data-field="filtered">
          <span>
            {names.length === 0 ? t('No axis matches “{text}”; {n} in all.', { text: axesFilter.value.trim(), n: all.length }) : t('{n} of {all} axes shown, filter: {text}', { n: names.length, all: all.length, text: axesFilter.value.trim() })}
          </span>
          <button type="button" class="button small" onClick={() => (axesFilter.value = '')}>
            {t('Show all')}
          </button>
        </p>
      )}
      {all.length > 1 && <SelectionBar />}
      {names.length > 0 && rows ? (
        <AxisTable groups={groups} order={order} />
      ) : names.length > 0 ? (
        groups.map((g) => (
          <div key={g.group} class="tile-group" role="group" aria-label={g.group || undefined} data-group={g.group}>
            {hasGroups && apart.value === 'yes' && (
              <h3 class="tile-group-head">
                <SelectBox names={g.names} label={g.group ? t('Select all axes of {group}', { group: g.group }) : t('Select all axes without a group')} />
                {g.group || t('Without a group')} <span class="where">{g.names.length === 1 ? t('1 axis') : t('{n} axes', { n: g.names.length })}</span>
              </h3>
            )}
            <div class="tiles">
              {g.names.map((n) => (
                <AxisTile key={n} name={n} bare={hidden} selectable={all.length > 1} />
              ))}
            </div>
          </div>
        ))
      ) : filtered ? null : store.listed.value ? (
        <NoAxis />
      ) : (
        <Empty text={t('Waiting for the gateway.')} />
      )}
    </Section>
  );
}

/** An empty site, and the way out of it for who may go it. */
function NoAxis() {
  const { session } = useGateway();
  const why = session.mayNot('engineer', t('Setting up lines, drives and axes'));
  return (
    <p class="empty" data-field="no-axis">
      {t('No axis is configured.')}{' '}
      {why ? (
        why
      ) : (
        <a href="/site" onClick={() => (persisted('site.wizard').value = 'open')}>
          {t('Begin with the wizard: from a line to a moving axis')}
        </a>
      )}
    </p>
  );
}
