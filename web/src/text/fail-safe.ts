// Fail-safe in words: causes, actions, what an axis has named, and the cells of a rehearsal. In: documents of the gateway. Out: texts. Pure.
import { midSentence, t, theirs } from '../language';
import type { Action, Cell, Choice, FailSafeRow, Matrix, Step } from '../api/fail-safe';
import { localFigures } from './number';

export type Cause = Matrix['causes'][number]['cause'];
const causes: Record<Cause, string> = {
  modbus_closed: t('Modbus connection closed'),
  modbus_silent: t('Modbus client silent'),
  set_points_silent: t('Set-points not renewed'),
  lease_ended: t('Lease ended'),
  enip_closed: t('EtherNet/IP connection closed'),
  enip_timed_out: t('EtherNet/IP connection timed out'),
  enip_idle: t('EtherNet/IP scanner idle'),
  line_lost: t('Drive not reached'),
  gateway_ends: t('Gateway is ended'),
  dds_deadline: t('DDS deadline missed'),
  enip_session_closed: t('EtherNet/IP session closed'),
  enip_silent: t('EtherNet/IP client silent'),
  motion_unowned: t('Motion without an order'),
};
export const failSafeHint = t('the default halts a velocity move and lets a move to a target end; what is chosen holds for every motion');
export const causeNames = Object.keys(causes) as Cause[];
const actions: Record<Action, string> = { nothing: t('Nothing'), halt: t('Halt'), quick_stop: t('Quick stop'), disable: t('Switch off') };

export const steps: Record<Step, string> = { second_client: t('A second client speaks'), refused_commands: t('Commands are refused'), gateway_restart: t('The gateway restarts'), old_image: t('The controller is back with its old image') };
const gone = 'gateway_gone'; // in a rehearsal alone: nobody acts but the drive
const others: Record<string, string> = { [gone]: t('Gateway without supply'), gateway_restarts: steps.gateway_restart, supervisor: t('Supervisor'), target: t('Target reached'), drive: t('The drive itself'), ...steps };
export const causeText = (cause: string): string => causes[cause as Cause] ?? others[cause] ?? cause.replaceAll('_', ' ');
export const actionText = (action: Action): string => actions[action];
export const actionChoices = (cause: Matrix['causes'][number]) => [
  { value: '', text: t('default: {n}', { n: midSentence(actionText(cause.default_endless)) }) },
  ...(Object.keys(actions) as Action[]).map((a) => ({ value: a as string, text: actionText(a) })),
];

/** What stands below a cause: when it is, and what its default spares. */
export function causeHint(cause: Matrix['causes'][number]): string {
  const when = theirs(cause.description.replace('watchdog_ms', 'the time below'));
  return cause.default_endless === cause.default_to_a_target ? when : t('{when}. By default a motion to a target goes on.', { when });
}

/** What an axis has named, in one line. */
export function namedText(row: FailSafeRow): string {
  const own = causeNames.flatMap((c) => {
    const action = row.fail_safe[c];
    return action ? [t('{cause}: {action}', { cause: midSentence(causeText(c)), action: midSentence(actionText(action)) })] : [];
  });
  if (row.fail_safe.watchdog_ms != null) own.push(t('Modbus clients watched for {watchdog_ms} ms', { watchdog_ms: row.fail_safe.watchdog_ms }));
  return own.length === 0 ? t('all as by default') : own.join('; ');
}

const ofDrive = { quick_stop: t('quick stop'), disable: t('switched off'), fault: t('fault') } as const;
/** What its drive does by itself, in one line. */
export function watchdogText({ drive_watchdog: w }: FailSafeRow): string {
  if (!w.available) return t('The drive has no watchdog of its own. {description}', { description: theirs(w.description) });
  if (w.state === 'armed' && w.action !== null) return t('The drive\'s own watchdog: {n} after {time_ms} ms without the gateway.', { n: ofDrive[w.action], time_ms: w.time_ms ?? 0 });
  if (w.state === 'off') return t('The drive\'s own watchdog is switched off (watchdog_action).');
  if (w.state === 'refused') return t('The drive does not take a watchdog of its own: without the gateway it goes on.');
  return t('The drive\'s own watchdog has not been set yet: the drive has not answered.');
}

/** Which limits of position it keeps by itself, in one line. */
export function limitsText({ drive_limits: l }: FailSafeRow): string {
  if (!l.available) return t('The drive has no limits of position of its own. {description}', { description: theirs(l.description) });
  if (!l.wanted) return t('The site does not limit the axis: the drive has no limits of position from it.');
  if (l.state === 'armed') return t('The drive\'s own limits of position are those of the site.');
  if (l.state === 'off') return t('The drive\'s own limits of position are left as they are (drive_limits).');
  if (l.refusal !== null) return t('The drive does not take limits of position: {refusal}', { refusal: theirs(l.refusal) });
  return t('The drive\'s own limits of position have not been set yet: the drive has not answered.');
}

/** The choice with one member changed, as PUT takes it: null is the default. */
export const changed = (row: FailSafeRow, cause: Cause, action: string): Choice => ({ ...row.fail_safe, [cause]: action === '' ? null : (action as Action) });

/** What is typed for the silence of a Modbus client: a whole number of ms, null (the gateway's own) for nothing typed, or why it is none. */
export function readWatchdog(text: string): { good: true; value: number | null } | { good: false; why: string } {
  const trimmed = text.trim();
  if (trimmed === '') return { good: true, value: null };
  const n = Number(trimmed);
  return /^\d+$/.test(trimmed) && n <= 600_000 ? { good: true, value: n } : { good: false, why: t('A whole number of ms from 0 (never) to 600000; empty: as the gateway is set.') };
}

const ms = (n: number | null): string => (n === null ? '' : n < 10 ? t('{n} ms', { n: localFigures(n.toFixed(1)) }) : t('{n} ms', { n: Math.round(n) }));
export interface CellRow {
  key: string;
  axis: string;
  cause: string;
  action: string;
  acted: string;
  slower: string;
  stood: string;
  way: string;
  ended: string;
}
/** What stands above the columns of `cellRow`; from the fourth to the seventh they are figures. */
export const cellHeads = (): string[] => [t('Axis'), t('Cause'), t('Action'), t('Gateway acted'), t('Motor slower'), t('Stood'), t('Way'), t('Ended by')];
export const cellRow = (c: Cell, unit: string): CellRow => ({
  key: `${c.axis} ${c.cause}`,
  axis: c.axis,
  cause: causeText(c.cause),
  action: c.cause === gone ? t('the drive\'s own') : (c.chosen === null ? t('{action}, by default', { action: actionText(c.taken) }) : actionText(c.taken)),
  acted: ms(c.noticed_ms) || (c.cause === gone ? '' : t('never')),
  slower: ms(c.reaction_ms) || t('never'),
  stood: ms(c.standstill_ms) || t('not within {watched_ms}', { watched_ms: ms(c.watched_ms) }),
  way: `${localFigures(String(Math.round(c.travel * 1000) / 1000))}${unit ? ` ${unit}` : ''}`,
  ended: [c.ended_by ? causeText(c.ended_by) : '', c.moved_again ? t('moved again') : ''].filter(Boolean).join('; '),
});
