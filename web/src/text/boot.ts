// The start of a drive in words: what the gateway sets in it and expects of it, by the options in its form. In: what is typed, the options of its family.
// Out: sentences. Pure. An option that the family does not have gives none; a text that is no value counts as not typed.
import { t } from '../language';
import { optionFault, optionPrefix, type OptionSpec } from './options';
import type { Texts } from './site';

type Said = (value: string, of: (name: string) => string) => string;

const stops: Record<string, string> = { quick_stop: t('by a quick stop'), disable: t('by switching off'), fault: t('with a fault') };

/** By option, in the order of what happens. */
const sentences: readonly [string, Said][] = [
  ['heartbeat_ms', (v) => (Number(v) === 0 ? t('It is told to send no heartbeat: silence is noticed by unanswered requests alone.') : t('It is told to send a heartbeat each {n} ms. After three without one it is asked, and without an answer it is offline.', { n: v }))],
  ['watchdog_action', (v, of) => (v === 'none' ? t('It does not watch the heartbeat of the gateway, so nothing stops it when the gateway is gone.') : t('It watches the heartbeat of the gateway (1016h, 6007h): {n} ms without one, and it stops by itself {how}.', { n: of('watchdog_ms'), how: stops[v] ?? v }))],
  ['drive_limits', (v) => (v === 'off' ? t('Its limits of position (607Dh) stay as they are in the drive.') : t('The limits of position of the site are written into it (607Dh).'))],
  ['quick_stop_stays', (v) => (v === 'yes' ? t('605Ah is set to 6 where it is less than 5, so that a quick stop ends in quick stop active.') : t('605Ah stays as it is: most drives switch the axis off behind a quick stop.'))],
  ['restart_stopped', (v) => (v === 'yes' ? t('A node that another master has stopped is started again, three times a minute at most.') : t('A node that another master has stopped is started again only while its axis moves.'))],
  ['mode_timeout_ms', (v) => t('It may take {n} ms to show an ordered mode (6061h).', { n: v })],
  ['start_timeout_ms', (v) => t('It may take {n} ms to acknowledge a set-point or to begin a homing.', { n: v })],
];

/** Sentences about the start of a drive of this family; none where the family has no such option. */
export function bootTexts(texts: Texts, specs: readonly OptionSpec[]): string[] {
  const value = (name: string): string => {
    const spec = specs.find((o) => o.name === name);
    const typed = (texts[optionPrefix + name] ?? '').trim();
    return spec && typed !== '' && optionFault(spec, typed) === '' ? typed : String(spec?.default ?? '');
  };
  return sentences.flatMap(([name, say]) => (specs.some((o) => o.name === name && o.of.includes('drive')) && value(name) !== '' ? [say(value(name), value)] : []));
}
