// Site stage: what is waiting to be applied, and the way there: check, apply, keep, or roll back. In: the draft. Out: the draft's steps.
// While an applied change waits to be kept, the rest of its time is shown each second; the head of the page speaks it when it is short.
import { gatewayText, t } from '../language';
import { useSignal, type Signal } from '@preact/signals';
import { useGateway } from '../gateway';
import { checkedText, stagerOf, type SiteDraft } from '../state/site-draft';
import { persisted } from '../state/persisted';
import { differenceText, sameDocument, type Difference } from '../text/site';
import type { StageDiff } from '../api/site';
import { parseNumber } from '../text/number';
import { Tell, TextField } from './form';
import { useBarred } from './gate';
import { Icon } from './icon';
import { KeepOrBack } from './keep-or-back';
import { keepBarred, useTrialRest } from './trial';
import { appliedText, applyBarred, closedText, disturbedText } from '../text/trial';

const usual = persisted('site.within_s', '60');
const mostShown = 200;
const kindText: Record<Difference['kind'], string> = { added: t('added'), removed: t('removed'), changed: t('changed') };

export function DifferenceList({ list, label }: { list: readonly (Difference | StageDiff)[]; label: string }) {
  return (
    <ul class="differences site-diff" aria-label={label}>
      {list.slice(0, mostShown).map((d) => (
        <li key={d.what} data-diff={d.what} class={`is-${d.kind}`}>
          <span class="diff-kind">{kindText[d.kind]}</span> <span>{differenceText(d)}</span>
        </li>
      ))}
      {list.length > mostShown && <li class="where">{t('and {n} more', { n: list.length - mostShown })}</li>}
    </ul>
  );
}

/** `within`: the field's own text, where another time is usual. */
export function SiteStage({ draft, within = usual }: { draft: SiteDraft; within?: Signal<string> }) {
  const { session, tab } = useGateway();
  const no = useBarred('engineer');
  const stage = draft.stage.value;
  const rest = useTrialRest(draft);

  const changes = draft.changes.value;
  const theirs = draft.theirs.value;
  const checked = draft.checked.value !== null && sameDocument(draft.checked.value, draft.draft.value);
  const faults = draft.faults.value;
  const s = parseNumber(within.value);
  const seconds = s.good && Number.isInteger(s.value) && (s.value === 0 || (s.value >= 5 && s.value <= 600)) ? s.value : null;
  const busy = draft.reported.value.tone === 'busy';
  const rival = draft.rival.value;
  const inView = rival?.inView === true && stage.state === 'staged';
  const foreign = stage.state === 'staged' && !checked;
  const ready = inView ? (stage.faults?.length ?? 0) === 0 : checked && faults.length === 0 && theirs === null && changes.length > 0;
  const list = inView ? (stage.faults ?? []) : checked ? faults : [];
  const asked = useSignal(false);
  const closed = closedText(draft.closes.value);
  const disturbed = disturbedText(draft.disturbs.value, draft.base.value, draft.draft.value);

  if (stage.state === 'applied') {
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
  return (
    <section class="card stage" aria-label={t('Changes')} data-field="stage" data-state={stage.state}>
      {theirs && (
        <div class="theirs" role="group" aria-label={t('Somebody else\'s change')} data-field="theirs">
          <p class="stage-count">
            <Icon name="triangle" />{' '}{t('Somebody else has changed the site meanwhile. What you typed is kept.')}
          </p>
          <DifferenceList list={theirs.changes} label={t('What somebody else changed')} />
          <div class="form-foot">
            <button type="button" class="button primary" onClick={() => void draft.adopt(true)}>
              {t('Put mine on top')}
            </button>
            <button type="button" class="button" onClick={() => void draft.adopt(false)}>
              {t('Drop mine')}
            </button>
          </div>
        </div>
      )}
      {foreign && (rival || changes.length === 0) && (
        <div class="theirs" role="group" aria-label={t('What is staged')} data-field="rival">
          <p class="stage-count">
            <Icon name="triangle" />{' '}{t('{stage} has staged this; nothing of it is in force yet.', { stage: stagerOf(stage) })}
            {changes.length > 0 && ` ${t('What you typed is kept.')}`}
          </p>
          <DifferenceList list={stage.diff ?? []} label={t('What is staged')} />
          <div class="form-foot">
            {changes.length > 0 && (
              <button type="button" class="button" disabled={busy || theirs !== null} {...no} onClick={() => void draft.check(true)}>
                {t('Check mine instead')}
              </button>
            )}
            {inView ? (
              <button type="button" class="button quiet" onClick={() => draft.view(false)}>
                {changes.length > 0 ? t('Back to mine') : t('Leave it')}
              </button>
            ) : (
              <button type="button" class="button" {...no} onClick={() => draft.view(true)}>
                {t('Take theirs into view')}
              </button>
            )}
          </div>
        </div>
      )}
      <p class="stage-count" role="status">
        {inView ? `${t('In view is what somebody else has staged: Apply applies that.')} ` : ''}
        {changes.length === 0 ? t('Nothing is changed.') : changes.length === 1 ? t('1 change is waiting; nothing has been sent to the drives.') : t('{n} changes are waiting; nothing has been sent to the drives.', { n: changes.length })}
        {foreign && !rival && changes.length > 0 && ` ${t('A change is staged at the gateway; checking yours takes its place.')}`}
      </p>
      {changes.length > 0 && <DifferenceList list={changes} label={inView ? t('What waits in your draft') : t('What would change')} />}
      {list.length > 0 && (
        <ul class="stage-faults" aria-label={t('Faults')}>
          {list.slice(0, 50).map((f) => (
            <li key={f.pointer + f.text} class="fault-text">
              <span class="mono">{f.pointer}</span> <span {...gatewayText}>{f.text}: {f.remedy}</span>
            </li>
          ))}
        </ul>
      )}
      {checked && disturbed && <p class="form-told" data-field="disturbs">{disturbed}</p>}
      {checked && closed && <p class="form-told" data-field="closes">{closed}</p>}
      <div class="form-foot">
        {changes.length > 0 && !inView && (
          <button type="button" class={`button${ready ? '' : ' primary'}`} disabled={busy || theirs !== null} {...no} onClick={() => void draft.check()}>
            {t('Check')}
          </button>
        )}
        {(changes.length > 0 || inView) && (
          <>
            {draft.offersStage.value !== false && <TextField label={t('Confirm within, s')} class="within" number value={within.value} onText={(t) => (within.value = t)} fault={seconds === null ? t('5 to 600; 0: no roll back.') : undefined} />}
            <button type="button" class="button primary" disabled={busy || !ready || seconds === null} {...no} onClick={() => void draft.apply(seconds ?? 60)}>
              {inView ? t('Apply theirs') : t('Apply')}
            </button>
            {!ready && !busy && !no.disabled && (
              <span class="where" data-field="apply-why">
                {applyBarred({ inView, theirs: theirs !== null, faults: list.length > 0 })}
              </span>
            )}
          </>
        )}
        {changes.length > 0 && !inView && (
          <>
            {asked.value ? (
              <>
                <button type="button" class="button" onClick={() => { asked.value = false; draft.drop(); }}>
                  {t('Drop all changes')}
                </button>
                <button type="button" class="button quiet" onClick={() => (asked.value = false)}>
                  {t('Keep typing')}
                </button>
              </>
            ) : (
              <button type="button" class="button quiet" onClick={() => (asked.value = true)}>
                {t('Drop …')}
              </button>
            )}
          </>
        )}
        {stage.state === 'staged' && (
          <button type="button" class="button quiet" {...no} onClick={() => void draft.discard()}>
            {t('Discard what is staged')}
          </button>
        )}
        {draft.rolledBack.value && changes.length === 0 && (
          <button type="button" class="button" {...no} onClick={() => draft.again()}>
            {t('Put it into the draft again')}
          </button>
        )}
        <Tell reported={changes.length === 0 && draft.reported.value.text === checkedText ? { tone: 'none', text: '' } : draft.reported.value} field="stage-told" />
      </div>
      {draft.offersStage.value === false && changes.length > 0 && <p class="form-told">{t('This gateway does not offer staging: an applied change stays, there is no roll back by itself.')}</p>}
    </section>
  );
}
