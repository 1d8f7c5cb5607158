// Clock: one tick per second for everything that shows an age. In: nothing. Out: a signal of the page's own clock (performance.now).
import { signal } from '@preact/signals';

export const tick = signal(0);
export function startClock(): void {
  tick.value = performance.now();
  setInterval(() => (tick.value = performance.now()), 1000);
}
