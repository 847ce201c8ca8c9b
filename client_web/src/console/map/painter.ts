/** Draws the whole map anew for each picture of the screen. */

import type { AppContext } from "../context";
import type { MapData, Raster } from "../net/types";
import { valuesOf, fullValue, pictureOf, type Picture } from "./raster";
import { drawDoors, drawGround, drawPlaces } from "./ground";
import { drawPicture, type HeatMap } from "./heat";
import {
  type Contacts,
  drawLayers,
  drawLine,
  drawMarks,
  drawSegments,
  type LayersMessage,
} from "./layers";
import type { MapOptions } from "./options";
import { type Drawn, drawPeople, drawTags, drawTrails, placed } from "./people";
import type { Pixel } from "./picking";
import type { MapView } from "./views";

/** With more avatars only the chosen ones have the long trails. */
const MANY = 100;
const SHORT_TRAIL_S = 10;

export class Painter {
  /** Everybody in the last picture. */
  drawn: readonly Drawn[] = [];
  /** The box or line that is being drawn. */
  ring: readonly Pixel[] | null = null;
  map: MapData | null = null;
  doors: Readonly<Record<string, boolean>> = {};
  layers: LayersMessage | null = null;
  /** Milliseconds that the last pictures took, on average. */
  tookMs = 0;
  private readonly still = document.createElement("canvas");
  private stillOf = "";
  private readonly pictures = new WeakMap<Raster, Picture>();

  constructor(
    private readonly app: AppContext,
    private readonly view: MapView,
    private readonly heat: HeatMap,
    private readonly contacts: Contacts,
  ) {}

  paint(pen: CanvasRenderingContext2D, ratio: number, nowS: number, options: MapOptions): void {
    const beganMs = performance.now();
    const { app, view, map } = this;
    const scheme = app.scheme.value;
    pen.setTransform(ratio, 0, 0, ratio, 0, 0);
    if (!map) {
      pen.fillStyle = scheme.colour("ground");
      pen.fillRect(0, 0, view.width, view.height);
      return;
    }
    this.drawStill(pen, ratio, map);
    const drawnS = app.avatars.drawnS(nowS);
    const chosen = new Set(app.state.chosen.value);
    if (options.heat !== "none") this.heat.draw(pen, view);
    this.drawOverlays(pen);
    drawDoors(pen, view, map, this.doors, scheme);
    const names = options.places ? drawPlaces(pen, view, map, scheme) : [];
    this.trails(pen, drawnS, options, chosen);
    if (this.layers) drawLayers(pen, view, this.layers, scheme);
    if (options.contacts) this.contacts.draw(pen, view, nowS, scheme);
    this.drawn = placed(app.avatars.byId.values(), view, drawnS);
    drawPeople(pen, view, this.drawn, chosen, scheme);
    drawTags(pen, this.drawn, chosen, options.tags, scheme, names);
    this.drawRing(pen);
    this.tookMs += 0.1 * (performance.now() - beganMs - this.tookMs);
  }

  private trails(
    pen: CanvasRenderingContext2D,
    drawnS: number,
    { trailS }: MapOptions,
    chosen: ReadonlySet<string>,
  ): void {
    if (trailS === 0) return;
    const { avatars, scheme } = this.app;
    const all = [...avatars.byId.values()];
    const isMuch = all.length > MANY && trailS > SHORT_TRAIL_S;
    const long = isMuch ? all.filter(({ key }) => chosen.has(key)) : all;
    const short = isMuch ? all.filter(({ key }) => !chosen.has(key)) : [];
    drawTrails(pen, this.view, long, drawnS, trailS, scheme.value);
    drawTrails(pen, this.view, short, drawnS, SHORT_TRAIL_S, scheme.value);
  }

  /** Parts that never move are drawn once for each view of them. */
  private drawStill(pen: CanvasRenderingContext2D, ratio: number, map: MapData): void {
    const { view, still } = this;
    const { dark } = this.app.scheme.value;
    const { width, height, scale, centreX, centreY, only } = view;
    const of = [width, height, scale, centreX, centreY, only, ratio, dark, map.scene].join();
    if (of !== this.stillOf) {
      this.stillOf = of;
      still.width = Math.round(width * ratio);
      still.height = Math.round(height * ratio);
      const pen = still.getContext("2d");
      if (!pen) return;
      pen.setTransform(ratio, 0, 0, ratio, 0, 0);
      drawGround(pen, view, map, this.app.scheme.value);
    }
    pen.drawImage(still, 0, 0, width, height);
  }

  private drawOverlays(pen: CanvasRenderingContext2D): void {
    const { view } = this;
    for (const { lines, raster, segments } of this.app.state.overlays.value.values()) {
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
    const picking = this.app.state.picking.value;
    if (!picking || picking.points.length === 0) return;
    const { points, closed } = picking;
    const colour = this.app.scheme.value.colour("focus");
    drawLine(pen, view, { points, colour, widthPx: 2, closed, filled: closed });
    drawMarks(pen, view, points, colour);
  }

  private picture(raster: Raster & { most?: number }): Picture {
    const known = this.pictures.get(raster);
    if (known) return known;
    const values = valuesOf(raster);
    const made = pictureOf(raster, values, raster.most ?? fullValue(values));
    this.pictures.set(raster, made);
    return made;
  }

  private drawRing(pen: CanvasRenderingContext2D): void {
    if (!this.ring) return;
    pen.strokeStyle = pen.fillStyle = this.app.scheme.value.colour("focus");
    pen.lineWidth = 1.5;
    pen.beginPath();
    for (const [x, y] of this.ring) pen.lineTo(x, y);
    pen.closePath();
    pen.globalAlpha = 0.15;
    pen.fill();
    pen.globalAlpha = 1;
    pen.stroke();
  }
}
