/** Small scenes for tests, and those who walk in them. */

import type { SceneData, ScenePolygon, SceneWall } from "../src/net/messages";
import type { Reach } from "../src/world/barriers";
import type { Gait } from "../src/world/prediction";

export const adult: Reach = { heightM: 1.8, stepM: 0.6 };
export const gait: Gait = { clearanceM: 0.25, maxSpeedMps: 2.5, walkSpeedMps: 1.4 };

export const box = (
  [x0, y0]: [number, number],
  [x1, y1]: [number, number],
  changes: Partial<ScenePolygon> = {},
): ScenePolygon => ({
  points: [
    [x0, y0],
    [x1, y0],
    [x1, y1],
    [x0, y1],
  ],
  offset_m: 0,
  height_m: 3,
  kind: "building",
  name: "",
  ramp: null,
  ...changes,
});

export const wall = (
  start: [number, number],
  end: [number, number],
  changes: Partial<SceneWall> = {},
): SceneWall => ({ start, end, offset_m: 0, height_m: 2.5, ...changes });

export const bare: SceneData = {
  name: "bare",
  bounds: [0, 0, 100, 100],
  polygons: [],
  walls: [],
  stairs: [],
  doors: [],
  places: [],
  storeys: [0],
};

/**
 * A slab at 3 m over x of 10 to 20, which stairs reach from the west and a ramp from the south; a
 * door under it, a railing along its northern edge, and a kerb before the stairs.
 */
export const twoFloors: SceneData = {
  ...bare,
  name: "two floors",
  bounds: [0, 0, 30, 30],
  polygons: [
    box([10, 10], [20, 20], { kind: "floor", offset_m: 2.8, height_m: 0.2 }),
    box([14, 0], [16, 10], {
      kind: "floor",
      ramp: { start: [15, 0], end: [15, 10], start_height_m: 0 },
    }),
    box([2, 10], [3, 16], { kind: "floor", height_m: 0.4 }),
  ],
  walls: [wall([10, 20], [20, 20], { offset_m: 3, height_m: 1.1 })],
  stairs: [{ start: [4.9, 13], end: [10, 13], width_m: 2, bottom_m: 0, top_m: 3, steps: 17 }],
  doors: [{ name: "gate", ...wall([10, 24], [20, 24], { height_m: 2.2 }) }],
};
