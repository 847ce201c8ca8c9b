/** Pieces that the static world is put together from: coloured prisms, boxes and their merging. */

import {
  BoxGeometry,
  BufferAttribute,
  BufferGeometry,
  type Color,
  CylinderGeometry,
  Float32BufferAttribute,
  ShapeUtils,
  Vector2,
} from "three";
import { mergeGeometries } from "three/addons/utils/BufferGeometryUtils.js";

export type Ring = readonly (readonly [x: number, y: number])[];

/** The same ring, counter-clockwise as seen from above. */
export function counterClockwise(ring: Ring): Ring {
  return ShapeUtils.area(ring.map(([x, y]) => new Vector2(x, y))) < 0 ? ring.toReversed() : ring;
}

export function centreOf(ring: Ring): [x: number, y: number] {
  const n = ring.length;
  return [ring.reduce((sum, [x]) => sum + x, 0) / n, ring.reduce((sum, [, y]) => sum + y, 0) / n];
}

/** The ring drawn in towards its centre (`metres` > 0) or widened (< 0). */
export function drawnIn(ring: Ring, metres: number): Ring {
  const [cx, cy] = centreOf(ring);
  return ring.map(([x, y]) => {
    const distance = Math.hypot(x - cx, y - cy);
    const part = Math.max(0.05, 1 - metres / Math.max(distance, 1e-6));
    return [cx + (x - cx) * part, cy + (y - cy) * part] as const;
  });
}

/** Length and direction of the ring's longest edge, and the extents along and across it. */
export function orientation(ring: Ring): { angle: number; lengthM: number; widthM: number } {
  const edges = ring.map(([x, y], i) => {
    const [nx, ny] = ring[(i + 1) % ring.length] ?? [x, y];
    return { angle: Math.atan2(ny - y, nx - x), length: Math.hypot(nx - x, ny - y) };
  });
  const { angle } = edges.reduce((a, b) => (b.length > a.length ? b : a));
  const along = ring.map(([x, y]) => x * Math.cos(angle) + y * Math.sin(angle));
  const across = ring.map(([x, y]) => y * Math.cos(angle) - x * Math.sin(angle));
  return { angle, lengthM: span(along), widthM: span(across) };
}

/** A height, or how it changes over the ground. */
export type Height = number | ((x: number, y: number) => number);

/** The top of a ring: level at height z, or following it. */
export function cap(ring: Ring, z: Height, color: Color): BufferGeometry {
  const heightAt = typeof z === "number" ? () => z : z;
  const points = counterClockwise(ring);
  const corners = points.map(([x, y]) => new Vector2(x, y));
  const geometry = new BufferGeometry();
  geometry.setAttribute(
    "position",
    new Float32BufferAttribute(
      points.flatMap(([x, y]) => [x, y, heightAt(x, y)]),
      3,
    ),
  );
  geometry.setAttribute(
    "normal",
    new Float32BufferAttribute(
      points.flatMap(() => [0, 0, 1]),
      3,
    ),
  );
  geometry.setAttribute(
    "uv",
    new Float32BufferAttribute(
      points.flatMap(([x, y]) => [x, y]),
      2,
    ),
  );
  geometry.setIndex(ShapeUtils.triangulateShape(corners, []).flat());
  return painted(geometry.toNonIndexed(), color);
}

/** A level ring that is seen from below. */
export function underside(ring: Ring, z: number, color: Color): BufferGeometry {
  const geometry = cap(ring, z, color);
  const normal = geometry.getAttribute("normal");
  for (let i = 0; i < normal.count; i++) normal.setZ(i, -1);
  return geometry;
}

/** The sides of a ring; `uv` counts bays and floors when their sizes are given, else metres. */
export function sides(
  ring: Ring,
  z0: number,
  z1: Height,
  color: Color,
  unit: { bayM: number; floorM: number } | null = null,
): BufferGeometry {
  const heightAt = typeof z1 === "number" ? () => z1 : z1;
  const points = counterClockwise(ring);
  const position: number[] = [];
  const normal: number[] = [];
  const uv: number[] = [];
  points.forEach(([ax, ay], i) => {
    const [bx, by] = points[(i + 1) % points.length] ?? [ax, ay];
    const length = Math.hypot(bx - ax, by - ay);
    const u = unit ? Math.max(1, Math.round(length / unit.bayM)) : length;
    const [nx, ny] = [(by - ay) / length, (ax - bx) / length];
    const [za, zb] = [heightAt(ax, ay), heightAt(bx, by)];
    position.push(ax, ay, z0, bx, by, z0, bx, by, zb, ax, ay, z0, bx, by, zb, ax, ay, za);
    const [va, vb] = [za, zb].map((z) =>
      unit ? Math.max(1, Math.round((z - z0) / unit.floorM)) : z - z0,
    ) as [number, number];
    uv.push(0, 0, u, 0, u, vb, 0, 0, u, vb, 0, va);
    for (let k = 0; k < 6; k++) normal.push(nx, ny, 0);
  });
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new Float32BufferAttribute(position, 3));
  geometry.setAttribute("normal", new Float32BufferAttribute(normal, 3));
  geometry.setAttribute("uv", new Float32BufferAttribute(uv, 2));
  return painted(geometry, color);
}

/** Sides and top. */
export function prism(ring: Ring, z0: number, z1: number, color: Color): BufferGeometry[] {
  return [sides(ring, z0, z1, color), cap(ring, z1, color)];
}

/** A box of the given size, its middle at (x, y, z), turned by `angle` about the vertical. */
export function box(
  [x, y, z]: readonly [number, number, number],
  [sx, sy, sz]: readonly [number, number, number],
  angle: number,
  color: Color,
): BufferGeometry {
  const geometry = new BoxGeometry(sx, sy, sz);
  geometry.rotateZ(angle).translate(x, y, z);
  return painted(geometry.toNonIndexed(), color);
}

/** An upright cylinder standing on (x, y, z). */
export function column(
  [x, y, z]: readonly [number, number, number],
  radii: { top: number; bottom: number },
  heightM: number,
  color: Color,
): BufferGeometry {
  const geometry = new CylinderGeometry(radii.top, radii.bottom, heightM, 12);
  geometry.rotateX(Math.PI / 2).translate(x, y, z + heightM / 2);
  return painted(geometry.toNonIndexed(), color);
}

/** The geometry with one colour at every corner. */
export function painted(geometry: BufferGeometry, color: Color): BufferGeometry {
  const count = geometry.getAttribute("position").count;
  const colors = new Float32Array(count * 3);
  for (let i = 0; i < count; i++) color.toArray(colors, i * 3);
  geometry.setAttribute("color", new BufferAttribute(colors, 3));
  return geometry;
}

/** One geometry of all the pieces; null of none. */
export function merged(pieces: BufferGeometry[]): BufferGeometry | null {
  return pieces.length > 0 ? mergeGeometries(pieces) : null;
}

function span(values: readonly number[]): number {
  return Math.max(...values) - Math.min(...values);
}
