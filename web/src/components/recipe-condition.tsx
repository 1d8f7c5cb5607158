// Recipe condition: what a step waits for or looks at: the axis, a point or a parameter, a comparison, a value. In: the step's kind and place. Out: a changed copy of
// the document.
import { t } from '../language';
import { plainWord } from '../text/plain';
import { at, changed, comparisons, points, takesTolerance, typedOf, valueOf, type Json, type Path, type StepKind } from '../text/recipe';
import { AxisMark, useEditing } from './recipe-editing';
import { Typed } from './typed';

export function ConditionFields({ kind, path, title }: { kind: StepKind; path: Path; title: string }) {
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
