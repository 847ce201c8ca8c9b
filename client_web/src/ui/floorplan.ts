/** One storey from above, drawn once, with everything that stands on it and leads up or down. */

import type { SceneData, ScenePolygon, SceneStairs } from "../net/messages";
import type { MeshParts } from "../world/mesh";
import { treadsOf } from "../world/solids";

const COLORS = {
  building: "#8b8173",
  floor: "#ece6da",
  wall: "#6f675c",
  furniture: "#b08c63",
  plant: "#86a667",
  water: "#6fb3cf",
} as const;
/** The colour of places that one would fall into. */
const VOID = "#cbc4b6";
const DEEPER = "#bcb4a5";
const STEP = "#b9ae9b";
const SLOPE = "#ddd3c1";
const PORTAL = "#3aa6b9";
/** A piece that begins lower than this above a floor stands on it, or in the way. */
const HEADROOM_M = 2;
/** A piece that rises less above a floor is part of it. */
const KERB_M = 0.3;
const NEAR_M = 0.9;

type ToCanvas = (x: number, y: number) => [number, number];

/** `floorM` is the height of the storey's floor. */
export function drawFloorplan(
  pen: CanvasRenderingContext2D,
  { bounds: [x0, y0, x1, y1], polygons, walls, stairs, mesh, portals = [] }: SceneData,
  floorM: number,
  at: ToCanvas,
): void {
  const fill = (points: readonly (readonly [number, number])[], color: string): void => {
    pen.fillStyle = color;
    pen.beginPath();
    for (const [x, y] of points) pen.lineTo(...at(x, y));
    pen.fill();
  };
  const ground = [
    [x0, y0],
    [x1, y0],
    [x1, y1],
    [x0, y1],
  ] as const;
  fill(ground, Math.abs(floorM) < KERB_M && mesh === undefined ? COLORS.floor : VOID);
  for (const part of polygons) {
    if (isSlope(part) && touches(bottomOf(part), topOf(part), floorM)) fill(part.points, SLOPE);
    else if (isFloor(part, floorM)) fill(part.points, COLORS.floor);
  }
  for (const flight of stairs) {
    if (touches(flight.bottom_m, flight.top_m, floorM)) steps(pen, flight, at);
  }
  for (const { points, z_m } of portals) {
    if (Math.abs(z_m - floorM) < NEAR_M) fill(points, PORTAL);
  }
  for (const part of polygons) {
    if (part.kind !== "floor" && !part.ramp && stands(bottomOf(part), topOf(part), floorM)) {
      fill(part.points, COLORS[part.kind]);
    }
  }
  pen.strokeStyle = COLORS.wall;
  pen.lineWidth = 1.5;
  pen.beginPath();
  for (const { start, end, offset_m, height_m } of walls) {
    if (!stands(offset_m, offset_m + height_m, floorM)) continue;
    pen.moveTo(...at(...start));
    pen.lineTo(...at(...end));
  }
  pen.stroke();
}

/** Draws the same for a building that is a mesh; deeper parts show through. */
export function drawMesh(
  pen: CanvasRenderingContext2D,
  { solids, steep }: MeshParts,
  floorM: number,
  at: ToCanvas,
): void {
  const floors = solids
    .filter(({ carries }) => carries)
    .map(({ ring, topM }) => ({ ring, topM: Math.max(...ring.map(([x, y]) => topM(x, y))) }))
    .filter(({ topM }) => topM < floorM + HEADROOM_M)
    .sort((a, b) => a.topM - b.topM);
  pen.lineWidth = 0.5;
  for (const { ring, topM } of floors) {
    const level = Math.abs(topM - floorM) < KERB_M;
    pen.fillStyle = level ? COLORS.floor : topM < floorM - NEAR_M ? DEEPER : SLOPE;
    pen.strokeStyle = pen.fillStyle;
    pen.beginPath();
    for (const [x, y] of ring) pen.lineTo(...at(x, y));
    pen.closePath();
    pen.fill();
    pen.stroke();
  }
  pen.strokeStyle = COLORS.wall;
  pen.lineWidth = 1;
  pen.beginPath();
  for (const { a, b, bottomM, topM } of steep) {
    if (!stands(bottomM, topM, floorM)) continue;
    pen.moveTo(...at(...a));
    pen.lineTo(...at(...b));
  }
  pen.stroke();
}

/** Whether a piece from `bottomM` to `topM` is in the way of people on the floor. */
export function stands(bottomM: number, topM: number, floorM: number): boolean {
  return bottomM < floorM + HEADROOM_M && topM > floorM + KERB_M;
}

function steps(pen: CanvasRenderingContext2D, flight: SceneStairs, at: ToCanvas): void {
  pen.strokeStyle = STEP;
  pen.fillStyle = SLOPE;
  pen.lineWidth = 1;
  for (const { ring } of treadsOf(flight)) {
    pen.beginPath();
    for (const [x, y] of ring) pen.lineTo(...at(x, y));
    pen.closePath();
    pen.fill();
    pen.stroke();
  }
}

/** Whether something that leads up begins or ends on the floor, or passes it. */
function touches(bottomM: number, topM: number, floorM: number): boolean {
  return bottomM < floorM + HEADROOM_M && topM > floorM - KERB_M;
}

/** Landings on the way up from a floor are shown with it. */
function isFloor(part: ScenePolygon, floorM: number): boolean {
  if (part.kind !== "floor") return false;
  const off = topOf(part) - floorM;
  return Math.abs(off) < NEAR_M || (off > 0 && part.offset_m < floorM + NEAR_M);
}

const isSlope = ({ kind, ramp }: ScenePolygon): boolean => kind === "floor" && ramp !== null;
const bottomOf = ({ offset_m }: ScenePolygon): number => offset_m;
const topOf = ({ offset_m, height_m }: ScenePolygon): number => offset_m + height_m;
