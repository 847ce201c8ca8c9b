/** The floors of a building as people count them: heights with much to stand on. */

import type { SceneData } from "../net/messages";

/** Heights nearer to each other belong to one storey. */
const APART_M = 1.8;
/** A smaller slab is a landing. */
const LANDING_M2 = 12;

/** Heights of the storeys, metres, the ground first. */
export function storeysOf({ polygons, stairs }: Pick<SceneData, "polygons" | "stairs">): number[] {
  const slabs = polygons.filter(
    ({ kind, ramp, points }) => kind === "floor" && !ramp && areaM2(points) >= LANDING_M2,
  );
  const heights = slabs.map(({ offset_m, height_m }) => offset_m + height_m);
  const heads = stairs.map(({ top_m }) => top_m);
  const storeys = [0];
  for (const height of heights.sort((a, b) => a - b)) {
    if (height - (storeys.at(-1) ?? 0) >= APART_M) storeys.push(height);
  }
  // A flight may lead to what is no slab: the roof of a building, a platform.
  for (const head of heads.sort((a, b) => a - b)) {
    if (storeys.every((height) => Math.abs(head - height) >= APART_M)) storeys.push(head);
  }
  return storeys.sort((a, b) => a - b);
}

/** The storey, counted from 0, that is nearest to a height. */
export function storeyAt(storeys: readonly number[], z: number): number {
  const off = storeys.map((height) => Math.abs(height - z));
  return off.indexOf(Math.min(...off));
}

function areaM2(points: SceneData["polygons"][number]["points"]): number {
  const twice = points.reduce((sum, [x, y], i) => {
    const [nx, ny] = points[(i + 1) % points.length] ?? [x, y];
    return sum + x * ny - nx * y;
  }, 0);
  return Math.abs(twice) / 2;
}
