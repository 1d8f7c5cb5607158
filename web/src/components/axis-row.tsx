// Axis row: one axis on one line, for sites with many: what it is, where it is, what it does, what is wrong, and its stop.
// In: the axis' name. Out: a row. Everything else that can be told to it is on its page.
import { useGateway } from '../gateway';
import { axisPath } from '../router';
import { markOf, positionText, unitOf } from '../text/axis';
import { ResultLine, resultId } from './axis-controls';
import { Notice, StatePills } from './axis-tile';
import { Mark } from './pill';
import { StopButton } from './stop';

export function AxisRow({ name }: { name: string }) {
  const { store } = useGateway();
  const entry = store.axis(name);
  if (!entry) return null;
  const axis = entry.value.data;
  const trust = store.trustOf(entry.value);
  return (
    <li class="axis-row" data-axis={name} data-condition={axis.fault && trust === 'live' ? 'fault' : trust} data-presence={axis.presence}>
      <h3>
        <a href={axisPath(name)}>{name}</a>
      </h3>
      <Mark mark={markOf(axis)} />
      <p class={`row-position${trust === 'live' ? '' : ' is-old'}`} data-field="position" data-value={axis.position ?? ''} data-live={trust === 'live'}>
        <span class="visually-hidden">{trust === 'live' ? 'Position' : 'Last known position, not live'}: </span>
        <span class="figure">{positionText(axis)}</span> <span class="unit">{unitOf(axis)}</span>
      </p>
      <StatePills entry={entry} />
      <Notice entry={entry} />
      <StopButton axis={name} urgent={axis.moving} />
      <ResultLine axis={name} id={resultId(name)} />
    </li>
  );
}
