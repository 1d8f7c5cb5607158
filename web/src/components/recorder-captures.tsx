// Captures: a form that arms one, the list of those that run and are kept, and a plot of one or of several laid over each other at their
// triggers. In: GET /recorder/captures, twice a second while one runs. Out: requests. Rows are asked for when a capture is drawn, once.
import { t, theirs } from '../language';
import { marked } from './marked';
import { useSignal } from '@preact/signals';
import { useEffect, useMemo, useRef } from 'preact/hooks';
import { RecorderDoor } from '../api/recorder';
import type { Capture, CaptureList, CaptureTrigger, CaptureWish, CaptureWithRows } from '../api/types';
import { useGateway } from '../gateway';
import { capital } from '../state/commander';
import { persisted } from '../state/persisted';
import { readAt } from '../state/plot';
import { captureParts, joined } from '../state/recorder';
import { parseNumber, parseQuantity } from '../text/number';
import { bytesText, captureAbout, captureWord, freeName, levelText, nameFault, pointNames, points, pointUnit, sinceText, stateNames, triggerText, type TracePoint } from '../text/recorder';
import { dateTime } from '../text/time';
import { DeleteButton } from './ask';
import { Choice, quiet, Tell, TextField, type Reported } from './form';
import { Gate, useBarred } from './gate';
import { Empty } from './lines';
import { useLoaded } from './loaded';
import { Pill } from './pill';
import { CursorTable, Plot, PlotButtons, PlotView } from './plot';
import { scaleOf, toggled, traceCurves } from './recorder-trends';
import { RenameForm } from './rename-form';
import { saveText } from './save';
import { Section } from './section';
import { refusal, tellOf } from './reported';

export const mostOverlaid = 4;
const chosenPoints = persisted('captures.points', 'position,following_error', 'browser');

export function CapturesPart({ axis }: { axis: string | undefined }) {
  const { client, store } = useGateway();
  const door = useMemo(() => new RecorderDoor(client), [client]);
  const list = useSignal<CaptureList | null>(null);
  const drawn = useSignal<readonly CaptureWithRows[]>([]);
  const reported = useSignal<Reported>(quiet);
  const load = async () => void (list.value = await door.captures());
  const waiting = useLoaded(load, [door]);
  const runs = list.value?.captures.some((c) => c.state === 'armed' || c.state === 'triggered' || (c.state === 'done' && c.bytes === 0 && !c.fault)) ?? false;
  useEffect(() => {
    if (!runs) return;
    const timer = setInterval(() => void load().catch(() => undefined), 500);
    return () => clearInterval(timer);
  }, [door, runs]);
  const show = async (name: string) => {
    if (drawn.peek().some((c) => c.name === name)) return void (drawn.value = drawn.peek().filter((c) => c.name !== name));
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
  const captures = list.value?.captures ?? [];
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
      <Section title={captures.length > 0 ? t('Captures, {n}', { n: captures.length }) : t('Captures')} beside={list.value && <span class="where">{t('{disk_bytes} of {disk_most_bytes}', { disk_bytes: bytesText(list.value.disk_bytes), disk_most_bytes: bytesText(list.value.disk_most_bytes) })}</span>}>
        {list.value?.disk_fault && <p class="notice tone-fault">{marked(theirs(capital(list.value.disk_fault)))}</p>}
        {captures.length === 0 ? (
          <Empty text={waiting || t('No capture yet.')} />
        ) : (
          <ul class="card rows" aria-label={t('Captures')}>
            {captures.map((c) => (
              <CaptureRow key={c.name} capture={c} drawn={drawn.value.some((d) => d.name === c.name)} show={() => void show(c.name)} door={door} act={act} gone={(name) => (drawn.value = drawn.peek().filter((d) => d.name !== name))} />
            ))}
          </ul>
        )}
      </Section>
    </>
  );
}

function CaptureRow({ capture: c, drawn, show, door, act, gone }: { capture: Capture; drawn: boolean; show: () => void; door: RecorderDoor; act: (what: () => Promise<unknown>, done: string) => Promise<boolean>; gone: (name: string) => void }) {
  const no = useBarred('operator');
  const renaming = useSignal(false);
  const runs = c.state === 'armed' || c.state === 'triggered';
  const unit = c.axes.find((a) => a.axis === c.trigger?.axis)?.unit ?? '';
  const csv = () => void act(async () => saveText(`${c.name}.csv`, 'text/csv', await door.captureCsv(c.name)), t('{name}.csv is saved.', { name: c.name }));
  const remove = (done: string) => void act(() => door.remove('captures', c.name), done).then((good) => good && gone(c.name));
  return (
    <li class="row recorder-row" data-capture={c.name} data-state={c.state}>
      <Pill word={captureWord(c)} label={t('State')} />
      <span class="recorder-what">
        <b>{c.name}</b>
        <span class="where">
          {' '}
          {c.triggered_at ? dateTime(c.triggered_at) : ''} {captureAbout(c)} · {triggerText(c.trigger, unit)}
          {c.why ? marked(` · ${theirs(c.why)}`) : ''}
        </span>
      </span>
      <span class="recorder-buttons">
        {c.state === 'done' && !c.fault && (
          <>
            <button type="button" class="button" aria-pressed={drawn} aria-label={t('Draw {name}', { name: c.name })} onClick={show}>
              {drawn ? t('Drawn') : t('Draw')}
            </button>
            <button type="button" class="button" aria-label={t('CSV of {name}', { name: c.name })} onClick={csv}>
              {t('CSV')}
            </button>
            <button type="button" class="button quiet" {...no} aria-expanded={renaming.value} aria-label={t('Rename {name}', { name: c.name })} onClick={() => (renaming.value = !renaming.value)}>
              {t('Rename')}
            </button>
          </>
        )}
        {runs ? (
          <button type="button" class="button quiet" {...no} aria-label={t('Cancel {name}', { name: c.name })} onClick={() => remove(t('{name} is cancelled.', { name: c.name }))}>
            {t('Cancel')}
          </button>
        ) : (
          <DeleteButton name={c.name} no={no} onYes={() => remove(t('{name} is deleted.', { name: c.name }))} />
        )}
      </span>
      {renaming.value && (
        <RenameForm
          name={c.name}
          rename={(to) =>
            void act(() => door.rename('captures', c.name, to), t('{name} is called {to} now.', { name: c.name, to })).then((good) => {
              if (good) renaming.value = false;
              if (good) gone(c.name);
            })
          }
        />
      )}
    </li>
  );
}

export function Overlay({ captures }: { captures: readonly CaptureWithRows[] }) {
  const view = useRef<PlotView>(null as unknown as PlotView);
  view.current ??= new PlotView();
  const v = view.current;
  const seen = points.filter((p) => chosenPoints.value.split(',').includes(p));
  const several = captures.length > 1;
  const key = captures.map((c) => c.name).join() + seen.join();
  const levels = captures.flatMap((c) => {
    const trigger = c.trigger;
    const unit = c.axes.find((a) => a.axis === trigger?.axis)?.unit ?? '';
    if (trigger?.kind !== 'level' || !trigger.point || !seen.some((p) => scaleOf(p, unit) === scaleOf(trigger.point as TracePoint, unit))) return [];
    return [{ scale: scaleOf(trigger.point, unit), value: trigger.level ?? 0, text: levelText(trigger, unit) }];
  });
  const { data, curves } = useMemo(() => {
    const list = traceCurves(captures.flatMap((c) => c.columns.map((x) => ({ id: `${c.name} ${x.axis}`, name: `${several ? `${c.name}: ` : ''}${x.axis}`, unit: x.unit }))), seen);
    return { data: joined(captures.flatMap((c) => captureParts(c, seen))), curves: list };
  }, [key]);
  useEffect(() => {
    const low = data.at[0] ?? 0;
    const high = data.at.at(-1) ?? 1;
    v.whole.value = [low, Math.max(high, low + 0.001)];
    v.all();
  }, [captures.map((c) => c.name).join()]);
  return (
    <Section title={several ? t('Laid over each other at their triggers') : t('Capture {n}', { n: captures[0]?.name ?? '' })}>
      <div class="scope card recorder-plot" data-field="overlay">
        <div class="scope-head">
          <div class="group scope-channels" role="group" aria-label={t('Points of the captures')}>
            {points.map((p) => (
              <button key={p} type="button" class="button small" aria-pressed={seen.includes(p)} onClick={() => (chosenPoints.value = toggled(seen, p).join(',') || p)}>
                {pointNames[p]}
              </button>
            ))}
          </div>
          <PlotButtons view={v} />
        </div>
        <Plot
          zoomable
          view={v}
          curves={curves}
          data={() => [data.at, ...data.columns] as never}
          version={key}
          marks={[{ at: 0, text: t('trigger') }]}
          levels={levels}
          timeText={(entered, _end, span) => sinceText(entered, span)}
          label={t('Captures {n}, seconds from the trigger. Drag to come closer, 0 shows all. Arrow keys move the cursor {n2}, Delete takes it away.', { n: captures.map((c) => c.name).join(', '), n2: v.active.value === 0 ? 'A' : 'B' })}
        />
        {levels.length > 0 && (
          <p class="where" data-field="levels">
            {t('Level of the trigger, drawn across: {levels}', { levels: levels.map((l) => l.text).join(', ') })}
          </p>
        )}
        <ul class="curve-list" aria-label={t('Curves')}>
          {curves.map((c) => (
            <li key={c.id} class={`curve-key ink${c.color}`}>
              {c.name}
            </li>
          ))}
        </ul>
        <CursorTable view={v} curves={curves} read={(c, entered) => readAt(data.at, data.columns[curves.indexOf(c)] ?? [], entered)} clock={(entered) => sinceText(entered, 0.1)} />
      </div>
    </Section>
  );
}
function ArmForm({ first, taken, arm }: { first: string; taken: readonly string[]; arm: (wish: CaptureWish) => Promise<boolean> }) {
  const { store } = useGateway();
  const f = {
    name: useSignal(''),
    axis: useSignal(first),
    more: useSignal<readonly string[]>([]),
    rate: useSignal('1000'),
    before: useSignal('200'),
    after: useSignal('1000'),
    wait: useSignal('60'),
    kind: useSignal<CaptureTrigger['kind']>('command'),
    point: useSignal<TracePoint>('position'),
    edge: useSignal<'rising' | 'falling'>('rising'),
    level: useSignal('0'),
    state: useSignal<keyof typeof stateNames>('moving'),
  };
  const names = store.axisNames.value;
  const axis = names.includes(f.axis.value) ? f.axis.value : (names[0] ?? '');
  const entry = store.axis(axis)?.value.data;
  const lineOf = (n: string) => store.axis(n)?.peek()?.data.line;
  const others = names.filter((n) => n !== axis && lineOf(n) === entry?.line);
  const more = f.more.value.filter((n) => others.includes(n));
  const name = f.name.value || freeName('capture', taken);
  const read = (text: string, low: number, high: number, what: string) => {
    const p = parseQuantity(text);
    if (!p.good) return { value: 0, fault: p.why };
    return p.value >= low && p.value <= high ? { value: p.value, fault: undefined } : { value: p.value, fault: t('{what} is {low} to {high}.', { what, low, high }) };
  };
  const rate = read(f.rate.value, 1, 1000, t('The rate'));
  const before = read(f.before.value, 0, 120_000, t('The time before'));
  const after = read(f.after.value, 1, 120_000, t('The time after'));
  const wait = read(f.wait.value, 0.1, 300, t('The wait'));
  const level = f.kind.value === 'level' ? parseNumber(f.level.value) : { good: true as const, value: 0 };
  const wrongName = nameFault(name) ?? (taken.includes(name) ? t('There is one of this name.') : undefined);
  const good = !wrongName && level.good && [rate, before, after, wait].every((x) => x.fault === undefined) && axis !== '';
  const unit = entry?.unit ?? '';
  const submit = () => {
    if (!good) return;
    const trigger: CaptureTrigger =
      f.kind.value === 'level' ? { kind: 'level', axis, point: f.point.value, edge: f.edge.value, level: level.good ? level.value : 0 } : f.kind.value === 'state' ? { kind: 'state', axis, state: f.state.value, edge: f.edge.value } : { kind: f.kind.value, axis };
    void arm({ name, axes: [axis, ...more], rate_hz: Math.round(rate.value), before_ms: Math.round(before.value), after_ms: Math.round(after.value), wait_ms: Math.round(wait.value * 1000), trigger }).then((done) => {
      if (done) f.name.value = '';
    });
  };
  return (
    <form
      class="card form form-grid capture-form"
      noValidate
      aria-label={t('New capture')}
      onSubmit={(e) => {
        e.preventDefault();
        submit();
      }}
    >
      <TextField label={t('Name')} value={f.name.value} placeholder={name} onText={(entered) => (f.name.value = entered)} fault={wrongName} />
      <Choice label={t('Axis')} value={axis} onChoice={(x) => (f.axis.value = x)} choices={names.map((n) => ({ value: n, text: n }))} />
      <Choice
        label={t('Begins with')}
        value={f.kind.value}
        onChoice={(x) => (f.kind.value = x as CaptureTrigger['kind'])}
        choices={[
          { value: 'command', text: t('a command that moves it') },
          { value: 'level', text: t('a level') },
          { value: 'state', text: t('a state') },
          { value: 'at_once', text: t('now') },
        ]}
      />
      {f.kind.value === 'level' && (
        <>
          <Choice label={t('Point')} value={f.point.value} onChoice={(x) => (f.point.value = x as TracePoint)} choices={points.map((p) => ({ value: p, text: pointNames[p] }))} />
          <Choice label={t('Edge')} value={f.edge.value} onChoice={(x) => (f.edge.value = x as 'rising')} choices={[{ value: 'rising', text: t('rises through') }, { value: 'falling', text: t('falls through') }]} />
          <TextField label={t('Level, {n}', { n: pointUnit(f.point.value, unit) })} number value={f.level.value} onText={(entered) => (f.level.value = entered)} fault={level.good ? undefined : level.why} />
        </>
      )}
      {f.kind.value === 'state' && (
        <>
          <Choice label={t('State')} value={f.state.value} onChoice={(x) => (f.state.value = x as 'moving')} choices={Object.entries(stateNames).map(([value, text]) => ({ value, text }))} />
          <Choice label={t('Edge')} value={f.edge.value} onChoice={(x) => (f.edge.value = x as 'rising')} choices={[{ value: 'rising', text: t('comes') }, { value: 'falling', text: t('goes') }]} />
        </>
      )}
      <TextField label={t('Before it, ms')} number value={f.before.value} onText={(entered) => (f.before.value = entered)} fault={before.fault} />
      <TextField label={t('After it, ms')} number value={f.after.value} onText={(entered) => (f.after.value = entered)} fault={after.fault} />
      <TextField label={t('Rate, Hz')} number value={f.rate.value} onText={(entered) => (f.rate.value = entered)} fault={rate.fault} hint={t('The line may have room for less; the others on it are asked as before.')} />
      <TextField label={t('Wait for it at most, s')} number value={f.wait.value} onText={(entered) => (f.wait.value = entered)} fault={wait.fault} />
      {others.length > 0 && (
        <div class="group recorder-axes" role="group" aria-label={t('More axes of this line')}>
          {others.slice(0, 30).map((n) => (
            <button key={n} type="button" class="button small" aria-pressed={more.includes(n)} disabled={!more.includes(n) && more.length >= 7} onClick={() => (f.more.value = more.includes(n) ? more.filter((x) => x !== n) : [...more, n])}>
              {n}
            </button>
          ))}
        </div>
      )}
      <div class="form-foot">
        <button type="submit" class="button primary" disabled={!good}>
          {t('Arm')}
        </button>
      </div>
    </form>
  );
}
