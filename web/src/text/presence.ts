// Presence in words: who shall answer for a drive, as its entry of the site says. In: the entry. Out: texts. Pure.
import { t } from '../language';

export const presences = [
  { value: 'auto', text: t('real, else simulated') },
  { value: 'device', text: t('real only') },
  { value: 'twin', text: t('simulated only') },
];
export const presenceText = (presence: string): string => presences.find((p) => p.value === presence)?.text ?? presence;
