/** The parts of storeys: slabs, ramps, stairs and railings. */

import type { BufferGeometry } from "three";
import type { ScenePolygon, SceneStairs, SceneWall } from "../net/messages";
import { topOf, treadsOf } from "../world/solids";
import { CEILING, PARQUET, TERRAZZO } from "./interiorpalette";
import { DARK_STONE, FLOOR, IRON, STONE, TREAD } from "./palette";
import { box, cap, sides, underside } from "./shapes";
import type { Pieces } from "./structures";

const RAILING_M = 1.3;
const BAR_EVERY_M = 1.4;
const BAR_M = 0.05;
/** Below a slab as high as this there is a room. */
const ROOM_M = 2;
/** A floor that is laid on the ground is drawn a little above it. */
const LAID_M = 0.008;

/** A slab, a landing or a ramp; slabs above the ground are floored with wood. */
export function floor(polygon: ScenePolygon, into: Pieces): void {
  const { points, offset_m, ramp } = polygon;
  const top = topOf(polygon);
  into.plain.push(sides(points, offset_m, top, STONE));
  if (offset_m > 0) {
    into.boards.push(cap(points, top, PARQUET));
    into.plain.push(underside(points, offset_m, CEILING));
  } else {
    into.paving.push(cap(points, top, ramp ? FLOOR : TREAD));
  }
}

/** The ground below a slab is a room's. */
export function indoors({ points, offset_m }: ScenePolygon): BufferGeometry[] {
  return offset_m >= ROOM_M ? [cap(points, LAID_M, TERRAZZO)] : [];
}

export function stairs(flight: SceneStairs, into: Pieces): void {
  for (const { ring, topM } of treadsOf(flight)) {
    into.plain.push(sides(ring, flight.bottom_m, topM, STONE), cap(ring, topM, TREAD));
    if (flight.bottom_m > 0) into.plain.push(underside(ring, flight.bottom_m, DARK_STONE));
  }
}

/** A low wall that does not stand on the ground keeps people from falling. */
export function isRailing({ offset_m, height_m }: SceneWall): boolean {
  return offset_m > 0 && height_m <= RAILING_M;
}

export function railing({ start, end, offset_m, height_m }: SceneWall): BufferGeometry[] {
  const parts: BufferGeometry[] = [];
  const [dx, dy] = [end[0] - start[0], end[1] - start[1]];
  const length = Math.hypot(dx, dy);
  const angle = Math.atan2(dy, dx);
  const middle = [start[0] + dx / 2, start[1] + dy / 2] as const;
  for (const [at, thick] of [
    [height_m, 0.08],
    [height_m * 0.66, 0.03],
    [height_m * 0.33, 0.03],
  ] as const) {
    const z = offset_m + at - thick / 2;
    parts.push(box([...middle, z], [length + BAR_M, thick, thick], angle, IRON));
  }
  const bars = Math.max(1, Math.ceil(length / BAR_EVERY_M));
  for (let i = 0; i <= bars; i++) {
    const [x, y] = [start[0] + (dx * i) / bars, start[1] + (dy * i) / bars];
    parts.push(box([x, y, offset_m + height_m / 2], [BAR_M, BAR_M, height_m], angle, IRON));
  }
  return parts;
}
