// Recipe editing: what every form of a step needs of the recipe around it. In: the document, the axes, the faults. Out: a context; the mark of an axis that a step
// names, also by a parameter.
import type { Signal } from '@preact/signals';
import { createContext } from 'preact';
import { useContext } from 'preact/hooks';
import type { Fault } from '../api/types';
import { axisMeant, type RecipeDocument } from '../text/recipe';
import { SimulatedMark } from './name';

export interface Editing {
  document: RecipeDocument;
  change: (next: RecipeDocument) => void;
  axes: readonly string[];
  /** The axes of the site are known: one that is not among them is not there. */
  listed: boolean;
  /** Unit of the axis that a step names, also by a parameter; null: it is not known. */
  unitOf: (axis: string) => string | null;
  faults: readonly Fault[];
}
/** `folded`: steps that are shown in one line, by their places. */
type Inside = Editing & { folded: Signal<ReadonlySet<string>> };
const Context = createContext<Inside | null>(null);
export const EditingProvider = Context.Provider;
export const useEditing = () => useContext(Context) as Inside;

/** The axis that a step means; empty: it is not known. */
export function useMeant(named: unknown): string {
  const { document } = useEditing();
  return (typeof named === 'string' ? axisMeant(named, document.parameters) : null) ?? '';
}

/** Beside the field in which an axis is named: whether it is simulated now, also where a parameter names it. */
export function AxisMark({ named }: { named: unknown }) {
  const axis = useMeant(named);
  return axis ? <SimulatedMark of={axis} /> : null;
}
