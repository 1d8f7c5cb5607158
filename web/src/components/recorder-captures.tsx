// Captures: the list of those that run and are kept, the form that arms one, and a plot of those that are drawn. In: GET /recorder/captures, twice a second
// while one runs. Out: requests. Rows are asked for when a capture is drawn, once.
import { useSignal } from '@preact/signals';
import { useEffect, useRef } from 'preact/hooks';
import { RecorderDoor } from '../api/recorder';
import type { Capture, CaptureList, CaptureWithRows } from '../api/types';
import { useDoor, useGateway } from '../gateway';
import { t, theirs } from '../language';
import { useRepeated } from '../state/repeated';
import { quiet, refusal, tellOf, type Reported } from '../state/reported';
import { captureAbout, captureWord, triggerText } from '../text/recorder';
import { dateTime } from '../text/time';
import { ArmForm } from './capture-arm';
import { Overlay } from './capture-overlay';
import { Tell } from './form';
import { Gate, useBarred } from './gate';
import { useLoaded } from './loaded';
import { marked } from './marked';
import { KeptSection, RecorderRow } from './recorder-row';
import { saveText } from './save';
import { Section } from './section';

const mostOverlaid = 4;
const look_ms = 500;

export function CapturesPart({ axis }: { axis: string | undefined }) {
  const { store } = useGateway();
  const door = useDoor(RecorderDoor);
  const list = useSignal<CaptureList | null>(null);
  const drawn = useSignal<readonly CaptureWithRows[]>([]);
  const reported = useSignal<Reported>(quiet);
  const load = async () => void (list.value = await door.captures());
  const waiting = useLoaded(load, [door]);
  const captures = list.value?.captures ?? [];
  const runs = captures.some((c) => c.state === 'armed' || c.state === 'triggered' || (c.state === 'done' && c.bytes === 0 && !c.fault));
  useRepeated(() => load().catch(() => undefined), look_ms, runs, [door]);
  const gone = (name: string) => (drawn.value = drawn.peek().filter((c) => c.name !== name));
  const show = async (name: string) => {
    if (drawn.peek().some((c) => c.name === name)) return void gone(name);
    try {
      const whole = await door.capture(name);
      drawn.value = [...drawn.peek().filter((c) => c.name !== name), whole].slice(-mostOverlaid);
      reported.value = quiet;
    } catch (error) {
      reported.value = refusal(error);
    }
  };
  const act = (what: () => Promise<unknown>, done: string) => tellOf(reported, t('Asking the gateway.'), what, done, load);
  // One that was just armed here is drawn when it is done.
  const mine = useRef('');
  useEffect(() => {
    const c = list.value?.captures.find((x) => x.name === mine.current);
    if (!c || c.state !== 'done') return;
    mine.current = '';
    void show(c.name);
  }, [list.value]);
  return (
    <>
      <Section title={t('New capture')}>
        <Gate need="operator">
          <ArmForm
            first={axis ?? store.axisNames.value[0] ?? ''}
            taken={captures.map((c) => c.name)}
            arm={(wish) => {
              mine.current = wish.name;
              return act(() => door.arm(wish), t('{name} is armed.', { name: wish.name }));
            }}
          />
        </Gate>
        <Tell reported={reported.value} field="capture-told" />
      </Section>
      {drawn.value.length > 0 && <Overlay captures={drawn.value} />}
      <KeptSection title={captures.length > 0 ? t('Captures, {n}', { n: captures.length }) : t('Captures')} name={t('Captures')} disk={list.value} n={captures.length} empty={waiting || t('No capture yet.')}>
        {captures.map((c) => (
          <CaptureRow key={c.name} capture={c} drawn={drawn.value.some((d) => d.name === c.name)} show={() => void show(c.name)} door={door} act={act} gone={gone} />
        ))}
      </KeptSection>
    </>
  );
}

function CaptureRow({ capture: c, drawn, show, door, act, gone }: { capture: Capture; drawn: boolean; show: () => void; door: RecorderDoor; act: (what: () => Promise<unknown>, done: string) => Promise<boolean>; gone: (name: string) => void }) {
  const no = useBarred('operator');
  const { name } = c;
  const unit = c.axes.find((a) => a.axis === c.trigger?.axis)?.unit ?? '';
  const runs = c.state === 'armed' || c.state === 'triggered';
  const whole = c.state === 'done' && !c.fault;
  const forget = (good: boolean) => {
    if (good) gone(name);
    return good;
  };
  const csv = () => void act(async () => saveText(`${name}.csv`, 'text/csv', await door.captureCsv(name)), t('{name}.csv is saved.', { name }));
  const remove = (done: string) => void act(() => door.remove('captures', name), done).then(forget);
  return (
    <RecorderRow
      name={name}
      word={captureWord(c)}
      marks={{ 'data-capture': name, 'data-state': c.state }}
      about={
        <>
          {c.triggered_at ? dateTime(c.triggered_at) : ''} {captureAbout(c)} · {triggerText(c.trigger, unit)}
          {c.why ? marked(` · ${theirs(c.why)}`) : ''}
        </>
      }
      buttons={
        whole && (
          <>
            <button type="button" class="button" aria-pressed={drawn} aria-label={t('Draw {name}', { name })} onClick={show}>
              {drawn ? t('Drawn') : t('Draw')}
            </button>
            <button type="button" class="button" aria-label={t('CSV of {name}', { name })} onClick={csv}>
              {t('CSV')}
            </button>
          </>
        )
      }
      renames={whole}
      rename={(to) => act(() => door.rename('captures', name, to), t('{name} is called {to} now.', { name, to })).then(forget)}
      instead={
        runs ? (
          <button type="button" class="button quiet" {...no} aria-label={t('Cancel {name}', { name })} onClick={() => remove(t('{name} is cancelled.', { name }))}>
            {t('Cancel')}
          </button>
        ) : undefined
      }
      remove={() => remove(t('{name} is deleted.', { name }))}
    />
  );
}
