// Snapshot restore: what restoring a snapshot would change, each with a mark whether it is written, and what is left out with the reason. In: the shelf. Out: the
// choice, and the restore when its button is pressed.
import type { AxisParameter, MaybeValue } from '../api/types';
import { t } from '../language';
import { capital } from '../state/commander';
import type { Restoring, Shapes, SnapshotShelf } from '../state/snapshot-shelf';
import { steppedText, unitText, valueText } from '../text/parameter';
import { leftOut, parametersText } from '../text/transfer';
import { useBarred } from './gate';
import { AxisName } from './name';

const plain = { allowed: null };
/** An element of an array has the name of the array. */
const shapeOf = (id: string, shapes: Shapes) => shapes.get(id) ?? shapes.get(id.replace(/\[\d+\]$/, ''));
const unitAfter = (value: MaybeValue, p: AxisParameter | undefined): string => (!p || p.allowed ? '' : `${unitText(p.unit)} ${steppedText(value, p.unit)}`.trim());

export function RestoreChanges({ axis, shelf, restoring: { snapshot, report, chosen } }: { axis: string; shelf: SnapshotShelf; restoring: Restoring }) {
  const no = useBarred('engineer');
  const shapes = shelf.shapes.value;
  const { changes = [], skipped = [] } = report;
  if (changes.length === 0) return null;
  return (
    <fieldset class="changes">
      <legend>
        {t('Restoring {name} changes {n} of', { name: snapshot.name, n: parametersText(changes.length) })}{' '}<AxisName name={axis} plain />
      </legend>
      <ul>
        {changes.map((c) => {
          const shape = shapes.get(c.parameter);
          return (
            <li key={c.parameter}>
              <label class="check">
                <input type="checkbox" checked={chosen.has(c.parameter)} onChange={() => shelf.choose(c.parameter)} />
                <Known id={c.parameter} shapes={shapes} />
                <span>
                  <span class="mono">
                    {valueText(c.from, shape ?? plain)} → {valueText(c.to, shape ?? plain)}
                  </span>{' '}
                  <span class="unit">{unitAfter(c.to, shape)}</span>
                </span>
              </label>
            </li>
          );
        })}
      </ul>
      {skipped.length > 0 && <LeftOut skipped={skipped} shapes={shapes} />}
      <div class="form-foot">
        <button type="button" class="button primary" disabled={chosen.size === 0} {...no} onClick={() => void shelf.restore()}>
          {chosen.size === 1 ? t('Write 1 value to the drive') : t('Write {n} values to the drive', { n: chosen.size })}
        </button>
        <button type="button" class="button quiet" onClick={() => (shelf.restoring.value = null)}>
          {t('Change nothing')}
        </button>
      </div>
    </fieldset>
  );
}

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
