// Main: start here. The reader's language first, then everything else, whose constants may hold sentences. No module waits for another one while it is
// evaluated: a bundle that waits for a bundle which imports it would never go on, and nothing would be drawn.
import { startLanguage, t } from './language';
import { followUpgrade } from './state/upgrade';

/** The rest of the page has not come: said without any of it. */
function without(): void {
  const text = document.createElement('p');
  const again = document.createElement('a');
  text.textContent = `${t('The page could not be loaded from the gateway.')} `;
  again.textContent = t('Load it again');
  again.href = location.pathname;
  text.append(again);
  document.getElementById('app')?.replaceChildren(text);
}

void startLanguage()
  .then(() => import('./start'))
  .then(({ start }) => start())
  .catch(async (error: unknown) => {
    if ((await followUpgrade()) !== 'reloading') without();
    throw error;
  });
