// Capture: what is typed to arm a capture, as a wish, or why not, field by field. In: texts of a form, the axes, the names that are taken. Out: the wish,
// faults. Pure: the gateway looks at it again.
import type { CaptureTrigger, CaptureWish } from '../api/types';
import { t } from '../language';
import { parseNumber, parseQuantity } from './number';
import { freeName, nameFault, stateNames, type TracePoint } from './recorder';

export interface CaptureTexts {
  name: string;
  axis: string;
  rate: string;
  before: string;
  after: string;
  wait: string;
  kind: CaptureTrigger['kind'];
  point: TracePoint;
  edge: 'rising' | 'falling';
  level: string;
  state: keyof typeof stateNames;
}
export const firstCapture = (axis: string): CaptureTexts => ({ name: '', axis, rate: '1000', before: '200', after: '1000', wait: '60', kind: 'command', point: 'position', edge: 'rising', level: '0', state: 'moving' });

export interface CheckedCapture {
  /** The one that is typed, else the next that is free. */
  name: string;
  wish: CaptureWish | null;
  faults: Partial<Record<keyof CaptureTexts, string>>;
}

/** `axis`: the one that is meant; `more`: others of its line; `taken`: names of captures that there are. */
export function checkCapture(texts: CaptureTexts, axis: string, more: readonly string[], taken: readonly string[]): CheckedCapture {
  const faults: CheckedCapture['faults'] = {};
  const read = (field: 'rate' | 'before' | 'after' | 'wait', low: number, high: number, what: string): number => {
    const p = parseQuantity(texts[field]);
    if (!p.good) faults[field] = p.why;
    else if (p.value < low || p.value > high) faults[field] = t('{what} is {low} to {high}.', { what, low, high });
    return p.good ? p.value : 0;
  };
  const rate_hz = Math.round(read('rate', 1, 1000, t('The rate')));
  const before_ms = Math.round(read('before', 0, 120_000, t('The time before')));
  const after_ms = Math.round(read('after', 1, 120_000, t('The time after')));
  const wait_ms = Math.round(read('wait', 0.1, 300, t('The wait')) * 1000);
  const level = texts.kind === 'level' ? parseNumber(texts.level) : { good: true as const, value: 0 };
  if (!level.good) faults.level = level.why;
  const name = texts.name || freeName('capture', taken);
  const wrong = nameFault(name) ?? (taken.includes(name) ? t('There is one of this name.') : undefined);
  if (wrong) faults.name = wrong;
  const good = Object.keys(faults).length === 0 && axis !== '';
  return { name, faults, wish: good ? { name, axes: [axis, ...more], rate_hz, before_ms, after_ms, wait_ms, trigger: triggerOf(texts, axis, level.good ? level.value : 0) } : null };
}

function triggerOf({ kind, point, edge, state }: CaptureTexts, axis: string, level: number): CaptureTrigger {
  if (kind === 'level') return { kind, axis, point, edge, level };
  return kind === 'state' ? { kind, axis, state, edge } : { kind, axis };
}
