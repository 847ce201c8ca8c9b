/** Angles in radians, counter-clockwise from +x (east). */

/** The same angle in (-π, π]. */
export function wrapAngle(angle: number): number {
  const turned = angle % (2 * Math.PI);
  if (turned > Math.PI) return turned - 2 * Math.PI;
  return turned <= -Math.PI ? turned + 2 * Math.PI : turned;
}

/** From `a` to `b` the short way round; `part` 0 gives `a`, 1 gives `b`. */
export function mixAngles(a: number, b: number, part: number): number {
  return wrapAngle(a + wrapAngle(b - a) * part);
}
