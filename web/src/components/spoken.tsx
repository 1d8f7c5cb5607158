// Spoken: what is said without being asked: alarms, the loss of the connection, the answer to "stop all". In: events, the state of the connection. Out: regions that
// only screen readers see. A burst of alarms is told as a number, at its end.
import { signal } from '@preact/signals';
import { useEffect } from 'preact/hooks';
import { useGateway } from '../gateway';
import { t } from '../language';

const burst_ms = 2_000;
const spoken = signal('');
export function Spoken() {
  const { store, commander } = useGateway();
  useEffect(() => {
    let waiting = 0;
    let quietUntil = 0;
    const say = (text: string) => {
      waiting += 1;
      const now = performance.now();
      if (now < quietUntil) return; // a burst of alarms is told as a number, at its end
      quietUntil = now + burst_ms;
      spoken.value = text;
      waiting = 0;
      setTimeout(() => {
        if (waiting > 0) spoken.value = waiting === 1 ? t('1 more alarm') : t('{n} more alarms', { n: waiting });
        waiting = 0;
      }, burst_ms);
    };
    return store.onEvent((e) => {
      if (e.severity === 'alarm') say(t('Alarm. {subject}: {text}', { subject: e.axis ?? e.drive ?? e.line ?? t('gateway'), text: e.text }));
    });
  }, [store]);
  const phase = store.connection.value.phase;
  const lost = phase === 'waiting' || phase === 'silent' ? t('Connection to the gateway lost. Values are not live.') : '';
  return (
    <>
      <div class="visually-hidden" role="alert" data-field="spoken">
        {spoken.value}
      </div>
      <div class="visually-hidden" role="alert">
        {lost}
      </div>
      <div class="visually-hidden" role="status">
        {commander.stopReport.value.text}
      </div>
    </>
  );
}
