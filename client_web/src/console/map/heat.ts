/** The heat map that is shown: asked of the server from time to time, and drawn as a picture. */

import type { Heat } from "../net/types";
import type { Api } from "../net/api";
import { fullValue, heatColour, type Picture, pictureOf, valuesOf } from "./raster";
import type { MapView } from "./views";

interface Shown extends Picture {
  z_m: number;
  west: number;
  south: number;
  east: number;
  north: number;
}

export class HeatMap {
  /** The value that has the full colour; null while there is none. */
  most: number | null = null;
  /** Becomes another with every picture. */
  version = 0;
  private shown: readonly Shown[] = [];
  private asked = 0;

  constructor(private readonly api: Api) {}

  async ask(kind: string, windowS: number): Promise<void> {
    const asked = ++this.asked;
    const heat = await this.api.get<Heat>("/heat", { kind, window_s: windowS });
    // Another map may have been chosen meanwhile, or none.
    if (asked !== this.asked) return;
    const values = heat.storeys.map(valuesOf);
    const most = Math.max(0, ...values.map(fullValue));
    this.most = most;
    this.version++;
    this.shown = heat.storeys.map((raster, index) => {
      const [west, south] = raster.origin_m;
      const picture = pictureOf(raster, values[index] ?? new Float32Array(), most);
      const east = west + raster.width * raster.cell_m;
      const north = south + raster.height * raster.cell_m;
      return { ...picture, z_m: raster.z_m, west, south, east, north };
    });
  }

  clear(): void {
    this.asked++;
    this.shown = [];
    this.most = null;
    this.version++;
  }

  draw(pen: CanvasRenderingContext2D, view: MapView): void {
    for (const { canvas, z_m, west, south, east, north } of this.shown) {
      const storey = view.storeyOf(z_m);
      if (!view.isShown(storey)) continue;
      drawPicture(pen, view, canvas, storey, [west, south, east, north]);
    }
  }
}

export function drawPicture(
  pen: CanvasRenderingContext2D,
  view: MapView,
  picture: HTMLCanvasElement,
  storey: number,
  [west, south, east, north]: readonly [number, number, number, number],
): void {
  const [x0, y0] = view.toCanvas(west, north, storey);
  const [x1, y1] = view.toCanvas(east, south, storey);
  pen.imageSmoothingEnabled = false;
  pen.drawImage(picture, x0, y0, x1 - x0, y1 - y0);
}

/** A bar of the colours from nothing to the full value. */
export function drawScale(canvas: HTMLCanvasElement): void {
  const pen = canvas.getContext("2d");
  if (!pen) return;
  pen.clearRect(0, 0, canvas.width, canvas.height);
  for (let x = 0; x < canvas.width; x++) {
    const [red, green, blue, alpha] = heatColour(x / canvas.width);
    pen.fillStyle = `rgb(${red} ${green} ${blue} / ${alpha / 255})`;
    pen.fillRect(x, 0, 1, canvas.height);
  }
}
