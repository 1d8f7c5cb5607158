// Recipe steps as forms, one per step, nested where the recipe nests. In: the document and the faults that the gateway has found in it.
// Out: a changed copy of the document. Never checks by itself: the gateway does, and its sentences stand at the step they are about.
import { gatewayText, midSentence, t } from '../language';
import { useSignal, type Signal } from '@preact/signals';
import { createContext } from 'preact';
import { useContext, useEffect } from 'preact/hooks';
import type { HandItem } from '../api/types';
import { useGateway } from '../gateway';
import type { components } from '../api/schema';
import { added, at, axisMeant, changed, commands, comparisons, fieldsOfStep, freshStep, kindOf, moved, pointerOf, points, removed, stepKinds, stepSummary, takesTolerance, titleOf, unknownAxes, unknownText, typedOf, unitOfField, valueOf, withCommand, type Json, type Path, type RecipeDocument, type Step, type StepField, type StepKind } from '../text/recipe';
import { capital } from '../state/commander';
import { plainWord } from '../text/plain';
import { Icon } from './icon';
import { SimulatedMark } from './name';
import { Typed } from './typed';

export type Fault = components['schemas']['Fault'];
export interface Editing {
  document: RecipeDocument;
  change: (next: RecipeDocument) => void;
  axes: string[];
  /** The axes of the site are known: one that is not among them is not there. */
  listed: boolean;
  /** Unit of the axis that a step names, also by a parameter; null: it is not known. */
  unitOf: (axis: string) => string | null;
  faults: Fault[];
}
/** Steps that are shown in one line, by their places. */
type Folded = Signal<ReadonlySet<string>>;
const Context = createContext<(Editing & { folded: Folded }) | null>(null);
const useEditing = () => useContext(Context) as Editing & { folded: Folded };
const placesOf = (document: RecipeDocument, list: Path): string[] =>
  ((at(document, list) ?? []) as Step[]).flatMap((s, i) => {
    const kind = kindOf(s);
    return [pointerOf([...list, i]), ...(kind?.lists ?? []).flatMap((l) => placesOf(document, [...list, i, kind!.word, l]))];
  });

export function StepEditor(editing: Editing) {
  // On a phone one begins with the whole recipe in sight, a line for each step.
  const narrow = globalThis.matchMedia?.('(width < 720px)').matches ?? false;
  const folded: Folded = useSignal<ReadonlySet<string>>(new Set(narrow ? placesOf(editing.document, ['steps']) : []));
  return (
    <Context.Provider value={{ ...editing, folded }}>
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
    </Context.Provider>
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
  const inner = kind?.lists?.map((l) => `${pointer}/${kind.word}/${l}/`) ?? [];
  const mine = faults.filter((f) => (f.pointer === pointer || f.pointer.startsWith(`${pointer}/`)) && !inner.some((p) => f.pointer.startsWith(p)));
  const title = titleOf(path);
  const nobody = listed ? unknownAxes(document, axes).filter((u) => u.pointer === pointer) : [];
  const body = kind ? step[kind.word] : undefined;
  // What is wrong is never folded away, nor what is wrong inside.
  const invalid = faults.some((f) => f.pointer === pointer || f.pointer.startsWith(`${pointer}/`));
  const open = invalid || !folded.value.has(pointer);
  const fold = () => {
    const next = new Set(folded.peek());
    if (!next.delete(pointer)) next.add(pointer);
    folded.value = next;
  };
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

/** Beside the field in which an axis is named: whether it is simulated now, also where a parameter names it. */
function AxisMark({ named }: { named: unknown }) {
  const { document } = useEditing();
  const axis = typeof named === 'string' ? axisMeant(named, document.parameters) : null;
  return axis ? <SimulatedMark of={axis} /> : null;
}

/** The axis that a step means, when it is known. */
function useMeant(named: unknown): string {
  const { document } = useEditing();
  return (typeof named === 'string' ? axisMeant(named, document.parameters) : null) ?? '';
}

/** What can be simulated on this axis' drive, offered while typing. */
function InputOffers({ id, named }: { id: string; named: unknown }) {
  const { client, store } = useGateway();
  const offers = useSignal<HandItem[]>([]);
  const axis = useMeant(named);
  const simulated = store.simulation('axis', axis).value;
  useEffect(() => {
    const drive = store.axis(axis)?.peek()?.data.drive;
    if (!simulated || !drive) return void (offers.value = []);
    const end = new AbortController();
    client.hand(drive, end.signal).then((items) => (offers.value = items.filter((i) => i.writable)), () => undefined);
    return () => end.abort();
  }, [axis, simulated]);
  return (
    <datalist id={id}>
      {offers.value.map((i) => (
        <option key={i.name} value={i.name}>
          {i.description}
        </option>
      ))}
    </datalist>
  );
}

function SimulateText({ axis: named }: { axis: unknown }) {
  const { store } = useGateway();
  const axis = useMeant(named);
  if (axis === '' || store.axis(axis) === undefined || store.simulation('axis', axis).value) return null;
  return (
    <p class="step-fault" data-field="not-simulated">
      {t('{axis} is not simulated now: a run would be refused. A real drive is never told what is not so.', { axis })}
    </p>
  );
}

function StepInput({ field, path, value, title, unit }: { field: StepField; path: Path; value: unknown; title: string; unit: string }) {
  const { document, change } = useEditing();
  const put = (v: Json | undefined) => change(changed(document, path, () => (v === undefined && !field.optional ? '' : v)));
  const label = `${title}: ${field.label}`;
  if (field.kind === 'command' || field.kind === 'register_type') {
    const choices = field.kind === 'command' ? commands : ['', 'u16', 'i16', 'u32', 'i32', 'f32', 'u64', 'i64', 'f64', 'bool'];
    return (
      <label class="step-field">
        <span>{field.label}</span>
        <select aria-label={label} value={typedOf(value)} onChange={(e) => {
            const to = e.currentTarget.value;
            if (field.kind === 'command') change(changed(document, path.slice(0, -1), (body: { [k: string]: Json }) => withCommand(body, to)));
            else put(to === '' ? undefined : to);
          }}
        >
          {choices.map((c) => (
            <option key={c} value={c}>
              {c === '' ? t('as mapped') : field.kind === 'command' ? capital(plainWord(c)) : plainWord(c)}
            </option>
          ))}
        </select>
      </label>
    );
  }
  return (
    <label class={`step-field${field.kind === 'text' ? ' is-wide' : ''}`}>
      <span>
        {field.label}
        {unit && <span class="unit">, {unit}</span>}
      </span>
      {field.kind === 'axis' && <AxisMark named={value} />}
      {field.kind === 'input' && <InputOffers id={`offers-${pointerOf(path)}`} named={at(document, [...path.slice(0, -1), 'axis'])} />}
      <Typed
        spellcheck={false}
        list={field.kind === 'axis' ? 'recipe-axes' : field.kind === 'input' ? `offers-${pointerOf(path)}` : undefined}
        aria-label={label}
        placeholder={field.optional ? t('none') : undefined}
        value={typedOf(value)}
        onDone={(typed) => {
          if (field.kind === 'text' || field.kind === 'axis' || field.kind === 'input') put(typed === '' && field.optional ? undefined : typed);
          else put(valueOf(typed));
        }}
      />
    </label>
  );
}

function ConditionFields({ kind, path, title }: { kind: StepKind; path: Path; title: string }) {
  const { document, change, axes } = useEditing();
  const place: Path = kind.condition === 'own' ? [...path, kind.word] : [...path, kind.word, kind.condition as string];
  const there = at(document, place) as { [k: string]: Json } | undefined;
  if (kind.condition === 'until' && there === undefined) {
    return (
      <button type="button" class="button small" onClick={() => change(changed(document, place, () => ({ axis: axes[0] ?? '', point: 'target_reached', is: true })))}>
        {t('Add an end: until…')}
      </button>
    );
  }
  const c = there ?? {};
  const op = comparisons.find((x) => x.key in c)?.key ?? 'is';
  const set = (more: { [k: string]: Json | undefined }, drop: string[] = []) =>
    change(
      changed(document, place, () => {
        const next: { [k: string]: Json | undefined } = { ...c, ...more };
        for (const d of drop) delete next[d];
        return next;
      }),
    );
  return (
    <>
      {kind.condition === 'until' && <span class="step-word">{t('until')}</span>}
      <label class="step-field">
        <span>{t('Axis')}</span>
        <AxisMark named={c['axis']} />
        <Typed list="recipe-axes" spellcheck={false} aria-label={t('{title}: Axis', { title })} value={typedOf(c['axis'])} onDone={(entered) => set({ axis: entered })} />
      </label>
      <label class="step-field">
        <span>{t('What')}</span>
        <select
          aria-label={t('{title}: What', { title })}
          value={'parameter' in c ? '(parameter)' : typedOf(c['point'])}
          onChange={(e) => (e.currentTarget.value === '(parameter)' ? set({ parameter: '' }, ['point']) : set({ point: e.currentTarget.value }, ['parameter']))}
        >
          {points.map((p) => (
            <option key={p} value={p}>
              {plainWord(p)}
            </option>
          ))}
          {typeof c['point'] === 'string' && !points.includes(c['point']) && <option value={c['point']}>{plainWord(c['point'])}</option>}
          <option value="(parameter)">{t('a parameter…')}</option>
        </select>
      </label>
      {'parameter' in c && (
        <label class="step-field">
          <span>{t('Parameter')}</span>
          <Typed spellcheck={false} aria-label={t('{title}: Parameter', { title })} value={typedOf(c['parameter'])} onDone={(entered) => set({ parameter: entered })} />
        </label>
      )}
      <label class="step-field is-narrow">
        <span>{t('Comparison')}</span>
        <select aria-label={t('{title}: Comparison', { title })} value={op} onChange={(e) => set({ [e.currentTarget.value]: c[op] as Json }, e.currentTarget.value === op ? [] : [op, ...(takesTolerance(e.currentTarget.value, c[op]) ? [] : ['tolerance'])])}>
          {comparisons.map((x) => (
            <option key={x.key} value={x.key}>
              {x.label}
            </option>
          ))}
        </select>
      </label>
      <label class="step-field is-narrow">
        <span>{t('Value')}</span>
        <Typed spellcheck={false} aria-label={t('{title}: Value', { title })} value={typedOf(c[op])} onDone={(entered) => set({ [op]: valueOf(entered) ?? '' })} />
      </label>
      {('tolerance' in c || takesTolerance(op, c[op])) && (
        <label class="step-field is-narrow">
          <span>{t('Tolerance ±')}</span>
          <Typed
            inputMode="decimal"
            spellcheck={false}
            aria-label={t('{title}: Tolerance', { title })}
            placeholder={t('exact')}
            value={typedOf(c['tolerance'])}
            onDone={(typed) => {
              const tolerance = valueOf(typed);
              if (tolerance === undefined) set({}, ['tolerance']);
              else set({ tolerance });
            }}
          />
        </label>
      )}
    </>
  );
}
