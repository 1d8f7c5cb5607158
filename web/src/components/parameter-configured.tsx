// Parameter configured: the values that the DCF of the drive gives to its parameters, where the drive has others: shown, chosen, then written. In: the axis.
// Out: a section; nothing for a drive whose description has no such values. What the site does by itself when the drive answers is said beside it.
import { useMemo } from 'preact/hooks';
import type { Axis } from '../api/types';
import { useGateway } from '../gateway';
import { gatewayText, t } from '../language';
import { descriptionPath } from '../router';
import { ConfiguredList, type Differing } from '../state/configured';
import { steppedText, unitText, valueText } from '../text/parameter';
import { Tell } from './form';
import { useBarred, Why } from './gate';
import { useLoaded } from './loaded';
import { Section } from './section';

const rules: Record<string, string> = {
  ignore: t('When the drive answers, the gateway does not compare these values (stored parameters of the axis).'),
  compare: t('When the drive answers, the gateway compares these values and reports each difference by an event (stored parameters of the axis).'),
  write: t('When the drive answers, the gateway writes those that differ, unless the axis moves (stored parameters of the axis).'),
};

export function ParameterConfigured({ axis }: { axis: Axis }) {
  const { store } = useGateway();
  const description = store.drive(axis.drive)?.value.data.description ?? '';
  return description === '' ? null : <Configured key={description} axis={axis} description={description} />;
}

function Configured({ axis, description }: { axis: Axis; description: string }) {
  const { client } = useGateway();
  const list = useMemo(() => new ConfiguredList(client, axis.name), [client, axis.name]);
  const no = useBarred('engineer');
  useLoaded(list.load, [list]);
  const n = list.of.value;
  const rows = list.differing.value;
  const chosen = list.chosen.value.size;
  if (n === null || n === 0) return null;
  return (
    <Section title={t('Values of the DCF')} class="configured" help="parameters">
      <div class="card form" data-field="configured">
        <Why need="engineer" what={t('Writing the values of a file')} />
        <p class="where">
          {n === 1 ? t('The file gives a value to 1 parameter.') : t('The file gives values to {n} parameters.', { n })} <a href={descriptionPath(description)}>{description}</a>. {rules[axis.stored_parameters ?? 'ignore']}
        </p>
        <div class="form-foot">
          <button type="button" class="button" disabled={list.busy.value} onClick={() => void list.look()}>
            {t('Compare with the drive')}
          </button>
          <Tell reported={list.reported.value} field="configured-told" />
        </div>
        {list.unread.value.length > 0 && <p class="form-told is-fault">{t('Not read from the drive: {list}', { list: list.unread.value.join(', ') })}</p>}
        {rows !== null && rows.length > 0 && (
          <fieldset class="changes">
            <legend>{t('Values in which the drive differs from the file')}</legend>
            <ul>
              {rows.map((r) => (
                <Row key={r.p.id} r={r} chosen={list.chosen.value.has(r.p.id)} choose={() => list.choose(r.p.id)} />
              ))}
            </ul>
            <div class="form-foot">
              <button type="button" class="button primary" disabled={chosen === 0 || list.busy.value} {...no} onClick={() => void list.write()}>
                {chosen === 1 ? t('Write 1 value to the drive') : t('Write {n} values to the drive', { n: chosen })}
              </button>
            </div>
          </fieldset>
        )}
      </div>
    </Section>
  );
}

const Row = ({ r: { p, wanted }, chosen, choose }: { r: Differing; chosen: boolean; choose: () => void }) => (
  <li data-configured={p.id}>
    <label class="check">
      <input type="checkbox" checked={chosen} onChange={choose} />
      <span class="both">
        <span class="mono id">{p.id}</span> <span class="name" {...gatewayText}>{p.name.replaceAll('_', ' ')}</span>
      </span>
      <span>
        <span class="mono">
          {valueText(p.value, p)} → {valueText(wanted, p)}
        </span>{' '}
        <span class="unit">{p.allowed ? '' : `${unitText(p.unit)} ${steppedText(wanted, p.unit)}`.trim()}</span>{' '}
        {p.written_at !== null && <span class="flag">{t('written through the gateway, newer than the file')}</span>}
      </span>
    </label>
  </li>
);
