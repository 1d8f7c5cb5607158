// Section: a titled part of a page. In: title, things beside it, the content, the handbook's chapter about it. Out: a labelled region.
import type { ComponentChildren } from 'preact';
import { useId } from 'preact/hooks';
import { t } from '../language';
import { helpPath } from '../text/help';

export function Section({ title, beside, children, class: more = '', id: place, help }: { title: string; beside?: ComponentChildren; children: ComponentChildren; class?: string; id?: string; help?: string }) {
  const id = useId();
  return (
    <section class={`section ${more}`} id={place} aria-labelledby={id}>
      <header class="section-head">
        <h2 id={id}>{title}</h2>
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
