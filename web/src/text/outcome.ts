// Outcome: how a command went that the drive has taken, by what its axis shows afterwards. In: the command, the axis as it is told from then on.
// Out: nothing yet, or how it ended, in words. Pure. What was read before the drive took the command says nothing about it; a motion that neither
// moves nor has arrived is not called ended at the first look, since a drive may need a moment to get going.
import { midSentence, t } from '../language';
import type { Axis, Command } from '../api/types';
import { positionText, stateWord, unitOf } from './axis';

export interface Watched {
  command: Command;
  /** When it was taken; the gateway's clock. */
  taken_ms: number;
  moved: boolean;
  /** The target that the gateway took; undefined: not seen yet. */
  target: number | null | undefined;
}
export interface Outcome {
  tone: 'none' | 'good' | 'refused';
  text: string;
}

const fresh_ms = 100;
const begin_ms = 400;
const rest_ms = 700;
const motions = new Set(['move_absolute', 'move_relative', 'move_velocity', 'home']);
const watched = new Set([...motions, 'enable', 'disable']);
export const isWatched = (c: Command): boolean => watched.has(c.command) && !('prepare' in c && c.prepare);

const failed = (text: string): Outcome => ({ tone: 'refused', text });
const done: Outcome = { tone: 'good', text: t('done') };

export function outcomeOf(w: Watched, axis: Axis): Outcome | null {
  const after_ms = axis.at === null ? -Infinity : Date.parse(axis.at) - w.taken_ms;
  if (!axis.online) return failed(t('the axis went offline; whether it has finished is not known'));
  if (after_ms < fresh_ms) return null;
  const kind = w.command.command;
  if (axis.fault) return failed(axis.error.code ? t('ended by a fault, {code}: {text}', { code: axis.error.code, text: axis.error.text || t('the drive says no more') }) : t('ended by a fault'));
  if (kind === 'enable') return axis.state === 'operation_enabled' ? done : null;
  if (kind === 'disable') return axis.state === 'switch_on_disabled' || axis.state === 'ready_to_switch_on' ? done : null;
  w.moved ||= axis.moving;
  if (w.target === undefined) w.target = axis.target_position;
  const at = `${positionText(axis)} ${unitOf(axis)}`;
  if (axis.state !== 'operation_enabled') return failed(t('interrupted: the axis is {n} now, at {at}', { n: midSentence(stateWord(axis, 'live').text), at }));
  if (kind === 'move_velocity') return w.moved && !axis.moving ? { tone: 'none', text: '' } : null;
  if (kind !== 'home' && w.target !== axis.target_position) return failed(t('ended: another command took its place'));
  if (axis.moving || (!w.moved && after_ms < begin_ms)) return null;
  if (axis.target_reached || (kind === 'home' && axis.referenced)) return done;
  return after_ms > rest_ms ? failed(t('interrupted: the axis stopped at {at}', { at })) : null;
}

/** What a refusal of this reason came from, as the axis shows it; it is over when this is another. Empty: nothing that an axis shows. */
export function causeOf(reason: string, axis: Axis | undefined): string {
  if (!axis) return '';
  if (/wrong_state|interrupted|fault|not_enabled/.test(reason)) return `${axis.state} ${axis.fault} ${axis.error.code}`;
  if (/held|authority|claimed/.test(reason)) return axis.authority_holder ? t('held by {authority_holder}', { authority_holder: axis.authority_holder }) : t('nobody holds it');
  return /offline|no_answer|line_down/.test(reason) ? (axis.online ? t('online again') : t('still offline')) : '';
}
