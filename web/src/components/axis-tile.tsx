// Axis tile: one axis, live: what it is, where it is, what it does, what is wrong, and what can be told to it.
// In: the axis' name. Out: the tile. The readings are drawn apart from the controls, so that typing is never disturbed by them.
import { useComputed, type ReadonlySignal } from '@preact/signals';
import { useRef } from 'preact/hooks';
import { useGateway } from '../gateway';
import { t } from '../language';
import { axisPath } from '../router';
import { tick } from '../state/clock';
import type { AxisEntry } from '../state/store';
import { markOf, motionWord, noticeOf, positionText, stateWord, targetText, unitOf, velocityText } from '../text/axis';
import { duration } from '../text/time';
import { offlineReason } from '../text/errors';
import { ResultLine, resultId, TileControls } from './axis-controls';
import { SelectBox } from './axis-selection';
import { HolderLine } from './authority';
import { useInSight, useWord } from './calm';
import { Icon } from './icon';
import { memo } from './memo';
import { Mark, Pill } from './pill';
import { Sparkline } from './sparkline';
import { StopButton } from './stop';

type EntrySignal = ReadonlySignal<AxisEntry>;

/** How long ago the connection was last live, in words; ticks only while it is lost. */
export function lastKnownText(store: ReturnType<typeof useGateway>['store']): string {
  const c = store.connection.value;
  if (c.phase === 'live' || c.lastLiveAt === 0) return '';
  return duration(tick.value - c.lastLiveAt);
}

/** `whole`: with what a title says more. */
export function Notice({ entry, whole = false }: { entry: EntrySignal; whole?: boolean }) {
  const { store, tab } = useGateway();
  const word = useWord(() => {
    const axis = entry.value.data;
    const trust = store.trustOf(entry.value);
    const why = trust === 'offline' ? offlineReason(axis, store.drive(axis.drive)?.value.data, store.alarms.value?.alarms ?? []) : '';
    return noticeOf(axis, trust, why, trust === 'disconnected' ? lastKnownText(store) || t('some time') : '', tab.name.value);
  });
  return (
    <p class={`notice tone-${word.tone}`} title={word.long} data-field="notice">
      <Icon name={word.icon} size={14} />
      <span>{whole && word.long.startsWith(word.text) ? word.long : word.text}</span>
    </p>
  );
}

/** Position, velocity and target. Greyed and said to be old as soon as they are not live. */
export function Readout({ entry, large = false }: { entry: EntrySignal; large?: boolean }) {
  const { store } = useGateway();
  const trust = useComputed(() => store.trustOf(entry.value)).value;
  const unit = useComputed(() => unitOf(entry.value.data)).value;
  const value = useComputed(() => entry.value.data.position ?? '');
  const position = useComputed(() => positionText(entry.value.data));
  const velocity = useComputed(() => velocityText(entry.value.data));
  const target = useComputed(() => targetText(entry.value.data));
  return (
    <div class={`readout${large ? ' readout-large' : ''}${trust === 'live' ? '' : ' is-old'}`} data-trust={trust}>
      <p class="position" data-field="position" data-value={value} data-live={trust === 'live'}>
        <span class="visually-hidden">{trust === 'live' ? t('Position') : t('Last known position, not live')}: </span>
        <span class="figure">{position}</span>
        <span class="unit">{unit}</span>
      </p>
      <dl class="minor">
        <div>
          <dt>{t('Velocity')}</dt>
          <dd data-field="velocity">
            {velocity} <span class="unit">{unit}/s</span>
          </dd>
        </div>
        <div>
          <dt>{t('Target')}</dt>
          <dd data-field="target">
            {target} <span class="unit">{unit}</span>
          </dd>
        </div>
      </dl>
    </div>
  );
}

export function StatePills({ entry }: { entry: EntrySignal }) {
  const { store } = useGateway();
  const state = useWord(() => stateWord(entry.value.data, store.trustOf(entry.value)));
  const motion = useWord(() => motionWord(entry.value.data, store.trustOf(entry.value)));
  return (
    <p class="pills">
      <Pill label={t('State')} id="state" word={state} />
      <Pill label={t('Motion')} id="motion" word={motion} />
    </p>
  );
}

function TileHead({ entry, name, selectable }: { entry: EntrySignal; name: string; selectable: boolean }) {
  const presence = useComputed(() => entry.value.data.presence).value;
  const moving = useComputed(() => entry.value.data.moving).value;
  return (
    <header class="tile-head">
      <h3>
        {selectable && <SelectBox names={[name]} label={t('Select {axis}', { axis: name })} />}
        <a href={axisPath(name)}>{name}</a>
      </h3>
      <p class="where">
        <Mark mark={markOf({ presence })} />
      </p>
      <StopButton axis={name} urgent={moving} />
    </header>
  );
}

/** `selectable`: it stands among others, and a command can be meant for several. */
export function AxisTile({ name, bare, selectable = false }: { name: string; bare: boolean; selectable?: boolean }) {
  const entry = useGateway().store.axis(name);
  return entry ? <Tile name={name} of={entry} bare={bare} selectable={selectable} /> : null;
}

function Tile({ name, of, bare, selectable }: { name: string; of: EntrySignal; bare: boolean; selectable: boolean }) {
  const { store } = useGateway();
  const tile = useRef<HTMLElement>(null);
  const entry = useInSight(of, tile);
  // The frame tells the condition too.
  const trust = useComputed(() => store.trustOf(entry.value)).value;
  const fault = useComputed(() => entry.value.data.fault).value;
  const presence = useComputed(() => entry.value.data.presence).value;
  return (
    <article ref={tile} class="tile card" data-axis={name} data-condition={fault && trust === 'live' ? 'fault' : trust} data-presence={presence} aria-label={t('Axis {name}', { name })}>
      <TileHead entry={entry} name={name} selectable={selectable} />
      <div class="tile-live">
        <Readout entry={entry} />
        <Sparkline axis={name} />
      </div>
      <StatePills entry={entry} />
      <Steady entry={entry} bare={bare} />
      <footer class="tile-foot" tabIndex={0} role="group" aria-label={t('Messages of {name}', { name })}>
        <Notice entry={entry} />
        <TileHolder entry={entry} />
        <ResultLine axis={name} id={resultId(name)} />
        <TileWhere entry={entry} />
      </footer>
    </article>
  );
}

function TileHolder({ entry }: { entry: EntrySignal }) {
  return <HolderLine entry={entry.value} />;
}

/** Where nothing else is to be said: which axis it is to other machines. */
function TileWhere({ entry }: { entry: EntrySignal }) {
  const axis = entry.value.data;
  return (
    <p class="tile-where" title={t('Axis number {number}, family {family}, line {line}, drive {drive}', { number: axis.number, family: axis.family, line: axis.line, drive: axis.drive })}>
      {t('no. {number} · {family} · {line}', { number: axis.number, family: axis.family, line: axis.line })}
    </p>
  );
}

/** The controls need name, unit and limits of the axis, which change only with the site: live readings do not redraw them. */
const SteadyControls = memo(TileControls, (a, b) => {
  const x = a.axis;
  const y = b.axis;
  return a.bare === b.bare && x.name === y.name && x.unit === y.unit && x.velocity_max === y.velocity_max;
});
function Steady({ entry, bare }: { entry: EntrySignal; bare: boolean }) {
  return <SteadyControls axis={entry.value.data} bare={bare} />;
}
