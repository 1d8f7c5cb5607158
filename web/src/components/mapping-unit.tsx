// Mapping unit: what a Modbus unit answers where nothing is mapped. In: the HTTP door, the unit that is shown. Out: one choice beside the grid.
// Nothing is shown where the gateway does not offer it.
import { useSignal } from '@preact/signals';
import { useCallback } from 'preact/hooks';
import type { MappingDoor, ModbusUnit } from '../api/mappings';
import { t } from '../language';
import { quiet, tellOf, type Reported } from '../state/reported';
import { useBarred } from './gate';
import { useLoaded } from './loaded';
import { Tell } from './form';

const text: Record<NonNullable<ModbusUnit['gaps']>, string> = { zero: t('read 0'), refuse: t('are refused') };

export function MappingUnit({ door, unit, revision }: { door: MappingDoor; unit: number; revision: unknown }) {
  const units = useSignal<ModbusUnit[] | null>(null);
  const reported = useSignal<Reported>(quiet);
  const no = useBarred('engineer');
  const load = useCallback(async () => void (units.value = await door.units()), [door]);
  const why = useLoaded(load, [door, revision], (p) => p.text);
  if (why || !units.value) return null;
  const here = units.value.find((u) => u.unit === unit);
  const set = (gaps: ModbusUnit['gaps']) => tellOf(reported, t('Changing …'), () => door.setGaps(unit, gaps), (now) => (now.shown === 'zero' ? t('Gaps of unit {unit} read 0 now.', { unit }) : t('Gaps of unit {unit} are refused now.', { unit })), load);
  return (
    <>
      <label class="select" title={t('What a client gets for addresses between and around what is mapped. Panels that read in blocks need 0; a client that must never read a wrong address wants a refusal.')}>
        <span>{t('Gaps')}</span>
        <select data-field="gaps" value={here?.gaps ?? ''} {...no} onChange={(e) => void set((e.currentTarget.value || null) as ModbusUnit['gaps'])}>
          <option value="">{here && !here.gaps ? t('as the host has it: {how}', { how: text[here.shown] }) : t('as the host has it')}</option>
          <option value="zero">{text.zero}</option>
          <option value="refuse">{text.refuse}</option>
        </select>
      </label>
      <Tell reported={reported.value} field="gaps-told" />
    </>
  );
}
