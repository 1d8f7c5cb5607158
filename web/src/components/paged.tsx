// Paged: which part of a long list is shown, with buttons to the parts before and behind it. In: the part, how many there are. Out: another part.
import { t } from '../language';

interface PagedProps {
  /** Place of the first row that is shown, from 0. */
  from: number;
  atOnce: number;
  /** Rows that a filter has left, of all. */
  of: number;
  all: number;
  go: (from: number) => void;
}

export function Paged({ from, atOnce, of, all, go }: PagedProps) {
  const to = Math.min(of, from + atOnce);
  const text = of === 0 ? t('None of {all} fits.', { all }) : of === all ? t('{from} to {to} of {all}', { from: from + 1, to, all }) : t('{from} to {to} of {of} that fit, of {all}', { from: from + 1, to, of, all });
  return (
    <div class="paged">
      <span role="status" data-field="paged">
        {text}
      </span>
      {of > atOnce && (
        <>
          <button type="button" class="button small" disabled={from === 0} onClick={() => go(Math.max(0, from - atOnce))}>
            {t('Previous {n}', { n: atOnce })}
          </button>
          <button type="button" class="button small" disabled={to >= of} onClick={() => go(from + atOnce)}>
            {t('Next {n}', { n: atOnce })}
          </button>
        </>
      )}
    </div>
  );
}
