// What is wrong: a place of fixed height at the top of the overview, each entry a link to where it can be mended. In: the store. Out: a list, or that
// nothing is wrong. It is always there, so that an alarm moves no stop; what it has no room for is scrolled to.
import { useSignal } from '@preact/signals';
import { useGateway } from '../gateway';
import { gatewayText, t } from '../language';
import { withoutSubject } from '../text/alarm';
import { plain } from '../text/plain';
import { errorsNow, type ErrorEntry } from '../text/errors';
import { Icon } from './icon';
import { Empty } from './lines';
import { AxisName, SimulatedMark } from './name';

const most = 12;
const mostAxes = 8;

export function ErrorList() {
  const { store } = useGateway();
  const whole = useSignal(false);
  const known = store.connected.value && store.listed.value;
  const alarms = store.alarms.value;
  const all = known
    ? errorsNow(
        store.axisNames.value.flatMap((n) => store.axis(n)?.value.data ?? []),
        store.lineNames.value.flatMap((n) => store.line(n)?.value.data ?? []),
        store.driveNames.value.flatMap((n) => store.drive(n)?.value.data ?? []),
        alarms?.unacknowledged ?? 0,
        alarms?.alarms ?? [],
      )
    : [];
  const shown = whole.value ? all : all.slice(0, most);
  return (
    <section class="wrong" aria-label={t('What is wrong')}>
      <div class="card">
        {all.length === 0 ? (
          <Empty text={known ? t('Nothing is wrong.') : t('Not connected: what is wrong now is not known.')} />
        ) : (
          <ul aria-label={t('What is wrong')} data-field="wrong">
            {shown.map((w) => (
              <li key={w.key}>
                <a class={`wrong-item tone-${w.word.tone}`} href={w.path} data-wrong={w.key}>
                  <span class="wrong-word">
                    <Icon name={w.word.icon} size={14} /> {w.word.text}
                  </span>
                  {w.about && (
                    <b>
                      {w.about}
                      <SimulatedMark of={w.about} kind={w.path.startsWith('/axes/') ? 'axis' : 'drive'} lead=" " />
                    </b>
                  )}
                  <span class="wrong-text" {...gatewayText}>{plain(withoutSubject(w.text, w.about))}</span>
                </a>
                {w.axes.length > 0 && <ErrorAxes of={w} />}
              </li>
            ))}
            {all.length > most && (
              <li class="wrong-item">
                <button type="button" class="link" aria-expanded={whole.value} data-field="wrong-more" onClick={() => (whole.value = !whole.value)}>
                  {whole.value ? t('Show less') : t('and {n} more', { n: all.length - most })}
                </button>
              </li>
            )}
          </ul>
        )}
      </div>
    </section>
  );
}

function ErrorAxes({ of }: { of: ErrorEntry }) {
  const whole = useSignal(false);
  const shown = whole.value ? of.axes : of.axes.slice(0, mostAxes);
  return (
    <p class="wrong-axes" data-wrong-axes={of.key}>
      <span>{of.axes.length === 1 ? t('Axis:') : t('Axes:')}</span>
      {shown.map((n) => (
        <AxisName key={n} name={n} />
      ))}
      {of.axes.length > mostAxes && (
        <button type="button" class="link" aria-expanded={whole.value} onClick={() => (whole.value = !whole.value)}>
          {whole.value ? t('show less') : t('and {n} more', { n: of.axes.length - mostAxes })}
        </button>
      )}
    </p>
  );
}
