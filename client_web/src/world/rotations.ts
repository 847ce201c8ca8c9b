/** Operations on rotations that three.js lacks. Bodies have x forwards, y to the left and z up. */

import { type Quaternion, Vector3 } from "three";

export const UP = new Vector3(0, 0, 1);

const arm = new Vector3();

/** The place in the world of (x, y, z) in a frame with this origin; `out` may be the origin. */
export function transformPoint(
  origin: Vector3,
  rotation: Quaternion,
  x: number,
  y: number,
  z: number,
  out: Vector3,
): void {
  out.addVectors(origin, arm.set(x, y, z).applyQuaternion(rotation));
}

/**
 * The normalised linear interpolation, the short way round; `out` may be one of both. The server
 * blends rotations like this too, so three's `slerp` would give other joints.
 */
export function nlerp(from: Quaternion, to: Quaternion, part: number, out: Quaternion): void {
  const before = 1 - part;
  const after = from.dot(to) < 0 ? -part : part;
  out
    .set(
      from.x * before + to.x * after,
      from.y * before + to.y * after,
      from.z * before + to.z * after,
      from.w * before + to.w * after,
    )
    .normalize();
}

/** The direction on the ground that forwards points in, radians from +x. */
export function headingOf({ x, y, z, w }: Quaternion): number {
  return Math.atan2(2 * (x * y + w * z), 1 - 2 * (y * y + z * z));
}
