// Wizard steps: what stands under the forms of the wizard: the scan of the line, which must be in force first; check and apply; moving the axis, and the question
// whether the site stays. In: the draft. Out: its steps, each when its button is pressed. Nothing moves without a button of the axis' own tile.
import { useSignal, type Signal } from '@preact/signals';
import type { SiteDoor } from '../api/site';
import { useGateway } from '../gateway';
import { t } from '../language';
import { persisted } from '../state/persisted';
import type { SiteDraft } from '../state/site-draft';
import { applyStep, chosen, moveStep } from '../state/site-wizard';
import { sameDocument } from '../text/site';
import { AxisTile } from './axis-tile';
import { Tell } from './form';
import { Icon } from './icon';
import { KeepOrBack } from './keep-or-back';
import { ReadFromHmi } from './site-hmi';
import { ScanPanel } from './site-scan';
import { SiteStage } from './site-stage';
import { useTrialRest } from './trial';

/** Long enough to go to the machine, enable and move before the question whether it stays. */
const trial = persisted('wizard.within_s', '300');
/** What is being done with the line before its drives are looked for. */
export type LineFirst = '' | 'applying' | 'shown' | 'scan';

interface StepProps {
  draft: SiteDraft;
  go: (n: number) => void;
}

/** The scan, where the line is in force; else the way there. */
export function ScanStep({ draft, door, first }: { draft: SiteDraft; door: SiteDoor; first: Signal<LineFirst> }) {
  const meant = (draft.draft.value.lines ?? []).find((l) => l.name === chosen.lines.value);
  const line = (draft.base.value.lines ?? []).find((l) => l.name === chosen.lines.value && sameDocument(l, meant));
  const applying = first.value === 'applying';
  const onTrial = draft.stage.value.state === 'applied';
  return (
    <>
      {line && line.uri !== 'twin' && !applying && <ScanPanel key={line.name} line={line} door={door} draft={draft} begin={first.value === 'scan'} />}
      {meant && meant.uri !== 'twin' && (!line || applying) && <ApplyLine draft={draft} name={meant.name} first={first} />}
      {((first.value === 'shown' && !line) || (onTrial && !applying)) && <SiteStage draft={draft} />}
    </>
  );
}

/** One click for the line alone; more than that is looked at first. */
function ApplyLine({ draft, name, first }: { draft: SiteDraft; name: string; first: Signal<LineFirst> }) {
  const applying = first.value === 'applying';
  const alone = applying || draft.changes.value.every((c) => c.what === `lines/${name}`);
  const applyLine = async () => {
    first.value = 'applying';
    first.value = (await draft.applyAndKeep()) ? 'scan' : 'shown';
  };
  return (
    <div class="form-foot" data-field="scan-later">
      <p class="where">
        {t('Scanning asks the line itself, so {name} must be in force first.', { name })}{' '}
        {alone ? t('One click checks it, applies it, keeps it and begins to scan; nothing else is changed.') : t('More than this line is changed: look at all of it, apply it, then scan here.')}{' '}{t('Or describe the drive above without a scan: its address stands in the drive\'s papers.')}
      </p>
      {alone ? (
        <button type="button" class="button" disabled={applying} onClick={() => void applyLine()}>
          {t('Apply {name} and scan it', { name })}
        </button>
      ) : (
        <button type="button" class="button" aria-expanded={first.value === 'shown'} onClick={() => (first.value = first.value === 'shown' ? '' : 'shown')}>
          {t('Look at all changes')}
        </button>
      )}
      {applying && <Tell reported={draft.reported.value} field="wizard-told" />}
    </div>
  );
}

/** Whether the chosen axis is one of the gateway's. */
function useInForce(draft: SiteDraft): boolean {
  const { store } = useGateway();
  const axis = chosen.axes.value;
  return (draft.base.value.axes ?? []).some((a) => a.name === axis) && store.axisNames.value.includes(axis);
}

export function ApplyStep({ draft, go }: StepProps) {
  const axis = chosen.axes.value;
  const applied = useInForce(draft);
  return (
    <>
      <SiteStage draft={draft} within={trial} />
      <div class="form-foot">
        <button type="button" class="button" onClick={() => go(applyStep - 1)}>
          {t('Back')}
        </button>
        <button type="button" class="button primary" disabled={!applied} onClick={() => go(moveStep)}>
          {t('Go on to moving {axis}', { axis })}
        </button>
        {!applied && <span class="where">{t('Apply first: {axis} is not in force yet.', { axis: axis || t('the axis') })}</span>}
      </div>
    </>
  );
}

export function MoveStep({ draft, go, done }: StepProps & { done: () => void }) {
  const axis = chosen.axes.value;
  const applied = useInForce(draft);
  return (
    <>
      {draft.stage.value.state === 'applied' && <KeepAfterMove draft={draft} axis={axis} />}
      {applied ? (
        <>
          <p class="where">{t('Enable the axis, then move it: a short distance first. Escape stops all axes.')}</p>
          <AxisTile name={axis} bare={false} />
          <ReadFromHmi axis={axis} />
        </>
      ) : (
        <p class="empty" role="status" data-field="not-there">
          {draft.rolledBack.value ? t('The change was rolled back because nobody pressed Keep in time, so {axis} is not in force. What you typed can be applied again.', { axis }) : t('{axis} is not in force: go back and apply it.', { axis: axis || t('The axis') })}
        </p>
      )}
      <div class="form-foot">
        <button type="button" class="button" onClick={() => go(applyStep)}>
          {t('Back')}
        </button>
        {!applied && draft.rolledBack.value && (
          <button
            type="button"
            class="button primary"
            onClick={() => {
              draft.again();
              go(applyStep);
            }}
          >
            {t('Apply again')}
          </button>
        )}
        <button type="button" class={`button${applied ? ' primary' : ''}`} onClick={done}>
          {t('Done')}
        </button>
      </div>
    </>
  );
}

/** The question whether the site stays, asked when the axis has moved for the first time; before that it can be answered, too. */
function KeepAfterMove({ draft, axis }: { draft: SiteDraft; axis: string }) {
  const { store } = useGateway();
  const entry = store.axis(axis)?.value.data;
  const moved = useSignal(false);
  const rest = useTrialRest(draft);
  if (entry?.moving) moved.value = true;
  const asks = moved.value && entry?.moving === false;
  return (
    <section class={`card stage is-applied${asks ? ' is-asking' : ''}`} aria-label={t('Keep the site?')} data-field="keep-after-move" data-asks={asks}>
      <p class="stage-count" role="status">
        <Icon name="clock" />
        {asks ? t('{axis} has moved. Was it right? Then keep the site; else it is rolled back by itself in {n} s.', { axis, n: rest }) : t('The site is on trial, for {n} s more: move {axis} first, then you are asked whether it stays.', { axis, n: rest })}
      </p>
      <div class="form-foot">
        <KeepOrBack draft={draft} primary={asks} />
      </div>
    </section>
  );
}
