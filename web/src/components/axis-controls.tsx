// Axis controls: what a person can tell an axis: power, motion, jog, stops. In: the axis' name and unit. Out: commands; the answer in
// words underneath. Whether the axis may do it is for the gateway to say: nothing is greyed by guesswork, a refusal tells its reason.
import { useSignal } from '@preact/signals';
import { marked } from './marked';
import { useId, useMemo } from 'preact/hooks';
import type { Axis } from '../api/types';
import { useGateway } from '../gateway';
import { t } from '../language';
import type { Commander } from '../state/commander';
import { AxisOrders } from '../state/axis-orders';
import { setPositionText } from '../text/axis';
import { Ask } from './ask';
import { Field } from './field';
import { Icon } from './icon';
import { useBarred, Why } from './gate';
import { HelpButton } from './help-button';
import { JogButton } from './jog-button';

function useOrders(axis: Axis): AxisOrders {
  const { commander } = useGateway();
  return useMemo(() => new AxisOrders(commander, axis), [commander, axis.name, axis.unit]);
}

export const resultId = (axis: string): string => `result-${axis}`;

/** `by`: who was told; without it, this gateway's own axes are meant. */
export function ResultLine({ axis, id, by }: { axis: string; id: string; by?: Commander }) {
  const note = (by ?? useGateway().commander).note(axis).value;
  return (
    <p class={`result result-${note.tone}`} id={id} role="status" title={note.text}>
      {(note.tone === 'refused' || note.tone === 'partly') && <Icon name="triangle" size={14} />}
      {note.tone === 'good' && <Icon name="check" size={14} />}
      <span>{marked(note.text)}</span>
    </p>
  );
}

/** The compact form, for a tile. `bare`: power and stops alone. */
export function TileControls({ axis, bare }: { axis: Axis; bare: boolean }) {
  const c = useOrders(axis);
  const no = useBarred('operator');
  const name = axis.name;
  const error = c.error.value;
  const result = resultId(name);
  return (
    <div class="controls">
      {!bare && (
        <div class="control-rows">
          <Field label={t('Target')} longLabel={t('Target of {name}', { name })} unit={c.unit} text={c.fields.target} invalid={error === 'target'} describedBy={result} onEnter={() => c.move('move_absolute')} />
          <button type="button" class="button tinted" aria-label={t('Move to target of {name}', { name })} {...no} onClick={() => c.move('move_absolute')}>{t('Move to')}</button>
          <Field label={t('Distance')} longLabel={t('Distance of {name}', { name })} unit={c.unit} text={c.fields.distance} invalid={error === 'distance'} describedBy={result} onEnter={() => c.move('move_relative')} />
          <button type="button" class="button" aria-label={t('Move by distance of {name}', { name })} {...no} onClick={() => c.move('move_relative')}>{t('Move by')}</button>
          <Field label={t('Speed')} longLabel={t('Speed of {name}', { name })} unit={`${c.unit}/s`} text={c.fields.speed} invalid={error === 'speed'} describedBy={result} placeholder={t('as is')} />
          <span class="pair">
            <JogButton axis={name} direction={-1} speed={c.jogSpeed} unit={c.unit} />
            <JogButton axis={name} direction={1} speed={c.jogSpeed} unit={c.unit} />
          </span>
        </div>
      )}
      <div class="control-power">
        <span class="group">
          <button type="button" class="button" aria-label={t('Enable {name}', { name })} {...no} onClick={() => c.simple('enable', t('Enable'))}>{t('Enable')}</button>
          <button type="button" class="button" aria-label={t('Disable {name}', { name })} title={t('Takes the power off at once; the shaft is free')} {...no} onClick={() => c.simple('disable', t('Disable'))}>{t('Disable')}</button>
        </span>
        <button type="button" class="button" aria-label={t('Reset fault of {name}', { name })} {...no} onClick={() => c.simple('reset_fault', t('Reset fault'))}>{t('Reset')}</button>
        <button type="button" class="button" aria-label={t('Halt {name}', { name })} title={t('Stop on the profile ramp, stay enabled')} onClick={() => c.simple('halt', t('Halt'))}>{t('Halt')}</button>
      </div>
    </div>
  );
}

/** The present position gets another name, after a question: what counts from the zero moves with it. */
function SetPosition({ name, c, describedBy }: { name: string; c: AxisOrders; describedBy: string }) {
  const { store } = useGateway();
  const no = useBarred('operator');
  const asked = useSignal<number | null>(null);
  const ask = () => void (asked.value = c.newPosition());
  const now = asked.value === null ? undefined : store.axis(name)?.value.data;
  const text = now ? setPositionText(now, asked.value as number) : '';
  return (
    <>
      <div class="control-rows">
        <Field label={t('Position')} longLabel={t('What the present position shall be called')} unit={c.unit} text={c.fields.zero} invalid={c.error.value === 'zero'} describedBy={describedBy} placeholder={t('new value')} onEnter={ask} />
        <button type="button" class="button" title={t('Calls the present position this, after a question; nothing moves')} {...no} onClick={ask}>{t('Set position …')}</button>
      </div>
      {now && (
        <Ask
          field="set-position"
          text={text}
          yes={t('Set position')}
          onNo={() => (asked.value = null)}
          onYes={() => {
            c.setPosition(asked.peek() as number);
            asked.value = null;
          }}
        />
      )}
    </>
  );
}

/** The whole form, for the page of an axis. */
export function FullControls({ axis }: { axis: Axis }) {
  const c = useOrders(axis);
  const no = useBarred('operator');
  const result = useId();
  const name = axis.name;
  const error = c.error.value;
  const u = c.unit;
  return (
    <div class="controls controls-full">
      <Why need="operator" what={t('Every command but a stop')} />
      <div class="control-power">
        <span class="group">
          <button type="button" class="button" {...no} onClick={() => c.simple('enable', t('Enable'))}>{t('Enable')}</button>
          <button type="button" class="button" title={t('Takes the power off at once; the shaft is free')} {...no} onClick={() => c.simple('disable', t('Disable'))}>{t('Disable')}</button>
        </span>
        <button type="button" class="button" {...no} onClick={() => c.simple('reset_fault', t('Reset fault'))}>{t('Reset fault')}</button>
        <button type="button" class="button" title={t('Stop on the profile ramp, stay enabled')} onClick={() => c.simple('halt', t('Halt'))}>{t('Halt')}</button>
        <button type="button" class="button" title={t('Stop on the quick-stop ramp; enable to go on')} onClick={() => c.simple('quick_stop', t('Quick stop'))}>{t('Quick stop')}</button>
        <button type="button" class="button" title={t('Homing, by the drive\'s own method')} {...no} onClick={() => c.simple('home', t('Home'))}>{t('Home')}</button>
      </div>
      <p class="where stops-told">
        {t('Halt slows down on the profile ramp and stays enabled. Quick stop, STOP and Esc slow down on the quick-stop ramp; enable to go on. Disable takes the power off at once.')}{' '}
        <HelpButton of={t('the controls')}>
          {t('Enable gives power: the axis holds its place and follows commands. Reset fault clears a fault whose cause is gone. Home looks for the zero by the method of the drive. Move to goes to the target, the buttons by go that far from here, Jog moves while it is held. Speed, acceleration and deceleration that are left empty are as the drive has them. Set position gives the present place another name; nothing moves.')}
        </HelpButton>
      </p>
      <div class="control-rows">
        <Field label={t('Target')} unit={u} text={c.fields.target} invalid={error === 'target'} describedBy={result} onEnter={() => c.move('move_absolute')} />
        <button type="button" class="button primary" {...no} onClick={() => c.move('move_absolute')}>{t('Move to')}</button>
        <Field label={t('Distance')} unit={u} text={c.fields.distance} invalid={error === 'distance'} describedBy={result} onEnter={() => c.move('move_relative')} />
        <span class="pair">
          <button type="button" class="button" aria-label={t('Move back by distance')} {...no} onClick={() => c.move('move_relative', -1)}>{t('− by')}</button>
          <button type="button" class="button" aria-label={t('Move forward by distance')} {...no} onClick={() => c.move('move_relative')}>{t('+ by')}</button>
        </span>
        <Field label={t('Speed')} unit={`${u}/s`} text={c.fields.speed} invalid={error === 'speed'} describedBy={result} placeholder={t('as is')} />
        <span class="pair">
          <JogButton axis={name} direction={-1} speed={c.jogSpeed} unit={u} />
          <JogButton axis={name} direction={1} speed={c.jogSpeed} unit={u} />
        </span>
      </div>
      <div class="control-ramps">
        <Field label={t('Accel.')} longLabel={t('Acceleration')} unit={`${u}/s²`} text={c.fields.acceleration} invalid={error === 'acceleration'} describedBy={result} placeholder={t('as is')} />
        <Field label={t('Decel.')} longLabel={t('Deceleration')} unit={`${u}/s²`} text={c.fields.deceleration} invalid={error === 'deceleration'} describedBy={result} placeholder={t('as is')} />
      </div>
      <SetPosition name={name} c={c} describedBy={result} />
      <ResultLine axis={name} id={result} />
    </div>
  );
}
