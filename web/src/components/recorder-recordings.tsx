// Recordings: what is being recorded, a button that freezes it, the files that there are, and one of them played back.
// In: GET /recorder/recordings, with each connection and after each change. Out: requests, downloads.
import { useSignal } from '@preact/signals';
import { RecorderDoor, recordingFile } from '../api/recorder';
import type { Recording, RecordingList } from '../api/types';
import { useDoor } from '../gateway';
import { t, theirs } from '../language';
import { quiet, tellOf, type Reported } from '../state/reported';
import { bytesText, freeName, nameFault, recordingWord } from '../text/recorder';
import { dateTime } from '../text/time';
import { Tell, TextField } from './form';
import { Gate } from './gate';
import { useLoaded } from './loaded';
import { marked } from './marked';
import { PlaybackPart } from './playback';
import { KeptSection, RecorderRow } from './recorder-row';
import { Section } from './section';

export function RecordingsPart({ first, at_ms }: { first?: string | undefined; at_ms?: number | undefined }) {
  const door = useDoor(RecorderDoor);
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
      <KeptSection title={recordings.length > 0 ? t('Recordings, {n}', { n: recordings.length }) : t('Recordings')} name={t('Recordings')} disk={now} n={recordings.length} empty={waiting || t('No recording yet. An alarm makes one by itself.')}>
        {recordings.map((r) => (
          <RecordingRow key={r.name} recording={r} open={open.value === r.name} play={() => (open.value = open.peek() === r.name ? '' : r.name)} door={door} act={act} />
        ))}
      </KeptSection>
    </>
  );
}

function RecordingRow({ recording: r, open, play, door, act }: { recording: Recording; open: boolean; play: () => void; door: RecorderDoor; act: (what: () => Promise<unknown>, done: string) => Promise<boolean> }) {
  const { name } = r;
  return (
    <RecorderRow
      name={name}
      word={recordingWord(r)}
      marks={{ 'data-recording': name }}
      about={
        <>
          {r.at ? dateTime(r.at) : ''} {bytesText(r.bytes)}
          {r.automatic ? ` · ${t('by an alarm')}` : ''}
          {r.why ? marked(` · ${r.automatic ? theirs(r.why) : r.why}`) : ''}
          {r.who ? ` · ${r.who}` : ''}
          {r.fault ? marked(` · ${theirs(r.fault)}`) : ''}
        </>
      }
      buttons={
        <>
          {!r.fault && (
            <button type="button" class="button" aria-pressed={open} aria-label={t('Play back {name}', { name })} onClick={play}>
              {t('Play back')}
            </button>
          )}
          <a class="button" href={recordingFile(name)} download={`${name}.axr`} aria-label={t('Download {name}', { name })}>
            {t('Download')}
          </a>
        </>
      }
      rename={(to) => act(() => door.rename('recordings', name, to), t('{name} is called {to} now.', { name, to }))}
      remove={() => void act(() => door.remove('recordings', name), t('{name} is deleted.', { name }))}
    />
  );
}
