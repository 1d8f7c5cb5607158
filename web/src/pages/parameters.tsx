// Parameters: the whole catalogue of one axis on a page of its own: values, snapshots, comparison, export and import. In: its name. Out: a page.
import { t } from '../language';
import { useSignal } from '@preact/signals';
import type { Snapshot } from '../api/snapshots';
import { AxisTabs } from '../components/axis-tabs';
import { Empty } from '../components/lines';
import { ParameterCompare } from '../components/parameter-compare';
import { ParameterConfigured } from '../components/parameter-configured';
import { ParameterTransfer } from '../components/parameter-transfer';
import { Parameters } from '../components/parameters';
import { Mark } from '../components/pill';
import { Snapshots } from '../components/snapshots';
import { StopButton } from '../components/stop';
import { useGateway } from '../gateway';
import { axisPath } from '../router';
import { markOf } from '../text/axis';

export function ParametersPage({ name }: { name: string }) {
  const { store } = useGateway();
  const snapshots = useSignal<Snapshot[]>([]);
  const entry = store.axis(name);
  const axis = entry?.value.data;
  return (
    <main class="page parameters-page">
      <header class="axis-head">
        <div>
          <p class="crumbs">
            <a href={axisPath(name)}>{name}</a>
          </p>
          <h1 tabIndex={-1}>{t('Parameters of {name}', { name })}</h1>
          {axis && <Mark mark={markOf(axis)} />}
        </div>
        {axis && (
          <p class="where">
            {t('{family} · drive {drive}, channel {channel}', { family: axis.family, drive: axis.drive, channel: axis.channel })}
          </p>
        )}
        {axis && <StopButton axis={name} large urgent={axis.moving} />}
      </header>
      <AxisTabs name={name} tab="parameters" />
      {!axis ? (
        <Empty text={store.listed.value ? t('There is no axis {name}.', { name }) : t('Waiting for the gateway.')} />
      ) : (
        <>
          <Parameters axis={name} />
          <ParameterConfigured key={`${name} ${axis.drive}`} axis={axis} />
          <Snapshots axis={name} family={axis.family} onList={(list) => (snapshots.value = list)} />
          <ParameterCompare axis={name} family={axis.family} snapshots={snapshots.value} />
          <ParameterTransfer axis={name} />
        </>
      )}
    </main>
  );
}
