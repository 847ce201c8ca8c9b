/** Draws what panels want to be seen on the map. */

import type { Raster } from "../net/types";
import type { Overlay } from "../state/overlays";
import { drawPicture } from "./heat";
import { drawLine, drawSegments } from "./layers";
import { Offscreen } from "./offscreen";
import { fullValue, type Picture, pictureOf, valuesOf } from "./raster";
import type { MapView } from "./views";

export class OverlayPainter {
  private readonly rasters = new WeakMap<Raster, Picture>();
  /** Overlays of many lines, which stay the same for long. */
  private readonly dense = new Offscreen();
  private drawn: readonly Overlay[] = [];
  private version = 0;

  draw(
    pen: CanvasRenderingContext2D,
    view: MapView,
    ratio: number,
    overlays: Iterable<Overlay>,
  ): void {
    const all = [...overlays];
    const dense = all.filter(isDense);
    if (!isSame(dense, this.drawn)) {
      this.drawn = dense;
      this.version++;
    }
    if (dense.length > 0) {
      this.dense.show(pen, view, ratio, String(this.version), (own) => {
        for (const overlay of dense) this.drawOne(own, view, overlay);
      });
    }
    for (const overlay of all) if (!isDense(overlay)) this.drawOne(pen, view, overlay);
  }

  private drawOne(
    pen: CanvasRenderingContext2D,
    view: MapView,
    { lines, raster, segments }: Overlay,
  ): void {
    if (raster) {
      const storey = view.storeyOf(raster.z_m);
      const [west, south] = raster.origin_m;
      const east = west + raster.width * raster.cell_m;
      const north = south + raster.height * raster.cell_m;
      if (view.isShown(storey)) {
        const { canvas } = this.picture(raster);
        drawPicture(pen, view, canvas, storey, [west, south, east, north]);
      }
    }
    for (const many of segments ?? []) drawSegments(pen, view, many);
    for (const line of lines) drawLine(pen, view, line);
  }

  private picture(raster: Raster & { most?: number }): Picture {
    const known = this.rasters.get(raster);
    if (known) return known;
    const values = valuesOf(raster);
    const made = pictureOf(raster, values, raster.most ?? fullValue(values));
    this.rasters.set(raster, made);
    return made;
  }
}

function isDense({ raster, segments }: Overlay): boolean {
  return raster !== undefined || segments !== undefined;
}

function isSame(some: readonly Overlay[], others: readonly Overlay[]): boolean {
  return some.length === others.length && some.every((one, index) => one === others[index]);
}
