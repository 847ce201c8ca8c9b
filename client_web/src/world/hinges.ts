/**
 * A chain of hinges that reaches for a target in two stages, the limb at its end in closed form and
 * then the trunk by cyclic coordinate descent: the twin of `actors/locomotion/two_stage.py`.
 *
 * Axes are left, up, forward; lengths are shares of the body's.
 */

import { MathUtils, Quaternion, Vector3 } from "three";

const { clamp } = MathUtils;

/** Hinges of a limb: three at its root, and the elbow. */
const LIMB = 4;
/** The number of other turns of the limb that are tried when the present one breaks a limit. */
const YAWS = 8;

export interface Hinge {
  /** The axis in the frame that the hinges before it have turned. */
  readonly axis: Vector3;
  /** From here to the next hinge; the last leads to the hand. */
  readonly offset: Vector3;
  readonly low: number;
  readonly high: number;
}

export class Chain {
  readonly angles: Float64Array;
  /** The places of the hinges, and last of the hand. */
  readonly pivots: readonly Vector3[];
  /** The rotations of the hinges by those before them, and last of the hand by all. */
  readonly frames: readonly Quaternion[];
  private readonly trunk: number;
  private readonly axis = new Vector3();
  private readonly turned = new Quaternion();
  /** The tip and the target, seen from a hinge. */
  private readonly tipThere = new Vector3();
  private readonly targetThere = new Vector3();
  private readonly cross = new Vector3();
  /** The target in the frame of the limb's root. */
  private readonly local = new Vector3();
  private readonly pose = new Float64Array(LIMB);
  private readonly best = new Float64Array(LIMB);

  constructor(readonly hinges: readonly Hinge[]) {
    this.angles = new Float64Array(hinges.length);
    this.trunk = hinges.length - LIMB;
    this.pivots = Array.from({ length: hinges.length + 1 }, () => new Vector3());
    this.frames = this.pivots.map(() => new Quaternion());
  }

  /** Place hinges and hand by the present angles. */
  place(): void {
    this.hinges.forEach(({ axis, offset }, k) => {
      const frame = this.frame(k + 1);
      this.turned.setFromAxisAngle(axis, this.angle(k));
      frame.multiplyQuaternions(this.frame(k), this.turned);
      this.pivot(k + 1)
        .copy(offset)
        .applyQuaternion(frame)
        .add(this.pivot(k));
    });
  }

  /** Bring the hand to a target from the present angles; returns the distance that is left. */
  reach(target: Vector3, tolerance: number, sweeps: number): number {
    this.place();
    for (let sweep = 0; sweep < sweeps; sweep++) {
      this.bendLimb(target, tolerance, sweep === 0);
      if (this.offBy(target) <= tolerance) break;
      this.turnTrunk(target, tolerance);
      this.place();
      if (this.offBy(target) <= tolerance) break;
    }
    return this.offBy(target);
  }

  private offBy(target: Vector3): number {
    return this.tip.distanceTo(target);
  }

  private get tip(): Vector3 {
    return this.pivot(this.hinges.length);
  }

  /** Stage 2: each hinge of the trunk once, the outermost first, as far as it is allowed. */
  private turnTrunk(target: Vector3, tolerance: number): void {
    const { tip, axis: a, tipThere, targetThere, cross } = this;
    for (let k = this.trunk - 1; k >= 0; k--) {
      if (this.offBy(target) <= tolerance) return;
      const { axis, low, high } = this.hinge(k);
      const pivot = this.pivot(k);
      a.copy(axis).applyQuaternion(this.frame(k));
      tipThere.subVectors(tip, pivot);
      targetThere.subVectors(target, pivot);
      const sine = a.dot(cross.crossVectors(tipThere, targetThere));
      const cosine = tipThere.dot(targetThere) - a.dot(tipThere) * a.dot(targetThere);
      const allowed = clamp(this.angle(k) + Math.atan2(sine, cosine), low, high);
      tipThere.applyAxisAngle(a, allowed - this.angle(k));
      tip.addVectors(pivot, tipThere);
      this.angles[k] = allowed;
    }
  }

  /** Stage 1: the limb's hinges in closed form. One angle is free; others are tried if it fails. */
  private bendLimb(target: Vector3, tolerance: number, search: boolean): void {
    const { local, trunk, pose, best } = this;
    this.turned.copy(this.frame(trunk)).conjugate();
    local.subVectors(target, this.pivot(trunk)).applyQuaternion(this.turned);
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
    const cosine = (local.lengthSq() - upper ** 2 - lower ** 2) / (2 * upper * lower);
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
    const wanted = this.local.lengthSq();
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

  private pivot(k: number): Vector3 {
    return known(this.pivots[k]);
  }

  private frame(k: number): Quaternion {
    return known(this.frames[k]);
  }
}

function known<T>(value: T | undefined): T {
  if (value === undefined) throw new RangeError("the chain has no such hinge");
  return value;
}
