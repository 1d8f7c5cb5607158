// Loaded: what a part needs of REST, asked for with each connection and whenever something else says so. In: how to ask. Out: why it is not there
// yet, in words; empty: it is. While the gateway is away nothing is asked: it begins by itself with the next connection, and that is said.
// What nobody answered is asked again; what was refused is not: its words stay. What is there already stays as well.
import { useSignal } from '@preact/signals';
import { useEffect } from 'preact/hooks';
import { asProblem, type Problem } from '../api/problem';
import type { StreamState } from '../api/stream';
import { useGateway } from '../gateway';
import { t } from '../language';
import { capital } from '../state/commander';

const again_ms = 2_000;
export const waiting = t('Waiting for the gateway.');

/** Why nothing can be asked now; empty: it can, or the first connection is still being made. */
export function awayText({ phase, attempts, why }: Pick<StreamState, 'phase' | 'attempts' | 'why'>): string {
  if (phase === 'live' || (phase === 'connecting' && attempts === 0)) return '';
  return t('Not connected: {why}. This is loaded by itself when the gateway is back.', { why: why || t('the gateway cannot be reached') });
}

export function useLoaded(load: () => Promise<unknown>, when: readonly unknown[] = [], text: (p: Problem) => string = (p) => p.text): string {
  const { store } = useGateway();
  const connection = store.connection.value;
  const live = connection.phase === 'live';
  const state = useSignal<'asking' | 'there' | string>('asking');
  useEffect(() => {
    if (!live) return;
    let here = true;
    let timer: ReturnType<typeof setTimeout> | undefined;
    const ask = () =>
      load().then(
        () => here && (state.value = 'there'),
        (error: unknown) => {
          if (!here) return;
          const p = asProblem(error);
          if (state.peek() !== 'there') state.value = capital(text(p));
          if (p.status === 0 || p.status >= 500) timer = setTimeout(() => void ask(), again_ms);
        },
      );
    void ask();
    return () => {
      here = false;
      clearTimeout(timer);
    };
  }, [live, connection.epoch, ...when]);
  if (state.value === 'there') return '';
  return awayText(connection) || (state.value === 'asking' ? waiting : state.value);
}
