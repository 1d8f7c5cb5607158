// Increments: a small calculator beside the field that asks how many increments make one unit. In: the axis' unit. Out: the number, when it is taken.
import { useSignal } from '@preact/signals';
import { t } from '../language';
import { incrementsOf, incrementsText, plainMechanics, type Mechanics } from '../text/increments';
import { Choice, TextField } from './form';

export function Increments({ unit, onTake }: { unit: string; onTake: (text: string) => void }) {
  const m = useSignal<Mechanics>(plainMechanics);
  const by = useSignal<'steps' | 'counts'>('steps');
  const u = unit.trim() || t('unit of measurement');
  const reckoned = incrementsOf(m.value);
  const field = (key: keyof Mechanics, label: string, hint: string) => (
    <TextField
      label={label}
      number
      value={m.value[key]}
      onText={(text) => (m.value = { ...m.peek(), [key]: text })}
      hint={hint}
      fault={m.value[key].trim() !== '' && !reckoned.good && reckoned.errors.includes(key) ? t('A number above 0.') : undefined}
    />
  );
  return (
    <details class="increments" data-field="increments">
      <summary>{t('Work it out from motor, gear and screw')}</summary>
      <div class="form-grid">
        <Choice
          label={t('Counted in')}
          hint={t('one increment is one of these')}
          value={by.value}
          onChoice={(v) => {
            by.value = v === 'counts' ? 'counts' : 'steps';
            m.value = { ...m.peek(), microsteps: v === 'counts' ? '1' : '16', per_turn: v === 'counts' ? '4096' : '200' };
          }}
          choices={[
            { value: 'steps', text: t('steps') },
            { value: 'counts', text: t('encoder counts') },
          ]}
        />
        {by.value === 'steps'
          ? field('per_turn', t('Steps per revolution'), t('of the motor: 200 for 1.8° a step'))
          : field('per_turn', t('Counts per revolution'), t('of the encoder: four times its lines'))}
        {by.value === 'steps' && field('microsteps', t('Micro-steps'), t('as the drive is set'))}
        {field('motor_turns', t('Gear: motor turns'), t('5 for a gear of 5 : 1'))}
        {field('output_turns', t('Gear: output turns'), t('1 where there is no gear'))}
        {field('travel', t('Travel per output turn, {unit}', { unit: u }), t('pitch of the screw, circumference of the pulley, 360 for deg'))}
      </div>
      <p class="form-foot">
        <span role="status" data-field="increments-told">
          {reckoned.good ? t('{n} increments per {unit}', { n: incrementsText(reckoned.value), unit: u }) : t('Fill in the travel: the result stands here.')}
        </span>
        <button type="button" class="button small" disabled={!reckoned.good} onClick={() => reckoned.good && onTake(incrementsText(reckoned.value))}>
          {t('Take this number')}
        </button>
      </p>
    </details>
  );
}
