// Parameters of a recipe as a form: name, type, default, bounds, unit, what each is for. In: the document and the faults found in it.
// Out: a changed copy. A new name is taken over in every step that uses the old one. Never checks by itself: the gateway does.
import { gatewayText, t } from '../language';
import { useSignal } from '@preact/signals';
import type { Fault } from '../api/types';
import { defaultOf, parameterFault, parameterTypeName, parameterTypes, renamedParameter, typedOf, valueOf, withParameter, withoutParameter, type Json, type RecipeDocument, type RecipeParameter } from '../text/recipe';
import { Icon } from './icon';
import { Typed } from './typed';

export interface RecipeParametersProps {
  document: RecipeDocument;
  change: (next: RecipeDocument) => void;
  faults: readonly Fault[];
}

export function RecipeParameters({ document, change, faults }: RecipeParametersProps) {
  const fresh = useSignal('');
  const error = useSignal('');
  const names = Object.keys(document.parameters ?? {});
  const add = () => {
    const name = fresh.peek().trim();
    error.value = parameterFault(document, name);
    if (error.peek()) return;
    fresh.value = '';
    change(withParameter(document, name, { type: 'number' }));
  };
  return (
    <div class="recipe-parameters" role="group" aria-label={t('Parameters of the recipe')}>
      {names.length === 0 && <p class="where">{t('None: every run does the same. A step uses one as {n}.', { n: '${name}' })}</p>}
      {names.map((name) => (
        <ParameterRow key={name} name={name} document={document} change={change} faults={faults.filter((f) => f.pointer === `/parameters/${name}` || f.pointer.startsWith(`/parameters/${name}/`))} />
      ))}
      <form
        class="recipe-buttons"
        aria-label={t('Add a parameter')}
        onSubmit={(e) => {
          e.preventDefault();
          add();
        }}
      >
        <input class="search" type="text" aria-label={t('Name of the new parameter')} placeholder={t('name')} autocomplete="off" spellcheck={false} value={fresh.value} aria-invalid={error.value !== '' || undefined} onInput={(e) => (fresh.value = e.currentTarget.value)} />
        <button type="submit" class="button">
          {t('Add a parameter')}
        </button>
        {error.value && (
          <span class="step-fault" role="status">
            {error.value}
          </span>
        )}
      </form>
    </div>
  );
}

function ParameterRow({ name, document, change, faults }: RecipeParametersProps & { name: string }) {
  const error = useSignal('');
  const p = document.parameters?.[name] as RecipeParameter;
  const set = (more: Partial<Record<keyof RecipeParameter, Json | undefined>>) => change(withParameter(document, name, more));
  const label = (what: string) => t('Parameter {name}: {what}', { name, what });
  const isNumber = p.type === 'number' || p.type === 'integer';
  const field = (what: string, value: unknown, put: (typed: string) => void, more: { wide?: boolean; list?: string } = {}) => (
    <label class={`step-field${more.wide ? ' is-wide' : ' is-narrow'}`}>
      <span>{what}</span>
      <Typed spellcheck={false} aria-label={label(what)} list={more.list} placeholder={t('none')} value={typedOf(value)} onDone={put} />
    </label>
  );
  return (
    <div class={`step${faults.length > 0 ? ' is-wrong' : ''}`} data-recipe-parameter={name}>
      <div class="parameter-row">
        <div class="step-fields">
          <label class="step-field">
            <span>{t('Name')}</span>
            <Typed
              class="mono"
              spellcheck={false}
              aria-label={label(t('Name'))}
              aria-invalid={error.value !== '' || undefined}
              value={name}
              onDone={(text) => {
                const typed = text.trim();
                error.value = typed === name ? '' : parameterFault(document, typed);
                if (!error.peek() && typed !== name) change(renamedParameter(document, name, typed));
              }}
            />
          </label>
          <label class="step-field">
            <span>{t('Type')}</span>
            <select
              aria-label={label(t('Type'))}
              value={p.type}
              onChange={(e) => {
                const type = e.currentTarget.value;
                const numeric = type === 'number' || type === 'integer';
                set({ type, default: defaultOf(type, typedOf(p.default)), ...(numeric ? {} : { min: undefined, max: undefined }) });
              }}
            >
              {parameterTypes.map((type) => (
                <option key={type} value={type}>
                  {parameterTypeName(type)}
                </option>
              ))}
            </select>
          </label>
          {field(t('Default'), p.default, (entered) => set({ default: defaultOf(p.type, entered) }), p.type === 'axis' ? { list: 'recipe-axes' } : {})}
          {isNumber && field(t('Least'), p.min, (entered) => set({ min: valueOf(entered) }))}
          {isNumber && field(t('Most'), p.max, (entered) => set({ max: valueOf(entered) }))}
          {isNumber && field(t('Unit'), p.unit, (entered) => set({ unit: entered.trim() || undefined }))}
          {field(t('What it is for'), p.description, (entered) => set({ description: entered || undefined }), { wide: true })}
        </div>
        <button type="button" class="button small square" aria-label={t('Remove parameter {name}', { name })} title={t('Remove')} onClick={() => change(withoutParameter(document, name))}>
          <Icon name="remove" />
        </button>
      </div>
      {error.value && (
        <p class="step-fault" role="status">
          {error.value}
        </p>
      )}
      {faults.map((f) => (
        <p key={f.pointer + f.text} class="step-fault" {...gatewayText}>
          {f.text}. {f.remedy}.
        </p>
      ))}
    </div>
  );
}
