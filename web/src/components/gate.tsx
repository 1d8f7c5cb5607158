// Gate: what one's role may not do is disabled, and says why. In: the role that is needed. Out: the same controls, or disabled ones with the reason.
// The stops that everybody may do (quick stop, halt) never stand behind a gate; switching off does. The gateway refuses by itself; this only spares the attempt.
import type { ComponentChildren } from 'preact';
import type { Role } from '../api/types';
import { useGateway } from '../gateway';
import { barred } from '../state/session';

/** What to spread over a button. */
export const useBarred = (need: Role) => barred(useGateway().session.mayNot(need));

/** The reason once, in sight, where several controls of a part are disabled for it: a finger finds no tooltip. */
export function Why({ need, what }: { need: Role; what: string }) {
  const why = useGateway().session.mayNot(need, what);
  return why ? (
    <p class="gate-why" data-field="barred">
      {why}
    </p>
  ) : null;
}

/** A group of controls at once. `silent`: the reason stands above already. */
export function Gate({ need, silent = false, children }: { need: Role; silent?: boolean; children: ComponentChildren }) {
  const why = useGateway().session.mayNot(need);
  return (
    <fieldset class="gate" disabled={why !== ''} title={why || undefined} aria-label={why || undefined} data-barred={why !== ''}>
      {why && !silent && <p class="gate-why">{why}</p>}
      {children}
    </fieldset>
  );
}
