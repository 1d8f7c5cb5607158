// Site wizard: from an empty site to a moving axis in five steps: line, drive, axis, apply, move. In: the draft. Out: entries in the draft, then the
// same check, apply and keep as everywhere; the last step is the axis' own tile. Nothing moves without a button there. A reload goes on where it was;
// a step whose line, drive or axis is not there any more gives way to the one that makes it.
import { useSignal } from '@preact/signals';
import { useEffect, useRef } from 'preact/hooks';
import type { SiteDoor } from '../api/site';
import { useGateway } from '../gateway';
import { t } from '../language';
import { persisted } from '../state/persisted';
import type { SiteDraft } from '../state/site-draft';
import { checkEntry, fieldsOf, freeName, freeNumber, sameDocument, withEntry, type Room, type Texts } from '../text/site';
import { lineNameFor, numbered } from '../text/ports';
import { quiet, Tell } from './form';
import { AxisTile } from './axis-tile';
import { Icon } from './icon';
import { ScanPanel } from './site-scan';
import { EntryField } from './site-entries';
import { ReadFromHmi } from './site-hmi';
import { SiteStage } from './site-stage';
import { KeepOrBack } from './keep-or-back';
import { useTrialRest } from './trial';

const kinds = [
  { id: 'twin', text: t('No drive yet: simulate it'), uri: 'twin' },
  { id: 'can', text: t('CAN'), uri: 'can:can0' },
  { id: 'serial', text: t('Serial port, RS-485'), uri: 'serial:/dev/ttyUSB0?baud=9600&rs485=1' },
  { id: 'tcp', text: t('Network, TCP'), uri: 'tcp:192.0.2.10:8888' },
  { id: 'udp', text: t('Network, UDP'), uri: 'udp:192.0.2.10:503' },
];
const steps = [t('Line'), t('Drive'), t('Axis'), t('Apply'), t('Move')] as const;
const step = persisted('wizard.step', '0');
const chosen = { lines: persisted('wizard.line'), drives: persisted('wizard.drive'), axes: persisted('wizard.axis') };
/** What stands in the fields of a step that is not finished, as JSON. */
const typed = { lines: persisted('wizard.typed.line'), drives: persisted('wizard.typed.drive'), axes: persisted('wizard.typed.axis') };
/** Long enough to go to the machine, enable and move before the question whether it stays. */
const trial = persisted('wizard.within_s', '300');
const order: Room[] = ['lines', 'drives', 'axes'];

export function SiteWizard({ draft, door, leave }: { draft: SiteDraft; door: SiteDoor; leave: () => void }) {
  const { store } = useGateway();
  const wanted = Math.min(Number(step.value) || 0, steps.length - 1);
  const missing = order.findIndex((room) => !(draft.draft.value[room] ?? []).some((e) => e.name === chosen[room].value));
  // What was rolled back by itself can be applied again from where one is.
  const at = missing < 0 || missing >= wanted || (draft.rolledBack.value && wanted >= 3) ? wanted : missing;
  const head = useRef<HTMLHeadingElement>(null);
  const lineFirst = useSignal<'' | 'applying' | 'shown' | 'scan'>('');
  const go = (n: number) => {
    step.value = String(n);
    lineFirst.value = ''; // who comes back has not asked for the scan again
    requestAnimationFrame(() => head.current?.focus());
  };
  const axis = chosen.axes.value;
  const applied = (draft.base.value.axes ?? []).some((a) => a.name === axis) && store.axisNames.value.includes(axis);
  const meant = (draft.draft.value.lines ?? []).find((l) => l.name === chosen.lines.value);
  const line = (draft.base.value.lines ?? []).find((l) => l.name === chosen.lines.value && sameDocument(l, meant));
  const alone = draft.changes.value.every((c) => c.what === `lines/${chosen.lines.value}`);
  const applyLine = async () => {
    lineFirst.value = 'applying';
    lineFirst.value = (await draft.applyAndKeep()) ? 'scan' : 'shown';
  };
  const onTrial = draft.stage.value.state === 'applied';
  return (
    <section class="card wizard" aria-labelledby="wizard-head" data-step={at + 1}>
      <header class="wizard-head">
        <h2 id="wizard-head" ref={head} tabIndex={-1}>
          {t('Step {step} of {n}: {title}', { step: at + 1, n: steps.length, title: [t('Where is the line?'), t('Which drive is on it?'), t('What does it move?'), t('Check and apply'), t('Move it')][at] ?? '' })}
        </h2>
        <ol class="wizard-steps" aria-label={t('Steps')}>
          {steps.map((s, i) => (
            <li key={s} class={i < at ? 'is-done' : i === at ? 'is-now' : ''} aria-current={i === at ? 'step' : undefined}>
              {s}
            </li>
          ))}
        </ol>
        <button type="button" class="button quiet" onClick={leave}>
          {t('Leave the wizard')}
        </button>
      </header>
      {at < wanted && (
        <p class="where" role="status" data-field="wizard-back">
          {t('{what} is not there any more: it was rolled back, dropped, or removed by somebody else. So it goes on from here.', { what: chosen[order[at] as Room].value || theText[order[at] as Room] })}
        </p>
      )}
      {at < 3 && <StepForm key={at} room={order[at] as Room} draft={draft} back={at > 0 ? () => go(at - 1) : null} next={() => go(at + 1)} />}
      {at === 1 && line && line.uri !== 'twin' && lineFirst.value !== 'applying' && <ScanPanel key={line.name} line={line} door={door} draft={draft} begin={lineFirst.value === 'scan'} />}
      {at === 1 && meant && meant.uri !== 'twin' && (!line || lineFirst.value === 'applying') && (
        <div class="form-foot" data-field="scan-later">
          <p class="where">
            {t('Scanning asks the line itself, so {name} must be in force first.', { name: meant.name })}{' '}
            {alone || lineFirst.value === 'applying' ? t('One click checks it, applies it, keeps it and begins to scan; nothing else is changed.') : t('More than this line is changed: look at all of it, apply it, then scan here.')}{' '}{t('Or describe the drive above without a scan: its address stands in the drive\'s papers.')}
          </p>
          {alone || lineFirst.value === 'applying' ? (
            <button type="button" class="button" disabled={lineFirst.value === 'applying'} onClick={() => void applyLine()}>
              {t('Apply {name} and scan it', { name: meant.name })}
            </button>
          ) : (
            <button type="button" class="button" aria-expanded={lineFirst.value === 'shown'} onClick={() => (lineFirst.value = lineFirst.value === 'shown' ? '' : 'shown')}>
              {t('Look at all changes')}
            </button>
          )}
          {lineFirst.value === 'applying' && <Tell reported={draft.reported.value} field="wizard-told" />}
        </div>
      )}
      {at === 1 && ((lineFirst.value === 'shown' && !line) || (onTrial && lineFirst.value !== 'applying')) && <SiteStage draft={draft} />}
      {at === 3 && (
        <>
          <SiteStage draft={draft} within={trial} />
          <div class="form-foot">
            <button type="button" class="button" onClick={() => go(2)}>
              {t('Back')}
            </button>
            <button type="button" class="button primary" disabled={!applied} onClick={() => go(4)}>
              {t('Go on to moving {axis}', { axis })}
            </button>
            {!applied && <span class="where">{t('Apply first: {axis} is not in force yet.', { axis: axis || t('the axis') })}</span>}
          </div>
        </>
      )}
      {at === 4 && (
        <>
          {onTrial && <KeepAfterMove draft={draft} axis={axis} />}
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
            <button type="button" class="button" onClick={() => go(3)}>
              {t('Back')}
            </button>
            {!applied && draft.rolledBack.value && (
              <button
                type="button"
                class="button primary"
                onClick={() => {
                  draft.again();
                  go(3);
                }}
              >
                {t('Apply again')}
              </button>
            )}
            <button
              type="button"
              class={`button${applied ? ' primary' : ''}`}
              onClick={() => {
                for (const c of [...Object.values(chosen), ...Object.values(typed)]) c.value = '';
                step.value = '0';
                draft.reported.value = quiet;
                leave();
              }}
            >
              {t('Done')}
            </button>
          </div>
        </>
      )}
    </section>
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

const nouns: Record<Room, string> = { lines: t('line'), drives: t('drive'), axes: t('axis') };
const theText: Record<Room, string> = { lines: t('The line'), drives: t('The drive'), axes: t('The axis') };
const newText: Record<Room, string> = { lines: t('a new line'), drives: t('a new drive'), axes: t('a new axis') };
const keys: Record<Room, readonly string[]> = { lines: ['name', 'family', 'uri', 'bitrate'], drives: ['name', 'address', 'presence'], axes: ['name', 'unit', 'increments_per_unit', 'channel', 'position_min', 'position_max', 'velocity_max'] };

function StepForm({ room, draft, back, next }: { room: Room; draft: SiteDraft; back: (() => void) | null; next: () => void }) {
  const site = draft.draft.value;
  const list = site[room] ?? [];
  // A drive of the chosen line, an axis of the chosen drive.
  const fitting = list.filter((e) => (room === 'lines' ? true : room === 'drives' ? e.line === chosen.lines.value : e.drive === chosen.drives.value));
  const use = useSignal(fitting.some((e) => e.name === chosen[room].peek()) ? chosen[room].peek() : (fitting[0]?.name ?? ''));
  const texts = useSignal<Texts>(begun(room, draft));
  const touched = useSignal(false);
  const form = useRef<HTMLFormElement>(null);
  useEffect(() => {
    // What a scan added is chosen.
    if (use.peek() === '' && fitting.length > 0 && room === 'drives' && !touched.peek()) use.value = fitting[0]!.name;
  }, [fitting.length]);
  const { entry, faults } = checkEntry(room, texts.value, site, null);
  const set = (key: string) => (text: string) => {
    const before = texts.peek();
    const next = { ...before, [key]: text };
    // A name that nobody has typed goes with the line.
    if (room === 'lines' && key === 'uri' && before.name === lineNameFor(before.uri ?? '', site.lines)) next.name = lineNameFor(text, site.lines);
    texts.value = next;
    typed[room].value = JSON.stringify(next);
  };
  const word = nouns[room];
  const submit = () => {
    if (use.value !== '') {
      chosen[room].value = use.value;
      return next();
    }
    touched.value = true;
    if (!entry) return void requestAnimationFrame(() => form.current?.querySelector<HTMLElement>('.is-wrong')?.focus());
    draft.edit(withEntry(site, room, entry, null));
    chosen[room].value = entry.name;
    typed[room].value = '';
    next();
  };
  return (
    <form
      ref={form}
      class="form"
      noValidate
      aria-label={t('Wizard: {word}', { word })}
      onSubmit={(e) => {
        e.preventDefault();
        submit();
      }}
    >
      {fitting.length > 0 && (
        <fieldset class="choices">
          <legend>{t('Take one that is there, or describe a new one')}</legend>
          {fitting.map((e) => (
            <label key={e.name} class="check">
              <input type="radio" name={`wizard-${room}`} checked={use.value === e.name} onChange={() => (use.value = e.name)} /> {e.name}
            </label>
          ))}
          <label class="check">
            <input type="radio" name={`wizard-${room}`} checked={use.value === ''} onChange={() => (use.value = '')} />{' '}{newText[room]}
          </label>
        </fieldset>
      )}
      {use.value === '' && room === 'lines' && (
        <fieldset class="choices">
          <legend>{t('What kind of line is it?')}</legend>
          {kinds.map((k) => (
            <label key={k.id} class="check">
              <input type="radio" name="wizard-kind" checked={kindOf(texts.value.uri ?? '') === k.id} onChange={() => set('uri')(k.uri)} /> {k.text}
            </label>
          ))}
        </fieldset>
      )}
      {use.value === '' && (
        <div class="form-grid">
          {fieldsOf[room]
            .filter((f) => keys[room].includes(f.key))
            .map((f) => (
              <EntryField key={f.key} f={f} site={site} texts={texts.value} onText={set(f.key)} fault={touched.value || (texts.value[f.key] ?? '') !== '' ? faults[f.key] : undefined} />
            ))}
        </div>
      )}
      {use.value === '' && touched.value && (faults.line || faults.drive) && <p class="form-told is-fault">{faults.line ?? faults.drive}</p>}
      <div class="form-foot">
        {back && (
          <button type="button" class="button" onClick={back}>
            {t('Back')}
          </button>
        )}
        <button type="submit" class="button primary">
          {t('Next')}
        </button>
      </div>
    </form>
  );
}

/** The fields of a step: what is proposed, and on top of it what was typed for the same line or drive before a reload. */
function begun(room: Room, draft: SiteDraft): Texts {
  const proposed = first(room, draft);
  try {
    const before = JSON.parse(typed[room].peek() || '{}') as Texts;
    const same = before.line === proposed.line && before.drive === proposed.drive;
    return same ? { ...proposed, ...Object.fromEntries(Object.entries(before).filter(([k]) => keys[room].includes(k))) } : proposed;
  } catch {
    return proposed; // half of it is nothing
  }
}

const kindOf = (uri: string) => uri.split(':')[0] ?? '';

function first(room: Room, draft: SiteDraft): Texts {
  const site = draft.draft.peek();
  if (room === 'lines') return { name: lineNameFor('twin', site.lines), uri: 'twin', family: '' };
  if (room === 'drives') return { name: numbered(site.drives, 'feeder'), line: chosen.lines.peek(), presence: 'auto' };
  return { name: freeName(site.axes, chosen.drives.peek() || 'axis'), drive: chosen.drives.peek(), number: String(freeNumber(site)), unit: 'mm', increments_per_unit: '', channel: '1' };
}
