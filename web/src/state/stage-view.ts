// Stage view: what may be done with what waits to be applied: whether it was checked, whether it is one's own or somebody else's, whether it can be applied now. In: the
// draft, the time that is typed. Out: values. Never asks the gateway.
import type { SiteFault } from '../api/site';
import { parseNumber } from '../text/number';
import { sameDocument, type Difference } from '../text/site';
import type { SiteDraft } from './site-draft';

export interface StageView {
  changes: readonly Difference[];
  /** What is checked is what stands in the draft. */
  checked: boolean;
  /** In view is what somebody else has staged. */
  inView: boolean;
  /** Staged is something else than what stands in the draft. */
  foreign: boolean;
  faults: readonly SiteFault[];
  ready: boolean;
  /** How long it waits to be kept; null: what is typed is no such time. */
  within_s: number | null;
  busy: boolean;
}

/** 0: it is not rolled back by itself. */
export function readWithin(text: string): number | null {
  const s = parseNumber(text);
  return s.good && Number.isInteger(s.value) && (s.value === 0 || (s.value >= 5 && s.value <= 600)) ? s.value : null;
}

export function stageView(draft: SiteDraft, within: string): StageView {
  const stage = draft.stage.value;
  const changes = draft.changes.value;
  const checked = draft.checked.value !== null && sameDocument(draft.checked.value, draft.draft.value);
  const staged = stage.state === 'staged';
  const inView = draft.rival.value?.inView === true && staged;
  const faults = inView ? (stage.faults ?? []) : checked ? draft.faults.value : [];
  const own = checked && draft.theirs.value === null && changes.length > 0;
  return { changes, checked, inView, foreign: staged && !checked, faults, ready: (inView || own) && faults.length === 0, within_s: readWithin(within), busy: draft.reported.value.tone === 'busy' };
}
