// Parameter live: how old the value of a parameter is, and which rows of a table are on the screen. In: a parameter as the gateway tells it, the
// table's body. Out: the value, grey where it is not live; its age, counted on once a second; ids. Never asks the gateway for anything.
import { t } from '../language';
import type { ReadonlySignal } from '@preact/signals';
import { useEffect, useMemo } from 'preact/hooks';
import type { AxisParameter } from '../api/types';
import { useGateway } from '../gateway';
import { tick } from '../state/clock';
import { receivedAt } from '../state/parameter-table';
import { isLive } from '../state/reread';
import { valueText } from '../text/parameter';
import { clockTime, duration } from '../text/time';

/** What was read before this is old: a command, or a lost connection, has come since. The gateway's clock. */
export type Since = ReadonlySignal<number>;

/** Grey where it is not live: read before the connection was lost, before the last command, or long ago. */
export function LiveValue({ p, since, differs }: { p: AxisParameter; since: Since; differs: boolean }) {
  const { store } = useGateway();
  void tick.value;
  const live = store.connected.value && isLive(receivedAt(p), store.gatewayNow_ms(), since.value);
  return (
    <span class={`mono value${differs ? ' differs' : ''}${live ? '' : ' is-old-value'}`} data-live={live} title={p.at ? t('{value}, as the drive said at {at}', { value: valueText(p.value, p), at: clockTime(p.at) }) : t('Not read yet')}>
      {valueText(p.value, p)}
    </span>
  );
}
export function Age({ p }: { p: AxisParameter }) {
  const { store } = useGateway();
  void tick.value;
  const at_ms = receivedAt(p);
  if (at_ms === null) return null;
  return (
    <span class="age" data-field="age">
      {t('{time} ago', { time: duration(store.gatewayNow_ms() - at_ms) })}
    </span>
  );
}

/** The ids of the rows that are on the screen now. `rows`: looked at anew when these are others. */
export function useOnScreen(body: { current: HTMLElement | null }, rows: unknown): ReadonlySet<string> {
  const seen = useMemo(() => new Set<string>(), []);
  const eye = useMemo(
    () =>
      typeof IntersectionObserver === 'undefined'
        ? null
        : new IntersectionObserver((all) => {
            for (const e of all) {
              const id = (e.target as HTMLElement).dataset.parameter ?? '';
              if (e.isIntersecting) seen.add(id);
              else seen.delete(id);
            }
          }),
    [],
  );
  useEffect(() => {
    eye?.disconnect();
    seen.clear();
    for (const row of body.current?.children ?? []) eye?.observe(row);
  }, [rows, body.current]);
  useEffect(() => () => eye?.disconnect(), []);
  return seen;
}
