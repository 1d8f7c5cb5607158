// Mapping list: everything that is mapped, for paper: one table per unit, with both ways of counting and the revision. In: the mappings.
// Out: what the printer sees; on the screen it is not drawn. And the links to the lists that the gateway makes itself.
import { listAddress, type MappingDoor } from '../api/mappings';
import { useGateway } from '../gateway';
import { endOf, oneBased, tables, type Known, type Mapping } from '../text/mapping';
import { valueUnit } from '../text/mapping-type';
import { notOffered } from './form';
import { useLoaded, waiting } from './loaded';
import { scaleText } from './mapping-grid';
import { useNamed } from './name';

export function PrintedList({ rows, known, hash }: { rows: readonly Mapping[]; known: Known; hash: string }) {
  const { store } = useGateway();
  const named = useNamed();
  // The units of parameters stand in the catalogue of their axis.
  for (const a of new Set(rows.filter((m) => !known.points.some((p) => p.point === m.point)).map((m) => m.axis))) known.parameters(a);
  // Not followed: an axis is told ten times a second, its unit changes with the site.
  const unitOf = (m: Mapping) => valueUnit(store.axis(m.axis)?.peek().data, m.axis, m.point, known);
  const units = [...new Set(rows.map((m) => m.unit))].sort((a, b) => a - b);
  return (
    <div class="print-only" data-field="printed">
      <p>
        axisgate register list · mapping revision {hash || 'not told by this gateway'} (registers 18 and 19 of each axis) · {rows.length} mappings
      </p>
      {units.flatMap((u) =>
        tables.flatMap((t) => {
          const own = rows.filter((m) => m.unit === u && m.table === t.id).sort((a, b) => a.address - b.address);
          if (own.length === 0) return [];
          return [
            <table key={`${u}/${t.id}`} class="printed">
              <caption>
                Unit {u}, {t.name.toLowerCase()}
              </caption>
              <thead>
                <tr>
                  <th>From 0</th>
                  <th>From 1</th>
                  <th>Axis</th>
                  <th>Point</th>
                  <th>Type</th>
                  <th>Word order</th>
                  <th>Value in</th>
                  <th>Scaling</th>
                  <th>Access</th>
                  <th>Comment</th>
                </tr>
              </thead>
              <tbody>
                {own.map((m) => (
                  <tr key={m.id}>
                    <td>{endOf(m) === m.address ? m.address : `${m.address}–${endOf(m)}`}</td>
                    <td>{oneBased(m.table, m.address)}</td>
                    <td>{named(m.axis)}</td>
                    <td class="mono">{m.point}</td>
                    <td>{m.type}</td>
                    <td>{endOf(m) === m.address ? '' : m.word_order.replace('_', ' ')}</td>
                    <td>{unitOf(m)}</td>
                    <td>{scaleText(m)}</td>
                    <td>{m.access}</td>
                    <td>{m.comment ?? ''}</td>
                  </tr>
                ))}
              </tbody>
            </table>,
          ];
        }),
      )}
    </div>
  );
}

export function ListLinks({ door }: { door: MappingDoor }) {
  const why = useLoaded(door.hasLists, [door], (p) => (p.status === 404 || p.status === 501 ? notOffered('generated lists (HTML, PLC structure)') : p.words));
  return (
    <div class="list-links" data-field="lists">
      <a class="button" href="/api/v1/mappings.csv" download="mappings.csv">
        Export CSV
      </a>
      {!why && (
        <>
          <a class="button" href={listAddress('csv')} download="registers.csv">
            Register list, CSV
          </a>
          <a class="button" href={listAddress('html')} target="_blank" rel="noopener">
            Register list, HTML
          </a>
          <a class="button" href={listAddress('st')} download="axisgate.st">
            PLC structure
          </a>
        </>
      )}
      <button type="button" class="button" onClick={() => print()}>
        Print
      </button>
      {why && why !== waiting && <span class="where">{why}</span>}
    </div>
  );
}
