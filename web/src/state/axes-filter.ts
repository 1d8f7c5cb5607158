// Axes filter: which axes the overview shows. In: text of the field, or a count in the strip that is pressed. Out: a signal for this visit.
// Not kept over a reload: whoever opens the page sees every axis.
import { signal } from '@preact/signals';
import type { Axis } from '../api/types';
import { t } from '../language';
import { motionWord, stateWord } from '../text/axis';
import type { Trust } from './store';

export const axesFilter = signal('');

/** Also by what it does: "offline", "fault", "moving", "simulated", and the words on its tile. */
export function axisMatches(axis: Axis, trust: Trust, text: string): boolean {
  const wanted = text.trim().toLowerCase();
  if (wanted === '') return true;
  const texts = [axis.name, axis.group ?? '', axis.family, axis.line, axis.drive, stateWord(axis, trust).text];
  // What the strip counts, by the same rule and word as there.
  if (!axis.online) texts.push(t('offline'));
  else texts.push(motionWord(axis, trust).text, axis.moving ? t('moving') : '', axis.stale ? t('stale') : '');
  if (axis.fault) texts.push(t('in fault'));
  texts.push(axis.simulated ? t('simulated') : axis.presence === 'device' ? t('real') : '');
  return texts.some((w) => w.toLowerCase().includes(wanted));
}
