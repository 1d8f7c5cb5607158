// Actions: every command of the axis' family by name, as a form with a field for each argument. In: axis and family. Out: one request when Run is
// pressed, after a question where the catalogue says what is lost; the answer in words. What was typed stays for the visit, whatever becomes of it.
// Never sends by itself, nor twice.
import { gatewayText, t } from '../language';
import { marked } from './marked';
import { useSignal } from '@preact/signals';
import { useGateway } from '../gateway';
import { capital } from '../state/commander';
import { persisted } from '../state/persisted';
import { quiet, refusal, type Reported } from '../state/reported';
import { plain } from '../text/plain';
import { bodyOf, nameOf, questionOf, faultsOf, found, hintOf, isFlag, labelOf, recipeText, type CatalogueCommand } from '../text/action';
import { Ask } from './ask';
import { Choice, notOffered, Tell, TextField } from './form';
import { Gate } from './gate';
import { useLoaded } from './loaded';

export function Actions({ axis, family }: { axis: string; family: string }) {
  const { client } = useGateway();
  const commands = useSignal<CatalogueCommand[] | null>(null);
  const sought = persisted(`typed.action.sought.${axis}`);
  const chosen = persisted(`typed.action.name.${axis}`);
  const why = useLoaded(async () => void (commands.value = await client.familyCommands(family)), [client, family], (p) => (p.status === 404 ? notOffered(t('actions of this family')) : p.text));
  if (commands.value === null) return <p class="where">{marked(why)}</p>;
  const offered = found(commands.value, sought.value);
  const command = commands.value.find((c) => c.id === chosen.value);
  const listed = command && !offered.includes(command) ? [command, ...offered] : offered;
  return (
    <Gate need="engineer">
      <div class="form card" data-part="actions">
        <div class="form-grid">
          <TextField label={t('Find')} value={sought.value} onText={(t) => (sought.value = t)} hint={t('{n} of {all}', { n: offered.length, all: commands.value.length })} />
          <Choice label={t('Action')} value={chosen.value} onChoice={(id) => (chosen.value = id)} choices={listed.map((c) => ({ value: c.id, text: c.id === c.name ? nameOf(c) : `${nameOf(c)} (${c.id})` }))} />
        </div>
        {command && <ActionForm key={`${axis} ${command.id}`} axis={axis} command={command} />}
      </div>
    </Gate>
  );
}

function ActionForm({ axis, command }: { axis: string; command: CatalogueCommand }) {
  const { client } = useGateway();
  const typed = persisted(`typed.action.values.${axis}.${command.id}`, '{}');
  const text = persisted(`typed.action.text.${axis}.${command.id}`);
  const reported = useSignal<Reported>(quiet);
  const tried = useSignal(false);
  /** What was asked about: it alone is sent when the answer is yes. */
  const asked = useSignal<ReturnType<typeof bodyOf> | null>(null);
  const values: Record<string, string> = JSON.parse(typed.value);
  const faults = faultsOf(command, values);
  const change = (name: string, t: string) => {
    asked.value = null; // a question about other values is none
    typed.value = JSON.stringify({ ...JSON.parse(typed.peek()), [name]: t });
  };
  const run = () => {
    tried.value = true;
    const now: Record<string, string> = JSON.parse(typed.peek());
    if (Object.keys(faultsOf(command, now)).length > 0) {
      reported.value = { tone: 'refused', text: t('Not sent: see the fields.') };
      return;
    }
    const body = bodyOf(command, now, text.peek());
    if (!command.confirm) return void send(body);
    reported.value = quiet;
    asked.value = body;
  };
  const send = async (body: ReturnType<typeof bodyOf>) => {
    asked.value = null;
    reported.value = { tone: 'busy', text: t('Sent…') };
    try {
      const a = await client.act(axis, body);
      reported.value = { tone: 'good', text: capital(plain(a.text || `${nameOf(command)}: ${a.result}`)) };
    } catch (error) {
      reported.value = refusal(error);
    }
  };
  const asStep = Object.keys(faults).length === 0 ? recipeText(command, values) : '';
  return (
    <form
      class="form"
      data-action={command.id}
      onSubmit={(e) => {
        e.preventDefault();
        run();
      }}
    >
      <p class="where" {...gatewayText} data-field="action-description">
        {command.description}
      </p>
      <div class="form-grid">
        {command.arguments.length === 0 && <TextField label={t('Argument')} value={text.value} onText={(t) => { asked.value = null; text.value = t; }} hint={t('Most take none.')} />}
        {command.arguments.map((a) =>
          isFlag(a) ? (
            <Choice key={a.name} label={labelOf(a)} value={values[a.name] ?? ''} onChoice={(v) => change(a.name, v)} choices={[{ value: 'true', text: t('true') }, { value: 'false', text: t('false') }]} fault={tried.value ? faults[a.name] : undefined} hint={hintOf(a)} />
          ) : (
            <TextField
              key={a.name}
              label={labelOf(a)}
              value={values[a.name] ?? ''}
              onText={(t) => change(a.name, t)}
              number={a.type !== 'text' && a.type !== 'bytes'}
              placeholder={a.default === null || a.default === undefined ? t('needed') : String(a.default)}
              fault={tried.value || (values[a.name] ?? '') !== '' ? faults[a.name] : undefined}
              hint={hintOf(a)}
            />
          ),
        )}
      </div>
      <div class="form-foot">
        <button type="submit" class="button primary">
          {command.confirm ? t('Run …') : t('Run')}
        </button>
      </div>
      {asked.value && (
        <Ask
          field="action-question"
          text={questionOf(command, axis)}
          yes={t('Run {command}', { command: nameOf(command) })}
          onNo={() => (asked.value = null)}
          onYes={() => {
            if (asked.peek()) void send(asked.peek() as ReturnType<typeof bodyOf>);
          }}
        />
      )}
      {asStep && (
        <p class="where">
          {t('In a recipe:')}{' '}<span class="mono" data-field="action-as-text">{`${command.name}: ${asStep}`}</span>
        </p>
      )}
      <Tell reported={reported.value} field="action-result" />
    </form>
  );
}
