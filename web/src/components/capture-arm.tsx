// Capture form: what is captured, of which axes, and what it begins with. In: the axis to begin with, the names that are taken. Out: the wish, when Arm is
// pressed and nothing in it is wrong. Never asks the gateway by itself.
import { useSignal } from '@preact/signals';
import type { CaptureTrigger, CaptureWish } from '../api/types';
import { useGateway } from '../gateway';
import { t } from '../language';
import { toggled } from '../state/toggled';
import { checkCapture, firstCapture, type CaptureTexts } from '../text/capture';
import { pointNames, points, pointUnit, stateNames, type TracePoint } from '../text/recorder';
import { Choice, TextField } from './form';
import { PressGroup } from './press-group';

const mostAxes = 8;
const mostOffered = 30;

export function ArmForm({ first, taken, arm }: { first: string; taken: readonly string[]; arm: (wish: CaptureWish) => Promise<boolean> }) {
  const { store } = useGateway();
  const texts = useSignal(firstCapture(first));
  const chosen = useSignal<readonly string[]>([]);
  const f = texts.value;
  const set = (part: Partial<CaptureTexts>) => (texts.value = { ...texts.peek(), ...part });
  const names = store.axisNames.value;
  const axis = names.includes(f.axis) ? f.axis : (names[0] ?? '');
  const entry = store.axis(axis)?.value.data;
  const others = names.filter((n) => n !== axis && store.axis(n)?.peek()?.data.line === entry?.line);
  const more = chosen.value.filter((n) => others.includes(n));
  const { name, wish, faults } = checkCapture(f, axis, more, taken);
  const text = (field: 'rate' | 'before' | 'after' | 'wait' | 'level') => ({ number: true, value: f[field], onText: (entered: string) => set({ [field]: entered }), fault: faults[field] });
  const edge = (rising: string, falling: string) => <Choice label={t('Edge')} value={f.edge} onChoice={(x) => set({ edge: x as 'rising' })} choices={[{ value: 'rising', text: rising }, { value: 'falling', text: falling }]} />;
  return (
    <form
      class="card form form-grid capture-form"
      noValidate
      aria-label={t('New capture')}
      onSubmit={(e) => {
        e.preventDefault();
        if (wish) void arm(wish).then((done) => done && set({ name: '' }));
      }}
    >
      <TextField label={t('Name')} value={f.name} placeholder={name} onText={(entered) => set({ name: entered })} fault={faults.name} />
      <Choice label={t('Axis')} value={axis} onChoice={(x) => set({ axis: x })} choices={names.map((n) => ({ value: n, text: n }))} />
      <Choice
        label={t('Begins with')}
        value={f.kind}
        onChoice={(x) => set({ kind: x as CaptureTrigger['kind'] })}
        choices={[
          { value: 'command', text: t('a command that moves it') },
          { value: 'level', text: t('a level') },
          { value: 'state', text: t('a state') },
          { value: 'at_once', text: t('now') },
        ]}
      />
      {f.kind === 'level' && (
        <>
          <Choice label={t('Point')} value={f.point} onChoice={(x) => set({ point: x as TracePoint })} choices={points.map((p) => ({ value: p, text: pointNames[p] }))} />
          {edge(t('rises through'), t('falls through'))}
          <TextField label={t('Level, {n}', { n: pointUnit(f.point, entry?.unit ?? '') })} {...text('level')} />
        </>
      )}
      {f.kind === 'state' && (
        <>
          <Choice label={t('State')} value={f.state} onChoice={(x) => set({ state: x as 'moving' })} choices={Object.entries(stateNames).map(([value, text]) => ({ value, text }))} />
          {edge(t('comes'), t('goes'))}
        </>
      )}
      <TextField label={t('Before it, ms')} {...text('before')} />
      <TextField label={t('After it, ms')} {...text('after')} />
      <TextField label={t('Rate, Hz')} {...text('rate')} hint={t('The line may have room for less; the others on it are asked as before.')} />
      <TextField label={t('Wait for it at most, s')} {...text('wait')} />
      {others.length > 0 && (
        <PressGroup
          label={t('More axes of this line')}
          class="recorder-axes"
          of={others.slice(0, mostOffered).map((n) => ({ value: n, text: n, on: more.includes(n), disabled: !more.includes(n) && more.length >= mostAxes - 1 }))}
          press={(n) => (chosen.value = toggled(more, n))}
        />
      )}
      <div class="form-foot">
        <button type="submit" class="button primary" disabled={!wish}>
          {t('Arm')}
        </button>
      </div>
    </form>
  );
}
