// Site files: export and import of the document, and a copy of everything. In: the draft, the door. Out: a file; a
// document in the draft, which is then checked and applied like every change. A restored copy replaces everything and is asked for twice.
import { useSignal } from '@preact/signals';
import { asProblem } from '../api/problem';
import type { SiteDoor } from '../api/site';
import { capital } from '../state/commander';
import type { SiteDraft } from '../state/site-draft';
import { readSite } from '../text/site';
import { sizeWords as size } from '../text/site-files';
import { useBarred, Why } from './gate';
import { notOffered, quiet, Tell, type Told } from './form';
import { Section } from './section';
import { lookAtPending } from './site-pending';

const largestSite = 8_000_000;
const largestBackup = 64 * 1024 * 1024;
const absent = (status: number) => status === 404 || status === 405 || status === 501;

export function SiteFiles({ draft, door }: { draft: SiteDraft; door: SiteDoor }) {
  const no = useBarred('engineer');
  const noCopy = useBarred('administrator');
  const told = useSignal<Told>(quiet);
  const copy = useSignal<File | null>(null);
  const passphrase = useSignal('');
  const take = async (input: HTMLInputElement) => {
    const file = input.files?.[0];
    input.value = '';
    if (!file) return;
    if (file.size > largestSite) return void (told.value = { tone: 'refused', text: `${file.name} is larger than a site can be.` });
    const site = readSite(await file.text());
    if (typeof site === 'string') return void (told.value = { tone: 'refused', text: `${file.name}: ${site}` });
    draft.edit(site);
    const n = draft.changes.peek().length;
    told.value = { tone: 'good', text: n === 0 ? `${file.name} is the site that is in force.` : `${file.name} is in the draft: ${n} differences. Nothing has been sent; check and apply above.` };
  };
  const backup = async () => {
    told.value = { tone: 'busy', text: 'Copying …' };
    try {
      const blob = await door.backup(passphrase.value);
      const link = document.createElement('a');
      link.href = URL.createObjectURL(blob);
      link.download = `axisgate-${new Date().toISOString().slice(0, 10)}.${passphrase.value === '' ? 'tar' : 'sealed'}`;
      document.body.append(link);
      link.click();
      link.remove();
      setTimeout(() => URL.revokeObjectURL(link.href), 60_000);
      told.value = { tone: 'good', text: `A copy of everything, ${size(blob.size)}${passphrase.value === '' ? ', without private keys' : ', sealed'}.` };
    } catch (error) {
      const p = asProblem(error);
      told.value = { tone: 'refused', text: absent(p.status) ? notOffered('a backup through the page') : capital(p.words) };
    }
  };
  const restore = async () => {
    const file = copy.value;
    if (!file) return;
    told.value = { tone: 'busy', text: 'Restoring …' };
    try {
      const r = await door.restoreBackup(file, passphrase.value);
      copy.value = null;
      told.value = { tone: 'good', text: capital(r.text ?? r.detail ?? (r.restart_needed ? 'Taken; it takes effect when the gateway is started anew.' : 'Taken.')) };
      lookAtPending();
      await draft.load();
    } catch (error) {
      const p = asProblem(error);
      told.value = { tone: 'refused', text: absent(p.status) ? notOffered('a restore through the page') : capital(p.words) };
    }
  };
  return (
    <Section title="Export, import, backup" class="files" help="backup">
      <div class="card form">
        <Why need="administrator" what="A backup of everything, its restore, and whether one waits for the next start" />
        <div class="form-foot">
          <a class="button" href="/api/v1/site" download="site.json">
            Export the site
          </a>
          <label class="button">
            <input type="file" class="visually-hidden" aria-label="Import a site" accept=".json,application/json" {...no} onChange={(e) => void take(e.currentTarget)} />
            Import a site
          </label>
          <button type="button" class="button" {...noCopy} onClick={() => void backup()}>
            Backup of everything
          </button>
          <label class="button">
            <input
              type="file"
              class="visually-hidden"
              aria-label="Restore a backup"
              {...noCopy}
              onChange={(e) => {
                const file = e.currentTarget.files?.[0];
                e.currentTarget.value = '';
                if (file && file.size > largestBackup) told.value = { tone: 'refused', text: `${file.name} has ${size(file.size)}; at most 64 MiB are taken.` };
                else copy.value = file ?? null;
              }}
            />
            Restore a backup
          </label>
          <input type="password" aria-label="Passphrase of the backup" placeholder="passphrase, or none" autocomplete="new-password" maxLength={256} {...noCopy} value={passphrase.value} onInput={(e) => (passphrase.value = e.currentTarget.value)} />
          <Tell told={told.value} field="files-told" />
        </div>
        {copy.value && (
          <div class="form-foot ask" role="group" aria-label="Restore a backup">
            <span>
              {copy.value.name} ({size(copy.value.size)}) replaces site, mappings, parameters, snapshots, recipes, events, users and tokens of this gateway: who signs in after it signs in as the copy knows them.
            </span>
            <button type="button" class="button" {...noCopy} onClick={() => void restore()}>
              Replace everything
            </button>
            <button type="button" class="button quiet" onClick={() => (copy.value = null)}>
              Leave it
            </button>
          </div>
        )}
      </div>
    </Section>
  );
}
