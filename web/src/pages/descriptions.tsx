// Descriptions: the makers' EDS and DCF files of this gateway: dropped or chosen, looked at, removed, made into drives. In: the HTTP door. Out: a page.
import { DescriptionDrop } from '../components/description-drop';
import { DescriptionRow } from '../components/description-row';
import { Tell } from '../components/form';
import { Why } from '../components/gate';
import { Empty } from '../components/lines';
import { useLoaded } from '../components/loaded';
import { Section } from '../components/section';
import { useGateway } from '../gateway';
import { t } from '../language';
import { descriptionsOf } from '../state/descriptions';
import { useSiteEvents } from '../state/site-events';

export function DescriptionsPage() {
  const { client, store } = useGateway();
  const { shelf } = descriptionsOf(client);
  const changes = useSiteEvents();
  const why = useLoaded(shelf.load, [shelf, store.siteRevision.value, changes]);
  const list = shelf.list.value;
  return (
    <main class="page descriptions-page">
      <p class="crumbs">
        <a href="/site">{t('Site')}</a>
      </p>
      <h1 tabIndex={-1}>{t('Descriptions of drives')}</h1>
      <p class="where">{t('The maker of a CANopen drive describes it in an EDS file, and one configured drive in a DCF. A drive of the site that names such a file has its objects as parameters, with their types, limits and defaults. A file can be looked at before any drive uses it.')}</p>
      <Section title={t('Add files')} help="family-cia402">
        <div class="card form">
          <DescriptionDrop text={t('Drop EDS and DCF files here, several at once, or')} />
        </div>
      </Section>
      <Section title={list && list.length > 0 ? t('Descriptions, {n}', { n: list.length }) : t('Descriptions')}>
        <Why need="engineer" what={t('Adding and removing descriptions')} />
        <Tell reported={shelf.reported.value} field="description-told" />
        <div class="card">
          {list === null ? (
            <Empty text={why} />
          ) : list.length === 0 ? (
            <Empty text={t('There is no description yet.')} />
          ) : (
            <ul class="rows window" aria-label={t('Descriptions')}>
              {list.map((d) => (
                <DescriptionRow key={d.name} d={d} onRemove={() => void shelf.remove(d.name)} />
              ))}
            </ul>
          )}
        </div>
      </Section>
    </main>
  );
}
