// Later: a page whose code is fetched when the page is shown for the first time. In: how it is fetched. Out: a component that shows where the page will
// be, then the page; if the code cannot be fetched, why, and a button that tries again. It tries by itself when the gateway is back.
import type { ComponentType } from 'preact';
import { useEffect, useLayoutEffect } from 'preact/hooks';
import { useGateway } from '../gateway';
import { t } from '../language';
import { focusHeading, route } from '../router';
import { Code } from '../state/code';
import { titleOf } from '../text/title';

export function later<P extends object>(fetch: () => Promise<ComponentType<P>>): ComponentType<P> {
  const code = new Code(fetch);
  return function Later(props: P) {
    const { store } = useGateway();
    const { phase, epoch } = store.connection.value;
    const state = code.state.value;
    // Also when the connection is another one: what was missing because the gateway was away is there now.
    useEffect(() => void code.want(), [phase === 'live' ? epoch : 0]);
    useLayoutEffect(() => {
      if (state.at !== 'waiting') focusHeading();
    }, [state.at]);
    if (state.at === 'there') {
      const Part = state.part;
      return <Part {...props} />;
    }
    return (
      <main class="page later" aria-busy={state.at === 'waiting'}>
        {state.at === 'missing' && <h1 tabIndex={-1}>{titleOf(route.value)}</h1>}
        {state.at === 'waiting' ? <Waiting /> : <Missing why={state.why} again={() => void code.want()} />}
      </main>
    );
  };
}

/** Is seen only if it takes a while (styles/later.css): most bundles are there before anybody could read it. */
const Waiting = () => (
  <p class="empty later-waiting" role="status">
    {t('Loading …')}
  </p>
);

function Missing({ why, again }: { why: string; again: () => void }) {
  return (
    <div class="empty" role="alert" data-field="part-missing">
      <p>{why}</p>
      <button type="button" class="button" onClick={again}>
        {t('Try again')}
      </button>
    </div>
  );
}
