// Description objects: the objects of a file as a table, a hundred at a time, sought and filtered. In: the objects. Out: a table.
import { useSignal } from '@preact/signals';
import { useMemo } from 'preact/hooks';
import type { DescriptionObject } from '../api/descriptions';
import { gatewayText, t } from '../language';
import { kinds, limitsText, matchingObjects, objectName, type Kind } from '../text/description';
import { Empty } from './lines';
import { Paged } from './paged';
import { Section } from './section';
import { TableHead } from './table-head';

const rowsAtOnce = 100;

export function DescriptionObjects({ name, objects, waits }: { name: string; objects: readonly DescriptionObject[]; waits: string }) {
  const search = useSignal('');
  const kind = useSignal<Kind>('all');
  const from = useSignal(0);
  const fitting = useMemo(() => matchingObjects(objects, search.value, kind.value), [objects, search.value, kind.value]);
  const hasValues = useMemo(() => objects.some((o) => o.configured !== null), [objects]);
  const at = from.value < fitting.length ? from.value : 0;
  const shown = fitting.slice(at, at + rowsAtOnce);
  return (
    <Section
      title={t('Objects')}
      class="description-objects"
      beside={
        <>
          <input
            class="search"
            type="search"
            placeholder={t('Search')}
            aria-label={t('Search objects by number, name or type')}
            value={search.value}
            onInput={(e) => {
              search.value = e.currentTarget.value;
              from.value = 0;
            }}
          />
          <label class="select">
            <span class="visually-hidden">{t('Show')}</span>
            <select
              value={kind.value}
              onChange={(e) => {
                kind.value = e.currentTarget.value as Kind;
                from.value = 0;
              }}
            >
              {kinds.filter((k) => hasValues || k.value !== 'configured').map((k) => (
                <option key={k.value} value={k.value}>
                  {k.text}
                </option>
              ))}
            </select>
          </label>
        </>
      }
    >
      {waits ? (
        <Empty text={waits} />
      ) : (
        <div class="card">
          <Paged from={at} atOnce={rowsAtOnce} of={fitting.length} all={objects.length} go={(n) => (from.value = n)} />
          {shown.length > 0 && (
            <div class="table-scroll window" tabIndex={0} role="region" aria-label={t('Objects of {name}', { name })}>
              <table class="table">
                <TableHead of={[t('Object'), t('Type'), t('Access'), t('Limits'), t('Default'), ...(hasValues ? [t('Value of the DCF')] : []), t('Line')]} figures={hasValues ? [4, 5, 6] : [4, 5]} />
                <tbody>
                  {shown.map((o) => (
                    <Row key={o.object} o={o} hasValues={hasValues} />
                  ))}
                </tbody>
              </table>
            </div>
          )}
        </div>
      )}
    </Section>
  );
}

const Row = ({ o, hasValues }: { o: DescriptionObject; hasValues: boolean }) => (
  <tr data-object={o.object}>
    <th scope="row">
      <span class="both">
        <span class="mono id">{o.object}</span>
        <span class="name" {...gatewayText}>
          {objectName(o)}
        </span>
      </span>
    </th>
    <td class="mono" data-label={t('Type')}>{o.type}</td>
    <td data-label={t('Access')}>
      <span class="mono">{o.access}</span> {o.mappable && <abbr title={t('can be in a PDO')}>PDO</abbr>}
    </td>
    <td data-label={t('Limits')}>{limitsText(o)}</td>
    <td class="num mono" data-label={t('Default')}>{o.default ?? ''}</td>
    {hasValues && <td class={`num mono${o.configured !== null && o.configured !== o.default ? ' value differs' : ''}`} data-label={t('Value of the DCF')}>{o.configured ?? ''}</td>}
    <td class="num" data-label={t('Line')}>{o.line ?? ''}</td>
  </tr>
);
