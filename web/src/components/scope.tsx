// Scope: position, demand, velocity, following error and target over time. In: the axis' history. Out: plots on one time axis, newest at the
// right; two cursors with their readings; a trigger; the picture as CSV. Follows the gateway's clock; holds still when told to, or when the
// trigger has fired; a gap stays a gap. Redrawn at most 20 times a second (once with reduced motion), with at most two rows per pixel.
import { computed, useComputed } from '@preact/signals';
import { useEffect } from 'preact/hooks';
import type uPlot from 'uplot';
import { useGateway } from '../gateway';
import { t } from '../language';
import type { AxisHistory } from '../state/history';
import { persisted } from '../state/persisted';
import { channels, columnOf, csvOf, needsDemand, valueAt, type Channel } from '../state/scope';
import { extend, ScopeView } from '../state/scope-view';
import { toggled } from '../state/toggled';
import { demandText } from '../text/axis';
import { channelNames, curvesOf, secondsBefore } from '../text/scope';
import { Plot, usePlotView } from './plot';
import { CursorTable } from './plot-cursors';
import { PressGroup } from './press-group';
import { saveText } from './save';
import { TriggerBar } from './scope-trigger';

const windows = [2, 10, 30, 120] as const;
const chosen = persisted('scope.window', '30', 'browser');
const shown = persisted('scope.channels', 'position,velocity,target', 'browser');
const visible = computed(() => new Set(shown.value.split(',')));
/** Enough for two minutes at 1 kHz. */
const closeCapacity = 131_072;

export function Scope({ axis, unit }: { axis: string; unit: string }) {
  const { store } = useGateway();
  const v = usePlotView(() => new ScopeView());
  const seen = visible.value;
  const now = () => (Date.now() + store.clockOffset_ms) / 1000;
  const seconds = () => Number(chosen.peek()) || 30;
  useEffect(() => store.history(axis).keep(closeCapacity), [axis, store]);
  const curves = curvesOf(seen, unit);
  const data = (): uPlot.AlignedData => {
    const now_s = now();
    const [from, to] = v.look(store.history(axis), now_s, seconds());
    v.range.value = [from, to];
    const instant = store.history(axis).seen(from * 1000, to * 1000, Math.max(200, globalThis.innerWidth));
    const entry = store.axis(axis)?.peek();
    if (entry && store.trustOf(entry) === 'live' && instant.at.length > 0 && to >= now_s) extend(instant, now_s);
    return [instant.at, ...curves.map((c) => columnOf(instant, c.id as Channel))] as uPlot.AlignedData;
  };

  const save = () => {
    const [from, to] = v.range.peek();
    const name = `${axis}-${new Date(to * 1000).toISOString().replaceAll(':', '').slice(0, 17)}.csv`;
    saveText(name, 'text/csv', csvOf(store.history(axis).since(from * 1000, to * 1000), axis, unit));
  };

  return (
    <div class="scope card">
      <div class="scope-head">
        <PressGroup label={t('Channels')} class="scope-channels" of={channels.map((c) => ({ value: c, text: channelNames[c], on: seen.has(c), class: `key key-${c}` }))} press={toggle} />
        <PressGroup label={t('Time shown')} of={windows.map((w) => ({ value: w, text: w < 60 ? `${w} s` : t('{n} min', { n: w / 60 }), on: chosen.value === String(w) }))} press={(w) => (chosen.value = String(w))} />
        <button type="button" class="button small" title={t('What is seen now, as a table')} onClick={save}>
          {t('CSV')}
        </button>
        <button type="button" class="button small hold" aria-pressed={v.paused.value} onClick={() => v.hold()}>
          {v.paused.value ? t('Held') : t('Hold')}
        </button>
      </div>
      <Plot
        live
        view={v}
        curves={curves}
        data={data}
        timeText={secondsBefore}
        label={t('Scope of {axis}, the last {n} seconds. Arrow keys move the cursor {n2}, Delete takes it away.', { axis, n: chosen.value, n2: v.active.value === 0 ? 'A' : 'B' })}
      />
      <DemandLine axis={axis} seen={seen} view={v} />
      <CursorTable view={v} curves={curves} read={(c, instant) => readOf(store.history(axis), c.id as Channel, instant)} clock={(instant) => new Date(instant * 1000).toISOString().slice(11, 23)} />
      <TriggerBar view={v} unit={unit} now={now} />
    </div>
  );
}

function toggle(c: Channel): void {
  const next = toggled([...visible.peek()], c);
  if (next.length > 0) shown.value = channels.filter((x) => next.includes(x)).join(','); // an empty scope would only look broken
}

const readOf = (history: AxisHistory, c: Channel, instant: number) => valueAt(history.since(instant * 1000 - 60_000, instant * 1000 + 60_000), c, instant);

/** Where the demand of the newest sample comes from, as long as something of it is drawn or waited for. */
function DemandLine({ axis, seen, view }: { axis: string; seen: ReadonlySet<string>; view: ScopeView }) {
  const { store } = useGateway();
  const trigger = view.trigger.value;
  const source = useComputed(() => {
    const entry = store.axis(axis)?.value;
    return entry && store.trustOf(entry) === 'live' ? entry.data.demand_source : null;
  }).value;
  if (!channels.some((c) => needsDemand(c) && (seen.has(c) || (trigger.mode !== 'off' && trigger.channel === c)))) return null;
  return (
    <p class="where scope-why" data-field="demand-source" data-source={source ?? 'none'}>
      {demandText(source)}
    </p>
  );
}
