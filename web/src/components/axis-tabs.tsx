// Axis tabs: the parts of an axis' page as links, each an address that can be sent. In: the axis' name, which part is shown. Out: a row of links.
import { t } from '../language';
import { axisTabPath, parametersPath, type AxisTab } from '../router';

const tabs: readonly { tab: AxisTab | 'parameters'; text: string }[] = [
  { tab: 'move', text: t('Move') },
  { tab: 'scope', text: t('Scope') },
  { tab: 'parameters', text: t('Parameters') },
  { tab: 'drive', text: t('Drive') },
  { tab: 'simulation', text: t('Simulation') },
  { tab: 'events', text: t('Events') },
];

export function AxisTabs({ name, tab }: { name: string; tab: AxisTab | 'parameters' }) {
  return (
    <nav class="axis-tabs" aria-label={t('Parts of {name}', { name })}>
      {tabs.map((t) => (
        <a key={t.tab} href={t.tab === 'parameters' ? parametersPath(name) : axisTabPath(name, t.tab)} aria-current={t.tab === tab ? 'page' : undefined}>
          {t.text}
        </a>
      ))}
    </nav>
  );
}
