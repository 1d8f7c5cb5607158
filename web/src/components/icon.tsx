// Icons: drawn here, so that nothing is fetched. In: a name. Out: an SVG that is hidden from screen readers; the word beside it speaks.
import type { JSX } from 'preact';

const shapes = {
  'circle-dashed': <circle cx="8" cy="8" r="5.5" stroke-dasharray="2.4 2.2" />,
  circle: <circle cx="8" cy="8" r="5.5" />,
  'circle-half': (
    <>
      <circle cx="8" cy="8" r="5.5" />
      <path d="M8 2.5a5.5 5.5 0 0 1 0 11z" fill="currentColor" stroke="none" />
    </>
  ),
  dot: <circle cx="8" cy="8" r="2.5" fill="currentColor" stroke="none" />,
  check: <path d="M3 8.5l3.2 3.2L13 4.8" />,
  'power-off': <path d="M8 2v5M4.6 4.2a5 5 0 1 0 6.8 0" />,
  power: <path d="M8 2v5M4.6 4.2a5 5 0 1 0 6.8 0" />,
  // A full octagon is a stop and nothing else; an alarm is a bell.
  octagon: <path d="M5.5 2h5L14 5.5v5L10.5 14h-5L2 10.5v-5z" fill="currentColor" stroke="none" />,
  bell: <path d="M8 1.8v1.1M3.5 11.5c1-1 1.1-2 1.1-4.2a3.4 3.4 0 0 1 6.8 0c0 2.2.1 3.2 1.1 4.2zM6.6 13.6a1.5 1.5 0 0 0 2.8 0" />,
  chevron: <path d="M4 6l4 4 4-4" />,
  sort: <path d="M5 6.5l3-3 3 3M5 9.5l3 3 3-3" />,
  triangle: <path d="M8 2.5l6 10.5H2zM8 6.5v3M8 11.2v.3" />,
  unplugged: <path d="M2 2l12 12M6 4V2M10 4V2M4.5 5H11v3.2M10 10.5A3.5 3.5 0 0 1 4.5 8V5M8 11v3" />,
  plug: <path d="M6 4V2M10 4V2M4.5 5h7v3a3.5 3.5 0 0 1-7 0zM8 11.5V14" />,
  chip: <path d="M4.5 4.5h7v7h-7zM6.5 2v2.5M9.5 2v2.5M6.5 11.5V14M9.5 11.5V14M2 6.5h2.5M2 9.5h2.5M11.5 6.5H14M11.5 9.5H14" />,
  clock: <path d="M8 2.5a5.5 5.5 0 1 0 0 11 5.5 5.5 0 0 0 0-11M8 5v3.2l2.2 1.4" />,
  'arrow-right': <path d="M2.5 8h11M9 3.5L13.5 8 9 12.5" />,
  'arrow-left': <path d="M13.5 8h-11M7 3.5L2.5 8 7 12.5" />,
  target: (
    <>
      <circle cx="8" cy="8" r="5.5" />
      <circle cx="8" cy="8" r="1.8" fill="currentColor" stroke="none" />
    </>
  ),
  pause: <path d="M5.5 3.5v9M10.5 3.5v9" />,
  stop: <rect x="3.5" y="3.5" width="9" height="9" fill="currentColor" stroke="none" />,
  info: <path d="M8 2.5a5.5 5.5 0 1 0 0 11 5.5 5.5 0 0 0 0-11M8 7.5v3.5M8 5v.3" />,
  sun: <path d="M8 5.2a2.8 2.8 0 1 0 0 5.6 2.8 2.8 0 0 0 0-5.6M8 1.5v1.4M8 13.1v1.4M1.5 8h1.4M13.1 8h1.4M3.4 3.4l1 1M11.6 11.6l1 1M12.6 3.4l-1 1M4.4 11.6l-1 1" />,
  moon: <path d="M13 9.6A5.5 5.5 0 0 1 6.4 3a5.5 5.5 0 1 0 6.6 6.6z" />,
  refresh: <path d="M13 8a5 5 0 1 1-1.5-3.6M13 2v3h-3" />,
  axis: <path d="M2 13.5h12M3.5 10h9M5 8V5.5h6V8z" />,
  lines: <path d="M2 8h12M5 8V4.5M11 8v3.5M3.5 2.5h3v2h-3zM9.5 11.5h3v2h-3z" />,
  list: <path d="M5.5 4h8M5.5 8h8M5.5 12h8M2.5 4h.4M2.5 8h.4M2.5 12h.4" />,
  person: <path d="M8 2.5a2.7 2.7 0 1 0 0 5.4 2.7 2.7 0 0 0 0-5.4M2.8 13.5c.5-2.6 2.5-4 5.2-4s4.7 1.4 5.2 4" />,
  box: <path d="M2.5 4.5h11v7h-11zM5 9h.4M8 9h3" />,
  table: <path d="M2.5 3.5h11v9h-11zM2.5 6.5h11M2.5 9.5h11M6.5 3.5v9" />,
  site: <path d="M6 2.5h4v3H6zM2 10.5h4v3H2zM10 10.5h4v3h-4zM8 5.5V8M4 10.5V8h8v2.5" />,
  pencil: <path d="M3 13l.6-2.8L11 2.8l2.2 2.2-7.4 7.4z" />,
  bin: <path d="M3 4.5h10M6.5 4.5v-2h3v2M4.5 4.5l.5 9h6l.5-9M7 7v4M9 7v4" />,
  plus: <path d="M8 3v10M3 8h10" />,
  down: <path d="M8 3v10M3.5 8.5L8 13l4.5-4.5" />,
  remove: <path d="M4 4l8 8M12 4l-8 8" />,
  shelf: <path d="M2.5 10.5h11M4 10.5v3M12 10.5v3M4.5 10.5v-6h3v6M9.5 10.5v-4h3" />,
  play: <path d="M4.5 3l8 5-8 5z" />,
  up: <path d="M8 13V3M3.5 7.5L8 3l4.5 4.5" />,
} satisfies Record<string, JSX.Element>;

export type IconName = keyof typeof shapes;

export function Icon({ name, size = 16 }: { name: IconName; size?: number }) {
  return (
    <svg
      class="icon"
      width={size}
      height={size}
      viewBox="0 0 16 16"
      fill="none"
      stroke="currentColor"
      stroke-width="1.5"
      stroke-linecap="round"
      stroke-linejoin="round"
      aria-hidden="true"
      focusable="false"
    >
      {shapes[name]}
    </svg>
  );
}
