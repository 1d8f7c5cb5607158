// Axis rows: axes as a table, for sites with many: what each is, where it is, how fast, what it does, what is wrong, and its stop.
// In: names under their headings, the order. Out: a table whose headings sort; on a narrow screen each axis is a block. The rest is on the axis' page.
import type { Signal } from '@preact/signals';
import { useGateway } from '../gateway';
import { t } from '../language';
import { axisPath } from '../router';
import { markOf, positionText, unitOf, velocityText } from '../text/axis';
import { pressed, type Order, type SortKey } from '../text/axis-list';
import { ResultLine, resultId } from './axis-controls';
import { SelectBox } from './axis-selection';
import { Notice, StatePills } from './axis-tile';
import { Icon } from './icon';
import { Mark } from './pill';
import { StopButton } from './stop';

const columns = 7;

export function AxisTable({ groups, order }: { groups: readonly { group: string; names: string[] }[]; order: Signal<Order> }) {
  const all = groups.flatMap((g) => g.names);
  const headed = groups.some((g) => g.group !== '');
  return (
    <table class="axis-rows card" aria-label={t('Axes')}>
      <thead>
        <tr>
          <td>
            <SelectBox names={all} label={t('Select all axes that are shown')} />
          </td>
          <Heading by="name" text={t('Axis')} order={order} />
          <Heading by="position" text={t('Position')} order={order} num />
          <Heading by="velocity" text={t('Velocity')} order={order} num />
          <Heading by="state" text={t('State')} order={order} />
          <th scope="col">{t('Message')}</th>
          <th scope="col">
            <span class="visually-hidden">{t('Stop')}</span>
          </th>
        </tr>
      </thead>
      {groups.map((g) => (
        <tbody key={g.group} data-group={g.group}>
          {headed && (
            <tr class="axis-group">
              <td>
                <SelectBox names={g.names} label={g.group ? t('Select all axes of {group}', { group: g.group }) : t('Select all axes without a group')} />
              </td>
              <th scope="rowgroup" colSpan={columns - 1}>
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
  );
}

function Heading({ by, text, order, num = false }: { by: SortKey; text: string; order: Signal<Order>; num?: boolean }) {
  const now = order.value;
  const mine = now.by === by;
  return (
    <th scope="col" class={num ? 'num' : ''} aria-sort={mine ? (now.down ? 'descending' : 'ascending') : undefined}>
      <button type="button" class="sort" title={t('Sort by this column; once more: the other way round; then as in the site')} onClick={() => (order.value = pressed(now, by))}>
        {text} <Icon name={mine ? (now.down ? 'down' : 'up') : 'sort'} size={12} />
      </button>
    </th>
  );
}

function AxisRow({ name }: { name: string }) {
  const { store } = useGateway();
  const entry = store.axis(name);
  if (!entry) return null;
  const axis = entry.value.data;
  const trust = store.trustOf(entry.value);
  const old = trust === 'live' ? '' : ' is-old';
  return (
    <tr class="axis-row" data-axis={name} data-condition={axis.fault && trust === 'live' ? 'fault' : trust} data-presence={axis.presence}>
      <td class="row-select">
        <SelectBox names={[name]} label={t('Select {axis}', { axis: name })} />
      </td>
      <th scope="row" class="row-name">
        <a href={axisPath(name)}>{name}</a> <Mark mark={markOf(axis)} />
      </th>
      <td class={`num row-position${old}`} data-field="position" data-value={axis.position ?? ''} data-live={trust === 'live'}>
        <span class="visually-hidden">{trust === 'live' ? t('Position') : t('Last known position, not live')}: </span>
        <span class="figure">{positionText(axis)}</span> <span class="unit">{unitOf(axis)}</span>
      </td>
      <td class={`num row-velocity${old}`} data-field="velocity">
        <span class="figure">{velocityText(axis)}</span> <span class="unit">{unitOf(axis)}/s</span>
      </td>
      <td class="row-state">
        <StatePills entry={entry} />
      </td>
      <td class="row-notice">
        <Notice entry={entry} />
        <ResultLine axis={name} id={resultId(name)} />
      </td>
      <td class="row-stop">
        <StopButton axis={name} urgent={axis.moving} />
      </td>
    </tr>
  );
}
