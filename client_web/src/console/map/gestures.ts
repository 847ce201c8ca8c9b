/** Pointers on the map: drag to pan, pinch and wheel to zoom, draw a box or a line around many. */

import { boxOf, type Pixel } from "./picking";

export type Mode = "pan" | "box" | "lasso";

export interface Gestures {
  mode: () => Mode;
  pan: (dx: number, dy: number) => void;
  zoom: (factor: number, at: Pixel) => void;
  click: (at: Pixel, adds: boolean) => void;
  twice: (at: Pixel) => void;
  /** While it is drawn. */
  drawing: (ring: readonly Pixel[] | null) => void;
  region: (ring: readonly Pixel[], adds: boolean) => void;
  hover: (at: Pixel | null) => void;
}

/** A pointer that moves less than this clicks. */
const STILL_PX = 5;
const WHEEL = 0.0015;
const MOST_LASSO = 2000;

export class PointerGestures {
  private readonly down = new Map<number, Pixel>();
  private start: Pixel | null = null;
  private mode: Mode = "pan";
  private moved = false;
  private ring: Pixel[] = [];

  constructor(
    private readonly canvas: HTMLCanvasElement,
    private readonly to: Gestures,
  ) {
    canvas.addEventListener("pointerdown", (event) => {
      this.press(event);
    });
    canvas.addEventListener("pointermove", (event) => {
      this.move(event);
    });
    canvas.addEventListener("pointerup", (event) => {
      this.release(event, true);
    });
    canvas.addEventListener("pointercancel", (event) => {
      this.release(event, false);
    });
    canvas.addEventListener("pointerleave", () => {
      this.to.hover(null);
    });
    canvas.addEventListener("dblclick", (event) => {
      this.to.twice([event.offsetX, event.offsetY]);
    });
    canvas.addEventListener(
      "wheel",
      (event) => {
        event.preventDefault();
        this.to.zoom(Math.exp(-event.deltaY * WHEEL), [event.offsetX, event.offsetY]);
      },
      { passive: false },
    );
  }

  private press(event: PointerEvent): void {
    if (event.button !== 0) return;
    this.canvas.setPointerCapture(event.pointerId);
    const at: Pixel = [event.offsetX, event.offsetY];
    this.down.set(event.pointerId, at);
    if (this.down.size > 1) {
      this.to.drawing(null);
      this.start = null;
      return;
    }
    this.start = at;
    this.moved = false;
    this.ring = [at];
    this.mode = event.shiftKey ? "box" : event.altKey ? "lasso" : this.to.mode();
  }

  private move(event: PointerEvent): void {
    const at: Pixel = [event.offsetX, event.offsetY];
    const before = this.down.get(event.pointerId);
    if (!before) {
      this.to.hover(at);
      return;
    }
    if (this.down.size === 2) this.pinch(event.pointerId, before, at);
    this.down.set(event.pointerId, at);
    if (!this.start || this.down.size > 1) return;
    this.moved ||= Math.hypot(at[0] - this.start[0], at[1] - this.start[1]) > STILL_PX;
    if (!this.moved) return;
    if (this.mode === "pan") {
      this.to.pan(at[0] - before[0], at[1] - before[1]);
    } else {
      if (this.mode === "box") this.ring = [...boxOf(this.start, at)];
      else if (this.ring.length < MOST_LASSO) this.ring.push(at);
      this.to.drawing(this.ring);
    }
  }

  private pinch(moving: number, before: Pixel, at: Pixel): void {
    for (const [id, other] of this.down) {
      if (id === moving) continue;
      const was = Math.hypot(before[0] - other[0], before[1] - other[1]);
      const is = Math.hypot(at[0] - other[0], at[1] - other[1]);
      if (was > 1) this.to.zoom(is / was, [(at[0] + other[0]) / 2, (at[1] + other[1]) / 2]);
      this.to.pan((at[0] - before[0]) / 2, (at[1] - before[1]) / 2);
    }
  }

  private release(event: PointerEvent, meant: boolean): void {
    if (!this.down.delete(event.pointerId)) return;
    this.to.drawing(null);
    const { start } = this;
    this.start = null;
    if (!start || !meant) return;
    const adds = event.ctrlKey || event.metaKey || (event.shiftKey && !this.moved);
    if (!this.moved) this.to.click(start, adds);
    else if (this.mode !== "pan") this.to.region(this.ring, adds);
  }
}
