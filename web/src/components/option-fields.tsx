// Option fields: what `options` of a line or drive may say, one typed field for each option that the family has, and what is there besides.
// In: the family's catalogue, the texts. Out: what is typed. Nothing is left out unseen: an option that the family does not know is shown, and says so.
import { t } from '../language';
import { useSignal } from '@preact/signals';
import { useRef } from 'preact/hooks';
import { optionField, optionFault, optionPrefix, optionsTitle, unknownOptions, type OptionSpec } from '../text/options';
import type { Room, Texts } from '../text/site';
import { Choice, TextField } from './form';

interface Props {
  room: Room;
  family: string;
  specs: readonly OptionSpec[];
  texts: Texts;
  onText: (key: string, text: string | null) => void;
  fault: (key: string) => string | undefined;
}

export function OptionFields({ room, family, specs, texts, onText, fault }: Props) {
  const name = useSignal('');
  const error = useSignal('');
  const others = unknownOptions(texts, specs);
  const faultOf = (o: OptionSpec) => optionFault(o, texts[optionPrefix + o.name] ?? '') || fault(optionPrefix + o.name);
  // Opened once it stays: a fault that is mended while one types must not shut it.
  const open = useRef(false);
  open.current ||= specs.some((o) => faultOf(o)) || others.length > 0;
  const add = () => {
    const n = name.value.trim();
    error.value = n === '' ? t('What is it called?') : optionPrefix + n in texts || specs.some((o) => o.name === n) ? t('{n} is here already.', { n }) : '';
    if (error.value) return;
    onText(optionPrefix + n, '');
    name.value = '';
  };
  return (
    <details class="option-fields" data-field="options" open={open.current || undefined}>
      <summary>{optionsTitle(family, specs, texts)}</summary>
      {specs.length === 0 && <p class="where">{family ? t('The gateway tells no options of {family}.', { family }) : t('Which options there are depends on the family: choose it first.')}</p>}
      <div class="form-grid">
        {specs.map((o) => {
          const f = optionField(o, room);
          const common = { label: f.label, hint: f.hint, fault: faultOf(o) || undefined, class: 'option' };
          const value = texts[f.key] ?? '';
          const set = (t: string) => onText(f.key, t);
          return f.kind === 'choice' ? <Choice key={f.key} {...common} value={value} onChoice={set} choices={f.choices ?? []} /> : <TextField key={f.key} {...common} value={value} onText={set} number={f.kind === 'integer'} placeholder={f.placeholder ?? ''} />;
        })}
        {others.map((n) => (
          <div key={n} class="option-other" data-option={n}>
            <TextField
              label={n}
              value={texts[optionPrefix + n] ?? ''}
              onText={(t) => onText(optionPrefix + n, t)}
              fault={fault(optionPrefix + n)}
              hint={specs.length > 0 ? t('{family} has no such option here: it counts as not given.', { family }) : t('Not checked by this page.')}
            />
            <button type="button" class="button small" aria-label={t('Remove option {n}', { n })} onClick={() => onText(optionPrefix + n, null)}>
              {t('Remove')}
            </button>
          </div>
        ))}
      </div>
      {specs.length === 0 && family && (
        <div class="form-foot">
          <TextField label={t('Another option')} value={name.value} onText={(t) => (name.value = t)} fault={error.value || undefined} />
          <button type="button" class="button" onClick={add}>
            {t('Add the option')}
          </button>
        </div>
      )}
    </details>
  );
}
