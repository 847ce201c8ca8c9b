/** The part of the map that stands still: floors, walls, doors and places. */

import type { MapData, Ring } from "../net/types";
import type { Scheme } from "../state/scheme";
import { type Box, boxAt } from "./labels";
import type { MapView } from "./views";

/** A wall that begins lower than this above a floor, and ends higher than a kerb, stands on it. */
const HEADROOM_M = 2;
const KERB_M = 0.3;
/** Names of places are left out where the map is smaller than this. */
const NAMES_PX_PER_M = 5;

const SOLIDS: Readonly<Partial<Record<string, string>>> = {
  plant: "map-plant",
  water: "map-water",
};

export function drawGround(
  pen: CanvasRenderingContext2D,
  view: MapView,
  map: MapData,
  scheme: Scheme,
): void {
  pen.fillStyle = scheme.colour("ground");
  pen.fillRect(0, 0, view.width, view.height);
  for (const storey of view.storeys) {
    drawFloor(pen, view, map, storey, scheme);
    drawWalls(pen, view, map, storey, scheme);
    if (map.storeys.length > 1) drawTitle(pen, view, map, storey, scheme);
  }
}

function drawFloor(
  pen: CanvasRenderingContext2D,
  view: MapView,
  { bounds: [x0, y0, x1, y1], outlines, floors, kinds }: MapData,
  storey: number,
  scheme: Scheme,
): void {
  const whole: Ring = [
    [x0, y0],
    [x1, y0],
    [x1, y1],
    [x0, y1],
  ];
  // The ground itself is no piece of a scene.
  const found = floors?.[storey] ?? [];
  const rings = storey === 0 || found.length === 0 ? [whole, ...found] : found;
  for (const ring of rings) fillRing(pen, view, ring, storey, scheme.colour("map-ground"));
  outlines?.[storey]?.forEach((ring, index) => {
    const kind = kinds?.[storey]?.[index] ?? "furniture";
    fillRing(pen, view, ring, storey, scheme.colour(SOLIDS[kind] ?? "map-solid"));
  });
}

function fillRing(
  pen: CanvasRenderingContext2D,
  view: MapView,
  ring: Ring,
  storey: number,
  colour: string,
): void {
  pen.fillStyle = colour;
  pen.beginPath();
  for (const [x, y] of ring) pen.lineTo(...view.toCanvas(x, y, storey));
  pen.fill();
}

function drawWalls(
  pen: CanvasRenderingContext2D,
  view: MapView,
  map: MapData,
  storey: number,
  scheme: Scheme,
): void {
  const floor = map.storeys[storey]?.z_m ?? 0;
  pen.strokeStyle = scheme.colour("map-wall");
  pen.lineWidth = Math.max(1, Math.min(3, view.scale * 0.12));
  pen.beginPath();
  for (const [x0, y0, x1, y1, bottom, top] of map.walls) {
    if (bottom >= floor + HEADROOM_M || top <= floor + KERB_M) continue;
    pen.moveTo(...view.toCanvas(x0, y0, storey));
    pen.lineTo(...view.toCanvas(x1, y1, storey));
  }
  pen.stroke();
}

function drawTitle(
  pen: CanvasRenderingContext2D,
  view: MapView,
  map: MapData,
  storey: number,
  scheme: Scheme,
): void {
  const [x0, , , y1] = map.bounds;
  const [x, y] = view.toCanvas(x0, y1, storey);
  pen.fillStyle = scheme.colour("soft-ink");
  pen.font = "600 13px system-ui, sans-serif";
  pen.textAlign = "left";
  pen.fillText(map.storeys[storey]?.name ?? `Floor ${storey}`, x, y - 6);
}

/** Doors, which open and close; `open` tells of each by its name. */
export function drawDoors(
  pen: CanvasRenderingContext2D,
  view: MapView,
  { doors }: MapData,
  open: Readonly<Record<string, boolean>>,
  scheme: Scheme,
): void {
  for (const door of doors) {
    const storey = view.storeyOf(door.z_m);
    if (!view.isShown(storey)) continue;
    const isOpen = open[door.name] ?? door.open;
    pen.strokeStyle = scheme.colour("map-door");
    pen.lineWidth = Math.max(2, Math.min(5, view.scale * 0.2));
    pen.setLineDash(isOpen ? [3, 5] : []);
    pen.beginPath();
    pen.moveTo(...view.toCanvas(door.x0, door.y0, storey));
    pen.lineTo(...view.toCanvas(door.x1, door.y1, storey));
    pen.stroke();
  }
  pen.setLineDash([]);
}

/** Places and their names, lighter than those of avatars; returns where the names are. */
export function drawPlaces(
  pen: CanvasRenderingContext2D,
  view: MapView,
  { places }: MapData,
  scheme: Scheme,
): Box[] {
  const names: Box[] = [];
  pen.fillStyle = scheme.colour("soft-ink");
  pen.globalAlpha = 0.8;
  pen.font = "italic 11px system-ui, sans-serif";
  pen.textAlign = "center";
  for (const place of places) {
    const storey = view.storeyOf(place.z);
    if (!view.isShown(storey)) continue;
    const [x, y] = view.toCanvas(place.x, place.y, storey);
    pen.fillRect(x - 2, y - 2, 4, 4);
    if (view.scale < NAMES_PX_PER_M) continue;
    pen.fillText(place.name, x, y - 7);
    const { width } = pen.measureText(place.name);
    names.push(boxAt({ x: x - width / 2, y: y - 7 }, width));
  }
  pen.globalAlpha = 1;
  return names;
}
