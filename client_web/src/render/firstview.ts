/** The direction of the first view: to people, and over open ground rather than at a wall. */

import type { SceneSpawn } from "../net/messages";
import { STOREYS_APART_M } from "../world/heights";

const DIRECTIONS = 24;
/** Ground that is open further than this is no better. */
const OPEN_M = 25;
/** Somebody so far away counts half as much as somebody right here. */
const NEAR_M = 8;
/** Newcomers to a full spawn stand up to so far outside of it. */
const BESIDE_M = 2;

interface Spot {
  x: number;
  y: number;
}

/**
 * The best of some directions, radians from +x. `freeM` tells how far one sees along a direction;
 * nobody behind what ends that is seen.
 */
export function firstYaw(
  own: Spot,
  others: readonly Spot[],
  freeM: (yaw: number) => number,
): number {
  let best = { yaw: 0, worth: -1 };
  for (let k = 0; k < DIRECTIONS; k++) {
    const yaw = (2 * Math.PI * k) / DIRECTIONS;
    const openM = freeM(yaw);
    const people = others.reduce((sum, other) => sum + worthOf(own, other, yaw, openM), 0);
    const worth = Math.min(openM, OPEN_M) / OPEN_M + people;
    if (worth > best.worth) best = { yaw, worth };
  }
  return best.yaw;
}

/**
 * The direction that the scene names for those who came in where somebody stands, radians from +x;
 * null where it names none. A newcomer stands within a spawn's radius, or next to it if it is full.
 */
export function namedYaw(own: Spot & { z: number }, spawns: readonly SceneSpawn[]): number | null {
  const here = spawns.find(
    ({ position: [x, y], z_m, radius_m }) =>
      Math.abs(z_m - own.z) < STOREYS_APART_M &&
      Math.hypot(x - own.x, y - own.y) <= radius_m + BESIDE_M,
  );
  if (!here?.view) return null;
  const [x, y] = here.view;
  return Math.atan2(y - own.y, x - own.x);
}

/** The worth of somebody in a view: most in its middle and near by. */
function worthOf(own: Spot, other: Spot, yaw: number, openM: number): number {
  const [dx, dy] = [other.x - own.x, other.y - own.y];
  const awayM = Math.hypot(dx, dy);
  const ahead = (dx * Math.cos(yaw) + dy * Math.sin(yaw)) / Math.max(awayM, 1e-6);
  return ahead > 0 && awayM < openM ? ahead ** 6 / (1 + awayM / NEAR_M) : 0;
}
