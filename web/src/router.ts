// Router: which page the address names. In: the address bar and links inside the page. Out: a signal.
// The gateway answers index.html for every address that is not a file or an API path, so that an address can be sent to a colleague.
import { signal } from '@preact/signals';

export type Route =
  | { page: 'overview' }
  | { page: 'axis'; name: string; tab: AxisTab }
  | { page: 'lines' }
  | { page: 'line'; name: string; at_ms?: number }
  | { page: 'recipes' }
  | { page: 'recipe'; name: string }
  | { page: 'events' }
  | { page: 'recorder'; tab: RecorderTab; axis?: string; at_ms?: number }
  | { page: 'gateway' }
  | { page: 'report' }
  | { page: 'fleet' }
  | { page: 'mappings' }
  | { page: 'parameters'; name: string }
  | { page: 'site' }
  | { page: 'descriptions' }
  | { page: 'description'; name: string; other?: string }
  | { page: 'users' }
  | { page: 'sign-in' }
  | { page: 'unknown'; path: string };

/** The tabs of an axis' page, by their address; its parameters are one more, and a page of their own. */
export const axisTabs = ['move', 'scope', 'drive', 'simulation', 'events'] as const;
export type AxisTab = (typeof axisTabs)[number];
const tabOf = (s: string | undefined): AxisTab | undefined => axisTabs.find((t) => t === s && t !== 'move');

/** The tabs of the recorder. `/recorder/trends/AXIS/MS` is an axis around an instant, `/recorder/captures/AXIS` a capture of it,
 *  `/recorder/recordings/NAME/MS` a recording played back at an instant. */
export const recorderTabs = ['trends', 'captures', 'recordings'] as const;
export type RecorderTab = (typeof recorderTabs)[number];

/** Pages without a name. */
const plain = ['lines', 'mappings', 'recipes', 'site', 'descriptions', 'events', 'gateway', 'report', 'fleet', 'users', 'sign-in'] as const;
const isPlain = (s: string): s is (typeof plain)[number] => (plain as readonly string[]).includes(s);

export function routeOf(path: string): Route {
  const parts = path.split('/').filter(Boolean).map(decode);
  const [first, second, ...rest] = parts;
  if (first === undefined) return { page: 'overview' };
  if (rest.length === 0 && second !== undefined) {
    if (first === 'axes') return { page: 'axis', name: second, tab: 'move' };
    if (first === 'lines') return { page: 'line', name: second };
    if (first === 'recipes') return { page: 'recipe', name: second };
    if (first === 'descriptions') return { page: 'description', name: second };
  }
  if (first === 'descriptions' && second !== undefined && rest.length === 1) return { page: 'description', name: second, other: rest[0] as string };
  const at_line = Number(rest[0]);
  if (first === 'lines' && second !== undefined && rest.length === 1 && Number.isSafeInteger(at_line) && at_line > 0) return { page: 'line', name: second, at_ms: at_line };
  if (first === 'axes' && second !== undefined && rest.length === 1 && rest[0] === 'parameters') return { page: 'parameters', name: second };
  const tab = tabOf(rest[0]);
  if (first === 'axes' && second !== undefined && rest.length === 1 && tab) return { page: 'axis', name: second, tab };
  if (first === 'recorder') {
    const part = second === undefined ? 'trends' : recorderTabs.find((t) => t === second);
    const [axis, at] = rest;
    const at_ms = at === undefined ? undefined : Number(at);
    if (part && rest.length <= 2 && (at_ms === undefined || Number.isSafeInteger(at_ms))) return { page: 'recorder', tab: part, ...(axis === undefined ? {} : { axis }), ...(at_ms === undefined ? {} : { at_ms }) };
  }
  if (second === undefined && isPlain(first)) return { page: first };
  return { page: 'unknown', path };
}

// A last part with a point looks like a file to the gateway, which then has no page to answer; a slash at the end says it is none.
const pathOf = (kind: string, name: string): string => `/${kind}/${encodeURIComponent(name)}${name.includes('.') ? '/' : ''}`;
export const axisPath = (name: string): string => pathOf('axes', name);
export const axisTabPath = (name: string, tab: AxisTab): string => (tab === 'move' ? axisPath(name) : `/axes/${encodeURIComponent(name)}/${tab}`);
export const parametersPath = (name: string): string => `/axes/${encodeURIComponent(name)}/parameters`;
export const linePath = (name: string): string => pathOf('lines', name);
/** A line's page with the frames around an instant, ms since 1970. */
export const framesPath = (line: string, at_ms: number): string => `/lines/${encodeURIComponent(line)}/${Math.round(at_ms)}`;

export const recorderPath = (tab: RecorderTab, axis?: string, at_ms?: number): string =>
  `/recorder/${tab}${axis === undefined ? '' : `/${encodeURIComponent(axis)}`}${at_ms === undefined ? '/' : `/${Math.round(at_ms)}`}`;

/** A description, perhaps beside another one. */
export const descriptionPath = (name: string, other?: string): string => (other === undefined ? pathOf('descriptions', name) : `/descriptions/${encodeURIComponent(name)}/${encodeURIComponent(other)}/`);

export const recipePath = (name: string): string => pathOf('recipes', name);

export const route = signal<Route>({ page: 'overview' });

export function go(path: string): void {
  if (path !== location.pathname) history.pushState(null, '', path);
  arrive(true);
}

/** Whether the heading of the page that was arrived at has yet to get the keyboard. */
let headingWanted = false;

function arrive(byLink: boolean): void {
  route.value = routeOf(location.pathname);
  headingWanted = false;
  if (!byLink) return;
  scrollTo(0, 0);
  headingWanted = true;
  requestAnimationFrame(focusHeading);
}

/** Keyboard and screen reader begin at the new page, as they would after a real load. A page whose code comes later calls this when it is drawn. */
export function focusHeading(): void {
  const heading = headingWanted ? document.querySelector<HTMLElement>('main h1') : null;
  if (!heading) return;
  headingWanted = false;
  heading.focus({ preventScroll: true });
}

export function startRouter(): void {
  arrive(false);
  addEventListener('popstate', () => arrive(false));
  document.addEventListener('click', (event) => {
    if (event.defaultPrevented || event.button !== 0 || event.metaKey || event.ctrlKey || event.shiftKey || event.altKey) return;
    const link = (event.target as Element | null)?.closest?.('a');
    if (!link || link.target || link.origin !== location.origin || link.hasAttribute('download') || /^\/(api|help)(\/|$)/.test(link.pathname)) return;
    if (link.hash && link.pathname === location.pathname) return; // a place on this page
    event.preventDefault();
    go(link.pathname);
  });
}

function decode(s: string): string {
  try {
    return decodeURIComponent(s);
  } catch {
    return s;
  }
}
