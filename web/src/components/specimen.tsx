// Specimen: which drive of its family a simulated drive is, in the words of the gateway, and the choice of another one. In: the draft of the site. Out: the
// drive's option `specimen` in the draft; it is checked and applied with the other changes, on the page of the site.
import { gatewayText, t } from '../language';
import { useSignal } from '@preact/signals';
import { useGateway } from '../gateway';
import { draftOf } from '../state/site-draft';
import { optionPrefix, optionTexts } from '../text/options';
import { TextField } from './form';
import { useBarred } from './gate';
import { useLoaded } from './loaded';

const named = ['0', 'slow', 'sparse', 'strict', 'chatty', 'weak', 'old'].map((value) => ({ value }));
const key = `${optionPrefix}specimen`;

export function Specimen({ drive, family }: { drive: string; family: string }) {
  const { client, store } = useGateway();
  const { draft } = draftOf(client);
  const typed = useSignal<string | null>(null);
  const words = useSignal<readonly string[]>([]);
  const no = useBarred('engineer');
  const load = async () => {
    const problem = await draft.load();
    if (problem) throw problem;
  };
  const absent = useLoaded(load, [draft, store.siteRevision.value]);
  const { drives = [], lines = [] } = draft.draft.value;
  const entry = drives.find((d) => d.name === drive);
  const kept = optionTexts(entry?.options)[key] ?? optionTexts(lines.find((l) => l.name === entry?.line)?.options)[key] ?? '0';
  const shown = (typed.value ?? kept).trim() || '0';
  const why = useLoaded(async () => void (words.value = (await client.specimen(family, shown)).words), [family, shown]);
  if (!entry) return <p class="where">{absent}</p>;
  const waits = draft.changes.value.length > 0;
  return (
    <form
      class="form card"
      noValidate
      aria-label={t('Specimen')}
      onSubmit={(e) => {
        e.preventDefault();
        draft.put('drives', { ...entry, options: { ...(entry.options as object | undefined), specimen: shown } }, drive);
        typed.value = null;
      }}
    >
      <p class="where">{t('A manual leaves choices to the drive. A specimen is a drive that has made them: by a number from which they are drawn, or by the name of an extreme. 0 is the drive as its manual shows it.')}</p>
      <TextField label={t('The simulated drive is specimen')} value={typed.value ?? kept} onText={(text) => (typed.value = text)} offers={named} disabled={Boolean(no.disabled)} fault={typed.value === null ? undefined : why || undefined} />
      {why === '' && (
        <ul class="where" data-field="specimen-words" aria-label={t('Differences from the manual')} {...gatewayText}>
          {words.value.map((w) => (
            <li key={w}>{w}</li>
          ))}
        </ul>
      )}
      <div class="form-foot">
        <button type="submit" class="button" {...no} disabled={Boolean(no.disabled) || typed.value === null || why !== ''}>
          {t('Save to draft')}
        </button>
        {waits && <a href="/site">{t('Check and apply the draft')}</a>}
      </div>
    </form>
  );
}
