/** The solids of a scene: prisms with level or sloping tops, and the treads of stairs. */

import type { Point, SceneData, ScenePolygon, SceneStairs } from "../net/messages";

export type Ring = readonly (readonly [x: number, y: number])[];

export interface Solid {
  readonly ring: Ring;
  readonly bottomM: (x: number, y: number) => number;
  /** Whether one can stand on top. */
  readonly carries: boolean;
  /** Without sides that could be in the way. */
  readonly sheet: boolean;
  readonly topM: (x: number, y: number) => number;
}

export function solidsOf({ polygons, stairs }: Pick<SceneData, "polygons" | "stairs">): Solid[] {
  const solids = polygons.map((polygon) => ({
    ring: polygon.points,
    bottomM: () => polygon.offset_m,
    sheet: false,
    carries: polygon.kind === "building" || polygon.kind === "floor",
    topM: topOf(polygon),
  }));
  const treads = stairs.flatMap((flight) =>
    treadsOf(flight).map(({ ring, topM }) => ({
      ring,
      bottomM: () => flight.bottom_m,
      sheet: false,
      carries: true,
      topM: () => topM,
    })),
  );
  return [...solids, ...treads];
}

/** The height of a polygon's top at each point of it. */
export function topOf({
  offset_m,
  height_m,
  ramp,
}: Pick<ScenePolygon, "offset_m" | "height_m" | "ramp">): (x: number, y: number) => number {
  const top = offset_m + height_m;
  if (!ramp) return () => top;
  const { start, end, start_height_m } = ramp;
  const [dx, dy] = [end[0] - start[0], end[1] - start[1]];
  const lengthSq = dx * dx + dy * dy;
  const rise = height_m - start_height_m;
  return (x, y) => {
    const part = ((x - start[0]) * dx + (y - start[1]) * dy) / lengthSq;
    return offset_m + start_height_m + rise * Math.max(0, Math.min(1, part));
  };
}

/** The treads of a flight from its foot to its head, each with the height of its top. */
export function treadsOf(flight: SceneStairs): { ring: Point[]; topM: number }[] {
  const { start, end, width_m, bottom_m, top_m, steps } = flight;
  const [dx, dy] = [end[0] - start[0], end[1] - start[1]];
  const half = width_m / 2 / Math.hypot(dx, dy);
  const at = (step: number, side: number): Point => [
    start[0] + (dx * step) / steps + side * half * dy,
    start[1] + (dy * step) / steps - side * half * dx,
  ];
  return Array.from({ length: steps }, (_, k) => ({
    ring: [at(k, 1), at(k + 1, 1), at(k + 1, -1), at(k, -1)],
    topM: bottom_m + ((k + 1) / steps) * (top_m - bottom_m),
  }));
}

export function isInside(ring: Ring, x: number, y: number): boolean {
  let inside = false;
  let [ax, ay] = ring.at(-1) ?? [0, 0];
  for (const [bx, by] of ring) {
    if (by > y !== ay > y && x < ((ax - bx) * (y - by)) / (ay - by) + bx) inside = !inside;
    [ax, ay] = [bx, by];
  }
  return inside;
}
