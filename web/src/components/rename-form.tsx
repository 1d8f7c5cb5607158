// Rename form: another name for a capture or a recording. In: the name it has. Out: the new one, if it is one.
import { useSignal } from '@preact/signals';
import { t } from '../language';
import { nameFault } from '../text/recorder';
import { TextField } from './form';

export function RenameForm({ name, rename }: { name: string; rename: (to: string) => void }) {
  const typed = useSignal(name);
  const fault = nameFault(typed.value);
  return (
    <form
      class="form-grid recorder-rename"
      noValidate
      aria-label={t('New name of {name}', { name })}
      onSubmit={(e) => {
        e.preventDefault();
        if (!fault) rename(typed.value);
      }}
    >
      <TextField label={t('Name')} value={typed.value} onText={(text) => (typed.value = text)} fault={fault} />
      <div class="form-foot">
        <button type="submit" class="button" disabled={fault !== undefined || typed.value === name}>
          {t('Rename')}
        </button>
      </div>
    </form>
  );
}
