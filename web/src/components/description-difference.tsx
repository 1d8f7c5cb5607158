// Description difference: two files beside each other: objects that one has alone, and those of both that differ. In: the objects of this file, which
// other one. Out: a table; the choice of the other file is in the address.
import { useSignal } from '@preact/signals';
import { useMemo } from 'preact/hooks';
import type { DescriptionEntry, DescriptionObject } from '../api/descriptions';
import { useGateway } from '../gateway';
import { gatewayText, t } from '../language';
import { descriptionPath, go } from '../router';
import { descriptionsOf } from '../state/descriptions';
import { differenceOfObjects, differenceText, memberNames, type ObjectDifference, type Side } from '../text/description-difference';
import { Choice } from './form';
import { Empty } from './lines';
import { useLoaded } from './loaded';
import { Paged } from './paged';
import { Section } from './section';
import { TableHead } from './table-head';

const rowsAtOnce = 100;
type Shown = 'all' | Side;

export function DescriptionDifference({ name, objects, other, list }: { name: string; objects: readonly DescriptionObject[] | null; other: string; list: readonly DescriptionEntry[] }) {
  const others = list.filter((d) => d.name !== name);
  return (
    <Section title={t('Difference to another file')} class="description-difference">
      <div class="card form">
        {others.length === 0 ? (
          <p class="where">{t('There is no other description to compare with.')}</p>
        ) : (
          <div class="form-grid">
            <Choice
              label={t('Compare {name} with', { name })}
              class="wide"
              value={other}
              onChoice={(b) => go(descriptionPath(name, b || undefined))}
              choices={[{ value: '', text: t('no file') }, ...others.map((d) => ({ value: d.name, text: d.name }))]}
            />
          </div>
        )}
        {other !== '' && objects !== null && <Differing key={other} name={name} other={other} objects={objects} />}
      </div>
    </Section>
  );
}

function Differing({ name, other, objects }: { name: string; other: string; objects: readonly DescriptionObject[] }) {
  const { door } = descriptionsOf(useGateway().client);
  const theirs = useSignal<DescriptionObject[] | null>(null);
  const shown = useSignal<Shown>('all');
  const from = useSignal(0);
  const why = useLoaded(async () => void (theirs.value = await door.objects(other)), [door, other]);
  const rows = useMemo(() => (theirs.value ? differenceOfObjects(objects, theirs.value) : []), [objects, theirs.value]);
  if (theirs.value === null) return <Empty text={why} />;
  const fitting = rows.filter((r) => shown.value === 'all' || r.side === shown.value);
  const at = from.value < fitting.length ? from.value : 0;
  const choices: { value: Shown; text: string }[] = [
    { value: 'all', text: t('all differences') },
    { value: 'both', text: t('in both, with other values') },
    { value: 'first', text: t('only in {name}', { name }) },
    { value: 'second', text: t('only in {name}', { name: other }) },
  ];
  return (
    <>
      <p role="status" data-field="difference-count">
        {differenceText(rows, name, other)}
      </p>
      {rows.length > 0 && (
        <>
          <div class="form-grid">
            <Choice
              label={t('Show')}
              class="wide"
              value={shown.value}
              onChoice={(v) => {
                shown.value = v as Shown;
                from.value = 0;
              }}
              choices={choices}
            />
          </div>
          <Paged from={at} atOnce={rowsAtOnce} of={fitting.length} all={rows.length} go={(n) => (from.value = n)} />
          {fitting.length > 0 && (
            <div class="table-scroll window" tabIndex={0} role="region" aria-label={t('Differences of {first} and {second}', { first: name, second: other })}>
              <table class="table">
                <TableHead of={[t('Object'), name, other]} />
                <tbody>
                  {fitting.slice(at, at + rowsAtOnce).map((r) => (
                    <Row key={r.object} r={r} first={name} second={other} />
                  ))}
                </tbody>
              </table>
            </div>
          )}
        </>
      )}
    </>
  );
}

function Row({ r, first, second }: { r: ObjectDifference; first: string; second: string }) {
  const cell = (side: 'first' | 'second') =>
    r.side === 'both' ? (
      <ul class="plain-list">
        {r.differing.map((d) => (
          <li key={d.member}>
            {memberNames[d.member]}: <span class="mono">{d[side] ?? t('none')}</span>
          </li>
        ))}
      </ul>
    ) : r.side === side ? (
      t('has it')
    ) : (
      <span class="where">{t('does not have it')}</span>
    );
  return (
    <tr data-object={r.object} data-side={r.side}>
      <th scope="row">
        <span class="both">
          <span class="mono id">{r.object}</span>
          <span class="name" {...gatewayText}>
            {r.name}
          </span>
        </span>
      </th>
      <td data-label={first}>{cell('first')}</td>
      <td data-label={second}>{cell('second')}</td>
    </tr>
  );
}
