// Palette of the register map: the points and parameters of one axis, to be dragged into a free place. In: the axis, what is known of it. Out: what was
// pressed or picked up. A finger or a key picks up by one press and puts down by the next. Shows at most 80 at once, and says how many more there are.
import { useSignal, type Signal } from '@preact/signals';
import { useEffect } from 'preact/hooks';
import { useGateway } from '../gateway';
import { t } from '../language';
import { naturalType } from '../text/mapping-type';
import { tableOf, type Known, type RegisterType, type Table } from '../text/mapping';
import type { Carried } from '../state/mapping-carry';
import { useBarred } from './gate';
import { useNamed } from './name';

const most = 80;
const parameters_ms = 400;

export interface PaletteProps {
  known: Known;
  table: Table;
  axis: Signal<string>;
  /** By a pressed pointer. */
  press: (e: PointerEvent, what: Carried) => void;
  /** By a click or a key. */
  pick: (what: Carried) => void;
}

export function MappingPalette({ known, table, axis, press, pick }: PaletteProps) {
  const { store } = useGateway();
  const named = useNamed();
  const no = useBarred('engineer');
  const wanted = useSignal('');
  const current = useSignal('');
  // The map comes first; what else the axis has is asked for when it has been drawn.
  const later = useSignal(false);
  useEffect(() => {
    const timer = setTimeout(() => (later.value = true), parameters_ms);
    return () => clearTimeout(timer);
  }, []);
  const names = store.axisNames.value;
  const chosen = names.includes(axis.value) ? axis.value : (names[0] ?? '');
  const bits = tableOf(table).bits;
  const text = wanted.value.trim().toLowerCase();
  const points = known.points.map((p) => ({ name: p.point, access: p.access as string, text: p.description }));
  const parameters = chosen === '' || !later.value ? [] : (known.parameters(chosen) ?? []).map((name) => ({ name, access: '', text: t('parameter of the drive') }));
  const all = [...points, ...parameters].filter((p) => text === '' || p.name.toLowerCase().includes(text) || p.text.toLowerCase().includes(text));
  // One place for the Tab key; the arrows go from one to the next.
  const here = Math.max(0, all.slice(0, most).findIndex((p) => p.name === current.value));
  const walk = (e: KeyboardEvent & { currentTarget: HTMLElement }) => {
    const way = { ArrowDown: 1, ArrowUp: -1 }[e.key];
    if (way === undefined) return;
    e.preventDefault();
    e.currentTarget.querySelectorAll<HTMLElement>('.palette-item')[here + way]?.focus();
  };
  const carried = (point: string): Carried => {
    const type: RegisterType = bits ? 'bool' : (naturalType(chosen, point, known) ?? 'i32');
    return { kind: 'new', axis: chosen, point, type, ...(type === 'string' ? { length: 16 } : {}) };
  };
  return (
    <aside class="map-palette" aria-label={t('Points and parameters')}>
      <label class="select">
        <span>{t('Points of')}</span>
        <select value={chosen} onChange={(e) => (axis.value = e.currentTarget.value)}>
          {names.map((n) => (
            <option key={n} value={n}>
              {named(n)}
            </option>
          ))}
        </select>
      </label>
      <input type="search" class="search" aria-label={t('Filter points and parameters')} placeholder={t('Filter')} value={wanted.value} onInput={(e) => (wanted.value = e.currentTarget.value)} />
      <p class="where">{t('Drag one into a free place; or press it, then the place.')}</p>
      <ul class="palette-list scroll" onKeyDown={walk}>
        {all.slice(0, most).map((p, i) => (
          <li key={p.name}>
            <button
              type="button"
              class="palette-item"
              title={p.text}
              data-point={p.name}
              tabIndex={i === here ? 0 : -1}
              onFocus={() => (current.value = p.name)}
              {...no}
              onPointerDown={(e) => !no.disabled && press(e, carried(p.name))}
              onClick={(e) => e.detail === 0 && pick(carried(p.name))}
            >
              <span class="mono">{p.name}</span> <span class="where mono">{carried(p.name).kind === 'new' ? typeText(carried(p.name)) : ''} {p.access}</span>
            </button>
          </li>
        ))}
      </ul>
      {all.length > most && <p class="where">{t('{n} more: type a part of the name.', { n: all.length - most })}</p>}
      {all.length === 0 && <p class="where">{t('No point or parameter has this in its name.')}</p>}
    </aside>
  );
}
const typeText = (c: Carried): string => (c.kind === 'new' ? c.type : '');
