// Recordings: what is being recorded, a button that freezes it, the files that there are, and one of them played back.
// In: GET /recorder/recordings, with each connection and after each change. Out: requests, downloads.
import { t, theirs } from '../language';
import { marked } from './marked';
import { useSignal } from '@preact/signals';
import { useMemo } from 'preact/hooks';
import { RecorderDoor, recordingFile } from '../api/recorder';
import type { Recording, RecordingList } from '../api/types';
import { useGateway } from '../gateway';
import { capital } from '../state/commander';
import { bytesText, freeName, nameFault, recordingWord } from '../text/recorder';
import { dateTime } from '../text/time';
import { DeleteButton } from './ask';
import { quiet, Tell, TextField, type Reported } from './form';
import { Gate, useBarred } from './gate';
import { Empty } from './lines';
import { useLoaded } from './loaded';
import { Pill } from './pill';
import { PlaybackPart } from './playback';
import { RenameForm } from './rename-form';
import { Section } from './section';
import { tellOf } from './reported';

export function RecordingsPart({ first, at_ms }: { first?: string | undefined; at_ms?: number | undefined }) {
  const { client } = useGateway();
  const door = useMemo(() => new RecorderDoor(client), [client]);
  const list = useSignal<RecordingList | null>(null);
  const reported = useSignal<Reported>(quiet);
  const open = useSignal(first ?? '');
  const name = useSignal('');
  const why = useSignal('');
  const load = async () => void (list.value = await door.recordings());
  const waiting = useLoaded(load, [door]);
  const act = (what: () => Promise<unknown>, done: string) => tellOf(reported, t('Asking the gateway.'), what, done, load);
  const recordings = list.value?.recordings ?? [];
  const wanted = name.value || freeName('recording', recordings.map((r) => r.name));
  const fault = nameFault(wanted);
  const now = list.value;
  return (
    <>
      <Section title={t('Record what happened')}>
        <Gate need="operator">
          <form
            class="card form form-grid"
            noValidate
            aria-label={t('New recording')}
            onSubmit={(e) => {
              e.preventDefault();
              if (!fault)
                void act(() => door.record(wanted, why.value.trim()), t('{wanted} is written.', { wanted })).then((good) => {
                  if (good) name.value = why.value = '';
                });
            }}
          >
            <TextField label={t('Name')} value={name.value} placeholder={wanted} onText={(entered) => (name.value = entered)} fault={fault} />
            <TextField label={t('Why')} value={why.value} onText={(entered) => (why.value = entered)} />
            <div class="form-foot">
              <button type="submit" class="button primary" disabled={fault !== undefined}>
                {t('Freeze the last minutes')}
              </button>
              <span class="where">{now ? `${now.from ? `${t('since {from}', { from: dateTime(now.from) })}, ` : ''}${bytesText(now.bytes)}${now.not_replayable ? ` · ${t('to be read, not replayed: {why}', { why: now.not_replayable })}` : ` · ${t('replayable')}`}` : waiting}</span>
            </div>
          </form>
        </Gate>
        <Tell reported={reported.value} field="recording-told" />
      </Section>
      {open.value && <PlaybackPart key={open.value} name={open.value} at_ms={open.value === first ? at_ms : undefined} close={() => (open.value = '')} />}
      <Section title={recordings.length > 0 ? t('Recordings, {n}', { n: recordings.length }) : t('Recordings')} beside={now && <span class="where">{t('{disk_bytes} of {disk_most_bytes}', { disk_bytes: bytesText(now.disk_bytes), disk_most_bytes: bytesText(now.disk_most_bytes) })}</span>}>
        {now?.disk_fault && <p class="notice tone-fault">{marked(theirs(capital(now.disk_fault)))}</p>}
        {recordings.length === 0 ? (
          <Empty text={waiting || t('No recording yet. An alarm makes one by itself.')} />
        ) : (
          <ul class="card rows" aria-label={t('Recordings')}>
            {recordings.map((r) => (
              <RecordingRow key={r.name} recording={r} open={open.value === r.name} play={() => (open.value = open.peek() === r.name ? '' : r.name)} door={door} act={act} />
            ))}
          </ul>
        )}
      </Section>
    </>
  );
}

function RecordingRow({ recording: r, open, play, door, act }: { recording: Recording; open: boolean; play: () => void; door: RecorderDoor; act: (what: () => Promise<unknown>, done: string) => Promise<boolean> }) {
  const no = useBarred('operator');
  const renaming = useSignal(false);
  return (
    <li class="row recorder-row" data-recording={r.name}>
      <Pill word={recordingWord(r)} label={t('State')} />
      <span class="recorder-what">
        <b>{r.name}</b>
        <span class="where">
          {' '}
          {r.at ? dateTime(r.at) : ''} {bytesText(r.bytes)}
          {r.automatic ? ` · ${t('by an alarm')}` : ''}
          {r.why ? marked(` · ${r.automatic ? theirs(r.why) : r.why}`) : ''}
          {r.who ? ` · ${r.who}` : ''}
          {r.fault ? marked(` · ${theirs(r.fault)}`) : ''}
        </span>
      </span>
      <span class="recorder-buttons">
        {!r.fault && (
          <button type="button" class="button" aria-pressed={open} aria-label={t('Play back {name}', { name: r.name })} onClick={play}>
            {t('Play back')}
          </button>
        )}
        <a class="button" href={recordingFile(r.name)} download={`${r.name}.axr`} aria-label={t('Download {name}', { name: r.name })}>
          {t('Download')}
        </a>
        <button type="button" class="button quiet" {...no} aria-expanded={renaming.value} aria-label={t('Rename {name}', { name: r.name })} onClick={() => (renaming.value = !renaming.value)}>
          {t('Rename')}
        </button>
        <DeleteButton name={r.name} no={no} onYes={() => void act(() => door.remove('recordings', r.name), t('{name} is deleted.', { name: r.name }))} />
      </span>
      {renaming.value && <RenameForm name={r.name} rename={(to) => void act(() => door.rename('recordings', r.name, to), t('{name} is called {to} now.', { name: r.name, to })).then((good) => good && (renaming.value = false))} />}
    </li>
  );
}
