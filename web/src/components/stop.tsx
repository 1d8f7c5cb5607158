// The stops: one per axis, and one for all in the head of the page, which is also the Escape key, wherever the keyboard is.
// Never disabled, never hidden, never waits for another answer. It is a command over the network, not a safety function.
import { useLayoutEffect } from 'preact/hooks';
import { useGateway } from '../gateway';
import { Icon } from './icon';

/** Filled where there is something to stop, outlined where nothing moves: always there, loud only when it matters. */
export function StopButton({ axis, large = false, urgent = true }: { axis: string; large?: boolean; urgent?: boolean }) {
  const { commander } = useGateway();
  return (
    <button
      type="button"
      class={`stop${large ? ' stop-large' : ''}${urgent ? '' : ' stop-calm'}`}
      aria-label={`Stop ${axis}`}
      title={`Quick stop of ${axis}. Not a safety function: keep the emergency stop of the machine at hand.`}
      onClick={() => void commander.stop(axis)}
    >
      <Icon name="octagon" size={large ? 18 : 14} />
      STOP
    </button>
  );
}

export function StopAll() {
  const { commander, store } = useGateway();
  useLayoutEffect(() => {
    const onKey = (event: KeyboardEvent) => {
      if (event.key !== 'Escape' || event.repeat || event.isComposing) return;
      // A search field would clear itself: a stop changes nothing of what is typed.
      if (event.target instanceof HTMLInputElement && event.target.type === 'search') event.preventDefault();
      void commander.stopAll(movingFirst());
    };
    // In the capturing phase: nothing on the page can swallow it.
    addEventListener('keydown', onKey, true);
    return () => removeEventListener('keydown', onKey, true);
  }, [commander]);

  const movingFirst = () => {
    const moves = (name: string) => (store.axis(name)?.peek().data.moving ? 0 : 1);
    return [...store.axisNames.peek()].sort((a, b) => moves(a) - moves(b));
  };

  return (
    <button
      type="button"
      class="stop stop-all"
      aria-keyshortcuts="Escape"
      title="Quick stop of every axis. Not a safety function: keep the emergency stop of the machine at hand."
      onClick={() => void commander.stopAll(movingFirst())}
    >
      <Icon name="octagon" size={16} />
      <span>Stop all</span>
      <kbd aria-hidden="true">Esc</kbd>
    </button>
  );
}
