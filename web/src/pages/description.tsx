// Description: one EDS or DCF file: what it is of, which drives use it, its warnings, its objects, its difference to another one. In: its name, perhaps
// the other one's. Out: a page. The objects are asked for once: a stored file never changes.
import { useSignal } from '@preact/signals';
import { descriptionFile, type Description, type DescriptionObject } from '../api/descriptions';
import { DescriptionDifference } from '../components/description-difference';
import { DescriptionObjects } from '../components/description-objects';
import { Empty } from '../components/lines';
import { useLoaded } from '../components/loaded';
import { Section } from '../components/section';
import { useGateway } from '../gateway';
import { gatewayText, t } from '../language';
import { descriptionsOf } from '../state/descriptions';
import { useSiteEvents } from '../state/site-events';
import { commissioningText, deviceText, extentText, usersText } from '../text/description';
import { dateTime } from '../text/time';

const hex = (n: number | null): string => (n === null ? '' : `${n.toString(16).toUpperCase()}h`);

export function DescriptionPage({ name, other = '' }: { name: string; other?: string | undefined }) {
  const { client, store } = useGateway();
  const { door, shelf } = descriptionsOf(client);
  const file = useSignal<Description | null>(null);
  const objects = useSignal<DescriptionObject[] | null>(null);
  const changes = useSiteEvents();
  const why = useLoaded(async () => void (file.value = await door.one(name)), [door, name, store.siteRevision.value, changes]);
  const waits = useLoaded(async () => void (objects.value = await door.objects(name)), [door, name]);
  useLoaded(shelf.load, [shelf, changes]);
  const d = file.value;
  return (
    <main class="page description-page" data-description={name}>
      <p class="crumbs">
        <a href="/site">{t('Site')}</a> · <a href="/descriptions">{t('Descriptions of drives')}</a>
      </p>
      <h1 tabIndex={-1}>{name}</h1>
      {d === null ? (
        <Empty text={why} />
      ) : (
        <>
          <Facts d={d} />
          <Warnings d={d} />
          <DescriptionObjects name={name} objects={objects.value ?? []} waits={objects.value === null ? waits : ''} />
          <DescriptionDifference name={name} objects={objects.value} other={other} list={shelf.list.value ?? []} />
        </>
      )}
    </main>
  );
}

function Facts({ d }: { d: Description }) {
  const numbers = [
    [t('vendor'), d.vendor_number],
    [t('product'), d.product_number],
    [t('revision'), d.revision_number],
  ].flatMap(([what, n]) => (typeof n === 'number' ? [`${what} ${hex(n)}`] : []));
  const rows: [string, string][] = [
    [t('Device'), deviceText(d)],
    [t('Identity (1018h)'), numbers.join(', ') || t('not in the file')],
    [t('Bit rates'), d.bit_rates_kbit.length > 0 ? t('{list} kbit/s', { list: d.bit_rates_kbit.join(', ') }) : t('not in the file')],
    [t('Content'), extentText(d)],
    [t('Drives'), usersText(d.used_by)],
    [t('Stored'), [dateTime(d.added_at), d.added_by].filter(Boolean).join(' · ')],
  ];
  const made = commissioningText(d);
  if (made) rows.push([t('Configuration'), made]);
  return (
    <Section title={t('The file')} fold={true} beside={<a href={descriptionFile(d.name)} download={d.name}>{t('Download')}</a>}>
      <dl class="card facts" data-field="description-facts">
        {rows.map(([what, text]) => (
          <div key={what}>
            <dt>{what}</dt>
            <dd>{text}</dd>
          </div>
        ))}
      </dl>
    </Section>
  );
}

function Warnings({ d }: { d: Description }) {
  const n = d.warnings.length;
  return (
    <Section title={t('Warnings')} fold={n > 0 ? n : false}>
      <div class="card" data-field="warnings">
        {n === 0 ? (
          <Empty text={t('Every row of the file was read as it stands.')} />
        ) : (
          <ul class="rows window" tabIndex={0} role="group" aria-label={t('Warnings of {name}', { name: d.name })}>
            {d.warnings.map((w, i) => (
              <li key={i} class="row">
                <span class="mono">{w.line > 0 ? t('line {n}', { n: w.line }) : t('the file')}</span>: <span {...gatewayText}>{w.text}</span>
              </li>
            ))}
          </ul>
        )}
        {n >= 50 && <p class="where">{t('At most 50 warnings are kept.')}</p>}
      </div>
    </Section>
  );
}
