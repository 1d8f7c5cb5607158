// Lines and drives, and one line with what it counts, the frames that cross it, and the hand of its twins. In: the store, the stream's
// frames. Out: two pages.
import { gatewayText, t } from '../language';
import { Gate } from '../components/gate';
import { Hand } from '../components/hand';
import { DriveList, Empty, LineCard, LineList, lineWord } from '../components/lines';
import { ScanSection } from '../components/scan';
import { Section } from '../components/section';
import { Trace } from '../components/trace';
import { useGateway } from '../gateway';

export function LinesPage() {
  return (
    <main class="page">
      <h1 tabIndex={-1}>{t('Lines and drives')}</h1>
      <div class="side-by-side">
        <Section title={t('Lines')}>
          <LineList />
        </Section>
        <Section title={t('Drives')}>
          <DriveList />
        </Section>
      </div>
    </main>
  );
}

export function LinePage({ name, at_ms }: { name: string; at_ms?: number | undefined }) {
  const { store } = useGateway();
  const known = store.line(name)?.value;
  const drives = store.driveNames.value.filter((d) => store.drive(d)?.value.data.line === name);
  const simulated = drives.filter((d) => store.drive(d)?.value.data.status.simulated);
  return (
    <main class="page">
      <p class="crumbs">
        <a href="/lines">{t('Lines and drives')}</a>
      </p>
      <h1 tabIndex={-1}>{name}</h1>
      {known ? (
        <>
          <p class="where">
            {known.data.family} · <span class="mono">{known.data.uri}</span> · {lineWord(known.data.status.state).text} <span {...gatewayText}>{known.data.status.text}</span>
          </p>
          <div class="side-by-side">
            <Section title={t('Statistics')}>
              <ul class="rows card">
                <LineCard name={name} />
              </ul>
            </Section>
            <Section title={t('Drives')}>
              <DriveList of={drives} />
            </Section>
          </div>
        </>
      ) : (
        store.listed.value && <Empty text={t('There is no line {name}.', { name })} />
      )}
      {known && <ScanSection line={name} />}
      <Trace key={name} line={name} at_ms={at_ms} />
      {simulated.length > 0 && (
        <Section title={t('Fault simulation: rehearse what goes wrong')} fold={simulated.length}>
          <div class="hands">
            {simulated.map((d) => (
              <section key={d} aria-label={t('Hand of {d}', { d })}>
                <h3>{d}</h3>
                <Gate need="engineer">
                  <Hand drive={d} />
                </Gate>
              </section>
            ))}
          </div>
        </Section>
      )}
    </main>
  );
}
