// Alarms: the list with what can be done about each: acknowledge, shelve for a time with a reason, take back. In: the store. Out: requests.
// The list is the gateway's; nothing is taken off it here before the gateway has said so.
import { gatewayText, t } from '../language';
import { useSignal } from '@preact/signals';
import { useEffect } from 'preact/hooks';
import { RecorderDoor } from '../api/recorder';
import type { Alarm, Recording } from '../api/types';
import { useDoor, useGateway } from '../gateway';
import { framesPath, linePath, recorderPath } from '../router';
import { windowOf } from '../state/narrow';
import { emptied } from '../state/persisted';
import { quiet, tellOf, type Reported } from '../state/reported';
import { alarmWord, canAcknowledge, recordingOf, shelfTimes, subjectOf, withoutSubject } from '../text/alarm';
import { plain } from '../text/plain';
import { clockTime } from '../text/time';
import { ErrorHelp } from './error-help';
import { Choice, Tell, TextField } from './form';
import { useBarred, Why } from './gate';
import { Empty } from './lines';
import { useLoaded } from './loaded';
import { AxisName, DriveName } from './name';
import { Pill } from './pill';
import { Section } from './section';

export function AlarmSection() {
  const { store, client } = useGateway();
  const reported = useSignal<Reported>(quiet);
  const comment = useSignal('');
  const shelving = useSignal<number | null>(null);
  const no = useBarred('operator');
  const list = store.alarms.value;
  // A fault makes a recording two seconds later: its event says so.
  const recordings = useSignal<readonly Recording[]>([]);
  const door = useDoor(RecorderDoor);
  const times = useSignal(0);
  useEffect(() => store.onEvent((e) => e.kind === 'recording' && (times.value += 1)), [store]);
  useLoaded(async () => void (recordings.value = (await door.recordings()).recordings), [door, times.value]);
  const all = list?.alarms ?? [];
  const open = all.filter(canAcknowledge);
  const act = (what: () => Promise<unknown>, done: string) => tellOf(reported, t('Asking the gateway.'), what, done);
  return (
    <Section
      title={open.length === 0 ? t('Alarms') : t('Alarms, {n} not acknowledged', { n: open.length })}
      beside={
        open.length > 0 ? (
          <span class="alarm-all">
            <input class="search" type="text" aria-label={t('Comment for the acknowledgement')} placeholder={t('Comment')} maxLength={200} value={comment.value} onInput={(e) => (comment.value = e.currentTarget.value)} />
            <button
              type="button"
              class="button primary"
              {...no}
              onClick={() => {
                const sent = comment.peek();
                void act(
                  () => client.acknowledgeAlarms(open.map((a) => a.id), sent.trim()),
                  open.length === 1 ? t('1 alarm acknowledged.') : t('{n} alarms acknowledged.', { n: open.length }),
                ).then((good) => good && emptied(comment, sent));
              }}
            >
              {t('Acknowledge all shown')}
            </button>
          </span>
        ) : undefined
      }
    >
      {all.length > 0 && <Why need="operator" what={t('Acknowledging and shelving')} />}
      <div {...(all.length > 2 ? { class: 'card window', ...windowOf(t('Alarms')) } : { class: 'card' })}>
        {list === null ? (
          <Empty text={t('Waiting for the gateway.')} />
        ) : all.length === 0 ? (
          <Empty text={store.connected.value ? t('No alarm. Everything that was is acknowledged.') : t('Not connected: what is wrong now is not known.')} />
        ) : (
          <ul aria-label={t('Alarms')}>
            {all.map((a) => (
              <AlarmRow
                key={a.id}
                alarm={a}
                recordings={recordings.value}
                shelving={shelving.value === a.id}
                onShelving={(yes) => (shelving.value = yes ? a.id : null)}
                onAcknowledge={() => void act(() => client.acknowledgeAlarm(a.id, comment.peek().trim()), t('Alarm of {a} acknowledged.', { a: subjectOf(a) }))}
                onShelve={async (for_s, reason) => {
                  if (await act(() => client.shelveAlarm(a.id, for_s, reason), t('Alarm of {a} shelved.', { a: subjectOf(a) }))) shelving.value = null;
                }}
                onUnshelve={() => void act(() => client.unshelveAlarm(a.id), t('Alarm of {a} is back from the shelf.', { a: subjectOf(a) }))}
              />
            ))}
          </ul>
        )}
        {(list?.dropped ?? 0) > 0 && <p class="empty">{t('{dropped} further alarms found the list full: acknowledge those that are cleared.', { dropped: list?.dropped ?? 0 })}</p>}
      </div>
      <Tell reported={reported.value} field="alarm-told" />
    </Section>
  );
}

interface RowProps {
  alarm: Alarm;
  recordings: readonly Recording[];
  shelving: boolean;
  onShelving: (yes: boolean) => void;
  onAcknowledge: () => void;
  onShelve: (for_s: number, reason: string) => Promise<void>;
  onUnshelve: () => void;
}

function AlarmRow(p: RowProps) {
  const no = useBarred('operator');
  const a = p.alarm;
  const about = subjectOf(a);
  const { store } = useGateway();
  const line = a.line ?? (a.axis ? store.axis(a.axis)?.peek()?.data.line : null) ?? (a.drive ? store.drive(a.drive)?.peek()?.data.line : null);
  const recording = recordingOf(p.recordings, a.since);
  return (
    <li class="row alarm-row" data-alarm={a.id} data-state={a.state}>
      <div class="alarm-line">
        <Pill word={alarmWord(a)} label={t('State')} />
        <span class="alarm-what">
          {a.axis ? <AxisName name={a.axis} /> : a.drive ? <b><DriveName name={a.drive} /></b> : a.line ? <a href={linePath(a.line)}>{about}</a> : <b>{about}</b>} <span {...gatewayText}>{plain(withoutSubject(a.text, about))}</span>
          {a.code !== null && <span class="mono">{' '}{t('(code {code})', { code: a.code })}</span>}
        </span>
        <span class="alarm-buttons">
          {a.axis && (
            <a class="button quiet" href={recorderPath('trends', a.axis, Date.parse(a.since))} aria-label={t('Trends then, when the alarm of {axis} came: {text}', { axis: a.axis, text: a.text })}>
              {t('Trends then')}
            </a>
          )}
          {line && (
            <a class="button quiet" href={framesPath(line, Date.parse(a.since))} aria-label={t('Frames then, when the alarm of {about} came: {text}', { about, text: a.text })}>
              {t('Frames then')}
            </a>
          )}
          {recording && (
            <a class="button quiet" href={recorderPath('recordings', recording, Date.parse(a.since))} aria-label={t('Recording of it: {recording}', { recording })}>
              {t('Recording of it')}
            </a>
          )}
          {canAcknowledge(a) && (
            <button type="button" class="button" {...no} aria-label={t('Acknowledge {about}: {text}', { about, text: a.text })} onClick={p.onAcknowledge}>
              {t('Acknowledge')}
            </button>
          )}
          {a.state === 'shelved' ? (
            <button type="button" class="button" {...no} aria-label={t('Unshelve {about}: {text}', { about, text: a.text })} onClick={p.onUnshelve}>
              {t('Unshelve')}
            </button>
          ) : (
            <button type="button" class="button quiet" {...no} aria-expanded={p.shelving} aria-label={t('Shelve {about}: {text}', { about, text: a.text })} onClick={() => p.onShelving(!p.shelving)}>
              {t('Shelve')}
            </button>
          )}
        </span>
      </div>
      <ErrorHelp axis={a.axis} drive={a.drive} code={a.code} />
      <p class="where">
        {t('Since')}{' '}<time dateTime={a.since}>{clockTime(a.since)}</time>
        {a.count > 1 && ` · ${t('{count} times', { count: a.count })}`}
        {a.cleared_at && ` · ${t('cleared {at}', { at: clockTime(a.cleared_at) })}`}
        {a.acknowledged_at && ` · ${t('acknowledged {at} by {who}', { at: clockTime(a.acknowledged_at), who: a.acknowledged_by ?? t('nobody known') })}${a.comment ? `: ${a.comment}` : ''}`}
        {a.shelved_until && ` · ${t('shelved until {until} by {who}: {reason}', { until: clockTime(a.shelved_until), who: a.shelved_by ?? t('nobody known'), reason: a.reason ?? '' })}`}
      </p>
      {p.shelving && !no.disabled && <ShelfForm about={about} onShelve={p.onShelve} onCancel={() => p.onShelving(false)} />}
    </li>
  );
}

function ShelfForm({ about, onShelve, onCancel }: { about: string; onShelve: RowProps['onShelve']; onCancel: () => void }) {
  const for_s = useSignal('3600');
  const reason = useSignal('');
  const fault = useSignal('');
  return (
    <form
      class="alarm-shelf"
      aria-label={t('Shelve the alarm of {about}', { about })}
      onSubmit={(e) => {
        e.preventDefault();
        fault.value = reason.peek().trim() === '' ? t('Say why it may be silent') : '';
        if (fault.peek() === '') void onShelve(Number(for_s.peek()), reason.peek().trim());
      }}
    >
      <Choice label={t('For')} value={for_s.value} choices={shelfTimes} onChoice={(v) => (for_s.value = v)} />
      <TextField label={t('Reason')} value={reason.value} fault={fault.value || undefined} onText={(entered) => (reason.value = entered)} />
      <span class="alarm-buttons">
        <button type="submit" class="button primary">
          {t('Put on the shelf')}
        </button>
        <button type="button" class="button quiet" onClick={onCancel}>
          {t('Cancel')}
        </button>
      </span>
    </form>
  );
}
