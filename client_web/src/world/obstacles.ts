/**
 * Collision of a walking body with the scene: it slides along barriers, goes up and down steps, and
 * stays where there is nothing to step on.
 */

import type { Doors, SceneData } from "../net/messages";
import { type Barrier, barriersOf, type Reach, type Vec2 } from "./barriers";
import { SpatialGrid } from "./spatialgrid";
import { Floors } from "./floors";

/** The place of the feet. */
export type Vec3 = readonly [x: number, y: number, z: number];

/** No server lets bodies keep further from walls than this. */
const LARGEST_RADIUS_M = 1;
const STEP_M = 0.1;
/** A body that kept nearer to a wall than a step is long could step through it. */
const LEAST_RADIUS_M = STEP_M;
const PUSHES = 4;
/** Floors are looked for this far around: the server's cells reach beyond edges by as much. */
const CRACK_M = 0.13;
const NEAR_BY = [
  [0, 0],
  [1, 0],
  [-1, 0],
  [0, 1],
  [0, -1],
] as const;

type Built = Pick<SceneData, "bounds" | "polygons" | "walls" | "stairs" | "doors">;

export class Obstacles {
  /** Doors that are not listed stand open. */
  doors: Readonly<Doors> = {};
  private readonly barriers = new SpatialGrid<Barrier>();
  private readonly bounds: SceneData["bounds"];

  constructor(
    scene: Built,
    private readonly reach: Reach,
    private readonly floors = new Floors(scene),
    more: readonly Barrier[] = [],
  ) {
    this.bounds = scene.bounds;
    for (const barrier of [...barriersOf(scene, floors, reach.stepM), ...more]) this.add(barrier);
  }

  /** The place that a body reaches when it wants to move by (dx, dy). */
  walk(from: Vec3, dx: number, dy: number, clearanceM: number): Vec3 {
    const radiusM = Math.max(clearanceM, LEAST_RADIUS_M);
    const steps = Math.max(1, Math.ceil(Math.hypot(dx, dy) / STEP_M));
    let at = from;
    for (let i = 0; i < steps; i++) {
      const next = this.pushOut([at[0] + dx / steps, at[1] + dy / steps, at[2]], radiusM);
      const foothold = this.foothold(next);
      // A body in the air, as while a building is fetched, is not held there.
      if (foothold === null && this.foothold(at) !== null) break;
      at = [next[0], next[1], foothold ?? next[2]];
    }
    return at;
  }

  /** Whether a body can go straight from one place to the other. */
  clear(from: Vec3, to: Vec3, clearanceM: number): boolean {
    const radiusM = Math.max(clearanceM, LEAST_RADIUS_M);
    const length = Math.hypot(to[0] - from[0], to[1] - from[1]);
    const steps = Math.ceil(length / STEP_M);
    let z = from[2];
    for (let i = 1; i <= steps; i++) {
      const part = i / steps;
      const x = from[0] + (to[0] - from[0]) * part;
      const y = from[1] + (to[1] - from[1]) * part;
      const meets = this.near([x, y, z]).some((barrier) => {
        const [bx, by] = nearestOn(barrier, [x, y]);
        return Math.hypot(x - bx, y - by) < radiusM;
      });
      if (meets) return false;
      z = this.foothold([x, y, z]) ?? z;
    }
    return Math.abs(z - to[2]) <= this.reach.stepM;
  }

  /** Height of the floor that is a step away at most. */
  private foothold([x, y, z]: Vec3): number | null {
    for (const [aside, ahead] of NEAR_BY) {
      const floor = this.floors.at(x + aside * CRACK_M, y + ahead * CRACK_M, z);
      if (floor !== null && Math.abs(floor - z) <= this.reach.stepM) return floor;
    }
    return null;
  }

  private pushOut(wish: Vec3, radiusM: number): Vec3 {
    let [x, y] = wish;
    const z = wish[2];
    for (let push = 0; push < PUSHES; push++) {
      let moved = false;
      for (const barrier of this.near([x, y, z])) {
        const [bx, by] = nearestOn(barrier, [x, y]);
        const distance = Math.hypot(x - bx, y - by);
        if (distance >= radiusM || distance < 1e-9 || isBeyond(barrier, [x - bx, y - by])) continue;
        x = bx + ((x - bx) / distance) * radiusM;
        y = by + ((y - by) / distance) * radiusM;
        moved = true;
      }
      if (!moved) break;
    }
    const [x0, y0, x1, y1] = this.bounds;
    return [Math.min(x1, Math.max(x0, x)), Math.min(y1, Math.max(y0, y)), z];
  }

  /** Barriers that can be touched from here and reach between the highest step and the head. */
  private near([x, y, z]: Vec3): Barrier[] {
    return this.barriers
      .at(x, y)
      .filter(
        ({ bottomM, topM, door }) =>
          bottomM < z + this.reach.heightM &&
          topM > z + this.reach.stepM &&
          (door === null || this.doors[door] === false),
      );
  }

  /** Add a barrier to every square from which it can be touched. */
  private add(barrier: Barrier): void {
    const { a, b } = barrier;
    const reach = LARGEST_RADIUS_M;
    this.barriers.put(
      barrier,
      [
        Math.min(a[0], b[0]) - reach,
        Math.min(a[1], b[1]) - reach,
        Math.max(a[0], b[0]) + reach,
        Math.max(a[1], b[1]) + reach,
      ],
      (x, y, reachM) => {
        const [bx, by] = nearestOn(barrier, [x, y]);
        return Math.hypot(x - bx, y - by) <= reach + reachM;
      },
    );
  }
}

/** Whether a body at this offset from an edge is not on its floor. */
function isBeyond({ inward }: Barrier, [dx, dy]: Vec2): boolean {
  return inward !== undefined && inward[0] * dx + inward[1] * dy < 0;
}

function nearestOn({ a, b }: Barrier, [x, y]: Vec2): Vec2 {
  const dx = b[0] - a[0];
  const dy = b[1] - a[1];
  const lengthSq = dx * dx + dy * dy;
  if (lengthSq === 0) return a;
  const part = Math.max(0, Math.min(1, ((x - a[0]) * dx + (y - a[1]) * dy) / lengthSq));
  return [a[0] + dx * part, a[1] + dy * part];
}
