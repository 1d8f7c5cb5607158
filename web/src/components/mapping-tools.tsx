// Mapping tools: what stands beside the title of the register map: which view, unit and table is shown, how addresses are counted, where to go, what is added, and undo.
// In: what is shown, the book. Out: what is chosen; nothing is sent but by undo and by the choice of what gaps answer.
import type { Signal } from '@preact/signals';
import type { MappingDoor } from '../api/mappings';
import { midSentence, t } from '../language';
import { addressBase, countFrom } from '../state/address-base';
import type { MappingBook } from '../state/mappings';
import { persisted } from '../state/persisted';
import { tables, type Table } from '../text/mapping';
import { isStandard } from '../text/register-map';
import { useBarred } from './gate';
import { Icon } from './icon';
import { addAt } from './mapping-form';
import { MappingUnit } from './mapping-unit';
import { PressGroup } from './press-group';

const goTo = persisted('mappings.go_to');
export type Dialog = '' | 'paste' | 'template';
interface ToolsProps {
  door: MappingDoor;
  book: MappingBook;
  revision: unknown;
  view: { mode: Signal<string>; unit: Signal<string>; table: Signal<string>; dialog: Signal<Dialog> };
  units: readonly number[];
  /** Why the unit takes no mappings; empty: it does. */
  fixed: string;
  show: (address: string) => void;
  undo: () => void;
}

export function MappingTools({ door, book, revision, view, units, fixed, show, undo }: ToolsProps) {
  const no = useBarred('engineer');
  const onMap = view.mode.value === 'map';
  const unit = Number(view.unit.value);
  const table = view.table.value as Table;
  const base = addressBase();
  const last = book.changes.value.at(-1);
  const toggle = (which: Dialog) => (view.dialog.value = view.dialog.peek() === which ? '' : which);
  return (
    <>
      <PressGroup label={t('View')} look="" of={[{ value: 'map', text: t('Map'), on: onMap }, { value: 'hmi', text: t('What the HMI sees'), on: !onMap }]} press={(m) => (view.mode.value = m)} />
      {onMap && (
        <label class="select">
          <span>{t('Unit ID')}</span>
          <select value={view.unit.value} onChange={(e) => (view.unit.value = e.currentTarget.value)}>
            {units.map((u) => (
              <option key={u} value={String(u)}>
                {u}
              </option>
            ))}
          </select>
        </label>
      )}
      <label class="select" title={t('How register addresses are written everywhere on this page; tables and files count from 0')}>
        <span>{t('Addresses')}</span>
        <select value={base} onChange={(e) => countFrom(e.currentTarget.value === '1' ? '1' : '0')}>
          <option value="0">{t('from 0')}</option>
          <option value="1">{t('from 1 (40001)')}</option>
        </select>
      </label>
      {onMap && (
        <>
          {fixed === '' && <MappingUnit door={door} unit={unit} revision={revision} />}
          <PressGroup
            label={t('Table')}
            class="tables"
            look=""
            of={tables.map((x) => ({ value: x.id, title: x.name, on: table === x.id, text: <>{x.short} <span class="where">{book.rows.value.filter((m) => m.unit === unit && m.table === x.id).length}</span></> }))}
            press={(x) => (view.table.value = x)}
          />
          <form
            class="map-go"
            onSubmit={(e) => {
              e.preventDefault();
              show(goTo.peek());
            }}
          >
            <label class="select">
              <span>{t('Go to')}</span>
              <input type="text" class="search" inputMode="decimal" value={goTo.value} onInput={(e) => (goTo.value = e.currentTarget.value)} />
            </label>
          </form>
          <button type="button" class="button" {...no} onClick={() => addAt(isStandard(unit) ? 2 : unit, table, null, true)}>
            <Icon name="plus" size={14} /> {t('Add a mapping')}
          </button>
          <button type="button" class="button" aria-expanded={view.dialog.value === 'template'} {...no} onClick={() => toggle('template')}>
            {t('Add a template')}
          </button>
          <button type="button" class="button" aria-expanded={view.dialog.value === 'paste'} {...no} onClick={() => toggle('paste')}>
            {t('Paste or import')}
          </button>
          <button type="button" class="button" disabled={!last} title={last ? t('{what} (Ctrl Z)', { what: last.text }) : t('Nothing was changed by this page yet')} {...no} onClick={undo}>
            {last ? t('Undo: {what}', { what: midSentence(last.text) }) : t('Undo')}
          </button>
        </>
      )}
    </>
  );
}
