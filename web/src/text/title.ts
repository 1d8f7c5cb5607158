// Title: what a page is called, above it and in the window's title, before its code is there. In: a route. Out: text.
import { t } from '../language';
import type { AxisTab, Route } from '../router';

const titles = {
  overview: t('Axes'),
  lines: t('Lines and drives'),
  mappings: t('Mappings'),
  recipes: t('Recipes'),
  site: t('Site'),
  descriptions: t('Descriptions of drives'),
  events: t('Events'),
  recorder: t('Recorder'),
  gateway: t('Gateway'),
  report: t('Commissioning report'),
  fleet: t('Fleet'),
  users: t('Users'),
  'sign-in': t('Sign in'),
  unknown: t('No such page'),
};

export function headingOf(name: string, tab: AxisTab): string {
  switch (tab) {
    case 'move': return name;
    case 'scope': return t('Scope of {name}', { name });
    case 'drive': return t('Drive of {name}', { name });
    case 'simulation': return t('Simulation of {name}', { name });
    case 'events': return t('Events of {name}', { name });
  }
}

export function titleOf(r: Route): string {
  switch (r.page) {
    case 'parameters': return t('Parameters of {name}', { name: r.name });
    case 'axis': return headingOf(r.name, r.tab);
    case 'line':
    case 'description':
    case 'recipe': return r.name;
    default: return titles[r.page];
  }
}
