// Name: an axis or a drive by its name, with the mark beside it while its model answers in place of the real one. In: the name. Out: a name, a link if
// there is a page, the mark. Every place that names an axis uses it, so that nothing simulated is taken for real anywhere. Follows only that one
// thing, not the readings: a list of a thousand names is not drawn anew by a moving axis.
import { useGateway } from '../gateway';
import { t } from '../language';
import { axisPath } from '../router';

type Kind = 'axis' | 'drive';
const long: Record<Kind, string> = { axis: t('Simulated: the embedded model of the drive answers; nothing real moves'), drive: t('Simulated: the embedded model answers in place of this drive') };

/** The mark alone; nothing while the real one answers, or nobody does. `short`: "SIM" to the eye; to a screen reader it is the whole word. */
export function SimulatedMark({ of, kind = 'axis', short = true, lead = '' }: { of: string; kind?: Kind; short?: boolean; lead?: string }) {
  const { store } = useGateway();
  if (!store.simulation(kind, of).value) return null;
  return (
    <>
      {lead}
      <span class="mark mark-simulated sim-mark" role="img" aria-label={t('simulated')} title={long[kind]} data-field="sim">
        {short ? t('SIM') : t('SIMULATED')}
      </span>
    </>
  );
}

interface NameProps {
  name: string;
  /** Without a link where the name stands on its own page, or in a heading that has its own. */
  plain?: boolean;
  short?: boolean;
}

export function AxisName({ name, plain = false, short = true }: NameProps) {
  return (
    <span class="named">
      {plain ? <span>{name}</span> : <a href={axisPath(name)}>{name}</a>}
      <SimulatedMark of={name} short={short} lead=" " />
    </span>
  );
}

export function DriveName({ name, short = true }: Omit<NameProps, 'plain'>) {
  return (
    <span class="named">
      <span>{name}</span>
      <SimulatedMark of={name} kind="drive" short={short} lead=" " />
    </span>
  );
}

/** For a choice or a sentence, where only text can stand: "feeder (simulated)". */
export function useNamed(): (axis: string) => string {
  const { store } = useGateway();
  return (axis) => (store.simulation('axis', axis).value ? t('{axis} (simulated)', { axis }) : axis);
}
