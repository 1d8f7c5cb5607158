// Site files: export and import of the document, the states that were applied before, and a copy of everything. In: the draft, the door. Out: a file; a
// document in the draft, which is then checked and applied like every change. A restored copy replaces everything and is asked for twice.
import { useSignal } from '@preact/signals';
import { asProblem } from '../api/problem';
import type { HistoryEntry, SiteDoor } from '../api/site';
import { useGateway } from '../gateway';
import { capital } from '../state/commander';
import type { SiteDraft } from '../state/site-draft';
import { differenceOf, readSite, type Difference } from '../words/site';
import { clockTime } from '../words/time';
import { useBarred, Why } from './gate';
import { notOffered, quiet, Tell, type Told } from './form';
import { useLoaded } from './loaded';
import { Section } from './section';
import { DifferenceList } from './site-stage';

const largestSite = 8_000_000;
const largestBackup = 64 * 1024 * 1024;
const absent = (status: number) => status === 404 || status === 405 || status === 501;
const size = (bytes: number) => (bytes < 1024 ? `${bytes} bytes` : bytes < 1024 * 1024 ? `${Math.round(bytes / 1024)} KiB` : `${(bytes / 1024 / 1024).toFixed(1)} MiB`);

export function SiteFiles({ draft, door }: { draft: SiteDraft; door: SiteDoor }) {
  const no = useBarred('engineer');
  const noCopy = useBarred('administrator');
  const told = useSignal<Told>(quiet);
  const copy = useSignal<File | null>(null);
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
      const blob = await door.backup();
      const link = document.createElement('a');
      link.href = URL.createObjectURL(blob);
      link.download = `axisgate-${new Date().toISOString().slice(0, 10)}.db`;
      document.body.append(link);
      link.click();
      link.remove();
      setTimeout(() => URL.revokeObjectURL(link.href), 60_000);
      told.value = { tone: 'good', text: `A copy of everything, ${size(blob.size)}.` };
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
      const r = await door.restoreBackup(file);
      copy.value = null;
      told.value = { tone: 'good', text: capital(r.text ?? r.detail ?? (r.restart_needed ? 'Taken; it takes effect when the gateway is started anew.' : 'Taken.')) };
      await draft.load();
    } catch (error) {
      const p = asProblem(error);
      told.value = { tone: 'refused', text: absent(p.status) ? notOffered('a restore through the page') : capital(p.words) };
    }
  };
  return (
    <Section title="Export, import, backup" class="files">
      <div class="card form">
        <Why need="administrator" what="A backup of everything, and its restore," />
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

export function SiteHistory({ draft, door }: { draft: SiteDraft; door: SiteDoor }) {
  const no = useBarred('engineer');
  const { store } = useGateway();
  const list = useSignal<HistoryEntry[]>([]);
  const shown = useSignal<{ revision: number; changes: Difference[] } | null>(null);
  const revision = store.siteRevision.value;
  const why = useLoaded(async () => void (list.value = await door.history()), [door, revision], (p) => (absent(p.status) ? notOffered('a history of applied states') : p.words));
  const look = async (n: number) => {
    if (shown.value?.revision === n) return void (shown.value = null);
    try {
      shown.value = { revision: n, changes: differenceOf(draft.base.peek(), await door.old(n)) };
    } catch (error) {
      draft.told.value = { tone: 'refused', text: capital(asProblem(error).words) };
    }
  };
  return (
    <Section title="Applied states" class="site-history">
      <div class="card" data-field="history">
        {why ? (
          <p class="empty">{why}</p>
        ) : list.value.length === 0 ? (
          <p class="empty">No earlier state is kept.</p>
        ) : (
          <ul class="rows">
            {list.value.slice(0, 100).map((h) => (
              <li key={h.revision} class="row" data-revision={h.revision}>
                <div class="row-head">
                  <h3>Revision {h.revision}</h3>
                  <button type="button" class="button small" aria-expanded={shown.value?.revision === h.revision} aria-label={`Difference to revision ${h.revision}`} onClick={() => void look(h.revision)}>
                    Difference
                  </button>
                  <button type="button" class="button small" aria-label={`Restore revision ${h.revision}`} {...no} onClick={() => void draft.restore(h.revision)}>
                    Restore
                  </button>
                </div>
                <p class="where">
                  {clockTime(h.at)} {h.who ?? ''} · {size(h.bytes)}
                </p>
                {draft.askRestore.value === h.revision && (
                  <p class="form-foot ask" role="group" aria-label={`Restore revision ${h.revision}`}>
                    <span>{draft.changes.value.length === 1 ? 'One change of yours is' : `${draft.changes.value.length} changes of yours are`} not applied; restoring puts revision {h.revision} in their place.</span>
                    <button type="button" class="button small" {...no} onClick={() => void draft.restore(h.revision, true)}>
                      Drop mine and restore
                    </button>
                    <button type="button" class="button small quiet" onClick={() => (draft.askRestore.value = null)}>
                      Keep mine
                    </button>
                  </p>
                )}
                {shown.value?.revision === h.revision && (shown.value.changes.length === 0 ? <p class="where">It is the site that is in force.</p> : <DifferenceList list={shown.value.changes} label={`What revision ${h.revision} would change`} />)}
              </li>
            ))}
          </ul>
        )}
      </div>
    </Section>
  );
}
