/** A building that comes as a mesh: bare triangles, coloured by how steep they are. */

import { BufferAttribute, BufferGeometry, Color } from "three";
import type { Triangles } from "../world/mesh";
import { FLOOR, PLASTER } from "./palette";

/** Heights above the feet that are left of walls, and of level things like table tops. */
const STUB_M = { upright: 0.35, level: 1.2 };
const LEVEL = 0.7;
/** Walls that face north and south are drawn darker, so that corners show in the shade too. */
const CORNERS = 0.12;

/** Every triangle is a piece of its own that begins at its lowest corner. */
export function meshGeometry(triangles: Triangles): BufferGeometry {
  const geometry = new BufferGeometry();
  const corners = triangles.length / 3;
  geometry.setAttribute("position", new BufferAttribute(triangles, 3));
  geometry.setAttribute("uv", new BufferAttribute(new Float32Array(corners * 2), 2));
  geometry.computeVertexNormals();
  const normal = geometry.getAttribute("normal");
  const colors = new Float32Array(corners * 3);
  const bases = new Float32Array(corners);
  const stubs = new Float32Array(corners);
  const color = new Color();
  for (let i = 0; i < corners; i++) {
    const first = i - (i % 3);
    const up = normal.getZ(i);
    color.lerpColors(PLASTER, FLOOR, Math.max(0, up) ** 2);
    color.multiplyScalar(1 - CORNERS * (1 - Math.abs(normal.getX(i))) * (1 - Math.abs(up)));
    color.toArray(colors, i * 3);
    stubs[i] = Math.abs(up) > LEVEL ? STUB_M.level : STUB_M.upright;
    bases[i] = Math.min(...[0, 1, 2].map((k) => triangles[(first + k) * 3 + 2] ?? 0));
  }
  geometry.setAttribute("color", new BufferAttribute(colors, 3));
  geometry.setAttribute("base", new BufferAttribute(bases, 1));
  geometry.setAttribute("stub", new BufferAttribute(stubs, 1));
  return geometry;
}

/** Height of the lowest corner, metres. */
export function lowestOf(triangles: Triangles): number {
  let lowest = Infinity;
  for (let i = 2; i < triangles.length; i += 3) lowest = Math.min(lowest, triangles[i] ?? lowest);
  return lowest;
}
