// Mapping dialog: a form over the page that is opened by a button and closed by another. In: a title, what stands in it. Out: the same, with the keyboard
// in it while it is open and back at the button afterwards. It does not bar the page behind it: the stops stay where they are, and Escape stays theirs.
import type { ComponentChildren } from 'preact';
import { useEffect, useId, useRef } from 'preact/hooks';
import { t } from '../language';
import { Icon } from './icon';

export function MappingDialog({ title, onClose, children }: { title: string; onClose: () => void; children: ComponentChildren }) {
  const id = useId();
  const box = useRef<HTMLDivElement>(null);
  useEffect(() => {
    const before = document.activeElement as HTMLElement | null;
    box.current?.querySelector<HTMLElement>('select, input:not([type=file]), textarea')?.focus({ preventScroll: true });
    return () => before?.isConnected && before.focus({ preventScroll: true });
  }, []);
  return (
    <div ref={box} class="card map-dialog" role="dialog" aria-labelledby={id}>
      <header class="section-head">
        <h2 id={id}>{title}</h2>
        <button type="button" class="button small" onClick={onClose}>
          <Icon name="remove" size={14} /> {t('Close')}
        </button>
      </header>
      {children}
    </div>
  );
}
