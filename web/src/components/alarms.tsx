// Alarms: the list with what can be done about each: acknowledge, shelve for a time with a reason, take back. In: the store. Out: requests.
// The list is the gateway's; nothing is taken off it here before the gateway has said so.
import { useSignal } from '@preact/signals';
import { asProblem } from '../api/problem';
import type { Alarm } from '../api/types';
import { useGateway } from '../gateway';
import { linePath, recorderPath } from '../router';
import { capital } from '../state/commander';
import { emptied } from '../state/persisted';
import { alarmWord, canAcknowledge, shelfTimes, subjectOf, withoutSubject } from '../text/alarm';
import { plain } from '../text/plain';
import { clockTime } from '../text/time';
import { Choice, quiet, Tell, TextField, type Told } from './form';
import { useBarred, Why } from './gate';
import { Empty } from './lines';
import { AxisName, DriveName } from './name';
import { Pill } from './pill';
import { Section } from './section';

export function AlarmSection() {
  const { store, client } = useGateway();
  const told = useSignal<Told>(quiet);
  const comment = useSignal('');
  const shelving = useSignal<number | null>(null);
  const no = useBarred('operator');
  const list = store.alarms.value;
  const all = list?.alarms ?? [];
  const open = all.filter(canAcknowledge);
  const act = async (what: () => Promise<unknown>, done: string) => {
    told.value = { tone: 'busy', text: 'Asking the gateway.' };
    try {
      await what();
      told.value = { tone: 'good', text: done };
      return true;
    } catch (error) {
      told.value = { tone: 'refused', text: capital(asProblem(error).words) };
      return false;
    }
  };
  return (
    <Section
      title={open.length === 0 ? 'Alarms' : `Alarms, ${open.length} not acknowledged`}
      beside={
        open.length > 0 ? (
          <span class="alarm-all">
            <input class="search" type="text" aria-label="Comment for the acknowledgement" placeholder="Comment" maxLength={200} value={comment.value} onInput={(e) => (comment.value = e.currentTarget.value)} />
            <button
              type="button"
              class="button primary"
              {...no}
              onClick={() => {
                const sent = comment.peek();
                void act(
                  () => client.acknowledgeAlarms(open.map((a) => a.id), sent.trim()),
                  open.length === 1 ? '1 alarm acknowledged.' : `${open.length} alarms acknowledged.`,
                ).then((good) => good && emptied(comment, sent));
              }}
            >
              Acknowledge all shown
            </button>
          </span>
        ) : undefined
      }
    >
      {all.length > 0 && <Why need="operator" what="Acknowledging and shelving" />}
      <div class="card">
        {list === null ? (
          <Empty text="Waiting for the gateway." />
        ) : all.length === 0 ? (
          <Empty text="No alarm. Everything that was is acknowledged." />
        ) : (
          <ul aria-label="Alarms">
            {all.map((a) => (
              <AlarmRow
                key={a.id}
                alarm={a}
                shelving={shelving.value === a.id}
                onShelving={(yes) => (shelving.value = yes ? a.id : null)}
                onAcknowledge={() => void act(() => client.acknowledgeAlarm(a.id, comment.peek().trim()), `Alarm of ${subjectOf(a)} acknowledged.`)}
                onShelve={async (for_s, reason) => {
                  if (await act(() => client.shelveAlarm(a.id, for_s, reason), `Alarm of ${subjectOf(a)} shelved.`)) shelving.value = null;
                }}
                onUnshelve={() => void act(() => client.unshelveAlarm(a.id), `Alarm of ${subjectOf(a)} is back from the shelf.`)}
              />
            ))}
          </ul>
        )}
        {(list?.dropped ?? 0) > 0 && <p class="empty">{list?.dropped} further alarms found the list full: acknowledge those that are cleared.</p>}
      </div>
      <Tell told={told.value} field="alarm-told" />
    </Section>
  );
}

interface RowProps {
  alarm: Alarm;
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
  return (
    <li class="row alarm-row" data-alarm={a.id} data-state={a.state}>
      <div class="alarm-line">
        <Pill word={alarmWord(a)} label="State" />
        <span class="alarm-what">
          {a.axis ? <AxisName name={a.axis} /> : a.drive ? <b><DriveName name={a.drive} /></b> : a.line ? <a href={linePath(a.line)}>{about}</a> : <b>{about}</b>} {plain(withoutSubject(a.text, about))}
          {a.code !== null && <span class="mono"> (code {a.code})</span>}
        </span>
        <span class="alarm-buttons">
          {a.axis && (
            <a class="button quiet" href={recorderPath('trends', a.axis, Date.parse(a.since))} aria-label={`Trends then, when the alarm of ${a.axis} came: ${a.text}`}>
              Trends then
            </a>
          )}
          {canAcknowledge(a) && (
            <button type="button" class="button" {...no} aria-label={`Acknowledge ${about}: ${a.text}`} onClick={p.onAcknowledge}>
              Acknowledge
            </button>
          )}
          {a.state === 'shelved' ? (
            <button type="button" class="button" {...no} aria-label={`Unshelve ${about}: ${a.text}`} onClick={p.onUnshelve}>
              Unshelve
            </button>
          ) : (
            <button type="button" class="button quiet" {...no} aria-expanded={p.shelving} aria-label={`Shelve ${about}: ${a.text}`} onClick={() => p.onShelving(!p.shelving)}>
              Shelve
            </button>
          )}
        </span>
      </div>
      <p class="where">
        Since <time dateTime={a.since}>{clockTime(a.since)}</time>
        {a.count > 1 && ` · ${a.count} times`}
        {a.cleared_at && ` · cleared ${clockTime(a.cleared_at)}`}
        {a.acknowledged_at && ` · acknowledged ${clockTime(a.acknowledged_at)} by ${a.acknowledged_by ?? 'nobody known'}${a.comment ? `: ${a.comment}` : ''}`}
        {a.shelved_until && ` · shelved until ${clockTime(a.shelved_until)} by ${a.shelved_by ?? 'nobody known'}: ${a.reason ?? ''}`}
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
      aria-label={`Shelve the alarm of ${about}`}
      onSubmit={(e) => {
        e.preventDefault();
        fault.value = reason.peek().trim() === '' ? 'Say why it may be silent' : '';
        if (fault.peek() === '') void onShelve(Number(for_s.peek()), reason.peek().trim());
      }}
    >
      <Choice label="For" value={for_s.value} choices={shelfTimes} onChoice={(v) => (for_s.value = v)} />
      <TextField label="Reason" value={reason.value} fault={fault.value || undefined} onText={(t) => (reason.value = t)} />
      <span class="alarm-buttons">
        <button type="submit" class="button primary">
          Put on the shelf
        </button>
        <button type="button" class="button quiet" onClick={onCancel}>
          Cancel
        </button>
      </span>
    </form>
  );
}
