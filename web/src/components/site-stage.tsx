// Site stage: what is waiting to be applied, and the way there: check, apply, keep, or roll back. In: the draft. Out: the draft's steps.
// While an applied change waits to be kept, the rest of its time is shown each second; the head of the page speaks it when it is short.
import { useSignal, type Signal } from '@preact/signals';
import { useGateway } from '../gateway';
import { gatewayText, t } from '../language';
import { persisted } from '../state/persisted';
import { quiet } from '../state/reported';
import { checkedText, type SiteDraft } from '../state/site-draft';
import { stageView, type StageView } from '../state/stage-view';
import { appliedText, applyBarred, closedText, disturbedText } from '../text/trial';
import { Tell, TextField } from './form';
import { useBarred } from './gate';
import { Icon } from './icon';
import { KeepOrBack } from './keep-or-back';
import { DifferenceList } from './site-differences';
import { Rival, Theirs } from './site-others';
import { keepBarred, useTrialRest } from './trial';

const usual = persisted('site.within_s', '60');
const mostFaults = 50;

/** `within`: the field's own text, where another time is usual. */
export function SiteStage({ draft, within = usual }: { draft: SiteDraft; within?: Signal<string> }) {
  return draft.stage.value.state === 'applied' ? <Applied draft={draft} /> : <Waiting draft={draft} within={within} />;
}

function Applied({ draft }: { draft: SiteDraft }) {
  const { session, tab } = useGateway();
  const stage = draft.stage.value;
  const rest = useTrialRest(draft);
  const changes = draft.changes.value;
  return (
    <section class="card stage is-applied" aria-label={t('Applied change')} data-field="stage" data-state="applied">
      <p class="stage-count" data-field="countdown">
        <Icon name="clock" />{' '}{t('The change is applied.')}{' '}{rest > 0 ? t('It is rolled back by itself in {rest} s.', { rest }) : t('Its time is over.')}
      </p>
      <p class="form-told" data-field="applied-by">
        {appliedText(stage, tab.name.value, keepBarred(draft, session, tab.name.value))}
      </p>
      <div class="form-foot">
        <KeepOrBack draft={draft} primary />
      </div>
      {(stage.diff?.length ?? 0) > 0 && <DifferenceList list={stage.diff ?? []} label={t('What was changed')} />}
      {changes.length > 0 && (
        <details class="own-draft" data-field="own-draft">
          <summary>
            {changes.length === 1 ? t('Your own draft waits: 1 change. It can be checked when the trial is over.') : t('Your own draft waits: {n} changes. It can be checked when the trial is over.', { n: changes.length })}
          </summary>
          <DifferenceList list={changes} label={t('What waits in your draft')} />
        </details>
      )}
    </section>
  );
}

function Waiting({ draft, within }: { draft: SiteDraft; within: Signal<string> }) {
  const view = stageView(draft, within.value);
  const { changes, checked, inView, foreign, faults } = view;
  const rival = draft.rival.value;
  const closed = checked && closedText(draft.closes.value);
  const disturbed = checked && disturbedText(draft.disturbs.value, draft.base.value, draft.draft.value);
  return (
    <section class="card stage" aria-label={t('Changes')} data-field="stage" data-state={draft.stage.value.state}>
      <Theirs draft={draft} />
      {foreign && (rival || changes.length === 0) && <Rival draft={draft} view={view} />}
      <p class="stage-count" role="status">
        {inView ? `${t('In view is what somebody else has staged: Apply applies that.')} ` : ''}
        {changes.length === 0 ? t('Nothing is changed.') : changes.length === 1 ? t('1 change is waiting; nothing has been sent to the drives.') : t('{n} changes are waiting; nothing has been sent to the drives.', { n: changes.length })}
        {foreign && !rival && changes.length > 0 && ` ${t('A change is staged at the gateway; checking yours takes its place.')}`}
      </p>
      {changes.length > 0 && <DifferenceList list={changes} label={inView ? t('What waits in your draft') : t('What would change')} />}
      {faults.length > 0 && (
        <ul class="stage-faults" aria-label={t('Faults')}>
          {faults.slice(0, mostFaults).map((f) => (
            <li key={f.pointer + f.text} class="fault-text">
              <span class="mono">{f.pointer}</span> <span {...gatewayText}>{f.text}: {f.remedy}</span>
            </li>
          ))}
        </ul>
      )}
      {disturbed && <p class="form-told" data-field="disturbs">{disturbed}</p>}
      {closed && <p class="form-told" data-field="closes">{closed}</p>}
      <Steps draft={draft} view={view} within={within} />
      {draft.offersStage.value === false && changes.length > 0 && <p class="form-told">{t('This gateway does not offer staging: an applied change stays, there is no roll back by itself.')}</p>}
    </section>
  );
}

/** Check, apply, drop, discard. */
function Steps({ draft, view, within }: { draft: SiteDraft; view: StageView; within: Signal<string> }) {
  const no = useBarred('engineer');
  const { changes, inView, ready, busy, within_s } = view;
  const theirs = draft.theirs.value !== null;
  const mine = changes.length > 0 && !inView;
  return (
    <div class="form-foot">
      {mine && (
        <button type="button" class={`button${ready ? '' : ' primary'}`} disabled={busy || theirs} {...no} onClick={() => void draft.check()}>
          {t('Check')}
        </button>
      )}
      {(mine || inView) && (
        <>
          {draft.offersStage.value !== false && <TextField label={t('Confirm within, s')} class="within" number value={within.value} onText={(t) => (within.value = t)} fault={within_s === null ? t('5 to 600; 0: no roll back.') : undefined} />}
          <button type="button" class="button primary" disabled={busy || !ready || within_s === null} {...no} onClick={() => void draft.apply(within_s ?? 60)}>
            {inView ? t('Apply theirs') : t('Apply')}
          </button>
          {!ready && !busy && !no.disabled && (
            <span class="where" data-field="apply-why">
              {applyBarred({ inView, theirs, faults: view.faults.length > 0 })}
            </span>
          )}
        </>
      )}
      {mine && <DropButton draft={draft} />}
      {draft.stage.value.state === 'staged' && (
        <button type="button" class="button quiet" {...no} onClick={() => void draft.discard()}>
          {t('Discard what is staged')}
        </button>
      )}
      {draft.rolledBack.value && changes.length === 0 && (
        <button type="button" class="button" {...no} onClick={() => draft.again()}>
          {t('Put it into the draft again')}
        </button>
      )}
      <Tell reported={changes.length === 0 && draft.reported.value.text === checkedText ? quiet : draft.reported.value} field="stage-told" />
    </div>
  );
}

/** Everything that is typed, after a question. */
function DropButton({ draft }: { draft: SiteDraft }) {
  const asked = useSignal(false);
  if (!asked.value) {
    return (
      <button type="button" class="button quiet" onClick={() => (asked.value = true)}>
        {t('Drop …')}
      </button>
    );
  }
  return (
    <>
      <button
        type="button"
        class="button"
        onClick={() => {
          asked.value = false;
          draft.drop();
        }}
      >
        {t('Drop all changes')}
      </button>
      <button type="button" class="button quiet" onClick={() => (asked.value = false)}>
        {t('Keep typing')}
      </button>
    </>
  );
}
