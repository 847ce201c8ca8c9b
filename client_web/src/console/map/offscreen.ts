/** A part of the map that changes seldom: drawn once, and then shown as a picture. */

import type { MapView } from "./views";

export class Offscreen {
  private readonly canvas = document.createElement("canvas");
  private shown = "";

  /** Show the part on `pen`; it is drawn anew where `of`, or the view, is not what it was. */
  show(
    pen: CanvasRenderingContext2D,
    view: MapView,
    ratio: number,
    of: string,
    draw: (pen: CanvasRenderingContext2D) => void,
  ): void {
    const { canvas } = this;
    const now = `${view.key} ${ratio} ${of}`;
    if (now !== this.shown) {
      const own = canvas.getContext("2d");
      if (!own) return;
      this.shown = now;
      const width = Math.round(view.width * ratio);
      const height = Math.round(view.height * ratio);
      if (canvas.width !== width) canvas.width = width;
      if (canvas.height !== height) canvas.height = height;
      own.setTransform(1, 0, 0, 1, 0, 0);
      own.clearRect(0, 0, width, height);
      own.setTransform(ratio, 0, 0, ratio, 0, 0);
      draw(own);
    }
    pen.drawImage(canvas, 0, 0, view.width, view.height);
  }
}
