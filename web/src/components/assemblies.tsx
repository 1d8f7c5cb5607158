// Assemblies: EtherNet/IP instances of the site's own, beside those of the axes: which there are, what stands at which byte, adding, changing,
// taking away, and a table of all of them. In: the HTTP door, the revision of the site. Out: a section. Asks before one is taken away: its connections are closed.
import { useSignal } from '@preact/signals';
import { marked } from './marked';
import { AssemblyDoor, type Assemblies as Listed, type Assembly } from '../api/assemblies';
import { useDoor } from '../gateway';
import { t } from '../language';
import { quiet, tellOf, type Reported } from '../state/reported';
import { assemblyText, bytesText, draftOf, emptyAssembly, readAssembly, type AssemblyDraft, type AssemblyFaults } from '../text/assembly';
import { Ask } from './ask';
import { AssemblyTable } from './assembly-table';
import { Choice, notOffered, Tell, TextField } from './form';
import { useBarred } from './gate';
import { useLoaded } from './loaded';
import { useNamed } from './name';
import { Section } from './section';
import { TableHead } from './table-head';

export function Assemblies({ revision }: { revision: unknown }) {
  const door = useDoor(AssemblyDoor);
  const listed = useSignal<Listed | null>(null);
  const draft = useSignal<AssemblyDraft>(emptyAssembly);
  const editing = useSignal<number | null>(null);
  const reported = useSignal<Reported>(quiet);
  const faults = useSignal<AssemblyFaults>({});
  const asking = useSignal<number | null>(null);
  const no = useBarred('engineer');
  const load = async () => void (listed.value = await door.all());
  const why = useLoaded(load, [door, revision], (p) => (p.status === 404 ? notOffered(t('assemblies')) : p.text));
  if (!listed.value) return why ? <Section title={t('EtherNet/IP assemblies')}>{<p class="where">{marked(why)}</p>}</Section> : null;
  const { assemblies, most } = listed.value;

  const send = (what: string, how: () => Promise<unknown>, good: string) => tellOf(reported, what, how, good, load);
  const put = (key: keyof AssemblyDraft) => (value: string) => (draft.value = { ...draft.value, [key]: value });
  const leave = () => {
    editing.value = null;
    draft.value = emptyAssembly;
    faults.value = {};
  };
  const save = async () => {
    const read = readAssembly(draft.value);
    faults.value = 'faults' in read ? read.faults : {};
    if ('faults' in read) {
      reported.value = { tone: 'refused', text: t('Mend the fields that are marked.') };
      return;
    }
    const was = editing.value;
    if (was === null && assemblies.some((a) => a.instance === read.instance)) {
      faults.value = { instance: t('Instance {n} is there: change it, or choose another.', { n: read.instance }) };
      reported.value = { tone: 'refused', text: t('Mend the fields that are marked.') };
      return;
    }
    const good = was === null ? t('Instance {n} is served now.', { n: read.instance }) : t('Instance {n} is changed.', { n: read.instance });
    if (await send(was === null ? t('Adding …') : t('Changing …'), () => door.put(read.instance, read.entry), good)) leave();
  };
  return (
    <Section title={t('EtherNet/IP assemblies')} class="assemblies" fold={assemblies.length}>
      <p class="where">
        {t("Instances of your own, beside 100+n and 150+n of the axes: a range of a unit's registers, byte by byte. {n} of at most {most}. A change closes the connections that are open.", { n: assemblies.filter((a) => !a.of_profile).length, most })}
      </p>
      {assemblies.map((a) => (
        <details key={a.instance} class="card profile" data-assembly={a.instance}>
          <summary>
            {t('Instance {n}:', { n: a.instance })} <strong>{a.name}</strong>, {assemblyText(a)}
          </summary>
          <ByteList assembly={a} />
          <div class="form-foot">
            {a.of_profile ? (
              <span class="where">{t('It comes with the profile of unit {unit} and goes with it.', { unit: a.unit })}</span>
            ) : asking.value === a.instance ? (
              <Ask
                text={t('Take instance {n} away? Connections that are open are closed.', { n: a.instance })}
                yes={t('Take it away')}
                field="assembly-ask"
                onYes={() => {
                  asking.value = null;
                  if (editing.value === a.instance) leave();
                  void send(t('Removing …'), () => door.remove(a.instance), t('Instance {n} is gone.', { n: a.instance }));
                }}
                onNo={() => (asking.value = null)}
              />
            ) : (
              <>
                <button
                  type="button"
                  class="button"
                  {...no}
                  onClick={() => {
                    editing.value = a.instance;
                    draft.value = draftOf(a);
                    faults.value = {};
                  }}
                >
                  {t('Change')}
                </button>
                <button type="button" class="button" {...no} onClick={() => (asking.value = a.instance)}>
                  {t('Take it away')}
                </button>
              </>
            )}
          </div>
        </details>
      ))}
      <form
        class="card form"
        noValidate
        aria-label={editing.value === null ? t('Add an assembly') : t('Change instance {n}', { n: editing.value })}
        onSubmit={(e) => {
          e.preventDefault();
          if (!no.disabled) void save();
        }}
      >
        <div class="form-grid">
          <TextField label={t('Instance')} number value={draft.value.instance} onText={put('instance')} disabled={editing.value !== null} fault={faults.value.instance} hint={t('1 to 65535; 200 to 1000 are free of axes')} />
          <Choice
            label={t('Direction')}
            value={draft.value.direction}
            onChoice={put('direction')}
            choices={[
              { value: 'input', text: t('input: the originator reads it') },
              { value: 'output', text: t('output: the originator renews it') },
            ]}
            fault={faults.value.direction}
          />
          <TextField label={t('Of unit')} number value={draft.value.unit} onText={put('unit')} fault={faults.value.unit} hint={t('with mappings or a profile')} />
          <Choice
            label={t('Registers of')}
            value={draft.value.table}
            onChoice={put('table')}
            choices={[
              { value: 'holding_registers', text: t('holding registers') },
              { value: 'input_registers', text: t('input registers') },
            ]}
            fault={faults.value.table}
          />
          <TextField label={t('First register')} number value={draft.value.address} onText={put('address')} fault={faults.value.address} hint={t('counted from 0')} />
          <TextField label={t('Number of registers')} number value={draft.value.registers} onText={put('registers')} fault={faults.value.registers} hint={t('two bytes each, at most 250')} />
          <Choice
            label={t('Order of bytes')}
            value={draft.value.order}
            onChoice={put('order')}
            choices={[
              { value: 'little_endian', text: t('each value, lowest byte first') },
              { value: 'registers', text: t('as the registers are') },
            ]}
            fault={faults.value.order}
          />
          <TextField label={t('Name')} value={draft.value.comment} onText={put('comment')} fault={faults.value.comment} hint={t('in the EDS; may be empty')} />
        </div>
        <div class="form-foot">
          <button type="submit" class="button primary" {...no}>
            {editing.value === null ? t('Add the assembly') : t('Save the change')}
          </button>
          {editing.value !== null && (
            <button type="button" class="button" onClick={leave}>
              {t('Leave it as it was')}
            </button>
          )}
          <Tell reported={reported.value} field="assembly-told" />
        </div>
      </form>
      <AssemblyTable door={door} taken={load} />
    </Section>
  );
}

function ByteList({ assembly }: { assembly: Assembly }) {
  const named = useNamed();
  return (
    <div class="table-scroll" tabIndex={0} role="region" aria-label={t('Bytes of instance {n}', { n: assembly.instance })}>
      <table class="table profile-registers">
        <TableHead of={[t('Bytes'), t('What'), t('Axis'), t('Type')]} />
        <tbody>
          {assembly.values.map((v) => (
            <tr key={v.offset}>
              <td class="mono">{bytesText(v.offset, v.bytes)}</td>
              <th scope="row">{v.name}</th>
              <td>{v.axis ? named(v.axis) : ''}</td>
              <td class="mono">{v.type}</td>
            </tr>
          ))}
        </tbody>
      </table>
    </div>
  );
}
