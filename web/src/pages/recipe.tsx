// Recipe: one recipe: forms and JSON side by side, checked by the gateway as it is typed; below it its runs. In: the document of the gateway. Out: a changed
// document, only when it is saved.
import { useEffect, useMemo } from 'preact/hooks';
import { Gate, useBarred } from '../components/gate';
import { Empty } from '../components/lines';
import { useLoaded } from '../components/loaded';
import { RecipeBar, RecipeJson } from '../components/recipe-bar';
import { RecipeParameters } from '../components/recipe-parameters';
import { RecipeRehearsalPart } from '../components/recipe-rehearsal';
import { RecordPart } from '../components/recipe-record';
import { RunReports } from '../components/recipe-report';
import { RunHead, useRuns } from '../components/recipe-run';
import { StepEditor } from '../components/recipe-steps';
import { Section } from '../components/section';
import { useGateway } from '../gateway';
import { gatewayText, t } from '../language';
import { RecipeDraft } from '../state/recipe-draft';
import type { RecipeRuns } from '../state/recipe-runs';
import { unitOf } from '../text/axis';
import { axisMeant, faultsElsewhere, type RecipeDocument } from '../text/recipe';

export function RecipePage({ name }: { name: string }) {
  const { client, store } = useGateway();
  const no = useBarred('engineer');
  const draft = useMemo(() => new RecipeDraft(client, name, () => (store.listed.peek() ? store.axisNames.peek() : null)), [client, name]);
  const why = useLoaded(draft.load, [draft]);
  useEffect(() => (no.disabled ? undefined : draft.checkSoon()), [draft, draft.text.value, no.disabled]);
  const d = draft.document.value;
  const parameters = d?.parameters ?? {};
  const run = useRuns(name, parameters);
  return (
    <main class="page">
      <p class="crumbs">
        <a href="/recipes">{t('Recipes')}</a>
      </p>
      <h1 tabIndex={-1}>{name}</h1>
      {!d && why && <Empty text={why} />}
      {d && (
        <>
          <RecipeBar name={name} draft={draft} document={d} />
          <RunHead run={run} parameters={parameters} saved={!draft.unsaved.value && draft.stored.value !== ''} />
          <div class="recipe-sides">
            <Gate need="engineer" silent>
              <Forms name={name} draft={draft} document={d} run={run} />
            </Gate>
            <RecipeJson draft={draft} />
          </div>
          <RunReports run={run} />
          <RecipeRehearsalPart name={name} document={d} run={run} saved={!draft.unsaved.value && draft.stored.value !== ''} />
        </>
      )}
    </main>
  );
}

/** The parameters and the steps as forms. */
function Forms({ name, draft, document: d, run }: { name: string; draft: RecipeDraft; document: RecipeDocument; run: RecipeRuns }) {
  const { store } = useGateway();
  const faults = draft.faults.value;
  const given = run.typed.value;
  const unitMeant = (named: string) => {
    const axis = axisMeant(named, d.parameters, given);
    const entry = axis === null ? undefined : store.axis(axis);
    return entry ? unitOf(entry.peek().data) : null;
  };
  return (
    <div>
      <Section title={t('Parameters')} fold={!faults.some((f) => f.pointer.startsWith('/parameters/')) && Object.keys(d.parameters ?? {}).length}>
        <div class="card recipe-card">
          <RecipeParameters document={d} change={draft.put} faults={faults} />
        </div>
      </Section>
      <Section title={t('Steps')}>
        <div class="card recipe-card">
          <RecordPart recipe={name} persisted={!draft.unsaved.value || d.steps.length === 0} add={(steps) => draft.put({ ...d, steps: [...d.steps, ...steps] })} />
          <StepEditor document={d} change={draft.put} axes={store.axisNames.value} listed={store.listed.value} unitOf={unitMeant} faults={faults} />
          {faultsElsewhere(faults, d).map((f) => (
            <p key={f.pointer + f.text} class="step-fault" {...gatewayText}>
              {f.pointer}: {f.text}. {f.remedy}.
            </p>
          ))}
        </div>
      </Section>
    </div>
  );
}
