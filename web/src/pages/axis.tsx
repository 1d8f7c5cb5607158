// Axis: one axis on its own page, in tabs that have addresses: move (readings, controls, states), scope, drive (actions, console), the twin's hand, events.
// Its parameters are a page of their own under the same tabs. In: its name, the tab. Out: a page. Follows the axis at 50 ms while it is open.
import { t } from '../language';
import { useSignal } from '@preact/signals';
import { useEffect } from 'preact/hooks';
import type { Authority, Axis } from '../api/types';
import { Actions } from '../components/actions';
import { FullControls } from '../components/axis-controls';
import { Notice, Readout, StatePills } from '../components/axis-tile';
import { AxisTabs } from '../components/axis-tabs';
import { AuthorityBar } from '../components/authority';
import { Gate } from '../components/gate';
import { Console } from '../components/console';
import { ErrorHelp } from '../components/error-help';
import { EventList } from '../components/events';
import { DriveCompare } from '../components/drive-comparison';
import { Hand } from '../components/hand';
import { Empty } from '../components/lines';
import { memo } from '../components/memo';
import { Mark } from '../components/pill';
import { Scope } from '../components/scope';
import { Section } from '../components/section';
import { Specimen } from '../components/specimen';
import { StateMachine } from '../components/state-machine';
import { StopButton } from '../components/stop';
import { useGateway } from '../gateway';
import { linePath, recorderPath, type AxisTab } from '../router';
import { commandedText } from '../text/authority';
import { markOf, unitOf } from '../text/axis';
import { headingOf } from '../text/title';

const Controls = memo(FullControls, (a, b) => a.axis.name === b.axis.name && a.axis.unit === b.axis.unit);

export function AxisPage({ name, tab }: { name: string; tab: AxisTab }) {
  const gateway = useGateway();
  const { store } = gateway;
  const entry = store.axis(name);
  useEffect(() => gateway.watchClosely(name), [gateway, name]);

  if (!entry) {
    return (
      <main class="page">
        <p class="crumbs">
          <a href="/">{t('Axes')}</a>
        </p>
        <h1 tabIndex={-1}>{headingOf(name, tab)}</h1>
        <Empty text={store.listed.value ? t('There is no axis {name}.', { name }) : t('Waiting for the gateway.')} />
      </main>
    );
  }
  const axis = entry.value.data;
  const trust = store.trustOf(entry.value);
  return (
    <main class="page axis-page" data-axis={name} data-condition={trust} data-presence={axis.presence}>
      <header class="axis-head">
        <div>
          <p class="crumbs">
            <a href="/">{t('Axes')}</a>
          </p>
          <h1 tabIndex={-1}>{headingOf(name, tab)}</h1>
          <Mark mark={markOf(axis)} />
        </div>
        <p class="where">
          {axis.family} · <a href={linePath(axis.line)}>{axis.line}</a>{' '}· {t('drive {drive}, channel {channel} · axis {number}', { drive: axis.drive, channel: axis.channel, number: axis.number })} ·{' '}
          <LastCommander axis={axis} />
        </p>
        <StopButton axis={name} large urgent={axis.moving} />
      </header>
      <AxisTabs name={name} tab={tab} />
      {tab === 'move' && (
        <>
          <div class="axis-top">
            <div class="axis-state card" data-condition={trust} data-presence={axis.presence}>
              <Readout entry={entry} large />
              <StatePills entry={entry} />
              <div class="axis-said" tabIndex={0} role="group" aria-label={t('Messages of {name}', { name })}>
                <Notice entry={entry} whole />
                <ErrorHelp axis={name} code={axis.fault || axis.warning ? axis.error.code : 0} />
              </div>
              <AuthorityBar entry={entry.value} />
              <Controls axis={axis} />
            </div>
            <Scope axis={name} unit={unitOf(axis)} />
          </div>
          <Section title={t('State machine')}>
            <StateMachine axis={axis} trust={trust} />
          </Section>
        </>
      )}
      {tab === 'scope' && (
        <>
          <div class="axis-glance card" data-condition={trust}>
            <Readout entry={entry} />
            <StatePills entry={entry} />
          </div>
          <div class="scope-alone">
            <Scope axis={name} unit={unitOf(axis)} />
          </div>
          <p class="where">
            <a href={recorderPath('captures', name)}>{t('Capture it at up to 1 kHz')}</a> · <a href={recorderPath('trends', name)}>{t('its last minutes in the recorder')}</a>
          </p>
        </>
      )}
      {tab === 'drive' && (
        <>
          <Section title={t('Actions of the family')}>
            <Actions key={name} axis={name} family={axis.family} />
          </Section>
          <Section title={t('Native console')} help="reference#families">
            <Gate need="engineer">
              <Console drive={axis.drive} />
            </Gate>
          </Section>
        </>
      )}
      {tab === 'simulation' && (
        <>
          <Section title={t('Fault simulation')}>
            <Gate need="engineer">
              <Hand drive={axis.drive} axis={name} />
            </Gate>
          </Section>
          <Section title={t('Specimen')} help="specimens">
            <Specimen key={axis.drive} drive={axis.drive} family={axis.family} />
          </Section>
          <Section title={t('Drive and twin')} help="compare">
            <DriveCompare key={name} axis={name} />
          </Section>
        </>
      )}
      {tab === 'events' && (
        <Section title={t('Events of this axis')}>
          <div class="card scroll" tabIndex={0} role="region" aria-label={t('Events of {name}', { name })}>
            <AxisEvents name={name} />
          </div>
        </Section>
      )}
    </main>
  );
}

/** Who commanded last: somebody who holds the axis now is told apart from that, by the bar below. Asked for when it may have changed. */
function LastCommander({ axis }: { axis: Axis }) {
  const { client, store, tab } = useGateway();
  const who = useSignal('');
  const times = useSignal(0);
  const { name, authority } = axis;
  useEffect(() => store.onEvent((e) => void (e.axis === name && e.kind === 'command' && (times.value += 1))), [store, name]);
  useEffect(() => {
    let here = true;
    void Promise.resolve(client.call<Authority>(`/axes/${encodeURIComponent(name)}/authority`)).then(
      (a) => here && (who.value = a?.last_commander ?? ''),
      () => undefined, // an older gateway: the door alone is told
    );
    return () => void (here = false);
  }, [client, name, authority, axis.authority_holder, times.value]);
  return <span data-field="last-commander">{commandedText(authority, who.value, tab.name.value)}</span>;
}

function AxisEvents({ name }: { name: string }) {
  const { store } = useGateway();
  return <EventList events={store.events.value.filter((e) => e.axis === name)} limit={100} />;
}
