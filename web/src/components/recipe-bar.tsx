// Recipe bar: what a recipe is for, what becomes of its axes when it fails, how long it may take; save and delete, how that went, and what somebody else has made
// of it meanwhile. And the recipe as JSON. In: the draft. Out: a changed draft, requests of its buttons.
import { t } from '../language';
import { go } from '../router';
import type { RecipeDraft } from '../state/recipe-draft';
import { recipeDifferences, valueOf, type RecipeDocument } from '../text/recipe';
import { DeleteButton } from './ask';
import { Gate, useBarred } from './gate';
import { marked } from './marked';
import { Section } from './section';
import { Typed } from './typed';

const mostDifferences = 50;

export function RecipeBar({ name, draft, document: d }: { name: string; draft: RecipeDraft; document: RecipeDocument }) {
  const clash = draft.clash.value;
  const result = draft.result.value;
  const remove = () => void draft.remove().then((good) => good && go('/recipes'));
  return (
    <>
      <Gate need="engineer">
        <Bar name={name} draft={draft} document={d} remove={remove} />
      </Gate>
      <p class={`result result-${result.tone}`} role="status">
        <span>{clash ? t('{text} What you typed is kept.', { text: clash.text }) : draft.unsaved.value && result.tone !== 'refused' ? t('Not saved yet.') : marked(result.text)}</span>
      </p>
      {clash && <Clash draft={draft} document={d} clash={clash} remove={remove} />}
    </>
  );
}

function Bar({ name, draft, document: d, remove }: { name: string; draft: RecipeDraft; document: RecipeDocument; remove: () => void }) {
  const no = useBarred('engineer');
  return (
    <div class="recipe-bar">
      <Typed
        class="recipe-description"
        aria-label={t('Description')}
        placeholder={t('What it does')}
        value={typeof d.description === 'string' ? d.description : ''}
        onDone={(entered) => draft.put({ ...d, description: entered })}
      />
      <label class="select">
        {t('If it fails')}
        <select aria-label={t('If it fails')} value={d.on_failure ?? 'halt'} onChange={(e) => draft.put({ ...d, on_failure: e.currentTarget.value as 'halt' | 'quick_stop' })}>
          <option value="halt">{t('halt its axes')}</option>
          <option value="quick_stop">{t('quick stop its axes')}</option>
        </select>
      </label>
      <label class="select">
        {t('At most, s')}
        <Typed
          class="recipe-limit"
          inputMode="decimal"
          aria-label={t('Longest time of a run, s')}
          placeholder="3600"
          value={typeof d.timeout_s === 'number' ? String(d.timeout_s) : ''}
          onDone={(entered) => {
            const { timeout_s: _, ...rest } = d;
            const typed = valueOf(entered);
            draft.put(typed === undefined ? { ...rest } : ({ ...rest, timeout_s: typed } as RecipeDocument));
          }}
        />
      </label>
      <button type="button" class="button primary" disabled={!draft.unsaved.value || draft.textFault.value !== '' || draft.clash.value !== null} {...no} onClick={() => void draft.save()}>
        {t('Save')}
      </button>
      <DeleteButton name={name} class="" no={no} onYes={remove} />
    </div>
  );
}

function Clash({ draft, document: d, clash, remove }: { draft: RecipeDraft; document: RecipeDocument; clash: NonNullable<RecipeDraft['clash']['value']>; remove: () => void }) {
  const no = useBarred('engineer');
  return (
    <div class="theirs card form" role="group" aria-label={t('Somebody else\'s change')} data-field="recipe-clash">
      <p class="where">{t('From what the gateway has now to what you typed:')}</p>
      <ul class="differences" aria-label={t('What differs')}>
        {recipeDifferences(clash.now ?? {}, d)
          .slice(0, mostDifferences)
          .map((entered) => (
            <li key={entered} class="mono">
              {entered}
            </li>
          ))}
      </ul>
      <div class="form-foot">
        <button type="button" class="button" {...no} onClick={() => (clash.act === 'remove' ? remove() : void draft.save())}>
          {clash.act === 'remove' ? t('Delete it all the same') : t('Save mine all the same')}
        </button>
        <button type="button" class="button" onClick={() => draft.adopt()}>
          {t('Take theirs')}
        </button>
      </div>
    </div>
  );
}

export function RecipeJson({ draft }: { draft: RecipeDraft }) {
  const no = useBarred('engineer');
  const faults = draft.faults.value;
  const textFault = draft.textFault.value;
  return (
    <Section title={t('JSON')} fold={textFault === ''}>
      <div class="card recipe-card">
        <textarea
          class="recipe-json mono"
          aria-label={t('The recipe as JSON')}
          aria-invalid={textFault !== '' || undefined}
          spellcheck={false}
          readOnly={no.disabled ?? false}
          value={draft.text.value}
          onInput={(e) => draft.type(e.currentTarget.value)}
        />
        <p class="step-fault" role="status">
          {textFault || (faults.length > 0 ? (faults.length === 1 ? t('1 place is not right yet.') : t('{n} places are not right yet.', { n: faults.length })) : '')}
        </p>
      </div>
    </Section>
  );
}
