// Mapping list: everything that is mapped, for paper: one table per unit, with both ways of counting and the revision, and the standard map once. In: the
// mappings. Out: what the printer sees; on the screen it is not drawn, and not made before something is printed. And the links to the files of it.
import { render } from 'preact';
import { useEffect, useRef } from 'preact/hooks';
import { listAddress, type MappingDoor } from '../api/mappings';
import { GatewayProvider, useGateway } from '../gateway';
import { midSentence, t } from '../language';
import { endOf, oneBased, tables, widthOf, type Known, type Mapping } from '../text/mapping';
import { valueUnit } from '../text/mapping-type';
import { standardRegisters } from '../text/register-map';
import { notOffered } from './form';
import { useLoaded, waiting } from './loaded';
import { scaleText } from './mapping-panel';
import { useNamed } from './name';

export interface ListProps {
  rows: readonly Mapping[];
  known: Known;
  hash: string;
}

/** Parameters have their unit in the catalogue of their axis, which is asked for when the page has been drawn: paper does not wait. */
const catalogues_ms = 1000;
const axesOfParameters = (rows: readonly Mapping[], known: Known) => new Set(rows.filter((m) => !known.points.some((p) => p.point === m.point)).map((m) => m.axis));

/** The list, made when something is printed: of 4096 entries it is larger than the whole page. */
export function PrintedOnPaper(props: ListProps) {
  const gateway = useGateway();
  const box = useRef<HTMLDivElement>(null);
  const now = useRef(props);
  now.current = props;
  useEffect(() => {
    const end = new AbortController();
    const draw = () => {
      if (!box.current) return;
      render(
        <GatewayProvider value={gateway}>
          <PrintedList {...now.current} />
        </GatewayProvider>,
        box.current,
      );
    };
    const paper = globalThis.matchMedia?.('print');
    addEventListener('beforeprint', draw, { signal: end.signal });
    paper?.addEventListener?.('change', (e) => e.matches && draw(), { signal: end.signal });
    return () => {
      end.abort();
      if (box.current) render(null, box.current);
    };
  }, [gateway]);
  useEffect(() => {
    if (props.known.points.length === 0) return;
    const timer = setTimeout(() => {
      for (const axis of axesOfParameters(now.current.rows, now.current.known)) now.current.known.parameters(axis);
    }, catalogues_ms);
    return () => clearTimeout(timer);
  }, [props.rows, props.known.points]);
  return <div ref={box} class="print-only" />;
}

export function PrintedList({ rows, known, hash }: ListProps) {
  const { store } = useGateway();
  const named = useNamed();
  for (const axis of axesOfParameters(rows, known)) known.parameters(axis);
  // Not followed: an axis is told ten times a second, its unit changes with the site.
  const unitOf = (m: Mapping) => valueUnit(store.axis(m.axis)?.peek().data, m.axis, m.point, known);
  const units = [...new Set(rows.map((m) => m.unit))].sort((a, b) => a - b);
  return (
    <div class="print-only" data-field="printed">
      <p>
        {t('axisgate register list · mapping revision {hash} (registers 18 and 19 of each axis) · {n} mappings', { hash: hash || t('not told by this gateway'), n: rows.length })}
      </p>
      {units.flatMap((u) =>
        tables.flatMap((table) => {
          const own = rows.filter((m) => m.unit === u && m.table === table.id).sort((a, b) => a.address - b.address);
          if (own.length === 0) return [];
          return [
            <table key={`${u}/${table.id}`} class="printed">
              <caption>
                {t('Unit {unit}, {table}', { unit: u, table: midSentence(table.name) })}
              </caption>
              <thead>
                <tr>
                  <th>{t('From 0')}</th>
                  <th>{t('From 1')}</th>
                  <th>{t('Axis')}</th>
                  <th>{t('Point')}</th>
                  <th>{t('Type')}</th>
                  <th>{t('Word order')}</th>
                  <th>{t('Value in')}</th>
                  <th>{t('Scaling')}</th>
                  <th>{t('Access')}</th>
                  <th>{t('Comment')}</th>
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
                    <td>{endOf(m) === m.address ? '' : m.word_order === 'low_first' ? t('low first') : t('high first')}</td>
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
      <StandardList />
    </div>
  );
}

/** Unit 1 once: where each axis begins, and what stands from there on. */
function StandardList() {
  const { store } = useGateway();
  const named = useNamed();
  const axes = store.axisNames.value.flatMap((n) => store.axis(n)?.peek().data ?? []);
  if (axes.length === 0) return null;
  return (
    <table class="printed" data-field="printed-standard">
      <caption>
        {t('Unit 1, the standard map. The registers of an axis begin at: {list}', { list: axes.map((a) => t('{axis} {address}', { axis: named(a.name), address: (a.number - 1) * 64 })).join(', ') })}
      </caption>
      <thead>
        <tr>
          <th>{t('From there')}</th>
          <th>{t('Point')}</th>
          <th>{t('Type')}</th>
          <th>{t('Access')}</th>
        </tr>
      </thead>
      <tbody>
        {standardRegisters.map((r) => (
          <tr key={r.offset}>
            <td>{widthOf(r.type) === 1 ? r.offset : `${r.offset}–${r.offset + widthOf(r.type) - 1}`}</td>
            <td class="mono">{r.point || r.name}</td>
            <td>{r.type}</td>
            <td>{r.writable ? 'RW' : 'R'}</td>
          </tr>
        ))}
      </tbody>
    </table>
  );
}

export function ListLinks({ door }: { door: MappingDoor }) {
  const why = useLoaded(door.hasLists, [door], (p) => (p.status === 404 || p.status === 501 ? notOffered(t('generated lists (CSV, PLC structure)')) : p.text));
  return (
    <div class="list-links" data-field="lists">
      <a class="button" href="/api/v1/mappings.csv" download="mappings.csv">
        {t('Export CSV')}
      </a>
      {!why && (
        <>
          <a class="button" href={listAddress('csv')} download="registers.csv">
            {t('Register list, CSV')}
          </a>
          <a class="button" href={listAddress('st')} download="axisgate.st">
            {t('PLC structure')}
          </a>
        </>
      )}
      <button type="button" class="button" onClick={() => print()}>
        {t('Print')}
      </button>
      {why && why !== waiting && <span class="where">{why}</span>}
    </div>
  );
}
