// Section: a titled part of a page. In: title, things beside it, the content. Out: a labelled region.
import type { ComponentChildren } from 'preact';
import { useId } from 'preact/hooks';

export function Section({ title, beside, children, class: more = '', id: place }: { title: string; beside?: ComponentChildren; children: ComponentChildren; class?: string; id?: string }) {
  const id = useId();
  return (
    <section class={`section ${more}`} id={place} aria-labelledby={id}>
      <header class="section-head">
        <h2 id={id}>{title}</h2>
        {beside}
      </header>
      {children}
    </section>
  );
}
