/**
 * A chain of hinges that reaches for a target in two stages, the limb at its end in closed form and
 * then the trunk by cyclic coordinate descent: the twin of `actors/locomotion/reaching/two_stage.py`.
 *
 * Axes are left, up, forward; lengths are shares of the body's.
 */

import { apart, set, type Vector, vector } from "./vectors";

/** Hinges of a limb: three at its root, and the elbow. */
const LIMB = 4;
/** So many other turns of the limb are tried when the present one breaks a limit. */
const YAWS = 8;

export interface Hinge {
  /** In the frame that the hinges before it have turned. */
  readonly axis: Vector;
  /** From here to the next hinge; the last leads to the hand. */
  readonly offset: Vector;
  readonly low: number;
  readonly high: number;
}

/** Three columns: where left, up and forward have been turned to. */
export type Frame = readonly [Vector, Vector, Vector];

export class Chain {
  readonly angles: Float64Array;
  /** Where each hinge is, and the hand. */
  readonly pivots: readonly Vector[];
  /** How each hinge finds the world turned, and the hand. */
  readonly frames: readonly Frame[];
  private readonly trunk: number;
  private readonly axis = vector();
  private readonly local = vector();
  private readonly pose = new Float64Array(LIMB);
  private readonly best = new Float64Array(LIMB);

  constructor(readonly hinges: readonly Hinge[]) {
    this.angles = new Float64Array(hinges.length);
    this.trunk = hinges.length - LIMB;
    this.pivots = Array.from({ length: hinges.length + 1 }, vector);
    this.frames = this.pivots.map(() => [vector(), vector(), vector()] as const);
    set(this.frame(0)[0], 1, 0, 0);
    set(this.frame(0)[1], 0, 1, 0);
    set(this.frame(0)[2], 0, 0, 1);
  }

  /** Where everything is at the present angles. */
  place(): void {
    this.hinges.forEach(({ axis, offset }, k) => {
      const before = this.frame(k);
      const after = this.frame(k + 1);
      carry(before, axis, this.axis);
      for (let i = 0; i < 3; i++)
        turn(this.axis, this.angle(k), column(before, i), column(after, i));
      const to = this.pivot(k + 1);
      carry(after, offset, to);
      const from = this.pivot(k);
      set(to, from.x + to.x, from.y + to.y, from.z + to.z);
    });
  }

  /** Bring the hand to a target from the present angles; says how far off it is in the end. */
  reach(target: Vector, tolerance: number, sweeps: number): number {
    this.place();
    for (let sweep = 0; sweep < sweeps; sweep++) {
      this.bendLimb(target, tolerance, sweep === 0);
      if (this.left(target) <= tolerance) break;
      this.turnTrunk(target, tolerance);
      this.place();
      if (this.left(target) <= tolerance) break;
    }
    return this.left(target);
  }

  private left(target: Vector): number {
    return apart(this.tip, target);
  }

  private get tip(): Vector {
    return this.pivot(this.hinges.length);
  }

  /** Stage 2: each hinge of the trunk once, the outermost first, as far as it is allowed. */
  private turnTrunk(target: Vector, tolerance: number): void {
    const { tip, axis: a } = this;
    for (let k = this.trunk - 1; k >= 0; k--) {
      if (this.left(target) <= tolerance) return;
      const { axis, low, high } = this.hinge(k);
      const pivot = this.pivot(k);
      carry(this.frame(k), axis, a);
      const v = { x: tip.x - pivot.x, y: tip.y - pivot.y, z: tip.z - pivot.z };
      const t = { x: target.x - pivot.x, y: target.y - pivot.y, z: target.z - pivot.z };
      const sine =
        a.x * (v.y * t.z - v.z * t.y) +
        a.y * (v.z * t.x - v.x * t.z) +
        a.z * (v.x * t.y - v.y * t.x);
      const wished = this.angle(k) + Math.atan2(sine, dot(v, t) - dot(a, v) * dot(a, t));
      const allowed = clamp(wished, low, high);
      turn(a, allowed - this.angle(k), v, v);
      set(tip, pivot.x + v.x, pivot.y + v.y, pivot.z + v.z);
      this.angles[k] = allowed;
    }
  }

  /** Stage 1: the limb's hinges in closed form. One angle is free; others are tried if it fails. */
  private bendLimb(target: Vector, tolerance: number, search: boolean): void {
    const { local, trunk, pose, best } = this;
    const root = this.pivot(trunk);
    const [left, up, forward] = this.frame(trunk);
    const t = { x: target.x - root.x, y: target.y - root.y, z: target.z - root.z };
    set(local, dot(left, t), dot(up, t), dot(forward, t));
    const now = this.angle(trunk);
    const { low, high } = this.hinge(trunk);
    let least = this.bentAt(now, best);
    if (search && this.inReach()) {
      for (let tried = 1; least > tolerance && tried <= YAWS; tried++) {
        const aside = (high - low) * (2 / YAWS) * Math.floor((tried + 1) / 2);
        const off = this.bentAt(clamp(now + (tried % 2 ? aside : -aside), low, high), pose);
        if (off >= least) continue;
        least = off;
        best.set(pose);
      }
    }
    this.angles.set(best, trunk);
    this.place();
  }

  /** The pose of the limb, turned by a yaw, that brings its tip nearest; the distance left. */
  private bentAt(yaw: number, pose: Float64Array): number {
    const { local, trunk } = this;
    const upper = -this.hinge(trunk + 2).offset.y;
    const lower = -this.hinge(trunk + 3).offset.y;
    const bends = this.hinge(trunk + 3).axis.x;
    const cosine = (dot(local, local) - upper ** 2 - lower ** 2) / (2 * upper * lower);
    const elbow = this.limited(3, Math.acos(clamp(cosine, -1, 1)));
    const along = upper + lower * Math.cos(elbow);
    const behind = bends * lower * Math.sin(elbow);
    const x = Math.cos(yaw) * local.x - Math.sin(yaw) * local.z;
    const z = Math.sin(yaw) * local.x + Math.cos(yaw) * local.z;
    let aside = Math.atan2(x, -local.y);
    // The same plane, with the limb raised beyond the horizontal.
    if (Math.abs(aside) > Math.PI / 2) aside -= Math.sign(aside) * Math.PI;
    aside = this.limited(1, aside);
    const down = Math.sin(aside) * x - Math.cos(aside) * local.y;
    const lag = Math.atan2(behind, along);
    const flexion = this.limited(2, Math.atan2(z, down) + lag);
    pose[0] = yaw;
    pose[1] = aside;
    pose[2] = flexion;
    pose[3] = elbow;
    const reach = Math.hypot(along, behind);
    const level = reach * Math.cos(flexion - lag);
    return Math.hypot(
      level * Math.sin(aside) - x,
      -level * Math.cos(aside) - local.y,
      reach * Math.sin(flexion - lag) - z,
    );
  }

  /** Whether some angle of the elbow puts the tip as far from the limb's root. */
  private inReach(): boolean {
    const { low, high } = this.hinge(this.trunk + 3);
    const upper = this.hinge(this.trunk + 2).offset.y;
    const lower = this.hinge(this.trunk + 3).offset.y;
    const square = (angle: number): number =>
      upper ** 2 + lower ** 2 + 2 * upper * lower * Math.cos(angle);
    const wanted = dot(this.local, this.local);
    return square(high) <= wanted && wanted <= square(low);
  }

  /** An angle of the limb within its limits. */
  private limited(index: number, angle: number): number {
    const { low, high } = this.hinge(this.trunk + index);
    return clamp(angle, low, high);
  }

  private hinge(k: number): Hinge {
    return known(this.hinges[k]);
  }

  private angle(k: number): number {
    return this.angles[k] ?? 0;
  }

  private pivot(k: number): Vector {
    return known(this.pivots[k]);
  }

  private frame(k: number): Frame {
    return known(this.frames[k]);
  }
}

/** A vector of a frame, seen from outside. */
function carry([a, b, c]: Frame, { x, y, z }: Vector, out: Vector): void {
  set(out, a.x * x + b.x * y + c.x * z, a.y * x + b.y * y + c.y * z, a.z * x + b.z * y + c.z * z);
}

/** A vector turned about a unit axis; `out` may be the vector. */
function turn(axis: Vector, angle: number, v: Vector, out: Vector): void {
  const c = Math.cos(angle);
  const s = Math.sin(angle);
  const along = (1 - c) * dot(axis, v);
  set(
    out,
    c * v.x + s * (axis.y * v.z - axis.z * v.y) + along * axis.x,
    c * v.y + s * (axis.z * v.x - axis.x * v.z) + along * axis.y,
    c * v.z + s * (axis.x * v.y - axis.y * v.x) + along * axis.z,
  );
}

function column(frame: Frame, index: number): Vector {
  return known(frame[index]);
}

function dot(a: Vector, b: Vector): number {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

function clamp(value: number, low: number, high: number): number {
  return Math.min(Math.max(value, low), high);
}

function known<T>(value: T | undefined): T {
  if (value === undefined) throw new RangeError("the chain has no such hinge");
  return value;
}
