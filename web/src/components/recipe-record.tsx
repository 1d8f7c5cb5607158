// Recording a recipe: while it is on, what is done to the chosen axes on any page or over any door is told by the gateway as steps. In: GET
// /recorder/steps, once a second. Out: the steps, added to the recipe when it is ended. It goes on while one looks at other pages: what is on is kept
// for the tab. Nothing is commanded from here, and nothing is saved.
import { t } from '../language';
import { marked } from './marked';
import { useSignal } from '@preact/signals';
import { asProblem } from '../api/problem';
import { RecorderDoor } from '../api/recorder';
import type { RecordedSteps } from '../api/types';
import { useDoor, useGateway } from '../gateway';
import { capital } from '../state/commander';
import { persisted } from '../state/persisted';
import { toggled } from '../state/toggled';
import { useRepeated } from '../state/repeated';
import { kindOf, stepLabel, stepSummary, type Step } from '../text/recipe';
import { clockTime } from '../text/time';
import { Icon } from './icon';
import { useNamed } from './name';
import { PressGroup } from './press-group';

const look_ms = 1_000;
const mostAxes = 64;
interface On {
  recipe: string;
  axes: string[];
  from_ms: number;
}
const stored = persisted('recipes.record');
function onNow(): On | null {
  try {
    const on = JSON.parse(stored.value) as On;
    return typeof on.recipe === 'string' && Array.isArray(on.axes) && Number.isFinite(on.from_ms) ? on : null;
  } catch {
    return null;
  }
}

/** `saved`: nothing is lost when the page is left. */
export function RecordPart({ recipe, persisted: saved, add }: { recipe: string; persisted: boolean; add: (steps: Step[]) => void }) {
  const { store } = useGateway();
  const door = useDoor(RecorderDoor);
  const named = useNamed();
  const chosen = useSignal<readonly string[] | null>(null);
  const now = useSignal<RecordedSteps | null>(null);
  const fault = useSignal('');
  const done = useSignal('');
  const on = onNow();
  const mine = on?.recipe === recipe;
  const axes = store.axisNames.value.slice(0, mostAxes);
  const picked = (chosen.value ?? axes).filter((a) => axes.includes(a));
  const reported = (error: unknown) => (fault.value = capital(asProblem(error).text));

  const look = async (end: AbortSignal) => {
    if (!on) return;
    try {
      const told = await door.steps(on.axes, on.from_ms);
      if (end.aborted) return;
      now.value = told;
      fault.value = '';
    } catch (error) {
      if (!end.aborted) reported(error);
    }
  };
  useRepeated(look, look_ms, mine, [door, on?.from_ms]);

  const begin = async () => {
    done.value = fault.value = '';
    now.value = null;
    try {
      const first = await door.steps(picked);
      stored.value = JSON.stringify({ recipe, axes: picked, from_ms: first.to } satisfies On);
    } catch (error) {
      reported(error);
    }
  };
  const end = async () => {
    if (!on) return;
    try {
      const all = await door.steps(on.axes, on.from_ms);
      stored.value = '';
      now.value = null;
      const steps = all.steps as unknown as Step[];
      if (steps.length > 0) add(steps);
      const count = steps.length === 0 ? t('Nothing was done to these axes.') : steps.length === 1 ? t('1 step is added; look at it, then save.') : t('{n} steps are added; look at them, then save.', { n: steps.length });
      done.value = [count, ...all.left_out.map((s) => t('Left out: {what}.', { what: s }))].join(' ');
    } catch (error) {
      reported(error); // it goes on: nothing is lost
    }
  };
  const steps = (now.value?.steps ?? []) as unknown as Step[];
  const late = now.value?.begins && on && Date.parse(now.value.begins) > on.from_ms ? now.value.begins : null;
  return (
    <div class="recipe-record" data-field="record" data-on={mine}>
      {!mine && (
        <details>
          <summary>{t('Record what is done by hand')}</summary>
          <p class="where">{t('Commands, actions, parameter writes and simulated faults of the chosen axes become steps, given on any page or over any door.')}</p>
          <PressGroup label={t('Axes that are recorded')} class="recorder-axes" of={axes.map((a) => ({ value: a, text: named(a), on: picked.includes(a) }))} press={(a) => (chosen.value = toggled(picked, a))} />
          <div class="recipe-buttons">
            <button type="button" class="button" disabled={!saved || picked.length === 0} onClick={() => void begin()}>
              <Icon name="play" /> {t('Record')}
            </button>
            <span class="where">{!saved ? t('Save first: what is not saved is lost when you go to another page.') : on ? t('This ends the recording for recipe {recipe}.', { recipe: on.recipe }) : ''}</span>
          </div>
        </details>
      )}
      {mine && on && (
        <div class="recording" role="group" aria-label={t('Recording')}>
          <p>
            <b>{t('Recording {axes} since {at}.', { axes: on.axes.map(named).join(', '), at: clockTime(new Date(on.from_ms).toISOString()) })}</b> {t('Do it now: on the page of an axis, on a panel, by a program.')}
          </p>
          <ol class="record-steps" aria-label={t('Steps so far')}>
            {steps.slice(-8).map((s, i) => (
              <li key={i}>
                <b>{stepLabel(kindOf(s)?.word ?? '')}</b> {stepSummary(s)}
              </li>
            ))}
          </ol>
          <p class="where" role="status">{steps.length === 1 ? t('1 step so far') : t('{n} steps so far', { n: steps.length })}</p>
          {late && <p class="step-fault">{t('The recorder remembers from {at} on: what was before is lost.', { at: clockTime(late) })}</p>}
          <div class="recipe-buttons">
            <button type="button" class="button primary" onClick={() => void end()}>
              <Icon name="stop" /> {t('End and add the steps')}
            </button>
            <button type="button" class="button quiet" onClick={() => (stored.value = '')}>
              {t('Throw away')}
            </button>
          </div>
        </div>
      )}
      {done.value && <p class="where" role="status">{done.value}</p>}
      {fault.value && <p class="step-fault" role="status">{marked(fault.value)}</p>}
    </div>
  );
}
