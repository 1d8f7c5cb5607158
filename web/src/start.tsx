// Start: theme first, then clock, router, gateway, page; loaded when the language is there. In: the document. Out: a living page. Never anything inline.
import { render } from 'preact';
import { App } from './app';
import { Gateway, GatewayProvider } from './gateway';
import { startRouter } from './router';
import { startClock } from './state/clock';
import { watchKeyboard } from './state/keyboard';
import { applyTheme } from './state/theme';
import './styles/tokens.css';
import './styles/base.css';
import './styles/frame.css';
import './styles/language.css';
import './styles/later.css';
import './styles/controls.css';
import './styles/tile.css';
import './styles/lists.css';
import './styles/axis.css';
import './styles/table.css';
import './styles/form.css';
import './styles/mappings.css';
import './styles/register-map.css';
import './styles/parameters.css';
import './styles/site.css';
import './styles/descriptions.css';
import './styles/recipes.css';
import './styles/alarms.css';
import './styles/users.css';
import './styles/fleet.css';
import './styles/recorder.css';

export async function start(): Promise<void> {
  applyTheme();
  startClock();
  watchKeyboard();
  startRouter();
  const gateway = new Gateway();
  gateway.start();
  // Who one is decides what is shown first; a gateway that does not answer keeps the stops off the screen for a second at most.
  await Promise.race([Promise.all([gateway.session.ask(), gateway.tab.settled]), new Promise((r) => setTimeout(r, 1000))]);
  render(
    <GatewayProvider value={gateway}>
      <App />
    </GatewayProvider>,
    document.getElementById('app') as HTMLElement,
  );
}
