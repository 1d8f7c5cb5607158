// The stops: one per axis, and one for all in the head of the page, which is also the Escape key, wherever the keyboard is; while something is
// being typed or carried over a map, the first Escape takes that back and the next one stops.
// Never hidden, never waits for another answer; disabled only where the gateway has said that it serves nobody here without a sign-in, and then it
// says so and names the machine's own emergency stop. It is a command over the network, not a safety function.
import { useLayoutEffect } from 'preact/hooks';
import { useGateway } from '../gateway';
import { t } from '../language';
import type { Commander } from '../state/commander';
import { emptyTyped, held, typing, watchTyping } from '../state/typing';
import { Icon } from './icon';

/** Filled where there is something to stop, outlined where nothing moves: always there, loud only when it matters. */
export function StopButton({ axis, large = false, urgent = true, by }: { axis: string; large?: boolean; urgent?: boolean; by?: Commander }) {
  const { commander, session } = useGateway();
  const barred = session.stopBarred.value;
  return (
    <button
      type="button"
      disabled={barred !== ''}
      class={`stop${large ? ' stop-large' : ''}${urgent ? '' : ' stop-calm'}`}
      aria-label={t('Stop {axis}', { axis })}
      title={barred || t('Quick stop of {axis}. Not a safety function: keep the emergency stop of the machine at hand.', { axis })}
      onClick={() => void (by ?? commander).stop(axis)}
    >
      <Icon name="octagon" size={large ? 18 : 14} />
      {t('STOP')}
    </button>
  );
}

/** What the key does, for the button and for those who look it up. */
export const keyWords = t('The Escape key does the same; while you type, it empties the field first and stops when pressed again.');

export function StopAll() {
  const { commander, session, store } = useGateway();
  const barred = session.stopBarred.value;
  const stopAll = () => {
    const why = session.stopBarred.peek();
    if (!why) return void commander.stopAll(store.listed.peek() ? movingFirst() : null);
    // Nothing is pretended: it would be refused. Perhaps somebody has signed in meanwhile.
    commander.stopReport.value = { tone: 'refused', text: t('NOT stopped.') };
    void session.ask();
  };
  useLayoutEffect(() => {
    const onKey = (event: KeyboardEvent) => {
      if (event.key !== 'Escape' || event.repeat || event.isComposing) return;
      // A search field would clear itself: a stop changes nothing of what is typed.
      if (event.target instanceof HTMLInputElement && event.target.type === 'search') event.preventDefault();
      if (emptyTyped()) return;
      stopAll();
    };
    // In the capturing phase: nothing on the page can swallow it.
    addEventListener('keydown', onKey, true);
    return () => removeEventListener('keydown', onKey, true);
  }, [commander, session]);

  useLayoutEffect(() => watchTyping(), []);

  const movingFirst = () => {
    const moves = (name: string) => (store.axis(name)?.peek().data.moving ? 0 : 1);
    return [...store.axisNames.peek()].sort((a, b) => moves(a) - moves(b));
  };

  return (
    <button
      type="button"
      class="stop stop-all"
      disabled={barred !== ''}
      aria-keyshortcuts="Escape"
      aria-description={barred || undefined}
      title={barred || t('Quick stop of every axis. {keyWords} Not a safety function: keep the emergency stop of the machine at hand.', { keyWords })}
      onClick={stopAll}
    >
      <Icon name="octagon" size={16} />
      <span>{barred ? t('No stop from here') : t('Stop all')}</span>
      <kbd aria-hidden="true">{typing.value || held.value ? 'Esc Esc' : 'Esc'}</kbd>
    </button>
  );
}
