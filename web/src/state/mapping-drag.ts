// Drag: one press of a pointer from its beginning to its end. In: the press, what to do. Out: a click, or a way that was gone and its end.
// A finger scrolls: only where `finger` says so (a handle that does not scroll) it drags. Ends with the pointer, with Escape's putting back, or when
// the browser takes the pointer away.
const slack_px = 4;

export interface DragSteps {
  /** The pointer has left its place; false: nothing is dragged. */
  start: () => boolean;
  move: (x: number, y: number) => void;
  /** `dropped`: let go by the person, not taken away by the browser. */
  end: (dropped: boolean) => void;
  click: () => void;
  finger?: boolean;
}

export function followPointer(down: PointerEvent, steps: DragSteps): void {
  if (down.button !== 0) return;
  const end = new AbortController();
  const drags = down.pointerType !== 'touch' || steps.finger === true;
  let moved = false;
  let started = false;
  const on = (kind: string, f: (e: PointerEvent) => void) => addEventListener(kind, (e) => (e as PointerEvent).pointerId === down.pointerId && f(e as PointerEvent), { signal: end.signal });
  on('pointermove', (e) => {
    if (!moved && Math.hypot(e.clientX - down.clientX, e.clientY - down.clientY) < slack_px) return;
    if (!moved && drags) started = steps.start();
    moved = true;
    if (started) steps.move(e.clientX, e.clientY);
  });
  on('pointerup', () => {
    end.abort();
    if (started) steps.end(true);
    else if (!moved) steps.click();
  });
  on('pointercancel', () => {
    end.abort();
    if (started) steps.end(false);
  });
}
