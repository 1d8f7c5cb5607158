// Plot cursors: what the two cursors of a plot read, as a table, and the buttons for the part of time that is seen. In: the plot's view, its curves and how
// one is read at an instant. Out: buttons and a table; nothing is drawn into the plot here.
import { t } from '../language';
import type { PlotView } from '../state/plot-view';
import { formatNumber } from '../text/number';
import type { Curve } from './plot-options';
import { PressGroup } from './press-group';
import { TableHead } from './table-head';

/** What the two cursors read, and the difference. */
export function CursorTable({ view, curves, read, clock }: { view: PlotView; curves: readonly Curve[]; read: (curve: Curve, instant: number) => number | null; clock: (instant: number) => string }) {
  const [a, b] = [view.cursors[0].value, view.cursors[1].value];
  const title = (c: Curve) => `${c.name}, ${c.unit}`;
  const at = (name: string, instant: number | null) => ({ name, time: instant === null ? '–' : clock(instant), read: (c: Curve) => (instant === null ? null : read(c, instant)) });
  const rows = [at('A', a), at('B', b)];
  if (a !== null && b !== null) {
    const difference = (c: Curve) => {
      const [p, q] = [read(c, a), read(c, b)];
      return p === null || q === null ? null : q - p;
    };
    rows.push({ name: 'B − A', time: `${formatNumber(b - a, 3)} s`, read: difference });
  }
  return (
    <div class="scope-cursors">
      <PressGroup label={t('Cursor that a click or the arrow keys place')} of={[0, 1].map((i) => ({ value: i, text: i === 0 ? 'A' : 'B', on: view.active.value === i }))} press={(i) => (view.active.value = i as 0 | 1)}>
        <button type="button" class="button small" onClick={() => view.cursors.forEach((c) => (c.value = null))} disabled={a === null && b === null}>
          {t('None')}
        </button>
      </PressGroup>
      {a === null && b === null ? (
        <span class="where">{t('Click into the plot to place cursor {n}.', { n: view.active.value === 0 ? 'A' : 'B' })}</span>
      ) : (
        <div class="scroll">
          <table class="cursor-table">
            <TableHead of={[t('Cursor'), t('Time'), ...curves.map(title)]} />
            <tbody>
              {rows.map((r) => (
                <tr key={r.name}>
                  <th scope="row">{r.name}</th>
                  <td class="mono" data-label={t('Time')}>
                    {r.time}
                  </td>
                  {curves.map((c) => (
                    <td key={c.id} class="mono" data-label={title(c)}>
                      {formatNumber(r.read(c), 3)}
                    </td>
                  ))}
                </tr>
              ))}
            </tbody>
          </table>
        </div>
      )}
    </div>
  );
}

/** Closer, further, left, right, all: what a drag and the keys do, for a finger. */
export function PlotButtons({ view }: { view: PlotView }) {
  const [r, w] = [view.range.value, view.whole.value];
  const all = r[1] - r[0] >= w[1] - w[0] - 1e-9;
  return (
    <div class="group" role="group" aria-label={t('Part of time')}>
      <button type="button" class="button small" onClick={() => view.pan(-0.5)} disabled={r[0] <= w[0]} aria-label={t('Earlier')} title={t('Earlier (Page up)')}>
        ←
      </button>
      <button type="button" class="button small" onClick={() => view.zoom(0.5)} title={t('Closer (+); or drag over a part of the plot')}>
        {t('Closer')}
      </button>
      <button type="button" class="button small" onClick={() => view.zoom(2)} disabled={all} title={t('Further (-)')}>
        {t('Further')}
      </button>
      <button type="button" class="button small" onClick={() => view.all()} disabled={all} title={t('All of it (0, or a double click)')}>
        {t('All')}
      </button>
      <button type="button" class="button small" onClick={() => view.pan(0.5)} disabled={r[1] >= w[1]} aria-label={t('Later')} title={t('Later (Page down)')}>
        →
      </button>
    </div>
  );
}
