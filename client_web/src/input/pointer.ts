/** Mouse and fingers on the picture: drag turns, wheel and pinch zoom, a tap points at something. */

export interface PointerEvents {
  orbit(yaw: number, pitch: number): void;
  zoom(factor: number): void;
  /** A tap at (x, y), each from -1 to 1 to the right and up. */
  tap(at: { x: number; y: number }): void;
}

const RADIANS_PER_PIXEL = 0.006;
const TAP_PIXELS = 8;
const TAP_MS = 450;
const WHEEL_PER_PIXEL = 0.0012;

interface Finger {
  x: number;
  y: number;
  startX: number;
  startY: number;
  startMs: number;
}

export function listenToPointer(surface: HTMLElement, events: PointerEvents): void {
  const fingers = new Map<number, Finger>();

  surface.addEventListener("pointerdown", (event) => {
    if (event.button > 0 && event.pointerType === "mouse" && event.button !== 2) return;
    surface.setPointerCapture(event.pointerId);
    const { clientX: x, clientY: y } = event;
    fingers.set(event.pointerId, { x, y, startX: x, startY: y, startMs: event.timeStamp });
  });

  surface.addEventListener("pointermove", (event) => {
    const finger = fingers.get(event.pointerId);
    if (!finger) return;
    const before = spread(fingers);
    const dx = event.clientX - finger.x;
    const dy = event.clientY - finger.y;
    finger.x = event.clientX;
    finger.y = event.clientY;
    const after = spread(fingers);
    if (fingers.size === 1) events.orbit(-dx * RADIANS_PER_PIXEL, dy * RADIANS_PER_PIXEL);
    else if (before > 0 && after > 0) events.zoom(before / after);
  });

  const lift = (event: PointerEvent): void => {
    const finger = fingers.get(event.pointerId);
    fingers.delete(event.pointerId);
    if (!finger || event.type === "pointercancel" || event.button === 2 || fingers.size > 0) return;
    const moved = Math.hypot(finger.x - finger.startX, finger.y - finger.startY);
    if (moved > TAP_PIXELS || event.timeStamp - finger.startMs > TAP_MS) return;
    const { left, top, width, height } = surface.getBoundingClientRect();
    events.tap({
      x: ((event.clientX - left) / width) * 2 - 1,
      y: 1 - ((event.clientY - top) / height) * 2,
    });
  };
  surface.addEventListener("pointerup", lift);
  surface.addEventListener("pointercancel", lift);
  surface.addEventListener("contextmenu", (event) => {
    event.preventDefault();
  });
  surface.addEventListener(
    "wheel",
    (event) => {
      event.preventDefault();
      events.zoom(Math.exp(event.deltaY * WHEEL_PER_PIXEL));
    },
    { passive: false },
  );
}

/** Distance between the first two fingers, 0 with fewer. */
function spread(fingers: ReadonlyMap<number, Finger>): number {
  const [a, b] = [...fingers.values()];
  return a && b ? Math.hypot(a.x - b.x, a.y - b.y) : 0;
}
