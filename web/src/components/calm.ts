// Calm: what a reading that comes ten times a second does not touch is not drawn anew. In: signals, an element. Out: the same signals, told less often:
// once a second while the element is out of sight, at once when it comes into sight; words, only when they read otherwise.
import { useComputed, useSignal, type ReadonlySignal } from '@preact/signals';
import { useEffect, useRef } from 'preact/hooks';
import { tick } from '../state/clock';
import type { Word } from '../text/axis';

/** So far beyond the edge a row is drawn as if it were in sight: it is there before it is scrolled to. */
const margin = '200px';

export function useInSight<T>(of: ReadonlySignal<T>, element: { current: Element | null }): ReadonlySignal<T> {
  const seen = useSignal(true);
  useEffect(() => {
    if (typeof IntersectionObserver === 'undefined' || !element.current) return;
    const eye = new IntersectionObserver((all) => (seen.value = all.at(-1)?.isIntersecting ?? true), { rootMargin: margin });
    eye.observe(element.current);
    return () => eye.disconnect();
  }, [seen, element]);
  return useComputed(() => {
    if (seen.value) return of.value;
    void tick.value;
    return of.peek();
  });
}

/** A word that is the same one until it reads otherwise. */
export function useWord(work: () => Word): Word {
  const last = useRef<Word | null>(null);
  return useComputed(() => {
    const next = work();
    const was = last.current;
    if (was && was.text === next.text && was.long === next.long && was.icon === next.icon && was.tone === next.tone) return was;
    return (last.current = next);
  }).value;
}
