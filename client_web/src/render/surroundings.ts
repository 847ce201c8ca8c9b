/** The land around the bounds, where nobody walks: meadows with trees, more of them farther off. */

import type { BufferGeometry } from "three";
import type { SceneData, ScenePolygon } from "../net/messages";
import { scatter } from "./palette";
import { tree } from "./plants";

const TREES = 90;
const NEAREST_M = 4;
const FARTHEST_M = 75;
const LEAST_M = 4.5;
const RANGE_M = 5;

/** Trees on the land at height `z`, always the same around the same bounds. */
export function treesAround([x0, y0, x1, y1]: SceneData["bounds"], z: number): BufferGeometry[] {
  const trees = Array.from({ length: TREES }, (_, i) => {
    const outM = NEAREST_M + (FARTHEST_M - NEAREST_M) * scatter(i, 90) ** 1.4;
    // Along the edge of the bounds, widened by that much.
    const [width, depth] = [x1 - x0 + 2 * outM, y1 - y0 + 2 * outM];
    const along = 2 * (width + depth) * scatter(i, 91);
    const [x, y] =
      along < 2 * width
        ? [x0 - outM + (along % width), along < width ? y0 - outM : y1 + outM]
        : [
            along < 2 * width + depth ? x0 - outM : x1 + outM,
            y0 - outM + ((along - 2 * width) % depth),
          ];
    return tree(footprint([x, y, z], LEAST_M + RANGE_M * scatter(i, 92)), 1000 + i);
  });
  return trees.flat();
}

function footprint([x, y, z]: readonly [number, number, number], heightM: number): ScenePolygon {
  return {
    points: [
      [x - 0.5, y - 0.5],
      [x + 0.5, y - 0.5],
      [x + 0.5, y + 0.5],
      [x - 0.5, y + 0.5],
    ],
    offset_m: z,
    height_m: heightM,
    kind: "plant",
    name: "",
    ramp: null,
  };
}
