// State machine: the power states of CiA 402 with the present one marked, and status and control word beside it, bit by bit.
// In: the axis. Out: a drawing whose content is also said in words. Old values are not shown as the present state.
import { t } from '../language';
import { useMemo } from 'preact/hooks';
import type { Axis, AxisStateName } from '../api/types';
import type { Trust } from '../state/store';
import { controlBits, hex, stateName, statusBits } from '../text/axis';

const width = 150;
const height = 32;
/** Where the right column begins. */
const far = 181;
/** Every text begins behind the place of the mark, so that the longest fits whether its state is the present one or not. */
const indent = 20;
interface Place { x: number; y: number; text: string }
const places: Record<AxisStateName, Place> = {
  not_ready_to_switch_on: { x: 1, y: 8, text: t('Not ready') },
  switch_on_disabled: { x: 1, y: 66, text: t('Switch on disabled') },
  ready_to_switch_on: { x: 1, y: 124, text: t('Ready to switch on') },
  switched_on: { x: 1, y: 182, text: t('Switched on') },
  operation_enabled: { x: 1, y: 240, text: t('Operation enabled') },
  quick_stop_active: { x: far, y: 240, text: t('Quick stop active') },
  fault_reaction_active: { x: far, y: 124, text: t('Fault reaction') },
  fault: { x: far, y: 66, text: t('Fault') },
};
const mid = (s: AxisStateName) => ({ x: places[s].x + width / 2, y: places[s].y + height / 2 });

function Arrow({ d }: { d: string }) {
  return <path d={d} class="edge" marker-end="url(#arrow)" />;
}

export function StateMachine({ axis, trust }: { axis: Axis; trust: Trust }) {
  const live = trust === 'live' || trust === 'stale';
  const now = live ? axis.state : null;
  const x = mid('ready_to_switch_on').x;
  const right = 1 + width;
  return (
    <figure class="machine card">
      <svg viewBox="0 0 332 280" role="img" aria-label={now ? t('Present state: {now}', { now: stateName(now) }) : t('The present state is not known')}>
        <defs>
          <marker id="arrow" viewBox="0 0 8 8" refX="7" refY="4" markerWidth="7" markerHeight="7" orient="auto-start-reverse">
            <path d="M0 0.5L7 4L0 7.5z" class="edge-head" />
          </marker>
        </defs>
        <Arrow d={`M${x} 40V65`} />
        <Arrow d={`M${x - 16} 98V123`} />
        <Arrow d={`M${x + 16} 124V99`} />
        <Arrow d={`M${x - 16} 156V181`} />
        <Arrow d={`M${x + 16} 182V157`} />
        <Arrow d={`M${x - 16} 214V239`} />
        <Arrow d={`M${x + 16} 240V215`} />
        <Arrow d={`M${right} 250H${far - 1}`} />
        <Arrow d={`M${far} 262H${right + 1}`} />
        <Arrow d={`M${right} 244L${far + 20} 157`} />
        <Arrow d={`M${mid('fault').x} 124V99`} />
        <Arrow d={`M${far} 82H${right + 1}`} />
        {(Object.keys(places) as AxisStateName[]).map((s) => (
          <g key={s} class={`node${s === now ? ' is-now' : ''}${s.startsWith('fault') ? ' is-fault' : ''}`} transform={`translate(${places[s].x} ${places[s].y})`}>
            <rect width={width} height={height} rx="6" />
            {s === now && <circle cx="11" cy={height / 2} r="4" />}
            <text x={indent} y={height / 2 + 4}>
              {places[s].text}
            </text>
          </g>
        ))}
      </svg>
      <div class="words">
        <p class="where">
          {t('The drive’s own word: {word}; mode {mode} of {modes}', { word: live ? hex(axis.native, 8) : '–', mode: live ? axis.mode_number : '–', modes: axis.modes.join(', ') })}
        </p>
        <Bits title={t('Status word')} word={live ? axis.statusword : null} bits={statusBits} />
        <Bits title={t('Control word')} word={live ? axis.controlword : null} bits={controlBits} />
      </div>
    </figure>
  );
}

/** One word, its highest bit first: each bit with its place, what it is now and its name. Folded on a phone. */
function Bits({ title, word, bits }: { title: string; word: number | null; bits: typeof statusBits }) {
  const open = useMemo(() => typeof matchMedia === 'undefined' || matchMedia('(width >= 900px)').matches, []);
  return (
    <details class="bits" open={open} data-word={title}>
      <summary>
        {title} <span class="mono">{word === null ? '–' : hex(word, 4)}</span>
      </summary>
      <ol>
        {[...bits].reverse().map(({ bit, name, lowActive }) => {
          const set = word !== null && ((word >> bit) & 1) === 1;
          return (
            <li key={bit} class={word !== null && set !== Boolean(lowActive) ? 'is-set' : ''}>
              <span class="mono">{bit}</span>
              <span class="mono">{word === null ? '–' : set ? '1' : '0'}</span>
              <span>{name}</span>
            </li>
          );
        })}
      </ol>
    </details>
  );
}
