// Drive description: in the form of a drive, which uploaded file describes it, with a link to that file; what the gateway does at the start of the drive;
// in the wizard, a file that is dropped and fills in the form. In: what is typed, the family. Out: what is typed.
import { useEffect } from 'preact/hooks';
import { useSignal } from '@preact/signals';
import { useGateway } from '../gateway';
import { t } from '../language';
import { descriptionPath } from '../router';
import { chosenDescription } from '../state/site-wizard';
import { descriptionsOf } from '../state/descriptions';
import { bootTexts } from '../text/boot';
import { chosenOf, deviceText, driveOf, rateText, type Chosen } from '../text/description';
import type { Family, OptionSpec } from '../text/options';
import type { Entry, Site, Texts } from '../text/site';
import { DescriptionDrop } from './description-drop';
import { Choice } from './form';

interface ChoiceProps {
  label: string;
  hint: string | undefined;
  fault: string | undefined;
  family: Family | undefined;
  value: string;
  onText: (text: string) => void;
}

/** Nothing where the drives of the family are known by its own page alone, unless something is named there all the same. */
export function DescriptionChoice({ label, hint, fault, family, value, onText }: ChoiceProps) {
  const { client } = useGateway();
  const { shelf } = descriptionsOf(client);
  const takes = family?.takes_description === true;
  useEffect(() => {
    if (takes) shelf.load().catch(() => undefined);
  }, [shelf, takes]);
  if (!takes && value === '') return null;
  const list = shelf.list.value ?? [];
  const missing = value !== '' && shelf.list.value !== null && !list.some((d) => d.name === value);
  const why = !takes ? t('Drives of this family have no description: choose none.') : missing ? t('There is no description {name}.', { name: value }) : fault;
  return (
    <div class="form-field wide description-choice">
      <Choice
        label={label}
        fault={why}
        {...(hint === undefined ? {} : { hint })}
        value={value}
        onChoice={onText}
        choices={[{ value: '', text: t('none') }, ...(missing ? [{ value, text: value }] : []), ...list.map((d) => ({ value: d.name, text: `${d.name} (${deviceText(d)})` }))]}
      />
      <p class="where">
        {value !== '' && !missing && (
          <>
            <a href={descriptionPath(value)}>{t('Look at {name}', { name: value })}</a> ·{' '}
          </>
        )}
        <a href="/descriptions">{t('All descriptions, and new ones')}</a>
      </p>
    </div>
  );
}

/** What is done at the start of the drive, as its options stand. */
export function BootTexts({ texts, options }: { texts: Texts; options: readonly OptionSpec[] }) {
  const list = bootTexts(texts, options);
  if (list.length === 0) return null;
  return (
    <details data-field="boot">
      <summary>{t('At the start of this drive')}</summary>
      <ul class="boot-texts">
        {list.map((text) => (
          <li key={text}>{text}</li>
        ))}
      </ul>
    </details>
  );
}

/** In the wizard: a file that is dropped, or was chosen on the page of the descriptions, fills in the fields of the drive. */
export function DriveOfFile({ line, site, onTexts }: { line: Entry | undefined; site: Site; onTexts: (texts: Texts) => void }) {
  const { store } = useGateway();
  const families = store.families.value;
  const dropped = useSignal<Chosen | null>(null);
  const d = dropped.value ?? chosenDescription();
  if (![...families.values()].some((f) => f.takes_description)) return null;
  const rate = d ? rateText(d, line) : '';
  return (
    <div data-field="drive-of-file">
      <DescriptionDrop
        text={t('A CANopen drive with an EDS or DCF of its maker: drop the file here, or')}
        onStored={(stored) => {
          const last = stored.at(-1);
          if (!last) return;
          dropped.value = chosenOf(last);
          onTexts(driveOf(dropped.value, line, site, families));
        }}
      />
      {d && (
        <p class="where" role="status" data-field="of-file">
          {d.commissioning?.node ? t('The drive is made of {name}, with the node number {node} of the file.', { name: d.name, node: d.commissioning.node }) : t('The drive is made of {name}. The file names no node number: the one that is set in the drive is its address.', { name: d.name })} {rate}
        </p>
      )}
    </div>
  );
}
