// Site: lines, drives and axes as forms; every change is a draft until it is checked and applied as one. In: the HTTP door. Out: a page.
// An empty site begins with the wizard. The draft is the page's, not the component's: it stays when the page is left.
import { Why } from '../components/gate';
import { useSignal } from '@preact/signals';
import { useEffect } from 'preact/hooks';
import { FailSafe } from '../components/fail-safe';
import { Empty } from '../components/lines';
import { useLoaded, waiting } from '../components/loaded';
import { SiteFiles } from '../components/site-files';
import { SiteHistory } from '../components/site-history';
import { PendingRestore } from '../components/site-pending';
import { ScanPanel } from '../components/site-scan';
import { SiteStage } from '../components/site-stage';
import { SiteTree } from '../components/site-tree';
import { SiteWizard } from '../components/site-wizard';
import { useGateway } from '../gateway';
import { t } from '../language';
import { persisted } from '../state/persisted';
import { barred } from '../state/session';
import { draftOf } from '../state/site-draft';

const wizard = persisted('site.wizard');
const lookAgain_ms = 3_000;
export function SitePage() {
  const { client, session, store } = useGateway();
  const { door, draft } = draftOf(client);
  const scanning = useSignal('');
  const revision = store.siteRevision.value;
  const why = useLoaded(
    async () => {
      const problem = await draft.load();
      if (problem) throw problem;
    },
    [draft, revision],
  );

  // Another client may replace or take away what is staged; that changes no revision.
  const staged = draft.stage.value.state === 'staged';
  useEffect(() => {
    if (!staged) return;
    const timer = setInterval(() => {
      if (!document.hidden && store.connected.peek()) void draft.look();
    }, lookAgain_ms);
    return () => clearInterval(timer);
  }, [draft, staged]);

  const empty = (draft.base.value.axes ?? []).length === 0;
  // The wizard is all change: who may change nothing reads the site instead.
  const guided = session.mayNot('engineer') === '' && (wizard.value === 'open' || (wizard.value === '' && draft.state.value === 'there' && empty));
  useEffect(() => {
    // The wizard stays until it is left, also when the site is not empty any more.
    if (guided && wizard.peek() === '') wizard.value = 'open';
  }, [guided]);
  const inForce = new Set((draft.base.value.lines ?? []).map((l) => l.name));
  return (
    <main class="page site-page">
      <div class="site-head">
        <h1 tabIndex={-1}>{t('Site')}</h1>
        <a class="button quiet" href="/descriptions">
          {t('Descriptions of drives')}
        </a>
        {!guided && draft.state.value === 'there' && (
          <button type="button" class="button" {...barred(session.mayNot('engineer'))} onClick={() => (wizard.value = 'open')}>
            {t('Wizard: to a moving axis')}
          </button>
        )}
      </div>
      <PendingRestore door={door} />
      {draft.state.value !== 'there' ? (
        <Empty text={why || waiting} />
      ) : guided ? (
        <SiteWizard draft={draft} door={door} leave={() => (wizard.value = 'closed')} />
      ) : (
        <>
          <Why need="engineer" what={t('Changing the site')} />
          <SiteStage draft={draft} />
          <SiteTree
            draft={draft}
            extra={(l) =>
              !inForce.has(l.name) ? (
                <span class="where" data-field="scan-later">
                  {t('Scan: once it is applied')}
                </span>
              ) : (
                <button type="button" class="button small" aria-expanded={scanning.value === l.name} aria-label={t('Scan {line}', { line: l.name })} onClick={() => (scanning.value = scanning.value === l.name ? '' : l.name)}>
                  {t('Scan')}
                </button>
              )
            }
            below={(l) => scanning.value === l.name && <ScanPanel line={l} door={door} draft={draft} headed />}
          />
          <FailSafe revision={revision} />
          <SiteFiles draft={draft} door={door} />
          <SiteHistory draft={draft} door={door} />
        </>
      )}
    </main>
  );
}
