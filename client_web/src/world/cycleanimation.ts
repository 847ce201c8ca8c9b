/**
 * A body that follows its snapshots with the common gait cycle, without steps of its own: everybody
 * far away, and everybody else for a moment until their steps are known.
 */

import { Quaternion, type Vector3 } from "three";
import { cyclePosture, stepAt } from "./cycle";
import { copyPose, type Pose } from "./interpolation";
import type { FootPosture, Posture } from "./posture";
import type { Build } from "./skeleton";
import { UP } from "./rotations";

/** Heights are drawn evened out over this time, so that nobody hops from tread to tread. */
const LIFT_S = 0.09;
/** A greater difference in height is no step. */
const FALL_M = 1.5;
const PACE_S = 0.15;
/** A larger step in one frame is no walking. */
const JUMP_M = 1;

export class CycleAnimation {
  /** The place of the body, its height evened out. */
  readonly place: Pose;
  private phase: number;
  /** Leg lengths a second. */
  private pace = 0;

  constructor(
    private readonly build: Build,
    start: Pose,
  ) {
    this.place = { ...start };
    // A crowd does not walk in step.
    this.phase = Math.abs(7.13 * start.x + 3.71 * start.y) % 1;
  }

  /** Follow the snapshots; the phase follows the distance, so that feet hardly slide. */
  advance(snapshots: Readonly<Pose>, frameS: number): void {
    const { place, build } = this;
    const dx = snapshots.x - place.x;
    const dy = snapshots.y - place.y;
    const z = lifted(place.z, snapshots.z, frameS);
    copyPose(snapshots, place);
    place.z = z;
    const distance = Math.hypot(dx, dy);
    if (frameS <= 0 || distance > JUMP_M) return;
    const legs = distance / build.legM;
    this.pace += (legs / frameS - this.pace) * Math.min(1, frameS / PACE_S);
    const ahead = dx * Math.cos(place.heading) + dy * Math.sin(place.heading);
    const cycles = legs / (2 * Math.max(stepAt(this.pace), 0.1));
    this.phase += ahead < 0 ? -cycles : cycles;
    this.phase -= Math.floor(this.phase);
  }

  pose(out: Posture): void {
    const { x, y, z, heading } = this.place;
    cyclePosture(this.phase, stepAt(this.pace), out);
    out.pelvis.premultiply(turn.setFromAxisAngle(UP, heading));
    this.bring(out.root, x, y, z, heading);
    this.step(out.left, x, y, z, heading);
    this.step(out.right, x, y, z, heading);
  }

  private step(foot: FootPosture, x: number, y: number, z: number, heading: number): void {
    this.bring(foot.heel, x, y, z, heading);
    foot.heading = heading;
  }

  /** Bring a point of a body of leg length 1 that faces +x over the origin to its place. */
  private bring(point: Vector3, x: number, y: number, z: number, heading: number): void {
    const { legM } = this.build;
    const c = Math.cos(heading) * legM;
    const s = Math.sin(heading) * legM;
    point.set(x + c * point.x - s * point.y, y + s * point.x + c * point.y, z + legM * point.z);
  }
}

const turn = new Quaternion();

/** The height on the way from the one that was drawn to the one that is right. */
function lifted(drawnM: number, rightM: number, frameS: number): number {
  const off = rightM - drawnM;
  return Math.abs(off) > FALL_M ? rightM : drawnM + off * (1 - Math.exp(-frameS / LIFT_S));
}
