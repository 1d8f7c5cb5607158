// Reported: how a request of a part went, in the words of its line. In: the line, what is done. Out: busy, then good or why not. What the page itself cannot
// do is told by the part; this is for what the gateway answers.
import type { Signal } from '@preact/signals';
import { asProblem } from '../api/problem';
import { capital } from './commander';
import type { Outcome } from './mappings';

export interface Reported {
  tone: 'none' | 'busy' | 'good' | 'refused';
  text: string;
}
export const quiet: Reported = { tone: 'none', text: '' };
export const reportedOf = (o: Outcome): Reported => ({ tone: o.good ? 'good' : 'refused', text: capital(o.text) });

/** Why the gateway refused it, or why nobody answered. */
export const refusal = (error: unknown): Reported & { tone: 'refused' } => ({ tone: 'refused', text: capital(asProblem(error).text) });

/** `good`: what to say when it is done, perhaps by what was answered. `then`: what is asked again afterwards. Out: whether all of it went well. */
export async function tellOf<T>(reported: Signal<Reported>, busy: string, how: () => Promise<T>, good: string | ((answer: T) => string), then?: () => Promise<unknown>): Promise<boolean> {
  reported.value = { tone: 'busy', text: busy };
  try {
    const answer = await how();
    reported.value = { tone: 'good', text: typeof good === 'string' ? good : good(answer) };
    await then?.();
    return true;
  } catch (error) {
    reported.value = refusal(error);
    return false;
  }
}
