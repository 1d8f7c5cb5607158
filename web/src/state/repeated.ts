// Repeated: what a part asks again and again while it is on the page: at once, and after a pause behind each answer. In: how to ask, the pause. Out: nothing;
// who asks keeps what was answered. Nothing is asked while the page is hidden, nor two at a time.
import { useEffect } from 'preact/hooks';

/** `ask` is told of the end; it may answer with another pause before the next one in milliseconds, and with null: no more. `when`: begins anew if these change. */
export function useRepeated(ask: (end: AbortSignal) => Promise<number | null | void>, pause_ms: number, on: boolean, when: readonly unknown[]): void {
  useEffect(() => {
    if (!on) return;
    const end = new AbortController();
    let timer: ReturnType<typeof setTimeout>;
    const turn = async () => {
      const next = document.hidden ? undefined : await ask(end.signal);
      if (next !== null && !end.signal.aborted) timer = setTimeout(() => void turn(), next ?? pause_ms);
    };
    void turn();
    return () => {
      end.abort();
      clearTimeout(timer);
    };
  }, [on, ...when]);
}
