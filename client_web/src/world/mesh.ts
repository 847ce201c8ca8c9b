/** A building that is a mesh: its faces that carry people, and those that stand in their way. */

import type { Barrier } from "./barriers";
import type { Solid } from "./solids";

/** x, y, z of the three corners of each triangle, metres, z up. */
export type Triangles = Float32Array;

export interface MeshParts {
  solids: Solid[];
  /** Faces too steep to stand on. */
  steep: Barrier[];
}

type Corner = readonly [x: number, y: number, z: number];

/** Nobody stands on a face that is steeper than 45 degrees. */
const STANDING = Math.SQRT1_2;
/** A face that is nearer to upright has next to no extent on the ground. */
const UPRIGHT = 0.05;
/** Sheets are taken for slabs this thick. */
const THICK_M = 0.02;

export function meshParts(triangles: Triangles): MeshParts {
  const parts: MeshParts = { solids: [], steep: [] };
  for (let i = 0; i + 9 <= triangles.length; i += 9) {
    const [a, b, c] = [
      cornerOf(triangles, i),
      cornerOf(triangles, i + 3),
      cornerOf(triangles, i + 6),
    ];
    const normal = normalOf(a, b, c);
    if (normal === null) continue;
    const [nx, ny, nz] = normal;
    if (nz < STANDING) parts.steep.push(faceOf(a, b, c));
    if (Math.abs(nz) < UPRIGHT) continue;
    const heightAt = (x: number, y: number): number =>
      a[2] - (nx * (x - a[0]) + ny * (y - a[1])) / nz;
    parts.solids.push({
      ring: [a, b, c].map(([x, y]) => [x, y] as const),
      sheet: true,
      carries: nz >= STANDING,
      bottomM: (x, y) => heightAt(x, y) - THICK_M,
      topM: heightAt,
    });
  }
  return parts;
}

/** The upright face over the longest side of a steep triangle, as seen from above. */
function faceOf(...corners: [Corner, Corner, Corner]): Barrier {
  const heights = corners.map(([, , z]) => z);
  const sides = corners.map((from, i) => {
    const to = corners[(i + 1) % 3] ?? from;
    return { from, to, length: Math.hypot(to[0] - from[0], to[1] - from[1]) };
  });
  const { from, to } = sides.reduce((x, y) => (y.length > x.length ? y : x));
  return {
    a: [from[0], from[1]],
    b: [to[0], to[1]],
    bottomM: Math.min(...heights),
    topM: Math.max(...heights),
    door: null,
  };
}

function cornerOf(triangles: Triangles, at: number): Corner {
  return [triangles[at] ?? 0, triangles[at + 1] ?? 0, triangles[at + 2] ?? 0];
}

/** Null for a triangle without area. */
function normalOf(a: Corner, b: Corner, c: Corner): Corner | null {
  const [ux, uy, uz] = [b[0] - a[0], b[1] - a[1], b[2] - a[2]];
  const [vx, vy, vz] = [c[0] - a[0], c[1] - a[1], c[2] - a[2]];
  const [nx, ny, nz] = [uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx];
  const length = Math.hypot(nx, ny, nz);
  return length < 1e-9 ? null : [nx / length, ny / length, nz / length];
}
