// An axis in words: its condition, its state, its motion. In: the axis document and how much it is trusted. Out: words, an icon, a tone.
// The tone only underlines the words: no state is told by colour alone.
import { midSentence, t } from '../language';
import type { Axis, AxisStateName } from '../api/types';
import type { Trust } from '../state/store';
import { clientText } from './authority';
import { causeText } from './fail-safe';
import { decimalsOf, formatNumber } from './number';
import type { IconName } from '../components/icon';

export type Tone = 'neutral' | 'good' | 'active' | 'warning' | 'fault' | 'simulated' | 'muted';
export interface Word {
  text: string;
  icon: IconName;
  tone: Tone;
  /** A whole sentence, for the title and for screen readers. */
  long: string;
}

const states: Record<AxisStateName, Word> = {
  not_ready_to_switch_on: { text: t('Not ready'), icon: 'circle-dashed', tone: 'muted', long: t('Not ready to switch on') },
  switch_on_disabled: { text: t('Disabled'), icon: 'power-off', tone: 'neutral', long: t('Switch on disabled: the axis has no power') },
  ready_to_switch_on: { text: t('Ready'), icon: 'circle', tone: 'neutral', long: t('Ready to switch on') },
  switched_on: { text: t('Switched on'), icon: 'circle-half', tone: 'neutral', long: t('Switched on, operation not enabled') },
  operation_enabled: { text: t('Enabled'), icon: 'check', tone: 'good', long: t('Operation enabled: the axis follows commands') },
  quick_stop_active: { text: t('Quick stop'), icon: 'pause', tone: 'warning', long: t('Quick stop active: enable the axis to go on') },
  fault_reaction_active: { text: t('Fault reaction'), icon: 'triangle', tone: 'fault', long: t('Fault reaction active: the drive is stopping') },
  fault: { text: t('Fault'), icon: 'triangle', tone: 'fault', long: t('Fault: reset it when its cause is gone') },
};

/** As it was, while nothing is heard of it. */
export const wordOf = (word: Word, live: boolean): Word => (live ? word : { ...word, tone: 'muted', text: t('Was {state}', { state: midSentence(word.text) }) });

export const stateName = (s: AxisStateName): string => states[s].long.split(/[:：]/)[0] as string;

export function stateWord(axis: Pick<Axis, 'state'>, trust: Trust): Word {
  if (trust === 'disconnected') {
    const w = states[axis.state];
    return { ...w, tone: 'muted', text: t('Was {list}', { list: midSentence(w.text) }), long: t('Not live. Last known state: {long}', { long: w.long }) };
  }
  if (trust === 'offline') return { text: t('Offline'), icon: 'unplugged', tone: 'muted', long: t('Offline: nobody answers for this axis') };
  return states[axis.state];
}

export function motionWord(axis: Pick<Axis, 'moving' | 'velocity' | 'mode' | 'target_reached' | 'state' | 'fault'>, trust: Trust): Word {
  if (trust === 'disconnected') return { text: t('Not live'), icon: 'unplugged', tone: 'muted', long: t('Whether it moves now is not known') };
  if (trust === 'offline') return { text: t('Not known'), icon: 'circle-dashed', tone: 'muted', long: t('Whether it moves is not known') };
  if (trust === 'stale') return { text: t('Stale'), icon: 'clock', tone: 'warning', long: t('The last data is too old to be trusted') };
  if (axis.moving) {
    const back = (axis.velocity ?? 0) < 0;
    const homing = axis.mode === 'homing';
    return { text: homing ? t('Homing') : t('Moving'), icon: back ? 'arrow-left' : 'arrow-right', tone: 'active', long: homing ? t('Homing') : back ? t('Moving, negative') : t('Moving, positive') };
  }
  // A drive in fault may say that it has reached its target; where it stands was nobody's order.
  if (axis.target_reached && !axis.fault && !/^fault/.test(axis.state)) return { text: t('In position'), icon: 'target', tone: 'good', long: t('Target reached') };
  return { text: t('At rest'), icon: 'pause', tone: 'neutral', long: t('At rest, not at a target') };
}

/** Which of the two answers: said in capitals on every tile. */
export function markOf(axis: Pick<Axis, 'presence'>): { text: string; kind: 'real' | 'simulated' | 'none'; long: string } {
  if (axis.presence === 'twin') return { text: t('SIMULATED'), kind: 'simulated', long: t('The embedded model of the drive answers; nothing real moves') };
  if (axis.presence === 'device') return { text: t('REAL'), kind: 'real', long: t('The real drive answers; something real moves') };
  return { text: t('NO DRIVE'), kind: 'none', long: t('Neither a drive nor its model answers') };
}

/** Whose word demand and following error are, in a sentence: nobody should take a reckoned value for a measured one. */
export function demandText(source: Axis['demand_source']): string {
  const about = t('Demand and following error');
  if (source === 'drive') return t('{about}: from the drive.', { about });
  if (source === 'computed') return t('{about}: computed by the gateway from the order, not measured by the drive.', { about });
  if (source === 'open_loop') return t('{about}: the drive counts its own steps; nothing measures whether the shaft follows them.', { about });
  return t('{about}: not known now. The axis is off, not heard, or moved by somebody else.', { about });
}

export const unitOf = (axis: Pick<Axis, 'unit'>): string => axis.unit || 'inc';

export const positionText = (axis: Pick<Axis, 'position' | 'increments_per_unit'>): string => formatNumber(axis.position, decimalsOf(axis.increments_per_unit));
export const velocityText = (axis: Axis): string => formatNumber(axis.velocity, decimalsOf(axis.increments_per_unit));
export const targetText = (axis: Axis): string => formatNumber(axis.target_position, decimalsOf(axis.increments_per_unit));

/** The question before the present position gets another name. */
export function setPositionText(axis: Axis, position: number): string {
  const unit = unitOf(axis);
  const old = axis.position === null ? t('not known') : `${positionText(axis)} ${unit}`;
  return t('The axis stands where it is; its position is {old} now and will be called {position} {unit}. Targets, limits and what other machines read count from the new zero. Set it?', { old, position: formatNumber(position, decimalsOf(axis.increments_per_unit)), unit });
}

/** Whose stop is latched and what a person does to move the axis again; behind it what a controller has to do. Nothing: none is latched. */
export function latchOf(axis: Pick<Axis, 'stop_latch' | 'stop_latch_by' | 'fail_safe_cause'>, tab = ''): Pick<Word, 'text' | 'long'> | null {
  const { stop_latch: bits, stop_latch_by: by, fail_safe_cause: cause } = axis;
  if (!(bits & latch.latched)) return null;
  const who = bits & latch.byClient ? clientText(by ?? '', tab) || t('another client') : cause ? t('the gateway ({cause})', { cause: midSentence(causeText(cause)) }) : t('the gateway');
  const text = bits & latch.bySafeInput ? t('Stopped by a safe input. Give the input back, then enable the axis.') : t('Stopped by {who}. Enable it and order a new motion.', { who });
  return { text, long: `${text} ${t('A controller that repeats its words does not move it: it has to change them.')}` };
}
/** Register 23. */
const latch = { latched: 1, byClient: 4, bySafeInput: 8 };

/** The one thing about the axis that a person must know now. */
export function noticeOf(axis: Axis, trust: Trust, driveText: string, lastKnown: string, tab = ''): Word {
  if (trust === 'disconnected') {
    return { text: t('Not live: last known {lastKnown} ago', { lastKnown }), icon: 'unplugged', tone: 'warning', long: t('The connection to the gateway is lost') };
  }
  if (trust === 'offline') {
    const why = driveText || t('nobody answers');
    return { text: t('Offline: {why}', { why }), icon: 'unplugged', tone: 'warning', long: t('Offline: {why}', { why }) };
  }
  const stopped = latchOf(axis, tab);
  if (axis.fault || axis.error.code !== 0) {
    const text = axis.fault ? t('Fault {code}: {n}', { code: axis.error.code, n: axis.error.text || t('the drive says no more') }) : t('Error {code}: {n}', { code: axis.error.code, n: axis.error.text || t('the drive says no more') });
    return { text, icon: 'triangle', tone: axis.fault ? 'fault' : 'warning', long: stopped ? `${text}. ${stopped.long}` : text };
  }
  if (trust === 'stale') return { text: t('Stale: the drive has not said anything new'), icon: 'clock', tone: 'warning', long: t('Stale data') };
  if (stopped) return { ...stopped, icon: 'pause', tone: 'warning' };
  if (axis.internal_limit) return { text: t('A limit is active'), icon: 'triangle', tone: 'warning', long: t('Internal limit active') };
  if (axis.warning) return { text: t('Warning'), icon: 'triangle', tone: 'warning', long: t('The drive reports a warning') };
  if (!axis.referenced) return { text: t('No error. Not referenced'), icon: 'dot', tone: 'muted', long: t('No error. The position has no known zero: home the axis') };
  return { text: t('No error. Referenced'), icon: 'dot', tone: 'muted', long: t('No error. The position has a known zero') };
}

/** Bits of the status word, CiA 402 with axisgate's own 8, 14 and 15. */
export const statusBits: readonly { bit: number; name: string; lowActive?: boolean }[] = [
  { bit: 0, name: t('Ready to switch on') },
  { bit: 1, name: t('Switched on') },
  { bit: 2, name: t('Operation enabled') },
  { bit: 3, name: t('Fault') },
  { bit: 4, name: t('Voltage enabled') },
  { bit: 5, name: t('Quick stop (0 is active)'), lowActive: true },
  { bit: 6, name: t('Switch on disabled') },
  { bit: 7, name: t('Warning') },
  { bit: 8, name: t('Simulated') },
  { bit: 9, name: t('Remote') },
  { bit: 10, name: t('Target reached') },
  { bit: 11, name: t('Internal limit active') },
  { bit: 12, name: t('Mode: set-point acknowledged / speed 0 / homed') },
  { bit: 13, name: t('Mode: following error / homing error') },
  { bit: 14, name: t('Stale') },
  { bit: 15, name: t('Referenced') },
];

/** Bits of the control word as it was last accepted, CiA 402; 9 and 11 to 15 are not used. */
export const controlBits: typeof statusBits = [
  { bit: 0, name: t('Switch on') },
  { bit: 1, name: t('Enable voltage') },
  { bit: 2, name: t('Quick stop (0 is active)'), lowActive: true },
  { bit: 3, name: t('Enable operation') },
  { bit: 4, name: t('Mode: new set-point / start homing') },
  { bit: 5, name: t('Mode: change at once') },
  { bit: 6, name: t('Mode: target is relative') },
  { bit: 7, name: t('Reset fault (at its rising edge)') },
  { bit: 8, name: t('Halt') },
  { bit: 10, name: t('Of the drive’s own') },
];

export const hex = (value: number, digits: number): string => `0x${(value >>> 0).toString(16).toUpperCase().padStart(digits, '0')}`;
