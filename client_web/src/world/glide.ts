/**
 * A body that goes along its snapshots without steps of its own: those who are far away, and
 * everybody for a moment until their steps are known.
 */

import type { Pose } from "./motion";
import type { Posture } from "./posture";
import { type Build, HIP_ASIDE } from "./skeleton";
import { headed, set, setRotation } from "./vectors";

/** Heights are drawn evened out over this time, so that nobody hops from tread to tread. */
const LIFT_S = 0.09;
/** A greater difference in height is no step. */
const FALL_M = 1.5;
/** The hips of one who stands, in leg lengths. */
const STANDING = 0.993;

export class Glide {
  readonly place: Pose;

  constructor(
    private readonly build: Build,
    start: Pose,
  ) {
    this.place = { ...start };
  }

  advance(snapshots: Pose, frameS: number): void {
    const z = lifted(this.place.z, snapshots.z, frameS);
    Object.assign(this.place, snapshots);
    this.place.z = z;
  }

  pose(out: Posture): void {
    const { x, y, z, heading } = this.place;
    const { legM } = this.build;
    set(out.root, x, y, z + STANDING * legM);
    headed(heading, out.pelvis);
    setRotation(out.chest, 1, 0, 0, 0);
    for (const [foot, side] of [
      [out.left, 1],
      [out.right, -1],
    ] as const) {
      const asideM = side * HIP_ASIDE * legM;
      set(foot.heel, x - Math.sin(heading) * asideM, y + Math.cos(heading) * asideM, z);
      foot.pitch = foot.raised = 0;
      foot.heading = heading;
    }
    out.leftArm.shoulder = out.rightArm.shoulder = 0;
    out.leftArm.elbow = out.rightArm.elbow = 0.15;
  }
}

/** The height on the way from the one that was drawn to the one that is right. */
function lifted(drawnM: number, rightM: number, frameS: number): number {
  const off = rightM - drawnM;
  return Math.abs(off) > FALL_M ? rightM : drawnM + off * (1 - Math.exp(-frameS / LIFT_S));
}
