// Keyboard of the screen: how much of the foot of the page it covers. In: the part of the page that is seen. Out: --keyboard for the styles, so
// that the stop at the foot lies above it. Browsers that make the page smaller themselves leave nothing to do; never asks for the keyboard.

export function watchKeyboard(view: VisualViewport | null = globalThis.visualViewport ?? null): void {
  if (!view) return;
  const look = () => {
    // A page that is zoomed in shows a part of itself too: that is no keyboard.
    const covered = view.scale > 1.01 ? 0 : Math.max(0, Math.round(innerHeight - view.height - view.offsetTop));
    document.documentElement.style.setProperty('--keyboard', `${covered}px`);
  };
  view.addEventListener('resize', look);
  view.addEventListener('scroll', look);
  look();
}
