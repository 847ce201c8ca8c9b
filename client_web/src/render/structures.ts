/** The looks of buildings, walls and basins. */

import { BoxGeometry, type BufferGeometry } from "three";
import type { ScenePolygon, SceneWall } from "../net/messages";
import { DARK_STONE, facadeOf, IRON, PLASTER, STONE, WATER, WOOD } from "./palette";
import {
  box,
  cap,
  centreOf,
  column,
  drawnIn,
  orientation,
  painted,
  prism,
  sides,
  underside,
} from "./shapes";

const BAY_M = 3.2;
const PILLAR_M = 1.3;
const KIOSK_M = 4;
const RIM_M = 0.35;
const SEAM_M = 0.03;
const COPING_M = 0.12;
const WALL_THICK_M = 0.14;

/** Pieces by the material they are drawn with. */
export interface Pieces {
  plain: BufferGeometry[];
  facade: BufferGeometry[];
  water: BufferGeometry[];
  /** Tops to walk on, with slabs like those of the ground. */
  paving: BufferGeometry[];
  /** The same with boards of wood. */
  boards: BufferGeometry[];
}

export function building(polygon: ScenePolygon, index: number, into: Pieces): void {
  const { points, height_m, offset_m } = polygon;
  const { lengthM } = orientation(points);
  if (lengthM <= PILLAR_M) {
    into.plain.push(...pillar(polygon));
    return;
  }
  if (height_m <= KIOSK_M) {
    into.plain.push(...kiosk(polygon, index));
    return;
  }
  const color = facadeOf(index);
  const top = offset_m + height_m;
  const eaves = drawnIn(points, -0.25);
  into.plain.push(sides(drawnIn(points, -0.04), offset_m, offset_m + 0.7, DARK_STONE));
  into.facade.push(sides(points, offset_m, top, color, { bayM: BAY_M, floorM: BAY_M }));
  into.plain.push(
    sides(eaves, top - 0.35, top + 0.25, STONE),
    cap(eaves, top + 0.25, STONE),
    cap(drawnIn(points, 0.3), top + 0.27, DARK_STONE),
  );
}

/** A square post is drawn round, with a foot and a head. */
function pillar({ points, height_m, offset_m }: ScenePolygon): BufferGeometry[] {
  const [x, y] = centreOf(points);
  const { lengthM, widthM, angle } = orientation(points);
  const radius = Math.min(lengthM, widthM) / 2;
  const top = offset_m + height_m;
  return [
    box([x, y, offset_m + 0.15], [lengthM, widthM, 0.3], angle, DARK_STONE),
    column(
      [x, y, offset_m + 0.3],
      { top: radius * 0.75, bottom: radius * 0.88 },
      height_m - 0.6,
      STONE,
    ),
    box([x, y, top - 0.15], [lengthM, widthM, 0.3], angle, STONE),
  ];
}

function kiosk({ points, height_m, offset_m }: ScenePolygon, index: number): BufferGeometry[] {
  const color = facadeOf(index * 3 + 1).clone();
  const top = offset_m + height_m;
  const counter = offset_m + Math.min(1.05, height_m / 2);
  return [
    ...prism(points, offset_m, counter, WOOD),
    sides(drawnIn(points, 0.25), counter, top - 0.3, IRON),
    ...prism(drawnIn(points, -0.35), top - 0.3, top - 0.18, color),
    ...prism(drawnIn(points, 0.3), top - 0.18, top, color.multiplyScalar(0.85)),
  ];
}

export function masonry({ points, height_m, offset_m }: ScenePolygon): BufferGeometry[] {
  const top = offset_m + height_m;
  // A wall on a slab reaches into it a little, or light shines through the seam.
  const foot = Math.max(0, offset_m - SEAM_M);
  const parts = [
    sides(points, foot, top - COPING_M, PLASTER),
    ...prism(drawnIn(points, -0.05), top - COPING_M, top, DARK_STONE),
  ];
  if (offset_m > 0) parts.push(underside(points, foot, STONE));
  return parts;
}

export function basin({ points, height_m, offset_m }: ScenePolygon, into: Pieces): void {
  const [x, y] = centreOf(points);
  const inner = drawnIn(points, RIM_M);
  const top = offset_m + height_m;
  const level = top - 0.12;
  into.plain.push(
    sides(points, offset_m, top, STONE),
    sides(inner, level - 0.1, top, DARK_STONE),
    ...rim(points, inner, top),
  );
  into.water.push(cap(inner, level, WATER));
  const { widthM } = orientation(points);
  if (widthM < 3) return;
  into.plain.push(
    column([x, y, offset_m], { top: 0.22, bottom: 0.4 }, top + 0.7, STONE),
    column([x, y, top + 0.7], { top: 0.95, bottom: 0.3 }, 0.28, STONE),
    column([x, y, top + 0.98], { top: 0.1, bottom: 0.16 }, 0.5, STONE),
  );
  into.water.push(column([x, y, top + 0.96], { top: 0.85, bottom: 0.85 }, 0.04, WATER));
}

/** The flat stone between the outer and the inner edge of a basin. */
function rim(
  outer: ScenePolygon["points"],
  inner: readonly (readonly [number, number])[],
  z: number,
): BufferGeometry[] {
  return outer.map((a, i) => {
    const next = (i + 1) % outer.length;
    const quad = [a, outer[next] ?? a, inner[next] ?? a, inner[i] ?? a];
    return cap(quad, z, STONE);
  });
}

export function thinWall({ start, end, offset_m, height_m }: SceneWall): BufferGeometry[] {
  const length = Math.hypot(end[0] - start[0], end[1] - start[1]);
  const angle = Math.atan2(end[1] - start[1], end[0] - start[0]);
  const middle = [(start[0] + end[0]) / 2, (start[1] + end[1]) / 2] as const;
  const body = new BoxGeometry(length + WALL_THICK_M, WALL_THICK_M, height_m);
  body.rotateZ(angle).translate(middle[0], middle[1], offset_m + height_m / 2);
  return [
    painted(body.toNonIndexed(), PLASTER),
    box(
      [...middle, offset_m + height_m],
      [length + 0.2, WALL_THICK_M + 0.08, 0.08],
      angle,
      DARK_STONE,
    ),
  ];
}
