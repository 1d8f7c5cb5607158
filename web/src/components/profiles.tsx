// Profiles: units that speak another device's language: which there are, what stands at their registers, adding and taking away.
// In: the HTTP door, the revision of the site, units that have mappings. Out: a section, and what it has loaded for others. Asks before a profile is taken away.
import { useSignal, type Signal } from '@preact/signals';
import { marked } from './marked';
import { useMemo } from 'preact/hooks';
import { ProfileDoor, type Profile, type Profiles as Listed } from '../api/profiles';
import { useDoor, useGateway } from '../gateway';
import { gatewayText, t, theirs } from '../language';
import { addressBase } from '../state/address-base';
import { persisted } from '../state/persisted';
import { quiet, tellOf, type Reported } from '../state/reported';
import { instanceText, profileText, readProfile, registerRows, type ProfileFaults } from '../text/profile';
import { Ask } from './ask';
import { Choice, notOffered, Tell, TextField } from './form';
import { useBarred } from './gate';
import { useLoaded } from './loaded';
import { useNamed } from './name';
import { Section } from './section';
import { TableHead } from './table-head';

const unit = persisted('profile.unit');
const language = persisted('profile.language', 'lexium');
const counts = persisted('profile.counts');
const velocity = persisted('profile.velocity');
const acceleration = persisted('profile.acceleration');
const input = persisted('profile.input');
const output = persisted('profile.output');
const object = persisted('profile.object');

export function Profiles({ listed, mapped, revision }: { listed: Signal<Listed | null>; mapped: ReadonlySet<number>; revision: unknown }) {
  const { store } = useGateway();
  const door = useDoor(ProfileDoor);
  const axes = useSignal<readonly string[]>(['']);
  const reported = useSignal<Reported>(quiet);
  const faults = useSignal<ProfileFaults>({});
  const asking = useSignal<number | null>(null);
  const named = useNamed();
  const no = useBarred('engineer');
  const load = async () => void (listed.value = await door.all());
  const why = useLoaded(load, [door, revision], (p) => (p.status === 404 ? notOffered(t('profiles')) : p.text));
  if (!listed.value) return why ? <Section title={t("Profiles: another device's registers")}>{<p class="where">{marked(why)}</p>}</Section> : null;
  const { languages, profiles } = listed.value;
  const chosen = languages.find((l) => l.language === language.value);
  const title = (p: Profile) => languages.find((l) => l.language === p.language)?.title ?? p.language;

  const send = (what: string, how: () => Promise<unknown>, good: string) => tellOf(reported, what, how, good, load);
  const add = async () => {
    const taken = new Map<number, string>([...[...mapped].map((u) => [u, t('mappings')] as const), ...profiles.map((p) => [p.unit, t('the profile {title}', { title: title(p) })] as const)]);
    const read = readProfile({ unit: unit.value, language: language.value, axes: axes.value, counts: counts.value, velocity: velocity.value, acceleration: acceleration.value, input: input.value, output: output.value, object: object.value }, languages, taken);
    faults.value = 'faults' in read ? read.faults : {};
    if ('faults' in read) {
      reported.value = { tone: 'refused', text: t('Mend the fields that are marked.') };
      return;
    }
    if (await send(t('Adding …'), () => door.put(read.unit, read.entry), t('Unit {unit} speaks {title} now.', { unit: read.unit, title: chosen?.title ?? '' }))) unit.value = input.value = output.value = object.value = '';
  };
  const place = (i: number, value: string) => {
    const next = axes.value.map((a, k) => (k === i ? value : a)).filter((a, k) => a !== '' || k === 0);
    axes.value = (chosen?.axes ?? 1) > next.length && next.at(-1) !== '' ? [...next, ''] : next;
  };
  return (
    <Section title={t("Profiles: another device's registers")} class="profiles" help="profiles" fold={profiles.length}>
      <p class="where">{t("A unit of its own speaks the registers that a machine's program was written for, whatever drive is behind.")}</p>
      {profiles.map((p) => (
        <details key={p.unit} class="card profile" data-profile={p.unit}>
          <summary>
            {t('Unit {unit}:', { unit: p.unit })} <strong>{title(p)}</strong> {t('in front of {axes}', { axes: profileText(p) })}
            {instanceText(p) !== '' && <span class="where"> {t('EtherNet/IP: {list}', { list: instanceText(p) })}</span>}
          </summary>
          <RegisterList profile={p} listed={listed.value!} />
          <div class="form-foot">
            {asking.value === p.unit ? (
              <Ask
                text={t('Take the profile of unit {unit} away? Clients of this unit are refused from then on.', { unit: p.unit })}
                yes={t('Take it away')}
                field="profile-ask"
                onYes={() => {
                  asking.value = null;
                  void send(t('Removing …'), () => door.remove(p.unit), t('Unit {unit} has no profile now.', { unit: p.unit }));
                }}
                onNo={() => (asking.value = null)}
              />
            ) : (
              <button type="button" class="button" {...no} onClick={() => (asking.value = p.unit)}>
                {t('Take it away')}
              </button>
            )}
          </div>
        </details>
      ))}
      <form
        class="card form"
        noValidate
        aria-label={t('Add a profile')}
        onSubmit={(e) => {
          e.preventDefault();
          if (!no.disabled) void add();
        }}
      >
        <div class="form-grid">
          <TextField label={t('Unit ID')} number value={unit.value} onText={(x) => (unit.value = x)} fault={faults.value.unit} hint={t('2 to 254, without mappings')} />
          <Choice
            label={t('Speaks')}
            value={language.value}
            onChoice={(v) => {
              language.value = v;
              axes.value = axes.value.slice(0, 1);
            }}
            choices={languages.map((l) => ({ value: l.language, text: l.title }))}
            fault={faults.value.language}
            hint={chosen && theirs(chosen.description)}
          />
          {axes.value.map((a, i) => (
            <Choice
              key={i}
              label={(chosen?.axes ?? 1) > 1 ? t('Axis {n}', { n: i + 1 }) : t('Axis')}
              value={a}
              onChoice={(v) => place(i, v)}
              choices={[{ value: '', text: i === 0 ? t('choose') : t('none') }, ...store.axisNames.value.map((n) => ({ value: n, text: named(n) }))]}
              fault={i === 0 ? faults.value.axes : undefined}
            />
          ))}
          <TextField label={t('Counts per unit')} number value={counts.value} onText={(x) => (counts.value = x)} fault={faults.value.counts} hint={t('of the program, for one unit of the axis; empty: as the language has it')} />
          <TextField label={t('Full speed')} number value={velocity.value} onText={(x) => (velocity.value = x)} fault={faults.value.velocity} hint={t("units/s; empty: the axis' limit")} />
          <TextField label={t('Full acceleration')} number value={acceleration.value} onText={(x) => (acceleration.value = x)} fault={faults.value.acceleration} hint={t("units/s²; empty: the axis' limit")} />
          <TextField label={t('Input assembly')} number value={input.value} onText={(x) => (input.value = x)} fault={faults.value.input} hint={t('EtherNet/IP instance; empty: none')} />
          <TextField label={t('Output assembly')} number value={output.value} onText={(x) => (output.value = x)} fault={faults.value.output} hint={t('EtherNet/IP instance; empty: none')} />
          {language.value === 'lexium' && (
            <TextField label={t('Instance of its objects')} number value={object.value} onText={(x) => (object.value = x)} fault={faults.value.object} hint={t('of classes 64h to 6Ah; empty: none')} />
          )}
        </div>
        <div class="form-foot">
          <button type="submit" class="button primary" {...no}>
            {t('Add the profile')}
          </button>
          <Tell reported={reported.value} field="profile-told" />
        </div>
      </form>
    </Section>
  );
}

function RegisterList({ profile, listed }: { profile: Profile; listed: Listed }) {
  const page = listed.languages.find((l) => l.language === profile.language);
  const base = addressBase();
  const rows = useMemo(() => (page ? registerRows(page, profile.axes.length, base) : []), [page, profile.axes.length, base]);
  return (
    <div class="table-scroll" tabIndex={0} role="region" aria-label={t('Registers of unit {unit}', { unit: profile.unit })}>
      <table class="table profile-registers">
        <TableHead of={[t('Register'), t('Name'), t('Type'), t('Access'), t('What it is'), ...(profile.object_instance != null ? [t('EtherNet/IP')] : [])]} />
        <tbody>
          {rows.map((r) => (
            <tr key={r.key}>
              <td class="mono">{r.where}</td>
              <th scope="row">{r.name}</th>
              <td class="mono">{r.type}</td>
              <td>{r.access}</td>
              <td {...gatewayText}>{r.text}</td>
              {profile.object_instance != null && <td>{r.object}</td>}
            </tr>
          ))}
        </tbody>
      </table>
    </div>
  );
}
