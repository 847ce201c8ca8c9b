/** Prisms on axes of their own, and boxes within them. */

import type { BufferGeometry } from "three";
import type { ScenePolygon } from "../net/messages";
import { box, centreOf, orientation } from "./shapes";

/** A prism on its own axes: middle of its foot, extents along and across. */
export interface Block {
  x: number;
  y: number;
  z: number;
  angle: number;
  lengthM: number;
  widthM: number;
  heightM: number;
}

export function blockOf({ points, offset_m, height_m }: ScenePolygon): Block {
  const [x, y] = centreOf(points);
  return { x, y, z: offset_m, heightM: height_m, ...orientation(points) };
}

/** A box within a block: its middle and its extents along, across and up from the foot. */
export function within(
  { x, y, z, angle }: Block,
  [along, across, up]: readonly [number, number, number],
  size: readonly [number, number, number],
  color: Parameters<typeof box>[3],
): BufferGeometry {
  const [cos, sin] = [Math.cos(angle), Math.sin(angle)];
  const middle = [x + along * cos - across * sin, y + along * sin + across * cos, z + up] as const;
  return box(middle, size, angle, color);
}
