// Description row: one file in the list: what it is of, who uses it, what can be done with it. In: its entry. Out: a row, a removal, the way to a drive.
import type { DescriptionEntry } from '../api/descriptions';
import { descriptionFile } from '../api/descriptions';
import { t } from '../language';
import { descriptionPath } from '../router';
import { begunWith } from '../state/site-wizard';
import { commissioningText, deviceText, extentText, usersText } from '../text/description';
import { dateTime } from '../text/time';
import { DeleteButton } from './ask';
import { useBarred } from './gate';

export function DescriptionRow({ d, onRemove }: { d: DescriptionEntry; onRemove: () => void }) {
  const no = useBarred('engineer');
  return (
    <li class="row" data-description={d.name}>
      <div class="row-head">
        <h3>
          <a href={descriptionPath(d.name)}>{d.name}</a>
        </h3>
        <a class="button small" href="/site" {...(no.disabled ? { 'aria-disabled': true, title: no.title } : {})} aria-label={t('Make a drive of {name}', { name: d.name })} onClick={(e) => (no.disabled ? e.preventDefault() : begunWith(d))}>
          {t('Make a drive')}
        </a>
        <a class="button small" href={descriptionFile(d.name)} download={d.name} aria-label={t('Download {name}', { name: d.name })}>
          {t('Download')}
        </a>
        <DeleteButton name={d.name} class="small quiet" no={no} onYes={onRemove} />
      </div>
      <p>{deviceText(d)}</p>
      <p class="where">
        {extentText(d)} · {dateTime(d.added_at)}
        {d.added_by ? ` · ${d.added_by}` : ''}
      </p>
      <p class="where">
        {usersText(d.used_by)} {commissioningText(d)}
      </p>
    </li>
  );
}
