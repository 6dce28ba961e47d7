/** Distinguishes clicks and taps from drags. */

const maxPixels = 6;
const maxMs = 600;

/** Calls `act` with the window coordinates of each click or tap of one pointer that did not move. */
export function listenToTaps(element: HTMLElement, act: (x: number, y: number) => void): void {
  let down: { id: number; x: number; y: number; time: number } | null = null;
  element.addEventListener("pointerdown", (event) => {
    const isFirst = event.isPrimary && event.button === 0;
    down = isFirst ? { id: event.pointerId, x: event.clientX, y: event.clientY, time: event.timeStamp } : null;
  });
  element.addEventListener("pointerup", (event) => {
    if (!down || event.pointerId !== down.id) return;
    const moved = Math.hypot(event.clientX - down.x, event.clientY - down.y);
    if (moved <= maxPixels && event.timeStamp - down.time <= maxMs) act(event.clientX, event.clientY);
    down = null;
  });
  element.addEventListener("pointercancel", () => (down = null));
}
