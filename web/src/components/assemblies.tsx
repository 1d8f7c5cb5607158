// Assemblies: EtherNet/IP instances of the site's own, beside those of the axes: which there are, what stands at which byte, adding, changing,
// taking away. In: the HTTP door, the revision of the site. Out: a section. Asks before one is taken away: its connections are closed.
import { useSignal } from '@preact/signals';
import { useMemo } from 'preact/hooks';
import { AssemblyDoor, type Assemblies as Listed, type Assembly } from '../api/assemblies';
import { asProblem } from '../api/problem';
import { useGateway } from '../gateway';
import { assemblyWords, bytesWords, draftOf, emptyAssembly, readAssembly, type AssemblyDraft, type AssemblyFaults } from '../text/assembly';
import { Ask } from './ask';
import { Choice, notOffered, quiet, Tell, TextField, type Told } from './form';
import { useBarred } from './gate';
import { useLoaded } from './loaded';
import { useNamed } from './name';
import { Section } from './section';

export function Assemblies({ revision }: { revision: unknown }) {
  const { client } = useGateway();
  const door = useMemo(() => new AssemblyDoor(client), [client]);
  const listed = useSignal<Listed | null>(null);
  const draft = useSignal<AssemblyDraft>(emptyAssembly);
  const editing = useSignal<number | null>(null);
  const told = useSignal<Told>(quiet);
  const faults = useSignal<AssemblyFaults>({});
  const asking = useSignal<number | null>(null);
  const no = useBarred('engineer');
  const load = async () => void (listed.value = await door.all());
  const why = useLoaded(load, [door, revision], (p) => (p.status === 404 ? notOffered('assemblies') : p.words));
  if (!listed.value) return why ? <Section title="EtherNet/IP assemblies">{<p class="where">{why}</p>}</Section> : null;
  const { assemblies, most } = listed.value;

  const send = async (what: string, how: () => Promise<unknown>, good: string) => {
    told.value = { tone: 'busy', text: what };
    try {
      await how();
      told.value = { tone: 'good', text: good };
      await load();
      return true;
    } catch (error) {
      told.value = { tone: 'refused', text: asProblem(error).words };
      return false;
    }
  };
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
      told.value = { tone: 'refused', text: 'Mend the fields that are marked.' };
      return;
    }
    const was = editing.value;
    if (was === null && assemblies.some((a) => a.instance === read.instance)) {
      faults.value = { instance: `Instance ${read.instance} is there: change it, or choose another.` };
      told.value = { tone: 'refused', text: 'Mend the fields that are marked.' };
      return;
    }
    const good = was === null ? `Instance ${read.instance} is served now.` : `Instance ${read.instance} is changed.`;
    if (await send(was === null ? 'Adding …' : 'Changing …', () => door.put(read.instance, read.entry), good)) leave();
  };
  return (
    <Section title="EtherNet/IP assemblies" class="assemblies">
      <p class="where">
        Instances of your own, beside 100+n and 150+n of the axes: a range of a unit's registers, byte by byte. {assemblies.filter((a) => !a.of_profile).length} of at most {most}. A change closes the connections that are open.
      </p>
      {assemblies.map((a) => (
        <details key={a.instance} class="card profile" data-assembly={a.instance}>
          <summary>
            Instance {a.instance}: <strong>{a.name}</strong>, {assemblyWords(a)}
          </summary>
          <ByteList assembly={a} />
          <div class="form-foot">
            {a.of_profile ? (
              <span class="where">It comes with the profile of unit {a.unit} and goes with it.</span>
            ) : asking.value === a.instance ? (
              <Ask
                words={`Take instance ${a.instance} away? Connections that are open are closed.`}
                yes="Take it away"
                field="assembly-ask"
                onYes={() => {
                  asking.value = null;
                  if (editing.value === a.instance) leave();
                  void send('Removing …', () => door.remove(a.instance), `Instance ${a.instance} is gone.`);
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
                  Change
                </button>
                <button type="button" class="button" {...no} onClick={() => (asking.value = a.instance)}>
                  Take it away
                </button>
              </>
            )}
          </div>
        </details>
      ))}
      <form
        class="card form"
        noValidate
        aria-label={editing.value === null ? 'Add an assembly' : `Change instance ${editing.value}`}
        onSubmit={(e) => {
          e.preventDefault();
          if (!no.disabled) void save();
        }}
      >
        <div class="form-grid">
          <TextField label="Instance" number value={draft.value.instance} onText={put('instance')} disabled={editing.value !== null} fault={faults.value.instance} hint="1 to 65535; 200 to 1000 are free of axes" />
          <Choice
            label="Direction"
            value={draft.value.direction}
            onChoice={put('direction')}
            choices={[
              { value: 'input', text: 'input: the originator reads it' },
              { value: 'output', text: 'output: the originator renews it' },
            ]}
            fault={faults.value.direction}
          />
          <TextField label="Of unit" number value={draft.value.unit} onText={put('unit')} fault={faults.value.unit} hint="with mappings or a profile" />
          <Choice
            label="Registers of"
            value={draft.value.table}
            onChoice={put('table')}
            choices={[
              { value: 'holding_registers', text: 'holding registers' },
              { value: 'input_registers', text: 'input registers' },
            ]}
            fault={faults.value.table}
          />
          <TextField label="First register" number value={draft.value.address} onText={put('address')} fault={faults.value.address} hint="counted from 0" />
          <TextField label="Number of registers" number value={draft.value.registers} onText={put('registers')} fault={faults.value.registers} hint="two bytes each, at most 250" />
          <Choice
            label="Order of bytes"
            value={draft.value.order}
            onChoice={put('order')}
            choices={[
              { value: 'little_endian', text: 'each value, lowest byte first' },
              { value: 'registers', text: 'as the registers are' },
            ]}
            fault={faults.value.order}
          />
          <TextField label="Name" value={draft.value.comment} onText={put('comment')} fault={faults.value.comment} hint="in the EDS; may be empty" />
        </div>
        <div class="form-foot">
          <button type="submit" class="button primary" {...no}>
            {editing.value === null ? 'Add the assembly' : 'Save the change'}
          </button>
          {editing.value !== null && (
            <button type="button" class="button" onClick={leave}>
              Leave it as it was
            </button>
          )}
          <Tell told={told.value} field="assembly-told" />
        </div>
      </form>
    </Section>
  );
}

function ByteList({ assembly }: { assembly: Assembly }) {
  const named = useNamed();
  return (
    <div class="table-scroll" tabIndex={0} role="region" aria-label={`Bytes of instance ${assembly.instance}`}>
      <table class="table profile-registers">
        <thead>
          <tr>
            <th scope="col">Bytes</th>
            <th scope="col">What</th>
            <th scope="col">Axis</th>
            <th scope="col">Type</th>
          </tr>
        </thead>
        <tbody>
          {assembly.values.map((v) => (
            <tr key={v.offset}>
              <td class="mono">{bytesWords(v.offset, v.bytes)}</td>
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
