// Site differences: what differs between two states of the site, as a list that ends after a while and says so. In: differences. Out: a list.
import type { StageDiff } from '../api/site';
import { t } from '../language';
import { differenceText, type Difference } from '../text/site';

const mostShown = 200;
const kindText: Record<Difference['kind'], string> = { added: t('added'), removed: t('removed'), changed: t('changed') };

export function DifferenceList({ list, label }: { list: readonly (Difference | StageDiff)[]; label: string }) {
  return (
    <ul class="differences site-diff" aria-label={label}>
      {list.slice(0, mostShown).map((d) => (
        <li key={d.what} data-diff={d.what} class={`is-${d.kind}`}>
          <span class="diff-kind">{kindText[d.kind]}</span> <span>{differenceText(d)}</span>
        </li>
      ))}
      {list.length > mostShown && <li class="where">{t('and {n} more', { n: list.length - mostShown })}</li>}
    </ul>
  );
}
