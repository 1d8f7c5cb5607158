// Site files: export and import of the document, and a copy of everything. In: the draft, the door. Out: a file; a
// document in the draft, which is then checked and applied like every change. A restored copy replaces everything and is asked for twice.
import { t } from '../language';
import { useSignal } from '@preact/signals';
import { asProblem } from '../api/problem';
import type { SiteDoor } from '../api/site';
import { capital } from '../state/commander';
import type { SiteDraft } from '../state/site-draft';
import { quiet, type Reported } from '../state/reported';
import { readSite } from '../text/site';
import { sizeText as size } from '../text/site-files';
import { useBarred, Why } from './gate';
import { notOffered, Tell } from './form';
import { Section } from './section';
import { lookAtPending } from './site-pending';

const largestSite = 8_000_000;
const largestBackup = 64 * 1024 * 1024;
const absent = (status: number) => status === 404 || status === 405 || status === 501;

export function SiteFiles({ draft, door }: { draft: SiteDraft; door: SiteDoor }) {
  const no = useBarred('engineer');
  const noCopy = useBarred('administrator');
  const reported = useSignal<Reported>(quiet);
  const copy = useSignal<File | null>(null);
  const passphrase = useSignal('');
  const take = async (input: HTMLInputElement) => {
    const file = input.files?.[0];
    input.value = '';
    if (!file) return;
    if (file.size > largestSite) return void (reported.value = { tone: 'refused', text: t('{name} is larger than a site can be.', { name: file.name }) });
    const site = readSite(await file.text());
    if (typeof site === 'string') return void (reported.value = { tone: 'refused', text: `${file.name}: ${site}` });
    draft.edit(site);
    const n = draft.changes.peek().length;
    reported.value = { tone: 'good', text: n === 0 ? t('{name} is the site that is in force.', { name: file.name }) : t('{name} is in the draft: {n} differences. Nothing has been sent; check and apply above.', { name: file.name, n }) };
  };
  const backup = async () => {
    reported.value = { tone: 'busy', text: t('Copying …') };
    try {
      const blob = await door.backup(passphrase.value);
      const link = document.createElement('a');
      link.href = URL.createObjectURL(blob);
      link.download = `axisgate-${new Date().toISOString().slice(0, 10)}.${passphrase.value === '' ? 'tar' : 'sealed'}`;
      document.body.append(link);
      link.click();
      link.remove();
      setTimeout(() => URL.revokeObjectURL(link.href), 60_000);
      reported.value = { tone: 'good', text: passphrase.value === '' ? t('A copy of everything, {size}, without private keys.', { size: size(blob.size) }) : t('A copy of everything, {size}, sealed.', { size: size(blob.size) }) };
    } catch (error) {
      const p = asProblem(error);
      reported.value = { tone: 'refused', text: absent(p.status) ? notOffered(t('a backup through the page')) : capital(p.text) };
    }
  };
  const restore = async () => {
    const file = copy.value;
    if (!file) return;
    reported.value = { tone: 'busy', text: t('Restoring …') };
    try {
      const r = await door.restoreBackup(file, passphrase.value);
      copy.value = null;
      reported.value = { tone: 'good', text: capital(r.text ?? r.detail ?? (r.restart_needed ? t('Taken; it takes effect when the gateway is started anew.') : t('Taken.'))) };
      lookAtPending();
      await draft.load();
    } catch (error) {
      const p = asProblem(error);
      reported.value = { tone: 'refused', text: absent(p.status) ? notOffered(t('a restore through the page')) : capital(p.text) };
    }
  };
  return (
    <Section title={t('Export, import, backup')} class="files" help="backup">
      <div class="card form">
        <Why need="administrator" what={t('A backup of everything, its restore, and whether one waits for the next start')} />
        <div class="form-foot">
          <a class="button" href="/api/v1/site" download="site.json">
            {t('Export the site')}
          </a>
          <label class="button">
            <input type="file" class="visually-hidden" aria-label={t('Import a site')} accept=".json,application/json" {...no} onChange={(e) => void take(e.currentTarget)} />
            {t('Import a site')}
          </label>
          <button type="button" class="button" {...noCopy} onClick={() => void backup()}>
            {t('Backup of everything')}
          </button>
          <label class="button">
            <input
              type="file"
              class="visually-hidden"
              aria-label={t('Restore a backup')}
              {...noCopy}
              onChange={(e) => {
                const file = e.currentTarget.files?.[0];
                e.currentTarget.value = '';
                if (file && file.size > largestBackup) reported.value = { tone: 'refused', text: t('{name} has {size}; at most 64 MiB are taken.', { name: file.name, size: size(file.size) }) };
                else copy.value = file ?? null;
              }}
            />
            {t('Restore a backup')}
          </label>
          <input type="password" aria-label={t('Passphrase of the backup')} placeholder={t('passphrase, or none')} autocomplete="new-password" maxLength={256} {...noCopy} value={passphrase.value} onInput={(e) => (passphrase.value = e.currentTarget.value)} />
          <Tell reported={reported.value} field="files-told" />
        </div>
        {copy.value && (
          <div class="form-foot ask" role="group" aria-label={t('Restore a backup')}>
            <span>
              {t('{name} ({size}) replaces site, mappings, parameters, snapshots, recipes, events, users and tokens of this gateway: who signs in after it signs in as the copy knows them.', { name: copy.value.name, size: size(copy.value.size) })}
            </span>
            <button type="button" class="button" {...noCopy} onClick={() => void restore()}>
              {t('Replace everything')}
            </button>
            <button type="button" class="button quiet" onClick={() => (copy.value = null)}>
              {t('Leave it')}
            </button>
          </div>
        )}
      </div>
    </Section>
  );
}
