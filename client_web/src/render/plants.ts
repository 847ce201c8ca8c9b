/** Plants: a small, tall footprint becomes a tree in its bed, any other a hedge in its trough. */

import { type BufferGeometry, IcosahedronGeometry } from "three";
import type { ScenePolygon } from "../net/messages";
import { gathered } from "./cutaway";
import { BARK, DARK_STONE, leavesOf, scatter } from "./palette";
import { cap, centreOf, column, drawnIn, orientation, painted, prism, sides } from "./shapes";

const TREE_FOOTPRINT_M = 3;
const TREE_HEIGHT_M = 2.2;
const BED_M = 0.35;
/** Radius of a crown, as part of the tree's height. */
const CROWN = 0.3;

export function isTree({ points, height_m }: ScenePolygon): boolean {
  return orientation(points).lengthM <= TREE_FOOTPRINT_M && height_m >= TREE_HEIGHT_M;
}

/** The stone around a tree's foot. */
export function bed({ points, offset_m }: ScenePolygon): BufferGeometry[] {
  return [
    ...prism(points, offset_m, offset_m + BED_M, DARK_STONE),
    cap(drawnIn(points, 0.12), offset_m + BED_M + 0.01, BARK),
  ];
}

/** A trunk and a crown of five balls of leaves, which know the middle of the whole tree. */
export function tree(
  { points, height_m, offset_m }: ScenePolygon,
  index: number,
): BufferGeometry[] {
  const middle = centreOf(points);
  const [x, y] = middle;
  const crown = height_m * CROWN;
  const trunkM = height_m - 1.2 * crown;
  const parts = [column([x, y, offset_m], { top: 0.1, bottom: 0.17 }, trunkM, BARK)];
  for (let i = 0; i < 5; i++) {
    const around = (i / 4) * 2 * Math.PI + scatter(index, i) * 1.5;
    const out = i === 4 ? 0 : crown * 0.5;
    const radius = crown * (i === 4 ? 0.85 : 0.6 + 0.2 * scatter(index, i + 20));
    const up = i === 4 ? crown * 0.35 : (scatter(index, i + 10) - 0.5) * crown * 0.5;
    parts.push(
      tuft(
        [x + out * Math.cos(around), y + out * Math.sin(around), offset_m + trunkM + up],
        radius,
        index * 7 + i,
      ),
    );
  }
  return parts.map((part) => gathered(part, middle));
}

export function hedge(
  { points, height_m, offset_m }: ScenePolygon,
  index: number,
): BufferGeometry[] {
  const leaves = leavesOf(index);
  const top = offset_m + height_m;
  const inner = drawnIn(points, 0.12);
  return [
    sides(points, offset_m, Math.min(top, offset_m + BED_M), DARK_STONE),
    cap(points, Math.min(top, offset_m + BED_M), DARK_STONE),
    sides(inner, offset_m, top, leaves),
    cap(inner, top, leaves.clone().multiplyScalar(1.12)),
  ];
}

/** A ball of leaves, lighter above than below. */
function tuft(
  [x, y, z]: readonly [number, number, number],
  radiusM: number,
  index: number,
): BufferGeometry {
  const geometry = new IcosahedronGeometry(radiusM, 1);
  painted(geometry, leavesOf(index));
  const position = geometry.getAttribute("position");
  const color = geometry.getAttribute("color");
  for (let i = 0; i < position.count; i++) {
    const shade = 0.9 + (0.22 * position.getZ(i)) / radiusM;
    color.setXYZ(i, color.getX(i) * shade, color.getY(i) * shade, color.getZ(i) * shade);
  }
  return geometry.translate(x, y, z);
}
