// Mapping panel: what stands at the chosen place, beside the map: its value, its registers, the names of its bits, and what can be done with it.
// In: the chosen blocks. Out: a panel with the form; buttons do by a finger what keys and the mouse do on the map.
import type { ReadonlySignal } from '@preact/signals';
import type { ComponentChildren } from 'preact';
import { t } from '../language';
import { otherText } from '../text/address';
import { addressBase } from '../state/address-base';
import type { Received } from '../state/register-look';
import { placeText, type MappingPoint } from '../text/mapping';
import { bitsOf, type Block } from '../text/mapping-blocks';
import { formatExact } from '../text/number';
import { useBarred } from './gate';
import { accessText, RawOf, usePublished, ValueOf } from './mapping-cell';
import { AxisName } from './name';

export interface PanelProps {
  chosen: readonly Block[];
  received: ReadonlySignal<ReadonlyMap<string, Received>>;
  points: readonly MappingPoint[];
  copyTo: string;
  remove: () => void;
  move: () => void;
  copy: () => void;
  whole: (axis: string) => void;
  children: ComponentChildren;
}

export function MappingPanel({ chosen, received, points, copyTo, remove, move, copy, whole, children }: PanelProps) {
  const no = useBarred('engineer');
  const own = chosen.filter((b) => b.mapping);
  const [one] = chosen;
  const ids = own.length === 1 ? own[0]!.key : t('{n} mappings', { n: own.length });
  return (
    <aside class="map-panel" aria-label={t('Chosen place')}>
      {one && chosen.length === 1 && <BlockFacts block={one} received={received} points={points} />}
      {chosen.length > 1 && <p data-field="chosen">{t('{n} entries are chosen.', { n: chosen.length })}</p>}
      {own.length > 0 && (
        <div class="form-foot">
          <button type="button" class="button small" {...no} onClick={move}>
            {t('Move {what}', { what: ids })}
          </button>
          <button type="button" class="button small" {...no} onClick={copy}>
            {t('Copy to {axis}', { axis: copyTo })}
          </button>
          <button type="button" class="button small" {...no} title={t('Can be undone')} onClick={remove}>
            {t('Remove {what}', { what: ids })}
          </button>
          {own.length === 1 && (
            <button type="button" class="button small quiet" onClick={() => whole(own[0]!.axis)}>
              {t('Choose all of {axis} here', { axis: own[0]!.axis })}
            </button>
          )}
        </div>
      )}
      {one && own.length === 0 && <p class="where">{t('This register is fixed by the gateway: it is not changed here.')}</p>}
      {children}
    </aside>
  );
}

export function scaleText(m: { scale: number; offset: number }): string {
  const scale = m.scale === 1 ? '' : `× ${formatExact(m.scale)}`;
  const offset = m.offset === 0 ? '' : `${m.offset < 0 ? '−' : '+'} ${formatExact(Math.abs(m.offset))}`;
  return [scale, offset].filter(Boolean).join(' ') || '1 : 1';
}

function BlockFacts({ block: b, received, points }: { block: Block; received: ReadonlySignal<ReadonlyMap<string, Received>>; points: readonly MappingPoint[] }) {
  const base = addressBase();
  const published = usePublished(b, received, points);
  const words = received.value.get(b.key)?.words;
  const bits = words?.length === 1 ? bitsOf(b.point, words[0]!) : [];
  const m = b.mapping;
  return (
    <div class="card map-facts" data-field="chosen">
      <h3>
        <span class="mono">{b.name}</span> {b.axis && <AxisName name={b.axis} />}
      </h3>
      <dl class="facts">
        <div><dt>{t('Register place')}</dt><dd><span class="mono">{placeText(b, base)}</span> <span class="where">{otherText(b.table, b.address, base)}</span></dd></div>
        <div><dt>{t('Type')}</dt><dd><span class="mono">{b.type}</span>{m && b.width > 1 && b.type !== 'string' ? ` ${m.word_order === 'low_first' ? t('low word first') : t('high word first')}` : ''}, {accessText[b.access]}</dd></div>
        <div><dt>{t('Value')}</dt><dd><ValueOf published={published} /></dd></div>
        <div><dt>{t('In the register')}</dt><dd><RawOf published={published} /></dd></div>
        {m && (m.scale !== 1 || m.offset !== 0) && <div><dt>{t('Scaling')}</dt><dd class="mono">{scaleText(m)}</dd></div>}
        {m?.comment && <div><dt>{t('Comment')}</dt><dd>{m.comment}</dd></div>}
      </dl>
      {bits.length > 0 && (
        <ul class="map-bits" aria-label={t('Bits')}>
          {bits.map((x) => (
            <li key={x.bit} class={x.on ? 'is-on' : ''}>
              <span class="mono">{x.bit}</span> {x.name} <span class="where">{x.on ? '1' : '0'}</span>
            </li>
          ))}
        </ul>
      )}
    </div>
  );
}
