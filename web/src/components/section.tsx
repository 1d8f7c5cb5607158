// Section: a titled part of a page. In: title, things beside it, the content, the handbook's chapter about it. Out: a labelled region.
// `fold`: on a phone the title is a button that shows the content, with how much is in it; paper and wide screens have it whole.
import { useSignal, type Signal } from '@preact/signals';
import type { ComponentChildren } from 'preact';
import { useId } from 'preact/hooks';
import { t } from '../language';
import { narrow } from '../state/narrow';
import { helpPath } from '../text/help';
import { Icon } from './icon';

interface SectionProps {
  title: string;
  beside?: ComponentChildren;
  children: ComponentChildren;
  class?: string;
  id?: string;
  help?: string;
  fold?: number | boolean | undefined;
  /** Whether it is unfolded, where others open it too. */
  unfolded?: Signal<boolean>;
}

export function Section({ title, beside, children, class: more = '', id: place, help, fold = false, unfolded }: SectionProps) {
  const id = useId();
  const own = useSignal(false);
  const open = unfolded ?? own;
  const folds = fold !== false && narrow.value;
  return (
    <section class={`section ${more}${folds && !open.value ? ' is-folded' : ''}`} id={place} aria-labelledby={id}>
      <header class="section-head">
        <h2 id={id}>
          {folds ? (
            <button type="button" class="fold" aria-expanded={open.value} onClick={() => (open.value = !open.peek())}>
              <Icon name={open.value ? 'down' : 'arrow-right'} /> {fold === true ? title : `${title} (${fold})`}
            </button>
          ) : (
            title
          )}
        </h2>
        {beside}
        {help !== undefined && (
          <a class="section-help" href={helpPath(help)} target="axisgate-help" aria-label={t('Help: {title}', { title })}>
            {t('Help')}
          </a>
        )}
      </header>
      {children}
    </section>
  );
}
