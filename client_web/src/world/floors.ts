/** The surfaces that one can stand on: the ground, and the tops of solids. */

import type { SceneData } from "../net/messages";
import { SpatialGrid } from "./spatialgrid";
import { isInside, type Solid, solidsOf } from "./solids";

/** With less room above it nobody stands on a surface. */
const LOWEST_M = 1;
/** A solid that begins this high above the feet is a ceiling. */
const CEILING_M = 1.2;
const SAME_M = 1e-6;

export class Floors {
  readonly solids: readonly Solid[];
  /** The ground that is walked on; null in a building that is a mesh. */
  private readonly ground: SceneData["bounds"] | null;
  private readonly grid = new SpatialGrid<Solid>();

  constructor(
    scene: Pick<SceneData, "bounds" | "polygons" | "stairs" | "mesh">,
    mesh: readonly Solid[] = [],
  ) {
    this.ground = scene.mesh === undefined ? scene.bounds : null;
    this.solids = [...solidsOf(scene), ...mesh];
    for (const solid of this.solids) {
      const xs = solid.ring.map(([x]) => x);
      const ys = solid.ring.map(([, y]) => y);
      this.grid.put(solid, [Math.min(...xs), Math.min(...ys), Math.max(...xs), Math.max(...ys)]);
    }
  }

  /** Height of the floor at (x, y) that is nearest to the height z; null where there is none. */
  at(x: number, y: number, z: number): number | null {
    const column = this.column(x, y);
    const tops = column.filter(({ carries }) => carries).map(({ topM }) => topM(x, y));
    if (this.ground && isWithin(this.ground, x, y)) tops.push(0);
    let nearest: number | null = null;
    for (const top of tops) {
      if (nearest !== null && Math.abs(top - z) >= Math.abs(nearest - z)) continue;
      const filled = column.some(
        ({ bottomM, topM }) => bottomM(x, y) < top + LOWEST_M && topM(x, y) > top + SAME_M,
      );
      if (!filled) nearest = top;
    }
    return nearest;
  }

  /** Whether somebody with the feet at (x, y, z) has something overhead. */
  covered(x: number, y: number, z: number): boolean {
    return this.column(x, y).some(({ bottomM }) => bottomM(x, y) > z + CEILING_M);
  }

  private column(x: number, y: number): Solid[] {
    return this.grid.at(x, y).filter(({ ring }) => isInside(ring, x, y));
  }
}

function isWithin([x0, y0, x1, y1]: SceneData["bounds"], x: number, y: number): boolean {
  return x >= x0 && x <= x1 && y >= y0 && y <= y1;
}
