// Site wizard: from an empty site to a moving axis in five steps: line, drive, axis, apply, move. In: the draft. Out: entries in the draft, then the
// same check, apply and keep as everywhere; the last step is the axis' own tile. Nothing moves without a button there. A reload goes on where it was;
// a step whose line, drive or axis is not there any more gives way to the one that makes it.
import { useSignal } from '@preact/signals';
import { useRef } from 'preact/hooks';
import type { SiteDoor } from '../api/site';
import { t } from '../language';
import { quiet } from '../state/reported';
import type { SiteDraft } from '../state/site-draft';
import { applyStep, chosen, forget, goTo, moveStep, order, placeOf, steps } from '../state/site-wizard';
import type { Room } from '../text/site';
import { StepForm } from './wizard-form';
import { ApplyStep, MoveStep, ScanStep, type LineFirst } from './wizard-steps';

const names = [t('Line'), t('Drive'), t('Axis'), t('Apply'), t('Move')] as const;
const titles = [t('Where is the line?'), t('Which drive is on it?'), t('What does it move?'), t('Check and apply'), t('Move it')] as const;
const theText: Record<Room, string> = { lines: t('The line'), drives: t('The drive'), axes: t('The axis') };

export function SiteWizard({ draft, door, leave }: { draft: SiteDraft; door: SiteDoor; leave: () => void }) {
  const { at, gone } = placeOf(draft);
  const head = useRef<HTMLHeadingElement>(null);
  const lineFirst = useSignal<LineFirst>('');
  const go = (n: number) => {
    goTo(n);
    lineFirst.value = ''; // who comes back has not asked for the scan again
    requestAnimationFrame(() => head.current?.focus());
  };
  const done = () => {
    forget();
    draft.reported.value = quiet;
    leave();
  };
  const room = order[at];
  return (
    <section class="card wizard" aria-labelledby="wizard-head" data-step={at + 1}>
      <header class="wizard-head">
        <h2 id="wizard-head" ref={head} tabIndex={-1}>
          {t('Step {step} of {n}: {title}', { step: at + 1, n: steps, title: titles[at] ?? '' })}
        </h2>
        <ol class="wizard-steps" aria-label={t('Steps')}>
          {names.map((s, i) => (
            <li key={s} class={i < at ? 'is-done' : i === at ? 'is-now' : ''} aria-current={i === at ? 'step' : undefined}>
              {s}
            </li>
          ))}
        </ol>
        <button type="button" class="button quiet" onClick={leave}>
          {t('Leave the wizard')}
        </button>
      </header>
      {gone && (
        <p class="where" role="status" data-field="wizard-back">
          {t('{what} is not there any more: it was rolled back, dropped, or removed by somebody else. So it goes on from here.', { what: chosen[gone].value || theText[gone] })}
        </p>
      )}
      {room && <StepForm key={at} room={room} draft={draft} back={at > 0 ? () => go(at - 1) : null} next={() => go(at + 1)} />}
      {room === 'drives' && <ScanStep draft={draft} door={door} first={lineFirst} />}
      {at === applyStep && <ApplyStep draft={draft} go={go} />}
      {at === moveStep && <MoveStep draft={draft} go={go} done={done} />}
    </section>
  );
}
