// What a plot keeps between two pictures: cursors by keys, the part of time by keys where it may be zoomed; and what the scope shows when it is held.
import { describe, expect, it } from 'vitest';
import { AxisHistory } from '../src/state/history';
import { PlotView } from '../src/state/plot-view';
import { extend, ScopeView } from '../src/state/scope-view';
import { curvesOf, secondsBefore } from '../src/text/scope';
import { levelsOf, traceCurves, trendCurves } from '../src/text/trace-curves';

const view = () => {
  const v = new PlotView();
  v.whole.value = [0, 100];
  v.range.value = [0, 100];
  return v;
};
const press = (v: PlotView, key: string, shiftKey = false, zoomable = true) => v.keyed({ key, shiftKey }, zoomable);

describe('keys on a plot', () => {
  it('place the active cursor, from the middle on, and never beyond what is seen', () => {
    const v = view();
    expect(press(v, 'ArrowLeft')).toBe(true);
    expect(v.cursors[0].value).toBe(49);
    press(v, 'ArrowRight', true);
    expect(v.cursors[0].value).toBe(59);
    press(v, 'End');
    press(v, 'ArrowRight');
    expect(v.cursors[0].value).toBe(100);
    v.active.value = 1;
    press(v, 'Home');
    expect([v.cursors[0].value, v.cursors[1].value]).toEqual([100, 0]);
    press(v, 'Delete');
    expect(v.cursors[1].value).toBeNull();
  });
  it('change the part of time only where it may be zoomed, about the active cursor', () => {
    const v = view();
    v.put(20);
    for (const key of ['+', '-', '0', 'PageUp', 'PageDown']) expect(press(v, key, false, false)).toBe(false);
    expect(v.range.value).toEqual([0, 100]);
    press(v, '+');
    expect(v.range.value).toEqual([10, 60]);
    press(v, 'PageDown');
    expect(v.range.value).toEqual([35, 85]);
    press(v, '0');
    expect(v.range.value).toEqual([0, 100]);
  });
  it('that are for nothing here are left to others', () => expect(press(view(), 'x')).toBe(false));
});

describe('the scope', () => {
  const history = new AxisHistory(64);
  it('follows the time until it is held, then stays where it was, and goes on', () => {
    const v = new ScopeView();
    v.range.value = v.look(history, 100, 10);
    expect(v.range.value).toEqual([90, 100]);
    v.hold();
    expect(v.look(history, 107, 10)).toEqual([90, 100]);
    v.hold();
    expect(v.look(history, 107, 10)).toEqual([97, 107]);
  });
  it('says what its trigger waits for', () => {
    const v = new ScopeView();
    v.trigger.value = { mode: 'single', channel: 'position', edge: 'rising', level: 1 };
    v.look(history, 5, 10);
    expect(v.triggerState.value).toBe('waiting');
    v.trigger.value = { ...v.trigger.value, mode: 'off' };
    v.look(history, 6, 10);
    expect(v.triggerState.value).toBe('off');
  });
  it('draws the newest values until now', () => {
    const columns = { at: [1, 2], position: [5, null], velocity: [0, 0], target: [1, 1], demand: [5, 6], error: [0, 0], source: ['drive' as const, null] };
    extend(columns, 3);
    expect([columns.at, columns.position, columns.demand, columns.source]).toEqual([[1, 2, 3], [5, null, null], [5, 6, 6], ['drive', null, null]]);
  });
  it('has the most important curve first, and counts back from its newest end', () => {
    expect(curvesOf(new Set(['target', 'velocity', 'position']), 'mm').map((c) => [c.id, c.unit, c.scale])).toEqual([['position', 'mm', 'p'], ['velocity', 'mm/s', 'v'], ['target', 'mm', 'p']]);
    expect([secondsBefore(10, 10), secondsBefore(7.5, 10), secondsBefore(-20, 10)]).toEqual(['0 s', '−2.5 s', '−30 s']);
  });
});

describe('curves of points', () => {
  it('share a side where they share a unit, each with an ink of its own; further ones are dashed', () => {
    const list = traceCurves([{ id: 'a', name: 'a', unit: 'mm' }, { id: 'b', name: 'b', unit: 'mm' }, { id: 'c', name: 'c', unit: '°' }], ['position', 'demand']);
    expect(list.map((c) => c.scale)).toEqual(['position mm', 'position mm', 'position mm', 'position mm', 'position °', 'position °']);
    expect(new Set(list.slice(0, 5).map((c) => c.color)).size).toBe(5);
    expect([list[4]!.dash, list[5]!.dash]).toEqual([undefined, [6, 3]]);
    expect(trendCurves({ axes: [{ axis: 'b', unit: 'mm' }] }, ['a', 'b'], ['velocity']).map((c) => [c.name, c.unit])).toEqual([['a velocity', '/s'], ['b velocity', 'mm/s']]);
  });
  it('show the level that a capture waited for only where its scale is seen', () => {
    const trigger = { kind: 'level' as const, axis: 'a', point: 'demand' as const, edge: 'falling' as const, level: 1.5 };
    const capture = { axes: [{ axis: 'a', unit: 'mm', rate_hz: 1, rows: 1 }], trigger } as never;
    expect(levelsOf([capture], ['position'])).toEqual([{ scale: 'position mm', value: 1.5, text: '↓ 1.500 mm' }]);
    expect(levelsOf([capture], ['velocity'])).toEqual([]);
    expect(levelsOf([{ axes: [], trigger: { kind: 'command', axis: 'a' } } as never], ['position'])).toEqual([]);
  });
});
