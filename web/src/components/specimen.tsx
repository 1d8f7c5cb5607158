// Specimen: which drive of its family a simulated drive is, in the words of the gateway, and the choice of another one. In: the draft of the site. Out: the
// drive's option `specimen` in the draft; it is checked and applied with the other changes, on the page of the site.
import { gatewayText, t } from '../language';
import { useSignal } from '@preact/signals';
import { useEffect } from 'preact/hooks';
import { asProblem } from '../api/problem';
import { useGateway } from '../gateway';
import { capital } from '../state/commander';
import { draftOf } from '../state/site-draft';
import { optionPrefix, optionTexts } from '../text/options';
import type { Entry } from '../text/site';
import { TextField } from './form';
import { useBarred } from './gate';
import { useLoaded } from './loaded';

const named = ['0', 'slow', 'sparse', 'strict', 'chatty', 'weak', 'old'].map((value) => ({ value }));
/** The option of an entry of the site; undefined: it has none. */
const chosen = (entry: Entry | undefined) => optionTexts(entry?.options)[optionPrefix + 'specimen'];

export function Specimen({ drive, family }: { drive: string; family: string }) {
  const { client, store } = useGateway();
  const { draft } = draftOf(client);
  const typed = useSignal<string | null>(null);
  const told = useSignal<{ words: readonly string[]; why: string }>({ words: [], why: '' });
  const no = useBarred('engineer');
  const load = async () => {
    const problem = await draft.load();
    if (problem) throw problem;
  };
  const absent = useLoaded(load, [draft, store.siteRevision.value]);
  const { drives = [], lines = [] } = draft.draft.value;
  const entry = drives.find((d) => d.name === drive);
  const kept = chosen(entry) ?? chosen(lines.find((l) => l.name === entry?.line)) ?? '0';
  const shown = (typed.value ?? kept).trim() || '0';
  const live = store.connected.value;
  useEffect(() => {
    let here = live;
    const take = (words: readonly string[], why: string) => void (here && (told.value = { words, why }));
    if (live) client.specimen(family, shown).then((s) => take(s.words, ''), (error: unknown) => take([], capital(asProblem(error).text)));
    return () => void (here = false);
  }, [client, family, shown, live]);
  const { words, why } = told.value;
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
      <TextField label={t('The simulated drive is specimen')} value={typed.value ?? kept} onText={(text) => (typed.value = text)} offers={named} disabled={Boolean(no.disabled)} fault={why || undefined} />
      {why === '' && (
        <ul class="where" data-field="specimen-words" aria-label={t('Differences from the manual')} {...gatewayText}>
          {words.map((w) => (
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
