/**
 * Vectors and rotations that are written in place, so that drawing a frame allocates nothing.
 * Rotations are unit quaternions; what is turned by them points forwards (x), left (y) and up (z).
 */

export interface Vector {
  x: number;
  y: number;
  z: number;
}

export interface Rotation {
  w: number;
  x: number;
  y: number;
  z: number;
}

export function vector(): Vector {
  return { x: 0, y: 0, z: 0 };
}

export function rotation(): Rotation {
  return { w: 1, x: 0, y: 0, z: 0 };
}

export function set(out: Vector, x: number, y: number, z: number): void {
  out.x = x;
  out.y = y;
  out.z = z;
}

export function copy(from: Vector, out: Vector): void {
  set(out, from.x, from.y, from.z);
}

export function mix(from: Vector, to: Vector, part: number, out: Vector): void {
  out.x = from.x + (to.x - from.x) * part;
  out.y = from.y + (to.y - from.y) * part;
  out.z = from.z + (to.z - from.z) * part;
}

export function apart(a: Vector, b: Vector): number {
  return Math.hypot(a.x - b.x, a.y - b.y, a.z - b.z);
}

/** What (x, y, z) in the turned frame is in the world; added to `from`. */
export function carried(
  from: Vector,
  { w, x: qx, y: qy, z: qz }: Rotation,
  x: number,
  y: number,
  z: number,
  out: Vector,
): void {
  const tx = 2 * (qy * z - qz * y);
  const ty = 2 * (qz * x - qx * z);
  const tz = 2 * (qx * y - qy * x);
  set(
    out,
    from.x + x + w * tx + qy * tz - qz * ty,
    from.y + y + w * ty + qz * tx - qx * tz,
    from.z + z + w * tz + qx * ty - qy * tx,
  );
}

export function setRotation(out: Rotation, w: number, x: number, y: number, z: number): void {
  out.w = w;
  out.x = x;
  out.y = y;
  out.z = z;
}

export function copyRotation(from: Rotation, out: Rotation): void {
  setRotation(out, from.w, from.x, from.y, from.z);
}

/** A turn about the vertical. */
export function headed(heading: number, out: Rotation): void {
  setRotation(out, Math.cos(heading / 2), 0, 0, Math.sin(heading / 2));
}

/** First `b`, then `a`; `out` may be one of them. */
export function times(a: Rotation, b: Rotation, out: Rotation): void {
  setRotation(
    out,
    a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z,
    a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y,
    a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x,
    a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w,
  );
}

/** The short way from one to the other, by weights that are made a rotation again. */
export function mixRotations(from: Rotation, to: Rotation, part: number, out: Rotation): void {
  const dot = from.w * to.w + from.x * to.x + from.y * to.y + from.z * to.z;
  const other = dot < 0 ? -part : part;
  setRotation(
    out,
    from.w * (1 - part) + to.w * other,
    from.x * (1 - part) + to.x * other,
    from.y * (1 - part) + to.y * other,
    from.z * (1 - part) + to.z * other,
  );
  normalise(out);
}

export function normalise(q: Rotation): void {
  const length = Math.hypot(q.w, q.x, q.y, q.z);
  if (length === 0) setRotation(q, 1, 0, 0, 0);
  else setRotation(q, q.w / length, q.x / length, q.y / length, q.z / length);
}

/** The direction on the ground that a rotation's forwards points in, radians. */
export function headingOf({ w, x, y, z }: Rotation): number {
  return Math.atan2(2 * (x * y + w * z), 1 - 2 * (y * y + z * z));
}
