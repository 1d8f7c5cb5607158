// Error help: what a drive's own error code means and what to do about it, from the catalogue of its family. In: an axis or a drive, a code. Out: the
// maker's words, as the catalogue has them; nothing where the code is none of the family's. Each family's list is asked for once.
import { gatewayText, t } from '../language';
import { useSignal } from '@preact/signals';
import { useEffect } from 'preact/hooks';
import type { Client } from '../api/client';
import type { components } from '../api/schema';
import { useGateway } from '../gateway';

type ErrorCode = components['schemas']['ErrorCode'];
const lists = new WeakMap<Client, Map<string, Promise<ErrorCode[]>>>();
function errorsOf(client: Client, family: string): Promise<ErrorCode[]> {
  const mine = lists.get(client) ?? new Map<string, Promise<ErrorCode[]>>();
  lists.set(client, mine);
  const known = mine.get(family);
  if (known) return known;
  const asked = client.call<ErrorCode[]>(`/families/${encodeURIComponent(family)}/errors`);
  mine.set(family, asked);
  asked.catch(() => mine.delete(family)); // another time, perhaps
  return asked;
}
export const entryOf = (list: readonly ErrorCode[], code: number): ErrorCode | undefined => list.find((e) => e.code === code) ?? list.find((e) => e.through != null && code > e.code && code <= e.through);

export function ErrorHelp({ axis, drive, code }: { axis?: string | null | undefined; drive?: string | null | undefined; code: number | null | undefined }) {
  const { client, store } = useGateway();
  const found = useSignal<ErrorCode | undefined>(undefined);
  const owner = (axis ? store.axis(axis)?.peek()?.data.drive : undefined) ?? drive ?? '';
  const family = store.listed.value ? (store.drive(owner)?.peek()?.data.family ?? '') : '';
  useEffect(() => {
    found.value = undefined;
    if (!code || !family) return;
    let here = true;
    errorsOf(client, family).then((list) => here && (found.value = entryOf(list, code)), () => undefined);
    return () => void (here = false);
  }, [client, family, code]);
  const e = found.value;
  if (!e?.remedy && !e?.cause) return null;
  return (
    <p class="error-help" data-field="error-help" data-code={e.code}>
      {e.remedy && (
        <>
          <b>{t('What to do:')}</b> <span {...gatewayText}>{e.remedy}</span>
        </>
      )}
      {e.cause && (
        <span class="error-cause">
          {' '}
          <b>{t('Cause:')}</b> <span {...gatewayText}>{e.cause}</span>
        </span>
      )}
    </p>
  );
}
