// A drive that a scan has found, as an entry of the site: with its family where the line has another one. In: a draft. Out: the edited site.
import { describe, expect, it } from 'vitest';
import { addFound } from '../src/components/site-scan';
import { familyOf } from '../src/text/options';

const line = { name: 'can0', uri: 'can:can0', family: 'uim342' };
function draftOf(site: Record<string, unknown>) {
  const draft = { draft: { peek: () => draft.site }, site, edit: (next: Record<string, unknown>) => void (draft.site = next) };
  return draft;
}

describe('a found drive', () => {
  it('names its family only where it is not the line’s', () => {
    const draft = draftOf({ lines: [line], drives: [], axes: [], mappings: [] });
    addFound(draft as never, line as never, 5, 'uim342');
    addFound(draft as never, line as never, 5, 'cia402');
    const drives = draft.site.drives as Record<string, unknown>[];
    expect(drives.map((d) => [d.address, d.family])).toEqual([[5, undefined], [5, 'cia402']]);
    expect(new Set(drives.map((d) => d.name)).size).toBe(2);
    expect(drives.map((d) => familyOf('axes', { drive: String(d.name) }, draft.site as never))).toEqual(['uim342', 'cia402']);
    expect(familyOf('drives', { line: 'can0', family: '' }, draft.site as never)).toBe('uim342');
  });
});
