// Snapshots of an axis' parameters: saved under a name, compared, restored after a look at what will change. In: the HTTP door. Out: a section.
// A restore is never sent without the list of its changes on the page; it is refused by the gateway while the axis is commanded.
import { useSignal } from '@preact/signals';
import { useMemo } from 'preact/hooks';
import { SnapshotDoor, type Snapshot } from '../api/snapshots';
import { useGateway } from '../gateway';
import { t } from '../language';
import { persisted } from '../state/persisted';
import { barred } from '../state/session';
import { SnapshotShelf } from '../state/snapshot-shelf';
import { foreignText, snapshotText } from '../text/snapshot';
import { DeleteButton } from './ask';
import { Choice, notOffered, Tell, TextField } from './form';
import { useBarred, Why } from './gate';
import { Empty } from './lines';
import { useLoaded } from './loaded';
import { Section } from './section';
import { RestoreChanges } from './snapshot-restore';

const gone = (status: number) => status === 404 || status === 405 || status === 501;

export function Snapshots({ axis, family, onList }: { axis: string; family: string; onList: (list: Snapshot[]) => void }) {
  const { client, store } = useGateway();
  const shelf = useMemo(() => new SnapshotShelf(new SnapshotDoor(client, axis), () => client.parameters(axis), onList), [client, axis]);
  const name = persisted(`snapshot.${axis}.name`);
  const comment = persisted(`snapshot.${axis}.comment`);
  const from = useSignal('device');
  const invalid = useSignal(false);
  const no = useBarred('engineer');
  const titles = store.familyTitles.value;
  const why = useLoaded(shelf.load, [shelf], (p) => (gone(p.status) ? notOffered('snapshots') : p.text));
  const save = () => {
    invalid.value = name.value.trim() === '';
    if (!invalid.value) void shelf.save(name, comment, from.value);
  };
  if (why) {
    return (
      <Section title={t('Snapshots')}>
        <div class="card" data-field="snapshots">
          <Empty text={why} />
        </div>
      </Section>
    );
  }
  const list = shelf.list.value;
  const restoring = shelf.restoring.value;
  return (
    <Section title={t('Snapshots')} class="snapshots" help="parameters">
      <form
        class="card form"
        noValidate
        aria-label={t('Save a snapshot')}
        data-field="snapshots"
        onSubmit={(e) => {
          e.preventDefault();
          save();
        }}
      >
        <Why need="engineer" what={t('Saving, restoring and removing a snapshot')} />
        <div class="form-grid">
          <TextField label={t('Name')} value={name.value} onText={(entered) => (name.value = entered)} fault={invalid.value && name.value.trim() === '' ? t('Give it a name.') : undefined} />
          <TextField label={t('Comment')} class="wide" value={comment.value} onText={(entered) => (comment.value = entered)} />
          <Choice label={t('Values')} class="wide" value={from.value} onChoice={(v) => (from.value = v)} choices={[{ value: 'device', text: t('read from the drive now') }, { value: 'stored', text: t('as the gateway has stored them') }]} />
        </div>
        <div class="form-foot">
          <button type="submit" class="button primary" {...no}>
            {t('Save snapshot')}
          </button>
          <Tell reported={shelf.reported.value} field="snapshot-told" />
        </div>
        {list.length === 0 ? (
          <p class="where">{t('No snapshot is kept.')}</p>
        ) : (
          <ul class="rows snapshot-list" aria-label={t('Snapshots')}>
            {[...list].reverse().map((s) => {
              const other = foreignText(s, family, titles);
              return (
              <li key={s.n} class="row" data-snapshot={s.n}>
                <div class="row-head">
                  <h3>
                    {s.name} <span class="where">{t('no. {n}', { n: s.n })}</span>
                  </h3>
                  <button type="button" class="button small" aria-label={t('Restore {name}', { name: s.name })} {...(no.disabled ? no : barred(other))} onClick={() => void shelf.look(s)}>
                    {t('Restore')}
                  </button>
                  <DeleteButton name={s.name} class="small quiet" no={no} onYes={() => void shelf.remove(s)} />
                </div>
                <p class="where">
                  {snapshotText(s, titles)}
                </p>
                {other && (
                  <p class="where">
                    <span class="flag" data-field="foreign">{other}</span>
                  </p>
                )}
              </li>
              );
            })}
          </ul>
        )}
        {list.length > 0 && (
          <div data-field="restore-live">
            <label class="check">
              <input type="checkbox" checked={shelf.live.value} aria-describedby="restore-live-told" onChange={(e) => shelf.setLive(e.currentTarget.checked)} />{' '}
              {t('Restore also what acts at once')}
            </label>
            <p class="form-told" id="restore-live-told">
              {t('Settings are always written back. Some values are no settings but act the moment they are written: switches, set-points, outputs, counters, variables of the program in the drive. Without this mark they are left alone and listed as left out; with it, writing them can switch or move something.')}
            </p>
          </div>
        )}
        {restoring && <RestoreChanges axis={axis} shelf={shelf} restoring={restoring} />}
      </form>
    </Section>
  );
}
