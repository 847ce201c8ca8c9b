/** Draws the whole map anew for each picture of the screen. */

import type { AppContext } from "../context";
import type { MapData } from "../net/types";
import { drawDoors, drawGround, drawPlaces } from "./ground";
import type { HeatMap } from "./heat";
import type { Box } from "./labels";
import { type Contacts, drawLayers, drawLine, drawMarks, type LayersMessage } from "./layers";
import type { MapOptions } from "./options";
import { Offscreen } from "./offscreen";
import { OverlayPainter } from "./overlaypainter";
import { type Drawn, drawPeople, drawTags, placed } from "./people";
import type { Pixel } from "./picking";
import { Trails } from "./trails";
import type { MapView } from "./views";

export class Painter {
  /** Everybody in the last picture. */
  drawn: readonly Drawn[] = [];
  /** The box or line that is being drawn. */
  ring: readonly Pixel[] | null = null;
  map: MapData | null = null;
  doors: Readonly<Record<string, boolean>> = {};
  /** Milliseconds that the last pictures took, on average. */
  tookMs = 0;
  private readonly still = new Offscreen();
  /** Ways, goals and predictions, which come twice a second. */
  private readonly planned = new Offscreen();
  private planning: LayersMessage | null = null;
  private plannings = 0;
  private readonly trails = new Trails();
  private readonly overlays = new OverlayPainter();
  /** Where names of places are, which those of avatars keep away from. */
  private names: readonly Box[] = [];

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
    this.drawStill(pen, ratio, map, options);
    const drawnS = app.avatars.drawnS(nowS);
    const chosen = new Set(app.state.chosen.value);
    const all = app.avatars.byId;
    this.overlays.draw(pen, view, ratio, app.state.overlays.value.values());
    this.drawPicking(pen);
    this.trails.draw(pen, view, ratio, all, drawnS, options.trailS, chosen, scheme);
    this.drawPlanned(pen, ratio);
    if (options.contacts) this.contacts.draw(pen, view, nowS, scheme);
    this.drawn = placed(all.values(), view, drawnS);
    drawPeople(pen, view, this.drawn, chosen, scheme);
    drawTags(pen, this.drawn, chosen, options.tags, scheme, this.names, view);
    this.drawRing(pen);
    this.tookMs += 0.1 * (performance.now() - beganMs - this.tookMs);
  }

  /** The parts that seldom change: the ground, the heat map, doors, places. */
  private drawStill(
    pen: CanvasRenderingContext2D,
    ratio: number,
    map: MapData,
    { heat, places }: MapOptions,
  ): void {
    const { view, doors } = this;
    const scheme = this.app.scheme.value;
    const open = map.doors.map((door) => doors[door.name] ?? door.open);
    const heated = heat === "none" ? -1 : this.heat.version;
    const of = [map.scene, scheme.dark, heated, places, ...open].join();
    this.still.show(pen, view, ratio, of, (own) => {
      drawGround(own, view, map, scheme);
      if (heat !== "none") this.heat.draw(own, view);
      drawDoors(own, view, map, doors, scheme);
      this.names = places ? drawPlaces(own, view, map, scheme) : [];
    });
  }

  /** The ways, goals and predictions that are shown, if any. */
  set layers(message: LayersMessage | null) {
    this.planning = message;
    this.plannings++;
  }

  private drawPlanned(pen: CanvasRenderingContext2D, ratio: number): void {
    const { view, planning, plannings } = this;
    if (!planning) return;
    const scheme = this.app.scheme.value;
    this.planned.show(pen, view, ratio, `${plannings} ${scheme.dark}`, (own) => {
      drawLayers(own, view, planning, scheme);
    });
  }

  /** The places that are being picked. */
  private drawPicking(pen: CanvasRenderingContext2D): void {
    const { view } = this;
    const picking = this.app.state.picking.value;
    if (!picking || picking.points.length === 0) return;
    const { points, closed } = picking;
    const colour = this.app.scheme.value.colour("focus");
    drawLine(pen, view, { points, colour, widthPx: 2, closed, filled: closed });
    drawMarks(pen, view, points, colour);
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
