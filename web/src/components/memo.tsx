// Memo: a component that is drawn anew only when its properties differ by the given test. In: a component. Out: the same, calmer.
// Signals that the component reads itself still redraw it. (Preact has this in its React layer, which is not needed otherwise.)
import { Component, h, type ComponentType } from 'preact';

export function memo<P extends object>(Inner: ComponentType<P>, same: (before: P, after: P) => boolean): ComponentType<P> {
  return class Memo extends Component<P> {
    override shouldComponentUpdate(next: P): boolean {
      return !same(this.props as P, next);
    }
    override render() {
      return h(Inner as ComponentType<object>, this.props);
    }
  } as unknown as ComponentType<P>;
}
