// Snapshots of an axis' parameters: saved under a name, compared, restored after a look at what will change. In: the HTTP door. Out: a section.
// A restore is never sent without the list of its changes on the page; it is refused by the gateway while the axis is commanded.
import { t } from '../language';
import { barred } from '../state/session';
import { useBarred, Why } from './gate';
import { useSignal } from '@preact/signals';
import { useMemo } from 'preact/hooks';
import { SnapshotDoor, type RestoreReport, type Snapshot } from '../api/snapshots';
import type { AxisParameter, MaybeValue } from '../api/types';
import { useGateway } from '../gateway';
import { capital } from '../state/commander';
import { emptied, persisted } from '../state/persisted';
import { steppedText, unitText, valueText } from '../text/parameter';
import { foreignText, snapshotText } from '../text/snapshot';
import { leftOut, parametersText } from '../text/transfer';
import { DeleteButton } from './ask';
import { Choice, notOffered, quiet, Tell, TextField, type Reported } from './form';
import { Empty } from './lines';
import { useLoaded } from './loaded';
import { AxisName } from './name';
import { Section } from './section';
import { tellOf } from './reported';

const plain = { allowed: null };
const gone = (status: number) => status === 404 || status === 405 || status === 501;

export function Snapshots({ axis, family, onList }: { axis: string; family: string; onList: (list: Snapshot[]) => void }) {
  const { client, store } = useGateway();
  const door = useMemo(() => new SnapshotDoor(client, axis), [client, axis]);
  const list = useSignal<Snapshot[]>([]);
  const reported = useSignal<Reported>(quiet);
  const name = persisted(`snapshot.${axis}.name`);
  const comment = persisted(`snapshot.${axis}.comment`);
  const from = useSignal('device');
  const invalid = useSignal(false);
  const no = useBarred('engineer');
  const live = useSignal(false);
  const titles = store.familyTitles.value;
  const shapes = useSignal<Shapes>(new Map());
  const restoring = useSignal<{ snapshot: Snapshot; report: RestoreReport; chosen: Set<string> } | null>(null);

  const load = async () => {
    list.value = await door.list();
    onList(list.value);
  };
  const why = useLoaded(load, [door], (p) => (gone(p.status) ? notOffered('snapshots') : p.text));

  /** What was done is done, whether or not the list can be read after it. */
  const again = () => load().catch(() => undefined);
  const tell = (busy: string, act: () => Promise<string>) => tellOf(reported, busy, act, (text) => text);
  const save = () => {
    invalid.value = name.value.trim() === '';
    if (invalid.value) return;
    void tell(from.value === 'device' ? t('Reading all parameters from the drive …') : t('Saving …'), async () => {
      const sent = { name: name.value, comment: comment.value };
      const s = await door.save({ name: sent.name.trim(), comment: sent.comment.trim(), from: from.value });
      emptied(name, sent.name);
      emptied(comment, sent.comment);
      await again();
      return t('Saved as {n}.', { n: s.n });
    });
  };
  const look = (s: Snapshot, withLive = live.peek()) =>
    tell(t('Comparing with the drive …'), async () => {
      const report = await door.restore(s.n, withLive ? { dry_run: true, include_live: true } : { dry_run: true });
      // Names and units only: what is to be written is in the report.
      if (shapes.peek().size === 0) shapes.value = new Map((await client.parameters(axis).catch(() => [])).map((x) => [x.id, x]));
      live.value = withLive;
      restoring.value = { snapshot: s, report, chosen: new Set((report.changes ?? []).map((c) => c.parameter)) };
      return report.changes?.length ? t('Nothing has been changed yet.') : t('The drive has all values of {name} already.', { name: s.name });
    });
  const restore = () => {
    const r = restoring.value;
    if (!r || r.chosen.size === 0) return;
    void tell(t('Writing {size} …', { size: parametersText(r.chosen.size) }), async () => {
      const done = await door.restore(r.snapshot.n, { parameters: [...r.chosen], dry_run: false, ...(live.peek() ? { include_live: true } : {}) });
      restoring.value = null;
      const failed = done.failed ?? [];
      if (failed.length > 0) throw new Error(t('{n} written; NOT written: {n2}', { n: done.changed?.length ?? 0, n2: failed.map((f) => `${f.parameter} (${f.reason})`).join(', ') }));
      return t('{n} restored from {name}.', { n: parametersText(done.changed?.length ?? r.chosen.size), name: r.snapshot.name });
    });
  };
  const remove = (s: Snapshot) =>
    tell(t('Removing …'), async () => {
      await door.remove(s.n);
      await again();
      return t('{name} is deleted.', { name: s.name });
    });

  if (why) {
    return (
      <Section title={t('Snapshots')}>
        <div class="card" data-field="snapshots">
          <Empty text={why} />
        </div>
      </Section>
    );
  }
  const r = restoring.value;
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
          <Tell reported={reported.value} field="snapshot-told" />
        </div>
        {list.value.length === 0 ? (
          <p class="where">{t('No snapshot is kept.')}</p>
        ) : (
          <ul class="rows snapshot-list" aria-label={t('Snapshots')}>
            {[...list.value].reverse().map((s) => {
              const other = foreignText(s, family, titles);
              return (
              <li key={s.n} class="row" data-snapshot={s.n}>
                <div class="row-head">
                  <h3>
                    {s.name} <span class="where">{t('no. {n}', { n: s.n })}</span>
                  </h3>
                  <button type="button" class="button small" aria-label={t('Restore {name}', { name: s.name })} {...(no.disabled ? no : barred(other))} onClick={() => void look(s)}>
                    {t('Restore')}
                  </button>
                  <DeleteButton name={s.name} class="small quiet" no={no} onYes={() => void remove(s)} />
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
        {list.value.length > 0 && (
          <div data-field="restore-live">
            <label class="check">
              <input
                type="checkbox"
                checked={live.value}
                aria-describedby="restore-live-told"
                onChange={(e) => {
                  live.value = e.currentTarget.checked;
                  if (restoring.peek()) void look(restoring.peek()!.snapshot, e.currentTarget.checked);
                }}
              />{' '}
              {t('Restore also what acts at once')}
            </label>
            <p class="form-told" id="restore-live-told">
              {t('Settings are always written back. Some values are no settings but act the moment they are written: switches, set-points, outputs, counters, variables of the program in the drive. Without this mark they are left alone and listed as left out; with it, writing them can switch or move something.')}
            </p>
          </div>
        )}
        {r && (r.report.changes?.length ?? 0) > 0 && (
          <fieldset class="changes">
            <legend>
              {t('Restoring {name} changes {n} of', { name: r.snapshot.name, n: parametersText(r.report.changes?.length ?? 0) })}{' '}<AxisName name={axis} plain />
            </legend>
            <ul>
              {r.report.changes?.map((c) => (
                <li key={c.parameter}>
                  <label class="check">
                    <input
                      type="checkbox"
                      checked={r.chosen.has(c.parameter)}
                      onChange={(e) => {
                        const chosen = new Set(r.chosen);
                        if (e.currentTarget.checked) chosen.add(c.parameter);
                        else chosen.delete(c.parameter);
                        restoring.value = { ...r, chosen };
                      }}
                    />
                    <Known id={c.parameter} shapes={shapes.value} />
                    <span>
                      <span class="mono">
                        {valueText(c.from, shapes.value.get(c.parameter) ?? plain)} → {valueText(c.to, shapes.value.get(c.parameter) ?? plain)}
                      </span>{' '}
                      <span class="unit">{unitAfter(c.to, shapes.value.get(c.parameter))}</span>
                    </span>
                  </label>
                </li>
              ))}
            </ul>
            {(r.report.skipped?.length ?? 0) > 0 && <LeftOut skipped={r.report.skipped ?? []} shapes={shapes.value} />}
            <div class="form-foot">
              <button type="button" class="button primary" disabled={r.chosen.size === 0} {...no} onClick={restore}>
                {r.chosen.size === 1 ? t('Write 1 value to the drive') : t('Write {n} values to the drive', { n: r.chosen.size })}
              </button>
              <button type="button" class="button quiet" onClick={() => (restoring.value = null)}>
                {t('Change nothing')}
              </button>
            </div>
          </fieldset>
        )}
      </form>
    </Section>
  );
}

type Shapes = ReadonlyMap<string, AxisParameter>;

/** "AC[1] motor acceleration". */
function Known({ id, shapes }: { id: string; shapes: Shapes }) {
  const name = shapeOf(id, shapes)?.name.replaceAll('_', ' ') ?? '';
  return (
    <span class="both">
      <span class="mono id">{id}</span>
      {name && <span class="name"> {name}</span>}
    </span>
  );
}
/** An element of an array has the name of the array. */
const shapeOf = (id: string, shapes: Shapes) => shapes.get(id) ?? shapes.get(id.replace(/\[\d+\]$/, ''));
const unitAfter = (value: MaybeValue, p: AxisParameter | undefined): string => (!p || p.allowed ? '' : `${unitText(p.unit)} ${steppedText(value, p.unit)}`.trim());

function LeftOut({ skipped, shapes }: { skipped: { parameter: string; why: string }[]; shapes: Shapes }) {
  const groups = leftOut(skipped);
  return (
    <details class="where" data-field="left-out">
      <summary>
        {t('Left out: {n} (', { n: parametersText(skipped.length) })}{groups.map((g) => `${g.parameters.length}: ${g.why}`).join('; ')})
      </summary>
      <ul>
        {groups.map((g) => (
          <li key={g.why}>
            {capital(g.why)}
            <ul class="left-out-ids">
              {g.parameters.map((id) => (
                <li key={id}>
                  <Known id={id} shapes={shapes} /> <span class="unit">{unitText(shapeOf(id, shapes)?.unit ?? null)}</span>
                </li>
              ))}
            </ul>
          </li>
        ))}
      </ul>
    </details>
  );
}
