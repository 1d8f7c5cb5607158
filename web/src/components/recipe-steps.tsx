// Recipe steps as forms, one per step, nested where the recipe nests. In: the document and the faults that the gateway has found in it.
// Out: a changed copy of the document. Never checks by itself: the gateway does, and its sentences stand at the step they are about.
import { useSignal } from '@preact/signals';
import { gatewayText, midSentence, t } from '../language';
import { toggledIn } from '../state/toggled';
import { added, at, changed, faultsOfStep, fieldsOfStep, freshStep, kindOf, moved, placesOf, pointerOf, removed, stepKinds, stepSummary, titleOf, typedOf, unitOfField, unknownAxes, unknownText, type Json, type Path, type Step } from '../text/recipe';
import { Icon } from './icon';
import { ConditionFields } from './recipe-condition';
import { EditingProvider, useEditing, type Editing } from './recipe-editing';
import { SimulateText, StepInput } from './recipe-step-input';
import { Typed } from './typed';

export function StepEditor(editing: Editing) {
  // On a phone one begins with the whole recipe in sight, a line for each step.
  const narrow = globalThis.matchMedia?.('(width < 720px)').matches ?? false;
  const folded = useSignal<ReadonlySet<string>>(new Set(narrow ? placesOf(editing.document, ['steps']) : []));
  return (
    <EditingProvider value={{ ...editing, folded }}>
      {editing.document.steps.length > 1 && (
        <div class="recipe-buttons step-folds">
          <button type="button" class="button small" onClick={() => (folded.value = new Set(placesOf(editing.document, ['steps'])))}>
            {t('Fold all')}
          </button>
          <button type="button" class="button small" onClick={() => (folded.value = new Set())}>
            {t('Unfold all')}
          </button>
        </div>
      )}
      <StepList path={['steps']} name={t('Steps')} />
      <datalist id="recipe-axes">
        {editing.axes.map((a) => (
          <option key={a} value={a} />
        ))}
      </datalist>
    </EditingProvider>
  );
}

function StepList({ path, name }: { path: Path; name: string }) {
  const { document, change, axes } = useEditing();
  const steps = (at(document, path) ?? []) as Step[];
  return (
    <div class="step-list">
      <ol aria-label={name}>
        {steps.map((s, i) => (
          <StepRow key={i} step={s} list={path} i={i} last={i === steps.length - 1} />
        ))}
      </ol>
      <label class="select step-add">
        <span class="visually-hidden">{t('Add a step to {n}', { n: midSentence(name) })}</span>
        <select
          value=""
          onChange={(e) => {
            const word = e.currentTarget.value;
            e.currentTarget.value = '';
            if (word) change(added(document, path, freshStep(word, axes[0] ?? '')));
          }}
        >
          <option value="">{t('Add a step…')}</option>
          {stepKinds.map((k) => (
            <option key={k.word} value={k.word}>
              {k.label}
            </option>
          ))}
        </select>
      </label>
    </div>
  );
}

function StepRow({ step, list, i, last }: { step: Step; list: Path; i: number; last: boolean }) {
  const { document, change, faults, unitOf, axes, listed, folded } = useEditing();
  const kind = kindOf(step);
  const path = [...list, i];
  const pointer = pointerOf(path);
  const { mine, any: invalid } = faultsOfStep(faults, pointer, kind);
  const title = titleOf(path);
  const nobody = listed ? unknownAxes(document, axes).filter((u) => u.pointer === pointer) : [];
  const body = kind ? step[kind.word] : undefined;
  // What is wrong is never folded away, nor what is wrong inside.
  const open = invalid || !folded.value.has(pointer);
  const fold = () => (folded.value = toggledIn(folded.peek(), pointer));
  return (
    <li class={`step${mine.length > 0 ? ' is-wrong' : ''}`} data-step={pointer}>
      <div class="step-head">
        <button type="button" class="button quiet small square" aria-expanded={open} aria-label={open ? t('Fold {title}', { title }) : t('Unfold {title}', { title })} disabled={invalid} onClick={fold}>
          <Icon name={open ? 'down' : 'arrow-right'} />
        </button>
        <b class="step-title">{title}</b>
        <span class="step-kind">{kind?.label ?? t('Unknown: {n}', { n: Object.keys(step)[0] ?? 'nothing' })}</span>
        {!open && <span class="step-summary" data-field="summary">{stepSummary(step)}</span>}
        <span class="group">
          <button type="button" class="button small square" aria-label={t('Move {title} up', { title })} disabled={i === 0} onClick={() => change(moved(document, list, i, -1))}>
            <Icon name="up" />
          </button>
          <button type="button" class="button small square" aria-label={t('Move {title} down', { title })} disabled={last} onClick={() => change(moved(document, list, i, 1))}>
            <Icon name="down" />
          </button>
          <button type="button" class="button small square" aria-label={t('Delete {title}', { title })} onClick={() => change(removed(document, list, i))}>
            <Icon name="remove" />
          </button>
        </span>
      </div>
      {open && <div class="step-fields">
        {kind?.condition && kind.condition !== 'until' && <ConditionFields kind={kind} path={path} title={title} />}
        {kind && fieldsOfStep(kind, body).map((f) => (
          <StepInput key={f.key} field={f} path={f.key === '' ? [...path, kind.word] : [...path, kind.word, f.key]} value={f.key === '' ? body : (body as { [k: string]: Json } | null)?.[f.key]} title={title} unit={kind.word === 'command' ? unitOfField(f.key, unitOf(typedOf((body as { [k: string]: Json } | null)?.['axis']))) : ''} />
        ))}
        {kind?.condition === 'until' && <ConditionFields kind={kind} path={path} title={title} />}
        <label class="step-field is-wide">
          <span>{t('Comment')}</span>
          <Typed aria-label={t('{title}: Comment', { title })} placeholder={t('none')} value={typedOf(step['comment'])} onDone={(entered) => change(changed(document, [...path, 'comment'], () => entered || undefined))} />
        </label>
      </div>}
      {mine.map((f) => (
        <p key={f.pointer + f.text} class="step-fault" {...gatewayText}>
          {f.text}. {f.remedy}.
        </p>
      ))}
      {nobody.length > 0 && (
        <p class="step-fault" data-field="no-axis">
          {unknownText(nobody)}
        </p>
      )}
      {open && kind?.word === 'simulate' && <SimulateText axis={(body as { axis?: unknown } | null)?.axis} />}
      {open && kind?.lists?.map((l) => (
        <div key={l} class="step-inner">
          {kind.lists && kind.lists.length > 1 && <p class="step-side">{l === 'then' ? t('Then') : t('Else')}</p>}
          <StepList path={[...path, kind.word, l]} name={l === 'then' ? t('{title}, then', { title }) : l === 'else' ? t('{title}, else', { title }) : t('{title}, steps', { title })} />
        </div>
      ))}
    </li>
  );
}
