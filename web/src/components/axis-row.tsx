// Axis rows: axes as a table, for sites with many: what each is, where it is, how fast, what it does, what is wrong, and its stop.
// In: names under their headings, the order. Out: a table whose headings sort; on a narrow screen each axis is a block. The rest is on the axis' page.
import { useComputed, type ReadonlySignal, type Signal } from '@preact/signals';
import { useRef } from 'preact/hooks';
import { useGateway } from '../gateway';
import { t } from '../language';
import { axisPath } from '../router';
import type { AxisEntry } from '../state/store';
import { markOf, positionText, unitOf, velocityText } from '../text/axis';
import { pressed, type Order, type SortKey } from '../text/axis-list';
import { ResultLine, resultId } from './axis-controls';
import { SelectBox } from './axis-selection';
import { Notice, StatePills } from './axis-tile';
import { useInSight } from './calm';
import { Icon } from './icon';
import { Mark } from './pill';
import { StopButton } from './stop';

export function AxisTable({ groups, order }: { groups: readonly { group: string; names: string[] }[]; order: Signal<Order> }) {
  const all = groups.flatMap((g) => g.names);
  const headed = groups.some((g) => g.group !== '');
  const { store } = useGateway();
  const longest = Math.max(...all.map((n) => (store.axis(n)?.peek().data.unit || 'inc').length));
  // A table whose rows are boxes of their own, so that one out of sight costs nothing; the roles say that it is still a table.
  return (
    <div class="axis-list">
    <table class="axis-rows card" role="table" aria-label={t('Axes')} style={{ '--unit': longest }}>
      <thead role="rowgroup">
        <tr role="row">
          <td role="cell">
            <SelectBox names={all} label={t('Select all axes that are shown')} />
          </td>
          <Heading by="name" text={t('Axis')} order={order} />
          <Heading by="position" text={t('Position')} order={order} num />
          <Heading by="velocity" text={t('Velocity')} order={order} num />
          <Heading by="state" text={t('State')} order={order} />
          <th scope="col" role="columnheader">
            {t('Message')}
          </th>
          <th scope="col" role="columnheader">
            <span class="visually-hidden">{t('Stop')}</span>
          </th>
        </tr>
      </thead>
      {groups.map((g) => (
        <tbody key={g.group} role="rowgroup" data-group={g.group}>
          {headed && (
            <tr class="axis-group" role="row">
              <td role="cell">
                <SelectBox names={g.names} label={g.group ? t('Select all axes of {group}', { group: g.group }) : t('Select all axes without a group')} />
              </td>
              <th scope="rowgroup" role="rowheader">
                {g.group || t('Without a group')} <span class="where">{g.names.length === 1 ? t('1 axis') : t('{n} axes', { n: g.names.length })}</span>
              </th>
            </tr>
          )}
          {g.names.map((n) => (
            <AxisRow key={n} name={n} />
          ))}
        </tbody>
      ))}
    </table>
    </div>
  );
}

function Heading({ by, text, order, num = false }: { by: SortKey; text: string; order: Signal<Order>; num?: boolean }) {
  const now = order.value;
  const mine = now.by === by;
  return (
    <th scope="col" role="columnheader" class={num ? 'num' : ''} aria-sort={mine ? (now.down ? 'descending' : 'ascending') : undefined}>
      <button type="button" class="sort" title={t('Sort by this column; once more: the other way round; then as in the site')} onClick={() => (order.value = pressed(now, by))}>
        {text} <Icon name={mine ? (now.down ? 'down' : 'up') : 'sort'} size={12} />
      </button>
    </th>
  );
}

function AxisRow({ name }: { name: string }) {
  const entry = useGateway().store.axis(name);
  return entry ? <Row name={name} of={entry} /> : null;
}

/** Drawn anew when its condition changes. The readings are texts of their own, each in a box of fixed size: another figure is laid out and painted alone. */
function Row({ name, of }: { name: string; of: ReadonlySignal<AxisEntry> }) {
  const { store } = useGateway();
  const row = useRef<HTMLTableRowElement>(null);
  const entry = useInSight(of, row);
  const trust = useComputed(() => store.trustOf(entry.value)).value;
  const fault = useComputed(() => entry.value.data.fault).value;
  const moving = useComputed(() => entry.value.data.moving).value;
  const presence = useComputed(() => entry.value.data.presence).value;
  const unit = useComputed(() => unitOf(entry.value.data)).value;
  const value = useComputed(() => entry.value.data.position ?? '');
  const position = useComputed(() => positionText(entry.value.data));
  const velocity = useComputed(() => velocityText(entry.value.data));
  const live = trust === 'live';
  const old = live ? '' : ' is-old';
  return (
    <tr ref={row} class="axis-row" role="row" data-axis={name} data-condition={fault && live ? 'fault' : trust} data-presence={presence}>
      <td class="row-select" role="cell">
        <SelectBox names={[name]} label={t('Select {axis}', { axis: name })} />
      </td>
      <th scope="row" role="rowheader" class="row-name">
        <a href={axisPath(name)}>{name}</a> <Mark mark={markOf({ presence })} />
      </th>
      <td class={`num row-position${old}`} role="cell" data-field="position" data-value={value} data-live={live}>
        <span class="visually-hidden">{live ? t('Position') : t('Last known position, not live')}: </span>
        <span class="reading">
          <span>
            <span class="figure">{position}</span> <span class="unit">{unit}</span>
          </span>
        </span>
      </td>
      <td class={`num row-velocity${old}`} role="cell" data-field="velocity">
        <span class="reading">
          <span>
            <span class="figure">{velocity}</span> <span class="unit">{unit}/s</span>
          </span>
        </span>
      </td>
      <td class="row-state" role="cell">
        <StatePills entry={entry} />
      </td>
      <td class="row-notice" role="cell">
        <div class="row-said" tabIndex={0} role="group" aria-label={t('Messages of {name}', { name })}>
          <Notice entry={entry} />
          <ResultLine axis={name} id={resultId(name)} />
        </div>
      </td>
      <td class="row-stop" role="cell">
        <StopButton axis={name} urgent={moving} />
      </td>
    </tr>
  );
}
