// Help: which chapter of the handbook a page is about. In: the page's name. Out: an address below /help/.
// The chapters are made from docs/handbook when the page is built; tests/help-text.test.ts checks that each is there.
import type { Route } from '../router';

const chapters: Record<Route['page'], string> = {
  overview: 'operate',
  axis: 'commanding',
  lines: 'drives-and-twins',
  line: 'drives-and-twins',
  recipes: 'alarms-and-recipes',
  recipe: 'alarms-and-recipes',
  events: 'alarms-and-recipes',
  gateway: 'operate',
  fleet: 'fleet',
  recorder: 'recorder',
  report: 'commission',
  mappings: 'map',
  parameters: 'parameters',
  site: 'changing-a-site',
  descriptions: 'descriptions',
  description: 'descriptions',
  users: 'access',
  'sign-in': 'access',
  unknown: '',
};

/** `chapter`: the name of its page, with an anchor where a section has its own heading; empty: the contents. */
export const helpPath = (chapter: string): string => {
  const [name, anchor] = chapter.split('#');
  return `/help/${name ? `${name}.html` : ''}${anchor ? `#${anchor}` : ''}`;
};
export const helpOfPage = (page: Route['page']): string => helpPath(chapters[page]);
