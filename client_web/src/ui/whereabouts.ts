/** Where somebody is, in words: "3 m, to the left, away". */

import { STOREYS_APART_M } from "../world/heights";
import type { Avatar } from "../world/world";

/** Names of the eight directions, the first straight ahead, and then to the left. */
const SIDES = [
  "ahead",
  "ahead to the left",
  "to the left",
  "behind to the left",
  "behind",
  "behind to the right",
  "to the right",
  "ahead to the right",
] as const;

/** The name of a direction on the ground, seen by somebody who looks along `yaw`; radians. */
export function sideOf(direction: number, yaw: number): string {
  const eighth = Math.round((direction - yaw) / (Math.PI / 4));
  return SIDES[((eighth % 8) + 8) % 8] ?? "ahead";
}

export function whereabouts(
  { pose, away }: Pick<Avatar, "pose" | "away">,
  here: { x: number; y: number; z: number },
  yaw: number,
): string {
  const [dx, dy, dz] = [pose.x - here.x, pose.y - here.y, pose.z - here.z];
  const parts = [`${Math.round(Math.hypot(dx, dy))} m`, sideOf(Math.atan2(dy, dx), yaw)];
  if (Math.abs(dz) > STOREYS_APART_M) parts.push(dz > 0 ? "further up" : "further down");
  if (away) parts.push("away from the screen");
  return parts.join(", ");
}
