// Trend feed: what the gateway remembers of the part of time that is seen: asked for at most every second while it runs on, and soon after each zoom. In: the
// recorder's door, the view of the plot. Out: columns that a plot draws, the document, the fault. One request at a time; the newest wish is asked last.
import { useSignal, type ReadonlySignal, type Signal } from '@preact/signals';
import { useEffect, useRef } from 'preact/hooks';
import { asProblem } from '../api/problem';
import type { RecorderDoor } from '../api/recorder';
import type { Trends } from '../api/types';
import type { TracePoint } from '../text/recorder';
import { capital } from './commander';
import type { PlotView } from './plot-view';
import { joined, trendPart, type Drawn } from './recorder';

const period_ms = 1_000;
const settled_ms = 120;

export interface TrendWish {
  door: Pick<RecorderDoor, 'trends' | 'recordings'>;
  view: PlotView;
  axes: readonly string[];
  seen: readonly TracePoint[];
  span_s: number;
  /** An instant that is looked at instead of now. */
  at_ms: number | undefined;
  /** Whether the picture runs on with the time. */
  follow: Signal<boolean>;
  now_s: () => number;
}
export interface TrendFeed {
  shown: ReadonlySignal<Trends | null>;
  drawn: { readonly current: Drawn };
  version: ReadonlySignal<number>;
  fault: Signal<string>;
}

export function useTrendFeed({ door, view: v, axes, seen, span_s, at_ms, follow, now_s }: TrendWish): TrendFeed {
  const shown = useSignal<Trends | null>(null);
  const drawn = useRef<Drawn>({ at: [], columns: [] });
  const version = useSignal(0);
  const fault = useSignal('');
  const minutes = useSignal(10);
  useEffect(() => {
    void door.recordings().then((r) => (minutes.value = r.trend_minutes), () => undefined);
  }, [door]);
  useEffect(() => {
    if (at_ms !== undefined) follow.value = false;
  }, [at_ms]);

  useEffect(() => {
    if (axes.length === 0 || seen.length === 0) return;
    let here = true;
    let soon: ReturnType<typeof setTimeout> | undefined;
    let own = false;
    const load = oneByOne(async () => {
      const [from, to] = v.range.peek();
      try {
        const doc = await door.trends({ axes, points: [...seen, 'state'], from_ms: from * 1000, to_ms: to * 1000, columns: Math.min(2000, Math.max(200, globalThis.innerWidth)) });
        if (!here) return;
        drawn.current = joined(doc.axes.map((a) => trendPart(a, seen, to)));
        shown.value = doc;
        fault.value = '';
        version.value += 1;
      } catch (error) {
        if (here) fault.value = capital(asProblem(error).text);
      }
      return here;
    });
    const whole = (instant: number) => (v.whole.value = [instant - minutes.peek() * 60, instant]);
    const turn = () => {
      if (document.hidden) return;
      const instant = now_s();
      whole(instant);
      if (!follow.peek()) return;
      own = true;
      v.range.value = [instant - span_s, instant];
      own = false;
      load();
    };
    if (!follow.peek() && at_ms !== undefined) {
      whole(now_s());
      v.range.value = [at_ms / 1000 - span_s / 2, at_ms / 1000 + span_s / 2];
    }
    turn();
    load();
    const timer = setInterval(turn, period_ms);
    const end = v.range.subscribe(([from, to]) => {
      if (own || !here) return;
      if (soon === undefined) follow.value = follow.peek() && to >= v.whole.peek()[1] && to - from === span_s;
      clearTimeout(soon);
      soon = setTimeout(() => {
        soon = undefined;
        load();
      }, settled_ms);
    });
    return () => {
      here = false;
      clearInterval(timer);
      clearTimeout(soon);
      end();
    };
  }, [axes.join(), seen.join(), span_s, door, at_ms]);
  return { shown, drawn, version, fault };
}

/** Asks once at a time; who asks meanwhile is answered by one more at the end. `ask`: false or nothing: no more is wanted. */
export function oneByOne(ask: () => Promise<boolean | undefined>): () => void {
  let asking = false;
  let again = false;
  return function load(): void {
    if (asking) return void (again = true);
    asking = true;
    void ask().then((more) => {
      asking = false;
      if (!more || !again) return;
      again = false;
      load();
    });
  };
}
