// The hand of a twin in words: which of its conditions belong to which axis of the drive, and which to the whole drive. In: the items as the gateway
// describes them, the axes of the drive by channel, the channel one looks from. Out: groups with labels. Pure. Channel k's conditions are named
// "axisK.NAME"; those of channel 1 stand bare beside them. A bare name that means the same as "axis1.NAME" is left out.
import { t, word } from '../language';
import type { HandItem } from '../api/types';
import { formatNumber, decimalsOf } from './number';

export interface HandAxis {
  name: string;
  channel: number;
  unit: string;
  increments_per_unit: number;
}
export interface HandGroup {
  /** Empty: the only group, which needs no heading. */
  title: string;
  kind: 'axis' | 'drive';
  axis: HandAxis | null;
  /** Of another axis than the one whose page it is. */
  folded: boolean;
  items: { item: HandItem; label: string }[];
}

/** Bare names that every family means for the axis alone: they tell only where a drive with one axis has conditions of both kinds. */
const ofAnAxis = new Set(['stall', 'limit_positive', 'limit_negative', 'home_switch', 'position', 'load', 'temperature', 'jog', 'following_error', 'power_pack', 'encoder_broken']);
const split = (name: string): { channel: number; base: string } => {
  const m = /^axis(\d+)\.(.+)$/.exec(name);
  return m ? { channel: Number(m[1]), base: m[2] as string } : { channel: 0, base: name };
};
/** Names that say too little by themselves, or mean something else elsewhere on the page. */
const odd: Readonly<Record<string, string>> = {
  can_objects: t('CAN objects'),
  eprom_writes: t('EPROM writes'),
  gone: t('Gone from the fleet'),
  input: t('One input'),
  jog: t('Jogged by its panel'),
  lag_ms: t('Lag, ms'),
  nmt0: t('NMT initialisations'),
  ptc_1: t('PTC 1 hot'),
  ptc_2: t('PTC 2 hot'),
};
export const handLabel = (name: string): string => {
  const { base } = split(name);
  const text = base.replaceAll('_', ' ');
  return odd[base] ?? word(text.charAt(0).toUpperCase() + text.slice(1));
};

/** `own`: the channel of the axis whose page it is; null: the page of the drive. */
export function handGroups(items: readonly HandItem[], axes: readonly HandAxis[], own: number | null): HandGroup[] {
  const parts = items.map((item) => ({ item, ...split(item.name) }));
  const named = parts.filter((p) => p.channel > 0);
  const others = new Set(named.filter((p) => p.channel > 1).map((p) => p.base));
  const first = new Map(named.filter((p) => p.channel === 1).map((p) => [p.base, p.item]));
  const by = new Map<number, { item: HandItem; label: string }[]>();
  for (const p of parts) {
    let { channel } = p;
    if (channel === 0 && named.length > 0) {
      const twin = first.get(p.base);
      if (twin && twin.description === p.item.description) continue;
      if (!twin && (others.size > 0 ? others.has(p.base) : ofAnAxis.has(p.base))) channel = 1;
    }
    by.set(channel, [...(by.get(channel) ?? []), { item: p.item, label: handLabel(p.item.name) }]);
  }
  const whole = by.get(0) ?? [];
  // A drive of one axis that tells nothing apart: one list, and it is the axis'.
  if (named.length === 0) return whole.length === 0 ? [] : [{ title: '', kind: 'drive', axis: axes.find((a) => a.channel === (own ?? 1)) ?? null, folded: false, items: whole }];
  const channels = [...by.keys()].filter((c) => c > 0).sort((a, b) => (a === own ? -1 : b === own ? 1 : a - b));
  const groups = channels.map((c): HandGroup => {
    const axis = axes.find((a) => a.channel === c) ?? null;
    return { title: axis?.name ?? t('Channel {c}, no axis of the site', { c }), kind: 'axis', axis, folded: own !== null && c !== own, items: by.get(c) ?? [] };
  });
  const drive: HandGroup[] = whole.length === 0 ? [] : [{ title: t('The whole drive'), kind: 'drive', axis: null, folded: false, items: whole }];
  return [...groups.filter((g) => !g.folded), ...drive, ...groups.filter((g) => g.folded)];
}

/** "= 12.500 mm": a position of the shaft in the unit of its axis; empty where the axis counts in increments, or nothing is known. */
export function positionInUnit(value: unknown, axis: HandAxis | null): string {
  if (!axis || axis.unit === '' || !(axis.increments_per_unit > 0) || typeof value !== 'number' || !Number.isFinite(value)) return '';
  return `= ${formatNumber(value / axis.increments_per_unit, decimalsOf(axis.increments_per_unit))} ${axis.unit}`;
}
