// Mapping known: what is known of axes, points and parameters while mappings are typed. In: the book, the catalogues of axes. Out: one value for forms and tables. The
// catalogue of an axis is asked for when somebody wants it, once; a refusal is forgotten, so that it is asked for again.
import { signal, type Signal } from '@preact/signals';
import { useMemo } from 'preact/hooks';
import { useGateway } from '../gateway';
import type { Base } from '../text/address';
import type { Known } from '../text/mapping';
import type { ParameterShape } from '../text/mapping-type';
import type { MappingBook } from './mappings';

export function useKnown(book: MappingBook, base: Base): Known {
  const { client, store } = useGateway();
  const parameters: Signal<ReadonlyMap<string, ReadonlyMap<string, ParameterShape>>> = useMemo(() => signal(new Map()), []);
  const asked = useMemo(() => new Set<string>(), []);
  const ask = (axis: string) => {
    asked.add(axis);
    client.parameters(axis).then(
      (list) => (parameters.value = new Map([...parameters.peek(), [axis, new Map(list.flatMap((p) => [p.id, p.name].map((k) => [k, p] as const)))]])),
      () => asked.delete(axis),
    );
  };
  return {
    base,
    axes: store.axisNames.value,
    points: book.points.value,
    parameters: (axis) => {
      if (axis && !asked.has(axis) && store.axisNames.peek().includes(axis)) ask(axis);
      const own = parameters.value.get(axis);
      return own ? [...own.keys()] : null;
    },
    parameter: (axis, id) => parameters.value.get(axis)?.get(id) ?? null,
  };
}
