// Site events: how often something of the site has changed while a part was open, by this page or by anybody else. In: the events. Out: a number.
import { useSignal } from '@preact/signals';
import { useEffect } from 'preact/hooks';
import { useGateway } from '../gateway';

export function useSiteEvents(): number {
  const { store } = useGateway();
  const times = useSignal(0);
  useEffect(() => store.onEvent((e) => void (e.kind === 'site' && (times.value += 1))), [store]);
  return times.value;
}
